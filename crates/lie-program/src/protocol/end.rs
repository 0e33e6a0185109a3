//! How a program ends.

use super::number;
use serde::{Deserialize, Serialize};

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
    /// What a projection is to keep.
    Keep,
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
