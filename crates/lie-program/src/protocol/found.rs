//! What a program finds on the way.

use super::{Columns, Milestone, Wire, number};
use crate::listen;
use lie_runtime::driver::{Chosen, Stats};
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead};

/// What a program finds that was asked for a [`Run`](super::Run).
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Found {
    /// The step that was chosen from a tolerance, before all else.
    Chosen(Choice),
    /// Steps are shorter from a time on.
    Shortened {
        /// Their size.
        #[serde(with = "number")]
        step: f64,
        /// The time.
        #[serde(with = "number")]
        time: f64,
    },
    /// From a time on the errors of steps are larger than the tolerance allows, and steps cannot be shortened any more.
    Lost {
        /// The time.
        #[serde(with = "number")]
        time: f64,
    },
    /// The steps that a tolerance allows differ by this factor along the run: steps that follow the motion are faster.
    Uneven {
        /// The factor.
        #[serde(with = "number")]
        factor: f64,
    },
    /// The error at the end of a run, relative to the state, if it can be told.
    Assessed {
        /// The error; not a number where it cannot be told.
        #[serde(with = "number")]
        error: f64,
        /// Whether it is much larger than the tolerance, or cannot be told.
        missed: bool,
    },
    /// What the numbers of the rows to come are.
    Columns(Columns),
    /// Rows. They come at least every 0.2 s while steps are being done.
    Rows(Rows),
    /// States between the rows, with the same columns, where a curve is wanted.
    Between(Rows),
    /// An event, in order of time.
    Event(Event),
    /// A place from which the run can be taken up again, behind all rows before it.
    Milestone(Box<Milestone>),
    /// The work so far, at the end.
    Work(Work),
}

/// An event of a run.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// Its name.
    pub name: String,
    /// When it happened.
    #[serde(with = "number")]
    pub time: f64,
    /// All coordinates there.
    #[serde(with = "number::list")]
    pub state: Vec<f64>,
    /// Whether it ended the run.
    pub stops: bool,
}

/// Rows of a run.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Rows {
    /// How many there are.
    pub count: u64,
    /// Numbers of each.
    pub width: usize,
    /// Row by row; little-endian float64 behind the line.
    #[serde(skip)]
    pub numbers: Vec<f64>,
}

impl Wire for Found {
    fn numbers(&self) -> &[f64] {
        match self {
            Self::Rows(rows) | Self::Between(rows) => &rows.numbers,
            _ => &[],
        }
    }

    fn read_numbers(&mut self, input: &mut dyn BufRead) -> io::Result<()> {
        match self {
            Self::Rows(rows) | Self::Between(rows) => {
                rows.numbers = listen::rows(input, rows.width, rows.count)?;
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

/// A step that was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// The step.
    #[serde(with = "number")]
    pub step: f64,
    /// Whether round-off forbids the error that was asked for.
    pub at_round_off: bool,
}

impl From<&Chosen> for Choice {
    fn from(chosen: &Chosen) -> Self {
        Self {
            step: chosen.step,
            at_round_off: chosen.at_round_off,
        }
    }
}

/// What was counted during a run; a program counts what its method has.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Work {
    /// Steps taken.
    pub steps: u64,
    /// Evaluations of the vector field or the residual.
    pub evaluations: u64,
    /// Iterations of the solver.
    pub newton: u64,
    /// Those among them without a Jacobian.
    pub fixed_point: u64,
    /// Steps that an adaptive method took within those; every other method takes one.
    pub accepted: u64,
    /// Steps tried and refused by an adaptive method.
    pub rejected: u64,
}

impl From<&Stats> for Work {
    fn from(stats: &Stats) -> Self {
        Self {
            steps: stats.steps,
            evaluations: stats.evaluations,
            newton: stats.newton,
            fixed_point: stats.fixed_point,
            accepted: stats.accepted,
            rejected: stats.rejected,
        }
    }
}
