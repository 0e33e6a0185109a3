//! How the steps of a run become shorter on its way: more of them on the rest of the grid, or several parts of each.

use super::course::{Course, Left};
use super::pace::count;
use super::solve::IntegrateError;
use super::watch::{Change, Guard, JACOBIAN, MOST_PARTS, SLOW_PARTS, divided};
use crate::methods::StepFailure;
use crate::poisson::Poisson;
use crate::scalar::Scalar;

/// Steps that divided ones may come to in all, unless the grid itself has an eighth of as many.
const MOST_DIVIDED: u64 = 1 << 18;

/// So many times as many steps are made after one that failed or did not contract, where that can be any number.
const SHORTER: f64 = 1.4;

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// Whether steps may change like that: a joint or a singularity asks for smaller ones without end.
    pub(super) fn allows(&self, change: Change) -> bool {
        let (left, size) = match change {
            Change::Parts(parts) => {
                let left = (self.grid.steps() - self.index).saturating_mul(u64::from(parts));
                (left, self.grid.step() / f64::from(parts))
            }
            Change::Times(factor) => {
                let left = self.steps_left(self.index, factor);
                (left, self.size() / factor)
            }
        };
        let most = self.planned.saturating_mul(8).max(MOST_DIVIDED);
        left.saturating_add(self.index) <= most && self.step / size <= f64::from(MOST_PARTS)
    }

    /// How many steps are left from a point on, of which there are so many times as many as now.
    pub(super) fn steps_left(&self, index: u64, factor: f64) -> u64 {
        let left = (self.grid.steps() - index) as f64 * f64::from(self.parts);
        let span = self.grid.time(self.grid.steps()) - self.grid.time(index);
        count(span, (left * factor).ceil()) as u64
    }

    /// Changes the steps from where the run is.
    #[cold]
    pub(super) fn change(&mut self, change: Change, guard: Option<&mut Guard<'_, S, P>>) {
        match change {
            Change::Parts(parts) => self.parts = parts,
            Change::Times(factor) => {
                let here = (self.index, self.grid.time(self.index));
                let steps = self.steps_left(self.index, factor);
                self.grid = self.grid.going_on_with(here, steps);
                self.parts = 1;
            }
        }
        if let Some(guard) = guard {
            guard.steps_are(self.grid.step());
        }
    }

    /// Divides steps where need be.
    pub(super) fn dividing(mut self, divides: bool) -> Self {
        self.divides = divides;
        self
    }

    /// Whether to divide all steps that are left costs less than some that need Jacobians.
    pub(super) fn divides_rather(&self, slow: u64) -> bool {
        let left = (self.grid.steps() - self.index).saturating_mul(u64::from(self.parts));
        let shortened = self.step / self.size();
        self.divides && shortened < SLOW_PARTS && left < slow.saturating_mul(JACOBIAN)
    }

    /// Steps that are somewhat shorter, as after one that failed.
    pub(super) fn shorter(&self) -> Option<Change> {
        match self.by_stages {
            true => Some(Change::Times(SHORTER)),
            false => divided(self.parts).map(Change::Parts),
        }
    }

    /// Whether too many steps did not contract.
    pub(super) fn is_slow(&mut self) -> bool {
        let slow = self.stats.factorizations > self.slow.0;
        self.slow.0 = self.stats.factorizations;
        self.slow.1 += u64::from(slow);
        if !slow || !self.divides_rather(self.slow.1) {
            return false;
        }
        self.slow.1 = 0;
        true
    }

    /// Goes on in smaller steps after one that failed, where that may be.
    #[cold]
    pub(super) fn divided(
        &mut self,
        system: &P,
        failure: StepFailure,
        mu: &P::State,
        guard: Option<&mut Guard<'_, S, P>>,
    ) -> Result<Left<P>, IntegrateError> {
        let next = self.shorter();
        let Some(next) = next.filter(|&next| self.divides && self.allows(next)) else {
            return Err(self.stopped(system, failure, self.size(), mu));
        };
        self.stats.add_failure(&failure.report);
        if let Change::Parts(parts) = next {
            self.done *= parts / self.parts;
        }
        self.change(next, guard);
        Ok(Left::Divided)
    }
}
