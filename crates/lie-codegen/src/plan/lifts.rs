//! The flows on linear spaces over g* that methods ask for.

use super::function::Function;
use super::planner::Planner;
use super::structure::{Structure, Unitary, Vectors};
use crate::methods::{Choice, Lift};
use crate::structure::lifts::Smallest;

impl Structure {
    /// The flows on linear spaces.
    pub fn flows(&self) -> impl Iterator<Item = &Function> {
        let spins = self.spins.iter().filter_map(|spins| spins.flow.as_ref());
        let vectors = self
            .vectors
            .iter()
            .filter_map(|vectors| vectors.flow.as_ref());
        let columns = self
            .representation
            .iter()
            .filter_map(|found| found.flow.as_ref());
        let factors = self.unitary.iter().filter_map(|found| found.flow.as_ref());
        spins.chain(vectors).chain(factors).chain(columns)
    }
}

impl Planner<'_> {
    /// Whether a method that evaluates its stages together on the points of a space is asked for.
    fn lifts(&self, lift: Lift) -> bool {
        let smallest = match self.structure.smallest {
            Some(Smallest::Hopf) => Some(Lift::Hopf),
            Some(Smallest::Quaternion) => Some(Lift::Quaternion),
            Some(Smallest::Unitary) => Some(Lift::Unitary),
            Some(Smallest::Representation) => Some(Lift::Representation),
            None => None,
        };
        self.methods.iter().any(|choice| match choice {
            Choice::Collective(order, Lift::Smallest) => *order > 6 && smallest == Some(lift),
            Choice::Collective(order, other) => *order > 6 && *other == lift,
            Choice::Isospectral(order) => *order > 6 && lift == Lift::Representation,
            _ => false,
        })
    }

    /// The flow on a space, where it is asked for.
    pub(super) fn flow_on(&mut self, lift: Lift) -> Option<Function> {
        if !self.lifts(lift) {
            return None;
        }
        let kernel = match lift {
            Lift::Hopf => self.source.spinor_flow(),
            Lift::Quaternion => self.source.quaternion_flow(),
            Lift::Unitary => self.source.unitary_flow(),
            _ => self.source.column_flow(),
        }?;
        Some(self.function(&kernel))
    }

    pub(super) fn unitary(&mut self) -> Option<Unitary> {
        let unitary = self.source.unitary()?;
        Some(Unitary {
            degree: unitary.degree,
            point: unitary.point(),
            flow: self.flow_on(Lift::Unitary),
        })
    }

    pub(super) fn vectors(&mut self) -> Option<Vectors> {
        let vectors = self.source.vectors()?.clone();
        Some(Vectors {
            rotation: vectors.rotation,
            vectors: vectors.vectors,
            scale: self.value(vectors.scale),
            flow: self.flow_on(Lift::Quaternion),
        })
    }
}
