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
mod end;
mod found;
mod held;
mod milestone;
pub mod number;
mod times;
mod words;

pub use columns::{Columns, Coordinates};
pub use end::{End, Obstacle, Stop};
pub use found::{Choice, Event, Found, Rows, Work};
pub use held::{Held, Sources, Table};
use lie_runtime::driver::{Density, Options, Pace, Save};
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

#[cfg(test)]
mod tests;
