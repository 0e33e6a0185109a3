//! The Hamiltonian of a declaration: as it stands, or that of a Lagrangian.

use super::configuration::Configuration;
use super::legendre::{self, Lagrangian};
use super::{discrete, size};
use crate::ast::{Declaration, Energy, Name};
use crate::diagnostic::{Origin, Report};
use crate::model::{self, Parameter};
use crate::symbolic::{ExprId, Graph};

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

impl Motion<'_> {
    /// The Hamiltonian for the lowered function of the declaration, and the Lagrangian if it is one.
    ///
    /// # Errors
    /// A Lagrangian without a Hamiltonian, reported.
    pub fn hamiltonian(
        &self,
        graph: &mut Graph,
        function: ExprId,
        report: &mut Report,
    ) -> Option<(ExprId, Option<model::Lagrangian>)> {
        match &self.declaration.energy {
            Energy::Hamiltonian(_) => Some((function, None)),
            Energy::Lagrangian { velocity, value }
            | Energy::DiscreteLagrangian { velocity, value } => {
                self.of_lagrangian(graph, function, (velocity, value.origin), report)
            }
        }
    }

    fn of_lagrangian(
        &self,
        graph: &mut Graph,
        function: ExprId,
        (velocity, origin): (&[Name], Origin),
        report: &mut Report,
    ) -> Option<(ExprId, Option<model::Lagrangian>)> {
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
        let (hamiltonian, transform) = legendre::hamiltonian(graph, &lagrangian, report)?;
        // one that depends on the group element or the time is none on the algebra alone
        let reduced = self.on_algebra.then(|| model::Lagrangian {
            value,
            velocity: velocity.to_vec(),
            transform,
            discrete,
            in_entries: self.declaration.group.is_some(),
        });
        Some((hamiltonian, reduced))
    }
}
