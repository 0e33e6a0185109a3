//! What is recorded beside the state: first integrals and observables.

use super::{Declaration, Expr, Name};

/// A function of the state that is recorded beside it.
#[derive(Clone, Debug)]
pub struct Observable {
    /// Its name.
    pub name: Name,
    /// The function.
    pub value: Expr,
    /// Whether it is an angle, which is recorded without its jumps by 2 pi.
    pub unwrap: bool,
}

impl Declaration {
    /// The names of what is recorded beside the state, and what it is.
    pub fn quantities(&self) -> impl Iterator<Item = (&Name, &'static str)> {
        let integrals = self.integrals.iter();
        let integrals = integrals.map(|(name, _)| (name, "first integral"));
        let observables = self.observables.iter();
        let observables = observables.map(|o| (&o.name, "observable"));
        let inputs = self.inputs.iter().map(|input| (&input.name, "input"));
        integrals.chain(observables).chain(inputs)
    }

    /// The expressions of what is recorded beside the state.
    pub fn recorded(&self) -> impl Iterator<Item = &Expr> {
        let integrals = self.integrals.iter().map(|(_, value)| value);
        integrals.chain(self.observables.iter().map(|o| &o.value))
    }
}
