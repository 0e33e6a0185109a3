//! A step is looked at before it is shown.

use super::{Event, Events};
use crate::driver::course::{Course, Left};
use crate::driver::grid::Place;
use crate::driver::joints::Joints;
use crate::driver::kept::KeptStepper;
use crate::driver::observer::Observer;
use crate::driver::options::OptionError;
use crate::driver::problem::set_time;
use crate::driver::solve::IntegrateError;
use crate::driver::stats::Status;
use crate::methods::{StepFailure, StepReport};
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// What happens until the next grid point.
pub(in crate::driver) struct Ahead<V> {
    events: Vec<Event<V>>,
}

impl<V> Ahead<V> {
    /// When the run stops, if it does.
    pub(in crate::driver) fn stop(&self) -> Option<f64> {
        let last = self.events.last().filter(|event| event.stops);
        last.map(|event| event.time)
    }

    /// Tells what happens.
    pub(in crate::driver) fn tell<S: Scalar, P: Poisson<S, State = V>>(
        &mut self,
        system: &P,
        observer: &mut dyn Observer<S, P>,
    ) {
        for event in self.events.drain(..) {
            observer.event(system, &event);
        }
    }

    /// Tells what happens until the run stops, if it does, and gives the event at which that is.
    pub(in crate::driver) fn take_stop<S: Scalar, P: Poisson<S, State = V>>(
        &mut self,
        system: &P,
        observer: &mut dyn Observer<S, P>,
    ) -> Option<Event<V>> {
        self.stop()?;
        let last = self.events.pop()?;
        self.tell(system, observer);
        observer.event(system, &last);
        Some(last)
    }
}

/// A step that was made before it is shown.
type Made<V> = Option<Result<(V, StepReport), StepFailure>>;

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// The time up to which the run is known next: the end of a step, or that of the run behind the last one.
    fn ahead(&self) -> Option<f64> {
        if self.index < self.grid.steps() {
            return Some(self.grid.time(self.index + 1));
        }
        match self.grid.end_place {
            Place::After(index, _) if index == self.index => Some(self.grid.end),
            _ => None,
        }
    }

    /// Looks at the step that begins here, if there is one that can be made. Where it is one alone that shows no motion on the group, it is
    /// made for that.
    pub(in crate::driver) fn look_ahead<'s>(
        &mut self,
        system: &'s P,
        mut joints: Option<&mut Joints<S, P>>,
        events: &mut Events<P::State>,
        mu: &P::State,
        (stepper, made): (&mut KeptStepper<'s, S, P>, &mut Made<P::State>),
        observer: &dyn Observer<S, P>,
    ) -> Result<Option<Ahead<P::State>>, IntegrateError> {
        let Some(time) = self.ahead() else {
            return Ok(None);
        };
        let piece = (self.grid.time(self.index), time);
        let held = observer
            .held()
            .filter(|held| held.changes_within(piece))
            .cloned();
        if self.shows_motion && held.as_ref().is_some_and(|held| held.samples_within(piece)) {
            return Err(OptionError::SampledWithin.into());
        }
        let alone = self.parts == 1 && joints.is_none() && held.is_none();
        let whole = self.index < self.grid.steps() && alone;
        if whole && made.is_none() && !self.shows_motion {
            let mut end = mu.clone();
            let stepped = stepper.step(&mut end, &mut ());
            *made = Some(stepped.map(|report| (end, report)));
        }
        let mut end = mu.clone();
        match made {
            Some(Ok((state, _))) => {
                end.copy_from(state);
                set_time(system, &mut end, time);
            }
            Some(Err(_)) => return Ok(None),
            None => {
                let stats = self.stats;
                let joints = joints.as_deref_mut();
                let reached = self.off_grid(system, joints, time, &mut end, &mut held.clone());
                self.stats = stats;
                if reached.is_err() {
                    return Ok(None);
                }
            }
        }
        Ok(Some(Ahead {
            events: self.events_until(system, joints, events, (mu, (time, &end)), held),
        }))
    }

    /// The last row of a run that stops at an event.
    pub(in crate::driver) fn stop_at(
        &mut self,
        system: &P,
        joints: Option<&mut Joints<S, P>>,
        last: Event<P::State>,
        (mu, between): (&P::State, &mut P::State),
        observer: &mut dyn Observer<S, P>,
    ) -> Result<Left<P>, IntegrateError> {
        if self.shown != Some(last.time) {
            between.copy_from(mu);
            // the motion on the group goes there too
            self.off_grid(system, joints, last.time, between, observer)?;
            // it is the last row, whatever an observer says
            let _ = observer.row(system, last.time, &last.mu);
        }
        Ok(Left::Over(Status::Event(last.index)))
    }
}
