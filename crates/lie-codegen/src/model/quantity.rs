//! What is recorded beside state, energy and Casimirs, and events.

use lie_core::EventRule;
use lie_symbolic::symbolic::ExprId;
use lie_syntax::diagnostic::Origin;

/// What a recorded function is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum QuantityKind {
    /// The work of forces and damping.
    Work,
    /// A first integral, proven to be one.
    Integral,
    /// A function that somebody wants to see.
    Observable,
    /// What acts from outside.
    Input,
}

impl QuantityKind {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Work => "work",
            Self::Integral => "first integral",
            Self::Observable => "observable",
            Self::Input => "input",
        }
    }
}

/// A named function of the state, a column of a run. Those of a model stand in the order of their kinds.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Where its expression stands.
    pub origin: Origin,
    /// The function.
    pub expr: ExprId,
    /// What it is.
    pub kind: QuantityKind,
    /// Whether it is an angle, whose jumps by 2 pi are taken out along a run.
    pub unwrap: bool,
    /// Whether it has several branches, between which its value jumps.
    pub multivalued: bool,
}

/// A function whose zeros along a run are found.
#[derive(Clone, Debug)]
pub struct Event {
    /// Its name.
    pub name: String,
    /// Where its expression stands.
    pub origin: Origin,
    /// The function.
    pub expr: ExprId,
    /// Which zeros count, and what they do.
    pub rule: EventRule,
}

/// The column of the work of forces and damping.
pub const WORK: &str = "work";

impl Quantity {
    /// The work of what acts, as a function of the state.
    pub fn work(origin: Origin, expr: ExprId) -> Self {
        Self {
            name: WORK.to_owned(),
            origin,
            expr,
            kind: QuantityKind::Work,
            unwrap: false,
            multivalued: false,
        }
    }

    /// Whether its drift is an error of the method.
    pub fn is_conserved(&self) -> bool {
        self.kind == QuantityKind::Integral && !self.multivalued
    }
}
