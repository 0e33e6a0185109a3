//! One experiment: a method, a system and a state, and what happened to the invariants.

use super::{Cell, REACH, STEPS};
use crate::diagnostics::verify::rate;
use crate::diagnostics::{AnyMethod, Claims};
use crate::newton::{FailureReason, NewtonOptions};
use crate::poisson::Poisson;
use crate::state::{State, Unknown};
use std::sync::atomic::Ordering;

/// Round-off of N steps in units of epsilon: a beginning, a random walk `WALK sqrt(N)`, and `BIAS N`, what does not
/// average out. The beginning is `LARGE` where steps are tried that are far beyond use: they act by elements of norm
/// 1e3 and more, by which round-off is multiplied.
const LARGE: f64 = 6400.0;
const SMALL: f64 = 64.0;
const WALK: f64 = 16.0;
const BIAS: f64 = 1.0 / 64.0;
const WINDOWS: usize = 10;
/// In longer runs the sizes of the terms are looked at every so many steps.
const LOOK: u64 = 64;

/// The largest relative error of a claimed invariant after N steps that is called round-off.
pub(super) fn bound(steps: u64, large: bool) -> f64 {
    let steps = steps as f64;
    let beginning = if large { LARGE } else { SMALL };
    f64::EPSILON * (beginning + WALK * steps.sqrt() + BIAS * steps)
}

/// How an invariant moved.
#[derive(Clone, Debug)]
struct Drift {
    first: f64,
    size: f64,
    max: f64,
    windows: [f64; WINDOWS],
}

impl Drift {
    fn new(first: f64, size: f64) -> Self {
        Self {
            first,
            size,
            max: 0.0,
            windows: [0.0; WINDOWS],
        }
    }

    fn see(&mut self, value: f64, window: usize) {
        let change = (value - self.first).abs();
        if change > self.max || change.is_nan() {
            self.max = change;
        }
        self.windows[window] = f64::max(self.windows[window], change);
    }

    fn relative(&self) -> f64 {
        if self.max == 0.0 {
            0.0
        } else {
            self.max / self.size
        }
    }

    fn growth(&self) -> f64 {
        self.windows[WINDOWS - 1] / self.windows[0]
    }
}

/// What happened in an experiment.
pub(super) struct Outcome {
    step: f64,
    word: &'static str,
    steps: u64,
    newton: f64,
    energy: (f64, f64),
    casimirs: (f64, f64),
    claimed: f64,
    what: String,
}

impl Outcome {
    pub(super) fn domain(what: &str) -> Self {
        Self {
            step: f64::NAN,
            word: "domain",
            steps: 0,
            newton: f64::NAN,
            energy: (f64::NAN, f64::NAN),
            casimirs: (f64::NAN, f64::NAN),
            claimed: f64::NAN,
            what: what.to_owned(),
        }
    }

    pub(super) fn fields(&self) -> Vec<String> {
        let number = |value: f64| format!("{value:?}");
        vec![
            number(self.step),
            self.word.to_owned(),
            self.steps.to_string(),
            number(self.newton),
            number(self.energy.0),
            number(self.energy.1),
            number(self.casimirs.0),
            number(self.casimirs.1),
            number(self.claimed),
            self.what.clone(),
        ]
    }
}

/// Which invariants a method claims on a system: the energy, then each Casimir.
pub(super) fn claimed<P: Poisson<f64>>(system: &P, claims: &Claims) -> Vec<bool> {
    let kept = claims.preserves;
    let quadratic = system
        .hamiltonian_degree()
        .is_some_and(|degree| degree <= 2);
    let casimirs = (0..system.casimir_count()).map(|index| {
        let degree = system.casimir_degree(index);
        let quadratic = kept.quadratic_casimirs && degree.is_some_and(|degree| degree <= 2);
        (kept.casimirs || quadratic) && !system.casimir_is_multivalued(index)
    });
    std::iter::once(kept.energy || (kept.quadratic_invariants && quadratic))
        .chain(casimirs)
        .collect()
}

pub(super) fn values<P: Poisson<f64>>(system: &P, mu: &P::State, values: &mut [f64]) {
    values[0] = system.hamiltonian(mu);
    system.casimirs(mu, &mut values[1..]);
}

