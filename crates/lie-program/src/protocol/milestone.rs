//! Places from which a run can be taken up again, bit by bit: of what is not a number too, since arrays show its bits.

use super::number;
use lie_runtime::Poisson;
use lie_runtime::State as _;
use lie_runtime::driver::{self, Control, Division, Stats, Watched};
use serde::{Deserialize, Serialize};

/// A [`driver::Milestone`], and the group element where a run follows it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Milestone {
    /// Steps done.
    pub index: u64,
    /// The time reached.
    #[serde(with = "number")]
    pub time: f64,
    step: u64,
    state: Vec<u64>,
    branch: Option<Vec<u64>>,
    element: Vec<u64>,
    /// The angles that are followed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    angles: Vec<u64>,
    #[serde(with = "StatsFields")]
    stats: Stats,
    #[serde(with = "DivisionFields")]
    division: Division,
}

/// Which milestones of a run are said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Milestones {
    /// None.
    #[default]
    None,
    /// About one in a second.
    Timed,
    /// The first one after each multiple of so many steps.
    Every(u64),
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|number| number.to_bits()).collect()
}

fn numbers(bits: &[u64]) -> Vec<f64> {
    bits.iter().copied().map(f64::from_bits).collect()
}

impl Milestone {
    /// That of a driver, with the group element and the angles that are followed.
    pub(crate) fn new<V: lie_runtime::State<f64>>(
        milestone: &driver::Milestone<V>,
        element: &[f64],
        angles: &[f64],
    ) -> Self {
        let branch = milestone.branch.as_ref();
        Self {
            index: milestone.index,
            time: milestone.time,
            step: milestone.step.to_bits(),
            state: bits(milestone.mu.as_slice()),
            branch: branch.map(|branch| bits(branch.as_slice())),
            element: bits(element),
            angles: bits(angles),
            stats: milestone.stats,
            division: milestone.division,
        }
    }

    /// The same for the driver; none where a vector has another length.
    pub(crate) fn of<P: Poisson<f64>>(&self, system: &P) -> Option<driver::Milestone<P::State>> {
        let vector = |bits: &[u64]| {
            let mut vector = system.zero_state();
            let entries = vector.as_mut_slice();
            (entries.len() == bits.len()).then(|| entries.copy_from_slice(&numbers(bits)))?;
            Some(vector)
        };
        let branch = match &self.branch {
            Some(branch) => Some(vector(branch)?),
            None => None,
        };
        Some(driver::Milestone {
            index: self.index,
            time: self.time,
            step: f64::from_bits(self.step),
            mu: vector(&self.state)?,
            branch,
            stats: self.stats,
            division: self.division,
        })
    }

    /// The memory of what follows the group element.
    pub(crate) fn element(&self) -> Vec<f64> {
        numbers(&self.element)
    }

    /// The angles that are followed.
    pub(crate) fn angles(&self) -> Vec<f64> {
        numbers(&self.angles)
    }
}

/// The fields of [`Stats`].
#[derive(Deserialize, Serialize)]
#[serde(remote = "Stats", deny_unknown_fields)]
struct StatsFields {
    steps: u64,
    evaluations: u64,
    newton: u64,
    fixed_point: u64,
    factorizations: u64,
    pivoted: u64,
    accepted: u64,
    rejected: u64,
    failures: u64,
}

/// The fields of [`Division`].
#[derive(Deserialize, Serialize)]
#[serde(remote = "Division", deny_unknown_fields)]
struct DivisionFields {
    parts: u32,
    shortened: Option<(u64, f64, u64)>,
    slow: (u64, u64),
    #[serde(with = "watched")]
    watched: Option<Watched>,
    #[serde(default, skip_serializing_if = "Option::is_none", with = "control")]
    control: Option<Control>,
}

/// The state of the control of steps that follow the motion, bit by bit.
mod control {
    use super::{Control, bits};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        control: &Option<Control>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let control = control.map(|control| bits(&[control.eps, control.rho, control.lost]));
        control.serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Control>, D::Error> {
        let written = Option::<[u64; 3]>::deserialize(deserializer)?;
        Ok(written.map(|bits| {
            let [eps, rho, lost] = bits.map(f64::from_bits);
            Control { eps, rho, lost }
        }))
    }
}

/// What is known of errors, if something is.
mod watched {
    use super::{Watched, number};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Deserialize, Serialize)]
    #[serde(remote = "Watched", deny_unknown_fields)]
    struct Fields {
        #[serde(with = "number")]
        ceiling: f64,
        #[serde(with = "number")]
        slope: f64,
        #[serde(with = "number")]
        spent: f64,
        left: u32,
        interval: u32,
        usual: u32,
        said: bool,
    }

    #[derive(Deserialize, Serialize)]
    #[serde(transparent)]
    struct Written(#[serde(with = "Fields")] Watched);

    pub(super) fn serialize<S: Serializer>(
        watched: &Option<Watched>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        watched.map(Written).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Watched>, D::Error> {
        let written = Option::<Written>::deserialize(deserializer)?;
        Ok(written.map(|Written(watched)| watched))
    }
}
