//! What the command and the programs that it builds say to each other.
//!
//! A request is one line on the standard input of the program, a value of [`Run`] or of a type of the program's own, as
//! JSON. The program answers on its standard output with one [`Message`] a line. Behind the line of [`Found::Rows`] the
//! rows follow as bytes: a trajectory is too long for text. What stands on its standard error is for people. Where the work
//! is done in the same process, the same values go through a channel.
//!
//! When the input ends, a program stops at the next step and keeps what it has; one that does not come to that
//! ends soon after. So no program outlives the command that started it, however that one was ended.

mod columns;
mod held;
mod milestone;
pub mod number;
mod times;
mod words;

use crate::listen;
pub use columns::{Columns, Coordinates};
pub use held::{Held, Sources, Table};
use lie_runtime::driver::{Chosen, Density, Options, Pace, Save, Stats};
use lie_runtime::methods::Keep;
pub use lie_runtime::methods::Tolerances;
use lie_runtime::newton::NewtonOptions;
pub use milestone::{Milestone, Milestones};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::{self, BufRead};
pub use times::Times;

/// Where a system starts.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Parameters that differ from their defaults, or all of them.
    pub parameters: BTreeMap<String, f64>,
    /// The initial state.
    #[serde(with = "number::list")]
    pub initial: Vec<f64>,
}

/// One trajectory.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The label of the method.
    pub method: String,
    /// Where it starts.
    pub start: Start,
    /// The group element there, in its chart; nothing for the identity.
    #[serde(default, skip_serializing_if = "Vec::is_empty", with = "number::list")]
    pub element: Vec<f64>,
    /// The step size, or a tolerance.
    #[serde(with = "words::PaceInWords")]
    pub pace: Pace,
    /// The time at which it starts.
    #[serde(with = "number")]
    pub from: f64,
    /// When rows are wanted.
    pub times: Times,
    /// The tolerances of an adaptive method.
    #[serde(with = "words::TolerancesFields")]
    pub tolerances: Tolerances,
    /// The solver of an implicit method.
    #[serde(with = "words::NewtonFields")]
    pub newton: NewtonOptions,
    /// What a projection behind each step keeps.
    #[serde(default, with = "words::KeepFields")]
    pub keep: Keep,
    /// Whether steps follow the motion.
    #[serde(default, with = "words::DensityInWords")]
    pub density: Density,
    /// A second run tells the error at the end of one with at most so many steps.
    #[serde(default)]
    pub assess: u64,
    /// What is held from step to step.
    #[serde(default)]
    pub held: Held,
    /// Where the values of inputs come from, within a process.
    #[serde(skip)]
    pub sources: Sources,
    /// Where it is taken up again; nothing for a run from its start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_milestone: Option<Milestone>,
    /// Which milestones are said.
    #[serde(default)]
    pub milestones: Milestones,
    /// Whether states between rows are said, so that lines through all of them are a curve.
    #[serde(default)]
    pub curve: bool,
}

impl Run {
    /// Start and end of the run: the end as asked, or the saved time farthest from the start.
    pub fn span(&self) -> (f64, f64) {
        let far = |time: f64| (time - self.from).abs();
        let farther = |a: f64, b: f64| if far(b) > far(a) { b } else { a };
        let end = match &self.times {
            Times::Until { end, .. } | Times::Within { end, .. } => *end,
            Times::At(times) => times.iter().copied().fold(self.from, farther),
        };
        (self.from, end)
    }

    /// The same as the driver takes it.
    pub fn options(&self) -> Options {
        let save = match &self.times {
            Times::Until { every, .. } => Save::Every(*every),
            Times::At(times) | Times::Within { times, .. } => Save::At(times.clone()),
        };
        Options {
            pace: self.pace,
            save,
            newton: self.newton,
            keep: self.keep,
            density: self.density,
            assess: self.assess,
        }
    }
}

/// What a program says, `R` being what it has found.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Message<R> {
    /// How far it is, at most ten times a second.
    Progress(Progress),
    /// Something that was asked for.
    Found(R),
    /// The last message.
    End(End),
}

/// What goes to another process as a line of JSON, with numbers behind it where they are many.
pub trait Wire: Serialize + DeserializeOwned {
    /// The numbers behind the line.
    fn numbers(&self) -> &[f64] {
        &[]
    }

    /// Reads them, as many as there are.
    ///
    /// # Errors
    /// The input cannot be read.
    fn read_numbers(&mut self, _input: &mut dyn BufRead) -> io::Result<()> {
        Ok(())
    }
}

/// How far a program is.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Progress {
    /// So much is done,
    pub done: u64,
    /// of so much.
    pub all: u64,
    /// What comes next, where that is something else than before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage: Option<String>,
}

/// What a program finds that was asked for a [`Run`].
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

/// How a program ended.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum End {
    /// With everything that was asked for.
    Done,
    /// Because its input ended.
    Interrupted,
    /// The integration stopped early.
    Stopped(Stop),
    /// A parameter's value is impossible.
    Parameter {
        /// Its name.
        name: String,
        /// Why.
        why: String,
    },
    /// Nothing was done.
    Refused {
        /// What stands against it.
        what: Obstacle,
        /// Why.
        why: String,
    },
    /// Nobody takes the results.
    Unwritten {
        /// Why.
        why: String,
    },
}

/// What a program can refuse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Obstacle {
    /// The request, or a part of it.
    Request,
    /// Step, times, or what else the driver does not take.
    Option,
    /// The milestone from which a run is to be taken up.
    Milestone,
    /// The initial state.
    Initial,
    /// Nothing can be measured there.
    Ground,
    /// The solution that others are compared with.
    Reference,
    /// Nothing moves.
    Still,
    /// The surface on which solutions are compared.
    Section,
}

/// Why an integration stopped early.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// The step that failed, counted from 1.
    pub step: u64,
    /// Time at its beginning.
    #[serde(with = "number")]
    pub time: f64,
    /// Iterations spent on it.
    pub iterations: u32,
    /// What was left of the residual.
    #[serde(with = "number")]
    pub residual: f64,
    /// Why.
    pub reason: String,
    /// What to do.
    pub remedy: String,
}

impl End {
    /// A refusal.
    pub fn refused(what: Obstacle, why: impl Into<String>) -> Self {
        let why = why.into();
        Self::Refused { what, why }
    }

    /// The exit code that goes with it.
    pub fn code(&self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Unwritten { .. } => 1,
            Self::Parameter { .. } | Self::Refused { .. } => 2,
            Self::Stopped(_) => 3,
            Self::Interrupted => 130,
        }
    }
}

#[cfg(test)]
mod tests;