/// The sizes of the terms: what round-off of the state changes.
pub(super) fn sizes<P: Poisson<f64>>(system: &P, mu: &P::State) -> Vec<f64> {
    let mut all = vec![0.0; system.casimir_count() + 1];
    values(system, mu, &mut all);
    let mut gradient = system.zero_state();
    for (index, size) in all.iter_mut().enumerate() {
        match index {
            0 => system.gradient(mu, &mut gradient),
            _ => system.casimir_gradient(index - 1, mu, &mut gradient),
        }
        let sum: f64 = gradient.as_slice().iter().map(|g| g.abs()).sum();
        *size = size.abs() + sum * mu.max_norm();
    }
    all
}

/// Runs one experiment.
pub(super) fn run<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    cell: &Cell,
    stop: &std::sync::atomic::AtomicBool,
) -> Outcome {
    let mut mu = system.zero_state();
    mu.as_mut_slice().copy_from_slice(&cell.mu);
    let mut field = system.zero_state();
    system.vector_field(&mu, &mut field);
    let local = rate(system, &mu);
    let step = cell.step.unwrap_or(REACH / local);
    let sane = field.finite() && system.hamiltonian(&mu).is_finite() && local.is_finite();
    let first_sizes = sizes(system, &mu);
    // squares of tiny numbers are no numbers any more: nothing can be relative to them
    let normal = first_sizes.iter().all(|size| size.is_finite());
    if !sane || !normal || !step.is_finite() {
        return Outcome::domain("H, its derivatives or a Casimir overflow there");
    }
    let mut now = vec![0.0; system.casimir_count() + 1];
    values(system, &mu, &mut now);
    let mut drifts: Vec<Drift> = now
        .iter()
        .zip(&first_sizes)
        .map(|(&first, &size)| Drift::new(first, size.max(f64::MIN_POSITIVE)))
        .collect();
    let mut stepper = method.any_stepper(system, step, &NewtonOptions::default());
    let (mut newton, mut failure, mut done) = (0_u64, None, 0);
    let mut outside = false;
    while done < cell.steps {
        match stepper.step(&mut mu) {
            Ok(report) => newton += u64::from(report.iterations),
            Err(why) => {
                failure = Some(why);
                break;
            }
        }
        let window = (done * WINDOWS as u64 / cell.steps) as usize;
        done += 1;
        values(system, &mu, &mut now);
        if !now[0].is_finite() && mu.finite() {
            outside = true;
            break;
        }
        for (drift, &value) in drifts.iter_mut().zip(&now) {
            drift.see(value, window);
        }
        // next to a singularity the sizes change within a few steps
        if cell.steps <= STEPS || done % LOOK == 0 || done == cell.steps {
            for (drift, size) in drifts.iter_mut().zip(sizes(system, &mu)) {
                drift.size = drift.size.max(size);
            }
            if stop.load(Ordering::Relaxed) {
                break;
            }
        }
    }
    for (drift, size) in drifts.iter_mut().zip(sizes(system, &mu)) {
        drift.size = drift.size.max(size);
    }
    let bound = bound(done.max(1), cell.steps <= STEPS);
    let claims = claimed(system, &method.claims());
    let excess = drifts
        .iter()
        .zip(&claims)
        .filter(|(_, claimed)| **claimed)
        .map(|(drift, _)| drift.relative() / bound)
        .fold(0.0, |m: f64, x| if x.is_nan() { x } else { f64::max(m, x) });
    let finite = outside || mu.finite() && drifts.iter().all(|drift| drift.max.is_finite());
    let worst = drifts[1..]
        .iter()
        .max_by(|a, b| a.relative().total_cmp(&b.relative()));
    let (word, what) = match (failure, excess <= 1.0) {
        (Some(failure), true) => ("stopped", format!("step {}: {failure}", done + 1)),
        (None, true) if outside => (
            "stopped",
            format!("step {done}: {}", FailureReason::OutsideDomain),
        ),
        (_, false) => {
            let lost: Vec<&str> = std::iter::once("energy")
                .chain((0..system.casimir_count()).map(|index| system.casimir_name(index)))
                .zip(drifts.iter().zip(&claims))
                .filter(|(_, (drift, claimed))| {
                    **claimed && !matches!(drift.relative() / bound, r if r <= 1.0)
                })
                .map(|(name, _)| name)
                .collect();
            ("lost", lost.join(" "))
        }
        (None, true) if !finite => ("lost", "a number is not finite".to_owned()),
        (None, true) => ("kept", String::new()),
    };
    Outcome {
        step,
        word,
        steps: done,
        newton: newton as f64 / done.max(1) as f64,
        energy: (drifts[0].relative(), drifts[0].growth()),
        casimirs: worst.map_or((f64::NAN, f64::NAN), |drift| {
            (drift.relative(), drift.growth())
        }),
        claimed: excess,
        what,
    }
}
