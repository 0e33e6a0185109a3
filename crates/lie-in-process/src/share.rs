//! A share of the members of an ensemble, and what its file says of itself, so that shares find together again.

mod stops;

use std::ops::Range;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::reduce::Bins;
pub use stops::{Ended, Stops, Table};

/// One of several shares of the members: those that lie side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// Its number, from 1 on.
    pub number: u64,
    /// How many there are.
    pub of: u64,
}

impl Share {
    /// All members.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// `3/8`.
    pub fn read(text: &str) -> Option<Self> {
        let (number, of) = text.split_once('/')?;
        let (number, of) = (number.trim().parse().ok()?, of.trim().parse().ok()?);
        (1 <= number && number <= of).then_some(Self { number, of })
    }

    /// Its members among so many.
    pub fn members(self, count: usize) -> Range<usize> {
        let before =
            |number: u64| (count as u128 * u128::from(number) / u128::from(self.of)) as usize;
        before(self.number - 1)..before(self.number)
    }
}

/// What a file of members says of itself, beside it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The form of this.
    pub format: u64,
    /// The program that has written it.
    pub lie: String,
    /// Whether all members of the share are in the file.
    pub complete: bool,
    /// The system.
    pub system: String,
    /// The method with its options.
    pub method: String,
    /// The names of what a projection behind each step keeps.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub kept: Vec<String>,
    /// A digest of the spec, and of the files that it reads.
    pub spec: String,
    /// What was asked for, by option; of a file its digest.
    pub asked: Map<String, Value>,
    /// How many members there are in all shares.
    pub members: usize,
    /// The share.
    pub share: Share,
    /// The parameters with several values, the last one fastest; of each value the members with its initial states.
    pub parameters: Vec<(String, Vec<f64>)>,
    /// The names of the coordinates, the last axis of the array.
    pub columns: Vec<String>,
    /// The times of the rows.
    pub times: Vec<f64>,
    /// Whether there is an axis of rows between members and coordinates.
    pub rows: bool,
    /// What is computed of all members.
    pub reduce: Vec<String>,
    /// The probabilities of the quantiles.
    pub quantiles: Vec<f64>,
    /// Where members are counted, if they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub histogram: Option<Bins>,
    /// How many members go on at each of the times, or end there.
    #[serde(default)]
    pub counts: Vec<u64>,
    /// When events ended members, where some are declared to do that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stops: Option<Stops>,
    /// The table of events, where one was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub events: Option<Table>,
    /// The members that ended early.
    pub failures: Vec<Failed>,
    /// A digest of the numbers of the share, once all are in the file.
    #[serde(default)]
    pub numbers: Option<String>,
}

/// A member that ended early.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Failed {
    /// Its number in the whole.
    pub member: usize,
    /// When.
    pub time: f64,
    /// Why.
    pub why: String,
}

impl Record {
    /// The form that is written today.
    pub const FORMAT: u64 = 3;

    /// How the ensemble differs from that of another share, if it does.
    pub fn differs(&self, other: &Self) -> Option<String> {
        let text = |value: Option<&Value>| value.map_or("not given".to_owned(), Value::to_string);
        let keys = self.asked.keys().chain(other.asked.keys());
        let options = keys.filter_map(|key| {
            let (own, others) = (self.asked.get(key), other.asked.get(key));
            (own != others)
                .then(|| format!("--{key} is {} here and {} there", text(own), text(others)))
        });
        let facts = [
            (self.lie != other.lie)
                .then(|| format!("lie {} here, lie {} there", self.lie, other.lie)),
            (self.system != other.system)
                .then(|| format!("{} here, {} there", self.system, other.system)),
            (self.spec != other.spec)
                .then(|| "the spec, or a file that it reads, was changed between them".to_owned()),
            (self.members != other.members)
                .then(|| format!("{} members here, {} there", self.members, other.members)),
            (self.share.of != other.share.of).then(|| {
                let of = |one: &Self| match one.share {
                    Share::WHOLE => "the whole".to_owned(),
                    Share { of, .. } => format!("one of {of} shares"),
                };
                format!("{} here, {} there", of(self), of(other))
            }),
            (self.events.is_some() != other.events.is_some()).then(|| {
                let given = |one: &Self| {
                    if one.events.is_some() {
                        "given"
                    } else {
                        "not given"
                    }
                };
                format!(
                    "--events is {} here and {} there",
                    given(self),
                    given(other)
                )
            }),
        ];
        let all_else = || {
            let differs = self.whole() != other.whole();
            differs.then(|| "what was asked for differs".to_owned())
        };
        facts
            .into_iter()
            .flatten()
            .chain(options)
            .next()
            .or_else(all_else)
    }

    /// That of all shares, before there is a member.
    #[must_use]
    pub fn whole(&self) -> Self {
        Self {
            share: Share::WHOLE,
            complete: false,
            counts: Vec::new(),
            stops: self.stops.as_ref().map(Stops::empty),
            events: self.events.as_ref().map(|_| Table::default()),
            failures: Vec::new(),
            numbers: None,
            histogram: self.histogram.as_ref().map(Bins::empty),
            ..self.clone()
        }
    }

    /// How many events are declared to end members.
    pub fn stopping(&self) -> usize {
        self.stops.as_ref().map_or(0, |stops| stops.events.len())
    }

    /// The shape of the array behind the axis of members.
    pub fn shape(&self) -> Vec<usize> {
        match self.rows {
            true => vec![self.times.len(), self.columns.len()],
            false => vec![self.columns.len()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_cover_all_members_once() {
        for (count, of) in [(10, 3), (3, 8), (1_000_000_007, 64), (0, 2)] {
            let mut next = 0;
            for number in 1..=of {
                let range = Share { number, of }.members(count);
                assert_eq!(range.start, next);
                next = range.end;
            }
            assert_eq!(next, count);
        }
        assert_eq!(Share::read("3/8"), Some(Share { number: 3, of: 8 }));
        for text in ["0/8", "9/8", "1", "a/2", "-1/3", "1/0", "1/2/3"] {
            assert_eq!(Share::read(text), None, "{text}");
        }
    }
}
