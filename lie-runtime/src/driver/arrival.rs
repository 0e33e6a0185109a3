//! How steps are counted, and how they fail.

use super::checks::{check_domain, smaller};
use super::course::Course;
use super::error::StepError;
use super::solve::IntegrateError;
use crate::methods::{StepFailure, StepReport};
use crate::newton::FailureReason;
use crate::poisson::Poisson;
use crate::scalar::Scalar;

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// The error of the step that comes next.
    pub(super) fn failed(&self, failure: StepFailure) -> Box<StepError> {
        let mut stats = self.stats;
        stats.add_failure(&failure.report);
        Box::new(StepError {
            step: self.index + 1,
            time: self.grid.time(self.index),
            failure,
            stats,
            works: None,
        })
    }

    /// The same of a step of h from a state: where it left its chart, with one that does not.
    pub(super) fn stopped(
        &self,
        system: &P,
        failure: StepFailure,
        h: f64,
        mu: &P::State,
    ) -> IntegrateError {
        let left = failure.reason == FailureReason::OutsideChart;
        let works = left.then(|| smaller(system, self.method, &self.newton, h, mu));
        let error = StepError {
            works: works.flatten(),
            ..*self.failed(failure)
        };
        IntegrateError::from(Box::new(error))
    }

    /// Counts a step that ended at a state.
    pub(super) fn arrived(
        &mut self,
        system: &P,
        mu: &P::State,
        report: StepReport,
    ) -> Result<(), Box<StepError>> {
        check_domain(system, mu, report).map_err(|failure| self.failed(failure))?;
        self.stats.add(&report);
        Ok(())
    }
}
