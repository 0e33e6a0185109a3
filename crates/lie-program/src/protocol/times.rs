//! The rows that are asked for.

use super::number;
use serde::{Deserialize, Serialize};

/// At which times rows are wanted.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Times {
    /// Every so many steps until a final time.
    Until {
        /// The final time.
        #[serde(with = "number")]
        end: f64,
        /// Steps between rows.
        every: u64,
    },
    /// At given times.
    At(#[serde(with = "number::list")] Vec<f64>),
    /// At given times of a run that goes on to a final time.
    Within {
        /// The final time.
        #[serde(with = "number")]
        end: f64,
        /// The times.
        #[serde(with = "number::list")]
        times: Vec<f64>,
    },
}
