//! Why a run did not reach its end.

use core::fmt;

use super::options::OptionError;
use super::solution::Solution;
use super::stats::Stats;
use crate::methods::StepFailure;
use thiserror::Error;

/// A step that failed, and with it the run.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "step {step} from t = {time} failed: {} (iterations {}, residual {:.1e}); {}",
    failure.reason, failure.report.iterations, failure.report.residual, self.remedy()
)]
pub struct StepError {
    /// The number of the step that failed, from 1.
    pub step: u64,
    /// The time before that step: the last good one.
    pub time: f64,
    /// The failure.
    pub failure: StepFailure,
    /// The work of the run up to and with the failed step.
    pub stats: Stats,
    /// Where the step left the chart of its retraction: the largest of the halved steps that succeeds from the same
    /// state. It has been tried.
    pub works: Option<f64>,
}

impl StepError {
    /// What to do about it, in one clause.
    pub fn remedy(&self) -> impl fmt::Display + '_ {
        Remedy(self)
    }
}

struct Remedy<'a>(&'a StepError);

impl fmt::Display for Remedy<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.failure.reason.remedy())?;
        match self.0.works {
            Some(step) => write!(f, "; from this state a step of {step} works"),
            None => Ok(()),
        }
    }
}

/// A run that could not start, or failed on its way.
#[derive(Clone, Debug, Error)]
pub enum SolveError<S, V> {
    /// The options are invalid.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// A step failed; everything saved before is kept.
    #[error("{error}")]
    Step {
        /// The step, its time, and why.
        error: Box<StepError>,
        /// What was saved before it; the last row is the last good saved state.
        solution: Box<Solution<S, V>>,
    },
}

impl<S, V> SolveError<S, V> {
    /// What was saved before the failure.
    pub fn solution(&self) -> Option<&Solution<S, V>> {
        match self {
            Self::Option(_) => None,
            Self::Step { solution, .. } => Some(solution),
        }
    }
}
