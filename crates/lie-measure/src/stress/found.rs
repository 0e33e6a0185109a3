//! What the program finds.

use lie_program::protocol::number;
use serde::{Deserialize, Serialize};

/// One message.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// What all experiments share.
    Ground {
        /// The step at which it times the largest rate of the field is 0.2.
        #[serde(with = "number")]
        step: f64,
    },
    /// How the round-off of a method grows.
    Growth(Growth),
    /// An experiment with a method.
    Cell(Cell),
}

/// What is changed in an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Experiment {
    /// The step.
    Step,
    /// A parameter.
    Parameter,
    /// The state as a whole.
    Scale,
    /// One coordinate.
    Component,
    /// The state, so that a Casimir becomes small.
    Casimir,
    /// The number of steps.
    Long,
}

impl Experiment {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Parameter => "parameter",
            Self::Scale => "scale",
            Self::Component => "component",
            Self::Casimir => "casimir",
            Self::Long => "long",
        }
    }
}

/// What an experiment comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// No claimed invariant is beyond its round-off bound, no step was refused.
    Kept,
    /// One is, and no message said so.
    Lost,
    /// A step failed, and says why.
    Stopped,
    /// H or the field is not finite there: nothing to integrate.
    Domain,
}

impl Outcome {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Lost => "lost",
            Self::Stopped => "stopped",
            Self::Domain => "domain",
        }
    }
}

/// How far an invariant moved, relative to the size of its terms, and the last tenth of the run over the first.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Moved {
    /// The largest distance from the start.
    #[serde(with = "number")]
    pub drift: f64,
    /// That of the last tenth over that of the first.
    #[serde(with = "number")]
    pub growth: f64,
}

impl Moved {
    /// Of what was not looked at.
    pub const UNKNOWN: Self = Self {
        drift: f64::NAN,
        growth: f64::NAN,
    };
}

/// An experiment with a method.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Cell {
    /// The method.
    pub method: String,
    /// What is changed.
    pub experiment: Experiment,
    /// The name of the parameter, the coordinate, the Casimir that is changed.
    pub name: String,
    /// By how much.
    #[serde(with = "number")]
    pub value: f64,
    /// The step.
    #[serde(with = "number")]
    pub step: f64,
    /// What it came to.
    pub outcome: Outcome,
    /// Steps done.
    pub steps: u64,
    /// Newton iterations for each.
    #[serde(with = "number")]
    pub newton: f64,
    /// How far the energy moved.
    pub energy: Moved,
    /// How far the Casimir moved that moved most.
    pub casimirs: Moved,
    /// The largest drift of a claimed invariant over its round-off bound.
    #[serde(with = "number")]
    pub claimed: f64,
    /// What was lost, or why it stopped.
    pub what: String,
}

/// How the round-off of the claimed invariant of a method that moves most grows with the steps.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Growth {
    /// The method.
    pub method: String,
    /// The invariant.
    pub invariant: String,
    /// The exponent of its error in the number of steps.
    #[serde(with = "number")]
    pub exponent: f64,
    /// The standard error of the exponent.
    #[serde(with = "number")]
    pub error: f64,
    /// The mean of the error per step over the states, with its sign.
    #[serde(with = "number")]
    pub bias: f64,
    /// The standard error of the bias.
    #[serde(with = "number")]
    pub bias_error: f64,
    /// The error at the end, relative to the size of the terms: root of the mean square over the states.
    #[serde(with = "number")]
    pub end: f64,
    /// The same: the largest.
    #[serde(with = "number")]
    pub largest: f64,
    /// The steps of the first point.
    pub from: u64,
    /// The steps of the last.
    pub to: u64,
    /// States that came to the end.
    pub states: usize,
    /// The step.
    #[serde(with = "number")]
    pub step: f64,
    /// The largest error over its bound.
    #[serde(with = "number")]
    pub ratio: f64,
}
