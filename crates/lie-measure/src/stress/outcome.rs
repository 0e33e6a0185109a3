//! One experiment: a method, a system and a state, and what happened to the invariants.

use super::REACH;
use super::found::{Cell, Moved, Outcome};
use super::trials::{STEPS, Trial};
use crate::facts::rate;
use lie_runtime::diagnostics::{AnyMethod, Claims, InvariantDrift};
use lie_runtime::methods::StepFailure;
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::{Poisson, State, Unknown};
use std::sync::atomic::{AtomicBool, Ordering};

/// Round-off of N steps in units of epsilon: a beginning, a random walk `WALK sqrt(N)`, and `BIAS N`, what does not
/// average out. The beginning is `LARGE` where steps are tried that are far beyond use: they act by elements of norm
/// 1e3 and more, by which round-off is multiplied.
const LARGE: f64 = 6400.0;
const SMALL: f64 = 64.0;
const WALK: f64 = 16.0;
const BIAS: f64 = 1.0 / 64.0;
/// In longer runs the sizes of the terms are looked at every so many steps.
const LOOK: u64 = 64;

/// The largest relative error of a claimed invariant after N steps that is called round-off.
pub(super) fn bound(steps: u64, large: bool) -> f64 {
    let steps = steps as f64;
    let beginning = if large { LARGE } else { SMALL };
    f64::EPSILON * (beginning + WALK * steps.sqrt() + BIAS * steps)
}

/// What there is to say where nothing can be integrated.
pub(super) fn domain(method: String, trial: &Trial, what: &str) -> Cell {
    Cell {
        method,
        experiment: trial.experiment,
        name: trial.name.clone(),
        value: trial.value,
        step: f64::NAN,
        outcome: Outcome::Domain,
        steps: 0,
        newton: f64::NAN,
        energy: Moved::UNKNOWN,
        casimirs: Moved::UNKNOWN,
        claimed: f64::NAN,
        what: what.to_owned(),
    }
}

