//! What is tried: steps, parameters and states at their limits, and a long run.

use super::Stress;
use super::found::Experiment;
use lie_program::protocol::{End, Start};
use lie_runtime::{Poisson, State, Unknown};

/// Steps of a trial other than the long run.
pub(super) const STEPS: u64 = 400;

/// A state, parameters and a step.
#[derive(Clone)]
pub(super) struct Trial {
    pub(super) experiment: Experiment,
    pub(super) name: String,
    pub(super) value: f64,
    pub(super) parameters: Vec<f64>,
    pub(super) mu: Vec<f64>,
    /// None: 0.2 over the rate there.
    pub(super) step: Option<f64>,
    pub(super) steps: u64,
}

impl<P: Poisson<f64> + Sync> Stress<P> {
    /// All trials, the long run last: it takes longest, and an interrupt before it leaves the map of the others.
    pub(super) fn trials(
        &self,
        system: &P,
        start: &Start,
        step: f64,
        long: u64,
    ) -> Result<Vec<Trial>, End> {
        let plain = Trial {
            experiment: Experiment::Step,
            name: "h/h0".to_owned(),
            value: 1.0,
            parameters: self.blueprint.values(start)?,
            mu: start.initial.clone(),
            step: Some(step),
            steps: STEPS,
        };
        let mut trials: Vec<Trial> = steps(&plain, step).collect();
        let names: Vec<&str> = self.blueprint.names().collect();
        let changed = names.iter().enumerate();
        let changed = changed.filter(|(_, name)| !self.left.iter().any(|left| left == *name));
        trials.extend(parameters(&plain, changed));
        trials.extend(scales(&plain));
        trials.extend(components(&plain, system));
        trials.extend(casimirs(&plain, system));
        trials.push(Trial {
            experiment: Experiment::Long,
            name: "steps".to_owned(),
            value: long as f64,
            steps: long,
            ..plain
        });
        Ok(trials)
    }
}

/// Powers of ten up to the step of the system's own time, then of two.
fn steps(plain: &Trial, step: f64) -> impl Iterator<Item = Trial> {
    let exponents = [-12, -9, -6, -4, -3, -2, -1, 0, 1, 2, 3, 4, 6, 8];
    let factors = exponents.map(|exponent| {
        if exponent <= 0 {
            10_f64.powi(exponent)
        } else {
            2_f64.powi(exponent)
        }
    });
    factors.into_iter().map(move |factor| Trial {
        value: factor,
        step: Some(factor * step),
        ..plain.clone()
    })
}

/// Each multiplied by powers of ten.
fn parameters<'a>(
    plain: &Trial,
    places: impl Iterator<Item = (usize, &'a &'a str)>,
) -> impl Iterator<Item = Trial> {
    let factors = places.flat_map(|place| (1..=6).map(move |k| (place, 10_f64.powi(k))));
    factors.map(|((index, name), factor)| {
        let mut parameters = plain.parameters.clone();
        parameters[index] *= factor;
        Trial {
            experiment: Experiment::Parameter,
            name: (*name).to_owned(),
            value: factor,
            parameters,
            ..plain.clone()
        }
    })
}

/// The state multiplied by powers of ten.
fn scales(plain: &Trial) -> impl Iterator<Item = Trial> {
    let exponents = [-100, -50, -20, -10, -5, -2, 2, 5, 10, 20, 50, 100];
    exponents.into_iter().map(|exponent| {
        let factor = 10_f64.powi(exponent);
        Trial {
            experiment: Experiment::Scale,
            name: "state".to_owned(),
            value: factor,
            mu: plain.mu.iter().map(|x| x * factor).collect(),
            step: None,
            ..plain.clone()
        }
    })
}

/// Each coordinate small, and zero.
fn components<P: Poisson<f64>>(plain: &Trial, system: &P) -> impl Iterator<Item = Trial> {
    let places = (0..system.dimension()).flat_map(|index| [(index, 1e-8), (index, 0.0)]);
    places.map(|(index, factor)| {
        let mut mu = plain.mu.clone();
        mu[index] *= factor;
        Trial {
            experiment: Experiment::Component,
            name: system.coordinate(index).to_owned(),
            value: factor,
            mu,
            step: None,
            ..plain.clone()
        }
    })
}

/// States at which each Casimir is small, and zero.
fn casimirs<P: Poisson<f64>>(plain: &Trial, system: &P) -> impl Iterator<Item = Trial> {
    let places = (0..system.casimir_count())
        .flat_map(|index| [1e-4, 1e-12, 0.0].map(|factor| (index, factor)));
    places.filter_map(|(index, factor)| {
        Some(Trial {
            experiment: Experiment::Casimir,
            name: system.casimir_name(index).to_owned(),
            value: factor,
            mu: towards_zero(system, &plain.mu, index, factor)?,
            step: None,
            ..plain.clone()
        })
    })
}

/// The state nearest to mu, about, at which a Casimir is so much smaller: along its gradient.
fn towards_zero<P: Poisson<f64>>(
    system: &P,
    mu: &[f64],
    index: usize,
    factor: f64,
) -> Option<Vec<f64>> {
    let mut start = system.zero_state();
    start.as_mut_slice().copy_from_slice(mu);
    let mut values = vec![0.0; system.casimir_count()];
    system.casimirs(&start, &mut values);
    let goal = factor * values[index];
    let mut state = start.clone();
    let mut gradient = system.zero_state();
    for _ in 0..200 {
        system.casimirs(&state, &mut values);
        system.casimir_gradient(index, &state, &mut gradient);
        let square: f64 = gradient.as_slice().iter().map(|g| g * g).sum();
        let step = (goal - values[index]) / square;
        if !step.is_finite() || step == 0.0 {
            break;
        }
        state.axpy(step, &gradient);
    }
    // the origin is a state of its own: nothing moves there
    let moves = state.max_norm() > 1e-30 * start.max_norm();
    (state.finite() && moves).then(|| state.as_slice().to_vec())
}
