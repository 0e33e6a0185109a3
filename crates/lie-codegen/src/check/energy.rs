//! The Hamiltonian of a declaration: as it stands, or that of a Lagrangian.

use super::legendre::{self, Lagrangian, Transform};
use super::{discrete, size};
use crate::model::configuration::Configuration;
use crate::model::{self, Discrete, Parameter};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Declaration, Energy, Name};
use lie_syntax::diagnostic::{Origin, Report};

/// What the equations of motion come from.
pub struct Motion<'a> {
    /// The declaration.
    pub declaration: &'a Declaration,
    /// The parameters with their defaults.
    pub parameters: &'a [Parameter],
    /// The group element and the time, where the function depends on them.
    pub configuration: Option<&'a Configuration>,
    /// Whether the bracket is that of an algebra, and the function one on it alone.
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
    /// A Lagrangian without a Hamiltonian, reported.
    pub fn energy(
        &self,
        graph: &mut Graph,
        function: ExprId,
        report: &mut Report,
    ) -> Option<model::Energy<Declared>> {
        let energy = match &self.declaration.energy {
            Energy::Hamiltonian(_) => model::Energy::Expression(function),
            Energy::Lagrangian { velocity, value }
            | Energy::DiscreteLagrangian { velocity, value } => {
                self.of_lagrangian(graph, function, (velocity, value.origin), report)?
            }
        };
        Some(energy.with(|energy| Declared {
            value: match self.configuration {
                Some(configuration) if configuration.time => {
                    let momentum = graph.symbol(Symbol::Coordinate(configuration.momenta - 1));
                    graph.add(energy, momentum)
                }
                _ => energy,
            },
            energy,
        }))
    }

    fn of_lagrangian(
        &self,
        graph: &mut Graph,
        function: ExprId,
        (velocity, origin): (&[Name], Origin),
        report: &mut Report,
    ) -> Option<model::Energy<ExprId>> {
        let count = velocity.len();
        if !size::lagrangian(graph, function, count, origin, report) {
            return None;
        }
        let discrete = self.declaration.energy.has_step().then_some(function);
        if discrete.is_some() && !self.on_algebra {
            report.push(discrete::elsewhere(origin));
            return None;
        }
        let value = match discrete {
            Some(discrete) => discrete::lagrangian(graph, discrete, count, origin, report)?,
            None => function,
        };
        let lagrangian = Lagrangian {
            value,
            velocity,
            origin,
            parameters: self.parameters,
            configuration: self.configuration,
            on_algebra: self.on_algebra,
        };
        let transform = legendre::hamiltonian(graph, &lagrangian, report)?;
        let in_entries = self.declaration.group.is_some();
        let lagrangian = model::Lagrangian {
            value,
            velocity: velocity.to_vec(),
            discrete: discrete.map(|value| Discrete { value, in_entries }),
        };
        Some(match transform {
            Transform::InVelocity(function) => model::Energy::Legendre(lagrangian, function),
            Transform::Exact(hamiltonian) if self.on_algebra => {
                model::Energy::Lagrangian(lagrangian, hamiltonian)
            }
            // one that depends on the group element or the time is none on the algebra alone
            Transform::Exact(hamiltonian) => model::Energy::Expression(hamiltonian),
        })
    }
}