/// Which invariants a method claims on a system: the energy, then each Casimir.
pub(super) fn claimed<P: Poisson<f64>>(system: &P, claims: &Claims) -> Vec<bool> {
    let kept = claims.preserves.on(system);
    let casimirs = (0..system.casimir_count()).map(|index| {
        let degree = system.casimir_degree(index);
        let quadratic = kept.quadratic_casimirs && degree.is_some_and(|degree| degree <= 2);
        (kept.casimirs || quadratic)
            && !system.casimir_is_multivalued(index)
            && system.casimir_is_kept(index)
    });
    std::iter::once(kept.keeps_energy(system))
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

/// The invariants of a run, the energy first, with the sizes of their terms.
struct Watched {
    drifts: Vec<InvariantDrift>,
    sizes: Vec<f64>,
    now: Vec<f64>,
}

impl Watched {
    /// None where an invariant or the size of its terms is no number: nothing can be relative to it.
    fn start<P: Poisson<f64>>(system: &P, mu: &P::State) -> Option<Self> {
        let sizes = sizes(system, mu);
        if !sizes.iter().all(|size| size.is_finite()) {
            return None;
        }
        let mut now = vec![0.0; system.casimir_count() + 1];
        values(system, mu, &mut now);
        let names = std::iter::once("energy")
            .chain((0..system.casimir_count()).map(|index| system.casimir_name(index)));
        let drifts = names.zip(&now);
        Some(Self {
            drifts: drifts
                .map(|(name, &first)| InvariantDrift::new(name, Some(first)))
                .collect(),
            sizes: sizes
                .into_iter()
                .map(|size| size.max(f64::MIN_POSITIVE))
                .collect(),
            now,
        })
    }

    /// Takes a state; false outside the domain of H.
    fn see<P: Poisson<f64>>(&mut self, system: &P, mu: &P::State, step: u64, steps: u64) -> bool {
        values(system, mu, &mut self.now);
        if !self.now[0].is_finite() && mu.finite() {
            return false;
        }
        for (drift, value) in self.drifts.iter_mut().zip(&self.now) {
            drift.record((value - drift.initial).abs(), step, steps);
        }
        true
    }

    fn see_sizes<P: Poisson<f64>>(&mut self, system: &P, mu: &P::State) {
        for (seen, size) in self.sizes.iter_mut().zip(sizes(system, mu)) {
            *seen = seen.max(size);
        }
    }

    fn moved(&self) -> Vec<Moved> {
        let pairs = self.drifts.iter().zip(&self.sizes);
        let moved = pairs.map(|(drift, size)| Moved {
            drift: if drift.max == 0.0 {
                0.0
            } else {
                drift.max / size
            },
            growth: drift.windows[drift.windows.len() - 1] / drift.windows[0],
        });
        moved.collect()
    }
}

/// How far a run came.
struct Done {
    steps: u64,
    newton: u64,
    /// Why it ended before its end.
    stopped: Option<String>,
    /// Whether everything is a number, up to where it stopped.
    finite: bool,
}

/// Runs one experiment.
pub(super) fn run<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    label: String,
    trial: &Trial,
    stop: &AtomicBool,
) -> Cell {
    let mut mu = system.zero_state();
    mu.as_mut_slice().copy_from_slice(&trial.mu);
    let mut field = system.zero_state();
    system.vector_field(&mu, &mut field);
    let local = rate(system, &mu);
    let step = trial.step.unwrap_or(REACH / local);
    let sane = field.finite() && system.hamiltonian(&mu).is_finite() && local.is_finite();
    let watched = Watched::start(system, &mu).filter(|_| sane && step.is_finite());
    let Some(mut watched) = watched else {
        return domain(
            label,
            trial,
            "H, its derivatives or a Casimir overflow there",
        );
    };
    let done = integrate(
        system,
        method,
        &mut mu,
        step,
        trial.steps,
        &mut watched,
        stop,
    );
    let moved = watched.moved();
    let bound = bound(done.steps.max(1), trial.steps <= STEPS);
    let claims = claimed(system, &method.claims());
    let excess = moved
        .iter()
        .zip(&claims)
        .filter(|(_, claimed)| **claimed)
        .map(|(moved, _)| moved.drift / bound)
        .fold(0.0, |m: f64, x| if x.is_nan() { x } else { f64::max(m, x) });
    let worst = moved[1..].iter().max_by(|a, b| a.drift.total_cmp(&b.drift));
    let (outcome, what) = match done.stopped {
        _ if !matches!(excess, excess if excess <= 1.0) => {
            (Outcome::Lost, lost(&watched, &moved, &claims, bound))
        }
        Some(why) => (Outcome::Stopped, why),
        None if !done.finite => (Outcome::Lost, "a number is not finite".to_owned()),
        None => (Outcome::Kept, String::new()),
    };
    Cell {
        step,
        outcome,
        steps: done.steps,
        newton: done.newton as f64 / done.steps.max(1) as f64,
        energy: moved[0],
        casimirs: worst.copied().unwrap_or(Moved::UNKNOWN),
        claimed: excess,
        ..domain(label, trial, &what)
    }
}

/// The names of what moved further than is claimed.
fn lost(watched: &Watched, moved: &[Moved], claims: &[bool], bound: f64) -> String {
    let beyond = |moved: &Moved| !matches!(moved.drift / bound, r if r <= 1.0);
    let all = watched.drifts.iter().zip(moved).zip(claims);
    let lost = all.filter(|((_, moved), claimed)| **claimed && beyond(moved));
    let names: Vec<&str> = lost.map(|((drift, _), _)| drift.name.as_str()).collect();
    names.join(" ")
}

/// Steps until the end, or until one fails or leaves the domain of H.
fn integrate<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &mut P::State,
    step: f64,
    steps: u64,
    watched: &mut Watched,
    stop: &AtomicBool,
) -> Done {
    let mut stepper = method.any_stepper(system, step, &NewtonOptions::default());
    let (mut newton, mut done, mut outside) = (0, 0, false);
    let mut failure: Option<StepFailure> = None;
    while done < steps {
        match stepper.step(mu) {
            Ok(report) => newton += u64::from(report.iterations),
            Err(why) => {
                failure = Some(why);
                break;
            }
        }
        done += 1;
        if !watched.see(system, mu, done, steps) {
            outside = true;
            break;
        }
        // next to a singularity the sizes change within a few steps
        if steps <= STEPS || done % LOOK == 0 || done == steps {
            watched.see_sizes(system, mu);
            if stop.load(Ordering::Relaxed) {
                break;
            }
        }
    }
    watched.see_sizes(system, mu);
    let stopped = match failure {
        Some(failure) => Some(format!("step {}: {failure}", done + 1)),
        None => outside.then(|| format!("step {done}: {}", FailureReason::OutsideDomain)),
    };
    let finite = mu.finite() && watched.drifts.iter().all(|drift| drift.max.is_finite());
    Done {
        steps: done,
        newton,
        stopped,
        finite,
    }
}
