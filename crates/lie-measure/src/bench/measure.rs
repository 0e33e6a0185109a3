//! What is set against the time: the error of a run, in one of several senses.

mod section;

use crate::facts::relative_error;
use lie_program::protocol::number;
use lie_runtime::diagnostics::reference;
use lie_runtime::{Poisson, State};
use serde::{Deserialize, Serialize};

pub(super) use section::{NoSection, Section};

/// The sense in which a run errs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// The state at the end: the largest difference of a component over the largest component.
    #[default]
    State,
    /// The largest distance of the energy from its first value over the run, relative to that.
    Energy,
    /// The same of the Casimirs: the largest of all.
    Casimirs,
    /// The time by which the end is ahead or behind: the `delta` for which the exact orbit at `T + delta` is nearest to it.
    Phase,
    /// The distance on a surface of section of the run's passages from the exact ones.
    Section(Option<Plane>),
}

/// The surface on which a coordinate has a value, passed upward.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Plane {
    /// Its place in the state.
    pub coordinate: usize,
    /// The value.
    #[serde(with = "number")]
    pub value: f64,
}

/// The states of a run that a measure asks for.
pub(super) enum Wanted<'a> {
    /// After every step; of a method that shows no steps at times throughout the run.
    Every,
    /// At these times or, on a grid, at the last point before each.
    At(&'a [f64]),
}

/// The error of a run.
pub(super) struct Judged {
    pub(super) error: f64,
    /// Of the phase: what remains of the error, across the orbit.
    pub(super) across: Option<f64>,
}

/// Shows states of a run: its first argument says which, the second takes them with their times.
pub(super) type Look<'a, V> =
    dyn Fn(&Wanted<'_>, &mut dyn FnMut(f64, &V)) -> Result<(), String> + 'a;

/// A measure with what runs are compared with.
pub(super) enum Judge<V> {
    State(V),
    Drift {
        casimirs: bool,
        start: Vec<f64>,
        sizes: Vec<f64>,
    },
    Phase {
        exact: V,
        rate: f64,
    },
    Section(Section<V>),
}

impl<V: State<f64>> Judge<V> {
    /// Of the drift of invariants, which needs no exact solution.
    pub(super) fn drift<P: Poisson<f64, State = V>>(system: &P, mu: &V, casimirs: bool) -> Self {
        let start = invariants(system, mu, casimirs);
        let scale = mu.max_norm();
        let size = |first: &f64| match first.abs() > 1e-12 * scale.min(scale * scale) {
            true => first.abs(),
            // of an invariant that is zero the change itself counts
            false => 1.0,
        };
        let sizes = start.iter().map(size).collect();
        Self::Drift {
            casimirs,
            start,
            sizes,
        }
    }

    /// The error of a run with this end; `look` shows the rest of it.
    pub(super) fn error<P: Poisson<f64, State = V>>(
        &self,
        system: &P,
        end: &V,
        look: &Look<'_, V>,
    ) -> Result<Judged, String> {
        let alone = |error| Judged {
            error,
            across: None,
        };
        match self {
            Self::State(exact) => Ok(alone(relative_error(end, exact))),
            Self::Drift {
                casimirs,
                start,
                sizes,
            } => {
                let mut largest = 0.0;
                look(&Wanted::Every, &mut |_, mu| {
                    let now = invariants(system, mu, *casimirs);
                    for ((now, first), size) in now.iter().zip(start).zip(sizes) {
                        largest = worse(largest, (now - first).abs() / size);
                    }
                })?;
                Ok(alone(largest))
            }
            Self::Phase { exact, rate } => {
                let (ahead, across) = phase(system, exact, end, *rate)
                    .ok_or("no point of the exact orbit is nearest to its end")?;
                Ok(Judged {
                    error: ahead.abs(),
                    across: Some(across),
                })
            }
            Self::Section(section) => section.distance(system, look).map(alone),
        }
    }
}

/// The larger one, or the one that is no number.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// The energy, or the Casimirs that have one branch.
fn invariants<P: Poisson<f64>>(system: &P, mu: &P::State, casimirs: bool) -> Vec<f64> {
    if !casimirs {
        return vec![system.energy(mu)];
    }
    let mut values = vec![0.0; system.casimir_count()];
    system.casimirs(mu, &mut values);
    let followed =
        |(place, value): (usize, f64)| (!system.casimir_is_multivalued(place)).then_some(value);
    values
        .into_iter()
        .enumerate()
        .filter_map(followed)
        .collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The time `delta` at which the orbit through `exact` is nearest to `state`, and the relative distance there:
///
/// ```math
/// \langle \mu - \varphi_\delta(\nu), f(\varphi_\delta(\nu)) \rangle = 0
/// ```
///
/// by Gauss–Newton steps from `delta = 0`, each along the exact flow and no longer than a quarter of the time in which the
/// field changes.
fn phase<P: Poisson<f64>>(
    system: &P,
    exact: &P::State,
    state: &P::State,
    rate: f64,
) -> Option<(f64, f64)> {
    const STEPS: usize = 400;
    let mut near = exact.clone();
    let mut field = system.zero_state();
    let mut delta = 0.0;
    for _ in 0..STEPS {
        system.vector_field(&near, &mut field);
        let away: Vec<f64> = state
            .as_slice()
            .iter()
            .zip(near.as_slice())
            .map(|(a, b)| a - b)
            .collect();
        let step = dot(&away, field.as_slice()) / dot(field.as_slice(), field.as_slice());
        let step = step.clamp(-0.25 / rate, 0.25 / rate);
        if !step.is_finite() {
            return None;
        }
        if step.abs() * rate <= f64::EPSILON {
            return Some((delta + step, relative_error(state, &near)));
        }
        near = reference(system, &near, step)?.mu;
        delta += step;
    }
    // nearer than the minimum is known: the distance is flat there
    Some((delta, relative_error(state, &near)))
}
