//! What is held from step to step, as a request says it.

use super::number;
use lie_runtime::driver::{self, Source};
use lie_runtime::poisson::Poisson;
use lie_runtime::scalar::Scalar;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Inputs and noise of a run.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Held {
    /// The seed of the noise.
    pub seed: u64,
    /// Its stream, such as the number of a member.
    pub stream: u64,
    /// Whether increments are bounded, as implicit steps need it.
    pub bounded: bool,
    /// Tables of inputs by name.
    pub inputs: BTreeMap<String, Table>,
}

/// A table: each value is held from its time on.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// The times, ascending.
    #[serde(with = "number::list")]
    pub times: Vec<f64>,
    /// A value for each.
    #[serde(with = "number::list")]
    pub values: Vec<f64>,
}

/// Sources of inputs by name, which do not leave a process.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sources(pub BTreeMap<String, Source>);

impl Held {
    /// The same for a system, from a time on.
    pub fn of<P: Poisson<f64>>(
        &self,
        system: &P,
        start: f64,
        sources: &Sources,
    ) -> Option<driver::Held> {
        self.in_lanes(system, start, sources, &[self.stream])
    }

    /// The same for a system in lanes, each with its stream.
    pub fn in_lanes<S: Scalar, P: Poisson<S>>(
        &self,
        system: &P,
        start: f64,
        sources: &Sources,
        streams: &[u64],
    ) -> Option<driver::Held> {
        let mut held = driver::Held::of(system, start, (self.seed, streams))?;
        let first = system.clock().map_or(0, |clock| clock.time + 2);
        for index in 0..system.input_count() {
            let name = system.coordinate(first + index);
            let table = self.inputs.get(name).map(|table| Source::Table {
                times: table.times.as_slice().into(),
                values: table.values.as_slice().into(),
            });
            if let Some(source) = sources.0.get(name).cloned().or(table) {
                held = held.with(index, source);
            }
        }
        Some(held.bounded(self.bounded))
    }
}
