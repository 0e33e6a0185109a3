//! What a file of members says of events.

use serde::{Deserialize, Serialize};

/// When events ended members. Their times are in an array beside the members: a column for each event that stops, in which a member
/// that it did not end has no number.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Stops {
    /// The probabilities of the quantiles.
    pub quantiles: Vec<f64>,
    /// The events, by columns.
    pub events: Vec<Ended>,
    /// A digest of the times, once all are in the file.
    #[serde(default)]
    pub numbers: Option<String>,
}

/// Members that an event ended. Of those alone the statistics are: others might have been ended later.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Ended {
    /// The name of the event.
    pub event: String,
    /// How many members it ended.
    pub members: u64,
    /// The mean of the times, if there is one.
    pub mean: Option<f64>,
    /// Their standard deviation, over the number of members less one, if there are two.
    pub deviation: Option<f64>,
    /// Their quantiles, if there is one.
    pub quantiles: Vec<f64>,
}

impl Stops {
    /// Of events with these names, before they ended a member.
    pub fn of(names: impl Iterator<Item = String>, quantiles: Vec<f64>) -> Self {
        let none = |event| Ended {
            event,
            ..Ended::default()
        };
        Self {
            quantiles,
            events: names.map(none).collect(),
            numbers: None,
        }
    }

    /// As they are before a member is ended.
    #[must_use]
    pub fn empty(&self) -> Self {
        let names = self.events.iter().map(|ended| ended.event.clone());
        Self::of(names, self.quantiles.clone())
    }
}

/// A table of events.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// The name of the file of a share, beside its members.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// A digest of its lines, once all are there.
    #[serde(default)]
    pub digest: Option<String>,
}
