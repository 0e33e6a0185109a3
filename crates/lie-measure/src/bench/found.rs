//! What the program finds.

use super::measure::Plane;
use lie_program::protocol::number;
use serde::{Deserialize, Serialize};

/// One message.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// The solution that others are compared with.
    Reference(Reference),
    /// The surface of section, and how often the exact solution passes it.
    Section {
        /// The surface.
        plane: Plane,
        /// Passages.
        passages: u64,
    },
    /// What the seconds are.
    Clock(ClockKind),
    /// A run that came to its end; of what is told again, times have become better.
    Point(Point),
    /// All runs of a method came to their ends, once.
    Climbed {
        /// The method.
        method: String,
    },
    /// One that did not.
    Stopped {
        /// The method.
        method: String,
        /// What its accuracy is chosen by, and the value of that.
        control: Accuracy,
        /// See `control`.
        #[serde(with = "number")]
        value: f64,
        /// Why.
        why: String,
    },
}

/// How reliable the reference solution is.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Reference {
    /// Its own estimate of its relative error.
    #[serde(with = "number")]
    pub error: f64,
    /// The relative difference from a second method.
    #[serde(with = "number")]
    pub difference: f64,
    /// Errors of the chosen measure below this are not told from 0.
    #[serde(with = "number")]
    pub floor: f64,
}

/// What seconds are counted by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClockKind {
    /// By the processor, for this thread.
    Processor,
    /// By the clock on the wall: the system has no other.
    #[default]
    Wall,
}

/// What the accuracy of a method is chosen by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Accuracy {
    /// Its step.
    Step,
    /// Both of its tolerances alike.
    Tolerance,
}

impl Accuracy {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Tolerance => "tolerance",
        }
    }
}

impl Point {
    /// Whether it is of the same run.
    pub fn is_again(&self, before: &Self) -> bool {
        (self.control, self.value) == (before.control, before.value) && self.method == before.method
    }
}

/// Error and time of one run; times are for a unit of time of the system.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Point {
    /// The method.
    pub method: String,
    /// What its accuracy is chosen by, and the value of that.
    pub control: Accuracy,
    /// See `control`.
    #[serde(with = "number")]
    pub value: f64,
    /// The relative error at the end, or what else is measured.
    #[serde(with = "number")]
    pub error: f64,
    /// Beside the error of the phase: the relative distance from the exact orbit.
    pub across: Option<f64>,
    /// The least time of all rounds, by the clock.
    #[serde(with = "number")]
    pub seconds: f64,
    /// Their median.
    #[serde(with = "number")]
    pub median: f64,
    /// The median of what passed meanwhile: where it is more, other programs ran.
    #[serde(with = "number")]
    pub wall: f64,
    /// Steps.
    pub steps: u64,
    /// Evaluations of the vector field or of a residual.
    pub evaluations: u64,
    /// Newton iterations.
    pub newton: u64,
}
