//! The observer that keeps what is saved.

use super::events::Event;
use super::observer::{Observer, Progress};
use super::pace::{Assessed, Chosen};
use super::quantities::Quantities;
use super::solution::Solution;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use core::ops::ControlFlow;

/// Records the saved states with energy, Casimirs and declared functions.
#[derive(Clone, Debug)]
pub struct Recorder<S, V> {
    /// What was recorded.
    pub solution: Solution<S, V>,
    quantities: Quantities<S>,
    events: bool,
}

impl<S: Scalar, V> Recorder<S, V> {
    /// An empty record for a system.
    pub fn new<P: Poisson<S, State = V>>(system: &P) -> Self {
        Self {
            solution: Solution::empty(system),
            quantities: Quantities::new(system),
            events: true,
        }
    }
}

impl<S, V> Recorder<S, V> {
    /// The same without events, which end no run then.
    #[must_use]
    pub fn without_events(self) -> Self {
        Self {
            events: false,
            ..self
        }
    }
}

impl<S: Scalar, P: Poisson<S>> Observer<S, P> for Recorder<S, P::State> {
    fn chosen(&mut self, chosen: &Chosen) {
        self.solution.chosen = Some(*chosen);
    }

    fn shortened(&mut self, _progress: Progress, step: f64) {
        self.solution.shortened = Some(step);
    }

    fn lost(&mut self, progress: Progress) {
        self.solution.lost = Some(progress.time);
    }

    fn uneven(&mut self, factor: f64) {
        self.solution.uneven = Some(factor);
    }

    fn assessed(&mut self, assessed: &Assessed) {
        self.solution.assessed = Some(*assessed);
    }

    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        if self.quantities.has_angles() {
            self.quantities.at(system, progress.time, mu);
        }
        ControlFlow::Continue(())
    }

    fn awaits_events(&self) -> bool {
        self.events
    }

    fn event(&mut self, _system: &P, event: &Event<P::State>) {
        self.solution.events.push(event);
    }

    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        let mut casimirs = vec![S::zero(); system.casimir_count()];
        system.casimirs(mu, &mut casimirs);
        self.solution.t.push(time);
        self.solution.energy.push(system.energy(mu));
        self.solution.casimirs.push(casimirs);
        let quantities = self.quantities.at(system, time, mu).to_vec();
        self.solution.quantities.push(quantities);
        self.solution.mu.push(mu.clone());
        ControlFlow::Continue(())
    }
}
