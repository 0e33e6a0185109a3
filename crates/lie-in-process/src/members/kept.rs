//! What is kept of the run of a member.

use super::Watch;
use lie_dynamic::Dynamic;
use lie_runtime::Scalar;
use lie_runtime::driver::{self, Observer, Options, Progress, Save};
use std::ops::ControlFlow;

/// Keeps the rows of a run, and ends it where the whole is to end.
pub(super) struct Kept<'a, S> {
    pub(super) times: Vec<f64>,
    pub(super) states: Vec<S>,
    pub(super) last_alone: bool,
    pub(super) watch: &'a Watch,
    pub(super) held: Option<driver::Held>,
    /// Whether an event may end the run.
    pub(super) ends: bool,
}

impl<'a, S> Kept<'a, S> {
    pub(super) fn new(options: &Options, watch: &'a Watch) -> Self {
        Self {
            times: Vec::new(),
            states: Vec::new(),
            last_alone: options.save == Save::Ends,
            watch,
            held: None,
            ends: false,
        }
    }
}

impl<S: Scalar> Observer<S, Dynamic<S>> for Kept<'_, S> {
    fn hold(&mut self, system: &Dynamic<S>, step: (u64, f64, f64), mu: &mut Vec<S>, element: &[S]) {
        self.held.hold(system, step, mu, element);
    }

    fn held(&self) -> Option<&driver::Held> {
        self.held.as_ref()
    }

    fn awaits_events(&self) -> bool {
        self.ends
    }

    fn step(&mut self, _: &Dynamic<S>, _: Progress, _: &Vec<S>) -> ControlFlow<()> {
        match self.watch.stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    fn row(&mut self, _: &Dynamic<S>, time: f64, mu: &Vec<S>) -> ControlFlow<()> {
        if self.last_alone {
            self.times.clear();
            self.states.clear();
        }
        let room = self.times.try_reserve(1);
        if room.and(self.states.try_reserve(mu.len())).is_err() {
            self.watch.is_full();
            return ControlFlow::Break(());
        }
        self.times.push(time);
        self.states.extend_from_slice(mu);
        ControlFlow::Continue(())
    }
}
