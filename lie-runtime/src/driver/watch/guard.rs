//! A watch beside what tries steps, as a run asks it.

use super::{BETWEEN, By, FIRST_STEPS, Verdict, WONDER, Watch};
use crate::driver::trial::Trial;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;

/// A watch with what tries steps.
pub(in super::super) struct Guard<'a, S: Scalar, P: Poisson<S>> {
    pub(in super::super) watch: Watch<S, P>,
    pub(in super::super) trial: Trial<'a, S, P>,
}

impl<S: Scalar, P: Poisson<S>> Guard<'_, S, P> {
    /// Whether the step to come, whose number is known, is looked at; keeps the state before it if so.
    #[inline(always)]
    pub(in super::super) fn begins(&mut self, mu: &P::State, index: u64) -> bool {
        let watch = &mut self.watch;
        watch.left -= 1;
        let due = watch.left == 0;
        if due {
            if let By::Stages = watch.by {
                watch.sum.interval = if index < FIRST_STEPS { 1 } else { BETWEEN };
            }
            watch.left = watch.sum.interval;
        }
        if due || matches!(watch.by, By::Stages) {
            watch.before.copy_from(mu);
        }
        due
    }

    /// Whether a step took so many more iterations than usual that it is looked at before its turn: its stages are at hand.
    #[inline(always)]
    pub(in super::super) fn wonders(&self, iterations: u32) -> bool {
        let usual = self.watch.usual;
        matches!(self.watch.by, By::Stages) && iterations > usual.saturating_add(WONDER)
    }

    /// A step that is looked at took so many iterations.
    #[inline(always)]
    pub(in super::super) fn usual(&mut self, iterations: u32) {
        self.watch.usual = iterations;
    }

    /// The state before the step.
    pub(in super::super) fn before(&self) -> &P::State {
        &self.watch.before
    }

    /// See [`Observer::uneven`](super::Observer::uneven).
    pub(in super::super) fn uneven(&self) -> Option<f64> {
        let order = f64::from(self.trial.method.order().max(1));
        self.watch.uneven(order)
    }

    /// Whether the stages of steps tell their errors.
    pub(in super::super) fn is_by_stages(&self) -> bool {
        matches!(self.watch.by, By::Stages)
    }

    /// Steps have this size from here on.
    pub(in super::super) fn steps_are(&mut self, h: f64) {
        self.watch.sum.share = h.abs() / self.trial.span;
    }

    /// What becomes of the step of h with a number that was made in some parts and has ended at a state; the stages of its last
    /// part may tell the error of that.
    #[inline(always)]
    pub(in super::super) fn looks(
        &mut self,
        system: &P,
        (index, h, parts): (u64, f64, u32),
        end: &P::State,
        told: impl FnOnce() -> Option<S>,
    ) -> Verdict {
        let watch = &mut self.watch;
        let By::Field(field) = &mut watch.by else {
            let error = told().map_or(f64::NAN, largest);
            let part = self.trial.part(error, h / f64::from(parts));
            let order = f64::from(self.trial.method.order().max(1));
            return watch.by_part(part, order, index);
        };
        let number = field.gauge.at(system, end);
        if !field.exceeded(number, &mut watch.sum) {
            return Verdict::Kept;
        }
        let at = (system, &watch.before);
        field.needed(&mut watch.sum, &self.trial, at, (h, parts), number)
    }
}
