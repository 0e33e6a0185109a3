//! What is recorded beside the state: first integrals, observables, events.

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

/// A function whose zeros along a run are found.
#[derive(Clone, Debug)]
pub struct Event {
    /// Its name.
    pub name: Name,
    /// The function.
    pub when: Expr,
    /// Which zeros count: 1 where it rises, -1 where it falls, 0 for both.
    pub direction: i8,
    /// Whether the first of them ends the run.
    pub stop: bool,
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

    /// The expressions of what is recorded beside the state, and those of events.
    pub fn recorded(&self) -> impl Iterator<Item = &Expr> {
        let integrals = self.integrals.iter().map(|(_, value)| value);
        let observables = self.observables.iter().map(|o| &o.value);
        let events = self.events.iter().map(|event| &event.when);
        integrals.chain(observables).chain(events)
    }
}
