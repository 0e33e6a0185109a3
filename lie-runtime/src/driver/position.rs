//! Where a run is: the size of its steps, its time, the rows that are left.

use super::course::Course;
use super::observer::Progress;
use super::options::Save;
use super::rows::{Row, Rows};
use super::solve::IntegrateError;
use crate::poisson::Poisson;
use crate::scalar::Scalar;

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// The size of the steps that are made.
    pub(super) fn size(&self) -> f64 {
        self.grid.step() / f64::from(self.parts)
    }

    /// The rows that have not been shown.
    pub(super) fn rows_left(&self, save: &Save) -> Result<Rows, IntegrateError> {
        let mut rows = self.grid.rows(save)?.from(self.index);
        let sign = self.step.signum();
        let is_shown = |row: &Row| {
            let shown = self
                .shown
                .is_some_and(|shown| (row.time - shown) * sign <= 0.0);
            let behind = self.follows && self.grid.is_behind(row.time);
            shown || behind || row.place.index() < self.index
        };
        while rows.next_if(is_shown).is_some() {}
        Ok(rows)
    }

    /// The time at the end of the part that is being made of a step.
    pub(super) fn next_time(&self) -> f64 {
        let done = self.done + 1;
        if done == self.parts {
            return self.grid.time(self.index + 1);
        }
        let part = self.grid.step() * (f64::from(done) / f64::from(self.parts));
        self.grid.time(self.index) + part
    }

    pub(super) fn progress(&self) -> Progress {
        Progress {
            step: self.index,
            steps: self.grid.steps(),
            time: self.grid.time(self.index),
        }
    }
}
