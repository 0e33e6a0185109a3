//! The Hamiltonian of a declaration: as it stands, or that of a Lagrangian.

use super::legendre::{self, Lagrangian, Transform};
use super::{derivatives, discrete, entries};
use crate::algebra::{Parametric, Representation};
use crate::model::configuration::Configuration;
use crate::model::{self, Discrete, Parameter};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Declaration, Energy, Name};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// What the equations of motion come from.
pub struct Motion<'a> {
    /// The declaration.
    pub declaration: &'a Declaration,
    /// The parameters with their defaults.
    pub parameters: &'a [Parameter],
    /// The group element and the time, where the function depends on them.
    pub configuration: Option<&'a Configuration>,
    /// The matrices of the algebra of the system.
    pub representation: Option<&'a Representation>,
    /// The same, where they have parameters.
    pub parametric: Option<&'a Parametric>,
    /// Whether the bracket is that of an algebra.
    pub is_lie: bool,
    /// Whether it is, and the function one on it alone.
    pub on_algebra: bool,
}

/// The Hamiltonian of a declaration.
#[derive(Clone, Copy, Debug)]
pub struct Declared {
    /// The function whose field moves the state: of a system that depends on the time `H(t, mu) + p`.
    pub value: ExprId,
    /// As it was declared.
    pub energy: ExprId,
}

impl Motion<'_> {
    /// The energy for the lowered function of the declaration.
    ///
    /// # Errors
    /// A Lagrangian without a Hamiltonian.
    pub fn energy(
        &self,
        graph: &mut Graph,
        function: ExprId,
    ) -> Result<model::Energy<Declared>, Diagnostic> {
        let energy = match &self.declaration.energy {
            Energy::Hamiltonian(_) => model::Energy::Expression(function),
            Energy::Lagrangian { velocity, value }
            | Energy::DiscreteLagrangian { velocity, value } => {
                self.lagrangian(graph, function, (velocity, value.origin))?
            }
        };
        Ok(energy.with(|energy| Declared {
            value: self.extended(graph, energy),
            energy,
        }))
    }

    /// The Hamiltonian whose field moves the state: where the time is part of it, with the momentum of the time.
    fn extended(&self, graph: &mut Graph, energy: ExprId) -> ExprId {
        match self.configuration {
            Some(configuration) if configuration.time => {
                let momentum = graph.symbol(Symbol::Coordinate(configuration.momenta - 1));
                graph.add(energy, momentum)
            }
            _ => energy,
        }
    }

    /// Whether entries of the group element may stand in a discrete Lagrangian.
    fn in_entries(&self) -> bool {
        self.declaration.energy.has_step() && self.declaration.group.is_some()
    }

    fn lagrangian(
        &self,
        graph: &mut Graph,
        function: ExprId,
        (velocity, origin): (&[Name], Origin),
    ) -> Result<model::Energy<ExprId>, Diagnostic> {
        let count = velocity.len();
        derivatives::momenta(graph, function, count, origin)?;
        let has_step = self.declaration.energy.has_step();
        if has_step && !self.on_algebra {
            return Err(discrete::elsewhere(origin));
        }
        if let Some(parametric) = self.parametric.filter(|_| self.in_entries()) {
            let what = "a discrete Lagrangian in entries of the group element";
            let (message, help) = parametric.refusal(what, |index| &self.parameters[index].name);
            return Err(Diagnostic::new(Kind::Representation, origin, message).help(help));
        }
        let in_entries = entries::in_entries(self.declaration, self.representation, function);
        let in_entries = in_entries.filter(|_| has_step);
        if let Some(written) = &in_entries
            && let Some(large) = entries::too_large(&mut graph.clone(), written, origin)
        {
            return Err(large);
        }
        let value = match has_step {
            true => discrete::reduced(graph, (function, in_entries.as_ref()), count, origin)?,
            false => function,
        };
        let lagrangian = Lagrangian {
            value,
            velocity,
            origin,
            parameters: self.parameters,
            configuration: self.configuration,
            iterates: self.is_lie && !self.declaration.is_driven(),
        };
        let transform = legendre::hamiltonian(graph, &lagrangian)?;
        let discrete = has_step.then(|| Discrete {
            value: match &in_entries {
                Some(written) => written.of_coordinates(graph),
                None => function,
            },
            in_entries,
        });
        let lagrangian = model::Lagrangian {
            reduced: self.on_algebra,
            value,
            velocity: velocity.to_vec(),
            discrete,
        };
        Ok(match transform {
            Transform::InVelocity(function) => {
                model::Energy::Legendre(lagrangian, self.extended(graph, function))
            }
            Transform::Exact(hamiltonian) if self.on_algebra => {
                model::Energy::Lagrangian(lagrangian, hamiltonian)
            }
            // one that depends on the group element or the time is none on the algebra alone
            Transform::Exact(hamiltonian) => model::Energy::Transformed(hamiltonian),
        })
    }
}
