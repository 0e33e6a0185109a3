//! What is kept of the run of a member.

use super::{Stop, Watch};
use lie_dynamic::Dynamic;
use lie_program::protocol::Event;
use lie_runtime::driver::{self, Observer, Options, Progress, Save};
use lie_runtime::{Poisson, Scalar};
use std::ops::ControlFlow;

/// Keeps the rows of a run, and ends it where the whole is to end.
pub(super) struct Kept<'a, S> {
    pub(super) times: Vec<f64>,
    pub(super) states: Vec<S>,
    pub(super) last_alone: bool,
    pub(super) watch: &'a Watch,
    pub(super) held: Option<driver::Held>,
    /// Whether events are looked for, which may end the run, and whether they are kept.
    pub(super) awaits_events: bool,
    pub(super) keeps_events: bool,
    pub(super) events: Vec<Event>,
    /// The last event that may end the run.
    pub(super) stopped: Option<Stop>,
}

impl<'a, S> Kept<'a, S> {
    pub(super) fn new(options: &Options, watch: &'a Watch) -> Self {
        Self {
            times: Vec::new(),
            states: Vec::new(),
            last_alone: options.save == Save::Ends,
            watch,
            held: None,
            awaits_events: false,
            keeps_events: false,
            events: Vec::new(),
            stopped: None,
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
        self.awaits_events
    }

    fn event(&mut self, system: &Dynamic<S>, event: &driver::Event<Vec<S>>) {
        if event.stops {
            self.stopped = Some(Stop {
                event: event.index,
                time: event.time,
            });
        }
        if !self.keeps_events {
            return;
        }
        if self.events.try_reserve(1).is_err() {
            self.watch.is_full();
            return;
        }
        self.events.push(Event {
            name: Poisson::<S>::event_name(system, event.index).to_owned(),
            time: event.time,
            state: event.mu.iter().map(|entry| entry.to_f64()).collect(),
            stops: event.stops,
        });
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
