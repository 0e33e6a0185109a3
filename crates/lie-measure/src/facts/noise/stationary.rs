//! The means of long runs at a temperature, against those of the density exp(-H/T) by quadrature.

use super::orbits::on_orbit;
use super::paths::{Increments, Places, bound};
use super::quadrature::Means;
use super::space::{MOST_COORDINATES, on_space};
use super::{Finding, largest_step};
use lie_program::protocol::number;
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::state::State;
use serde::{Deserialize, Serialize};

/// The density that temperatures leave invariant, as the declaration says it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Thermal {
    /// On the coadjoint orbit of the initial state, at this temperature.
    Orbit(#[serde(with = "number")] f64),
    /// On the space of all momenta.
    Space(#[serde(with = "number")] f64),
    /// None that is known, and why.
    Unknown(String),
}

/// Independent runs, whose means tell their error.
const RUNS: usize = 32;
/// The larger steps of a run, in parts: of the first one nothing counts.
const PARTS: usize = 5;
/// The larger steps of a part.
const STEPS: usize = 800;
/// Functions are looked at behind so many of the larger steps.
const EVERY: usize = 4;
/// How often the step is halved where one fails.
const HALVINGS: u32 = 3;
/// In standard errors.
const CERTAIN: f64 = 4.0;
/// What the square of the step may leave, as a part of what halving it changes.
const REMAINDER: f64 = 0.5;
/// A mean with a standard error of more than this part of the standard deviation tells nothing.
const COARSE: f64 = 0.1;
/// The most coordinates whose means are taken.
const COORDINATES: usize = 6;
/// Runs have paths of their own.
const FIRST: u64 = 1 << 30;

/// What long runs are compared with, or why with nothing.
pub(super) struct Stationary<V> {
    places: Places,
    seed: u64,
    start: V,
    step: f64,
    means: Result<Means, String>,
}

/// H and the first coordinates.
fn functions<P: Poisson<f64>>(system: &P, places: Places, mu: &P::State) -> Vec<f64> {
    let coordinates = places.momenta().min(COORDINATES);
    let mut values = vec![system.energy(mu)];
    values.extend(&mu.as_slice()[..coordinates]);
    values
}

impl<V: State<f64>> Stationary<V> {
    /// That of a system in a state.
    pub(super) fn new<P: Poisson<f64, State = V>>(
        system: &P,
        start: &V,
        seed: u64,
        thermal: &Thermal,
    ) -> Option<Self> {
        let places = Places::of(system)?;
        let mut start = start.clone();
        places.rates(&mut start).fill(0.0);
        let values = |mu: &V| functions(system, places, mu);
        let momenta = places.momenta();
        let means = match thermal {
            _ if !places.has_momenta_alone() => {
                Err("the state has entries of the group element".to_owned())
            }
            Thermal::Orbit(temperature) => on_orbit(system, momenta, &start, *temperature, &values),
            Thermal::Space(temperature) if momenta <= MOST_COORDINATES => {
                on_space::<P>(momenta, &start, *temperature, &values)
            }
            Thermal::Space(_) => Err(format!(
                "a quadrature over {momenta} coordinates is not made, at most over {MOST_COORDINATES}"
            )),
            Thermal::Unknown(why) => Err(why.clone()),
        };
        let step = largest_step(system, places, &start);
        Some(Self {
            places,
            seed,
            start,
            step,
            means,
        })
    }

    /// The means of runs with a step and of those on the same paths with half of it: `[run][part][step][function]`; none where a step fails.
    fn runs<P>(&self, system: &P, method: &dyn AnyMethod<f64, P>, step: f64) -> Option<Vec<Run>>
    where
        P: Poisson<f64, State = V>,
    {
        let run = |run: usize| {
            let mut means = Vec::new();
            let mut states = [self.start.clone(), self.start.clone()];
            let sizes = [step, 0.5 * step];
            let newton = NewtonOptions::default();
            let mut steppers = sizes.map(|h| method.any_stepper(system, h, &newton));
            let bounds = sizes.map(|h| bound(method, h));
            for part in 0..PARTS {
                let number = FIRST + (run * PARTS + part) as u64;
                let span = step * STEPS as f64;
                let fine = Increments::draw(self.places, self.seed, number, 2 * STEPS, span);
                let paths = [fine.in_steps(STEPS), fine];
                let mut sums = [Vec::new(), Vec::new()];
                for k in 0..STEPS {
                    for size in 0..2 {
                        for step in 0..=size {
                            let rates = self.places.rates(&mut states[size]);
                            let increments = paths[size].step((size + 1) * k + step);
                            for (rate, x) in rates.iter_mut().zip(increments) {
                                *rate = x.clamp(-bounds[size], bounds[size]) / sizes[size];
                            }
                            steppers[size].step(&mut states[size]).ok()?;
                        }
                        if k % EVERY == EVERY - 1 {
                            let values = functions(system, self.places, &states[size]);
                            if values.iter().any(|value| !value.is_finite()) {
                                return None;
                            }
                            sums[size].resize(values.len(), 0.0);
                            let pairs = sums[size].iter_mut().zip(values);
                            pairs.for_each(|(sum, x)| *sum += x * EVERY as f64 / STEPS as f64);
                        }
                    }
                }
                means.push(sums);
            }
            Some(means)
        };
        (0..RUNS).map(run).collect()
    }
}

/// The means of the parts of a run, with the larger step and with the smaller one.
type Run = Vec<[Vec<f64>; 2]>;

/// A mean over runs with its standard error.
fn over_runs(runs: &[Run], of: impl Fn(&Run) -> f64) -> (f64, f64) {
    let values: Vec<f64> = runs.iter().map(of).collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    (mean, (squares / (count - 1.0) / count).sqrt())
}

/// What was found of the mean of one function.
struct Found {
    name: String,
    exact: f64,
    /// With the larger step, with the smaller one, and what both say of none, each with its standard error.
    means: [(f64, f64); 3],
    /// How far the second half of what counts is from the first.
    drift: (f64, f64),
    deviation: f64,
}

impl Found {
    fn distance(&self) -> f64 {
        (self.means[2].0 - self.exact).abs()
    }

    fn bound(&self) -> f64 {
        let change = (self.means[0].0 - self.means[1].0).abs();
        // a mean that does not scatter, as of a coordinate that stays, has round-off
        CERTAIN * self.means[2].1 + REMAINDER * change + 1e-9 * self.exact.abs().max(self.deviation)
    }

    fn is_resolved(&self) -> bool {
        self.means[2].1 <= COARSE * self.deviation + 1e-9 * self.exact.abs()
    }

    fn is_at_rest(&self) -> bool {
        self.drift.0.abs() <= CERTAIN * self.drift.1 + 1e-9 * self.deviation
    }

    fn words(&self) -> String {
        let [large, small, none] = self.means;
        format!(
            "{} {:.4} where {:.4} is exact; {:.4} ± {:.4} with the step, {:.4} ± {:.4} with half of it",
            self.name, none.0, self.exact, large.0, large.1, small.0, small.1
        )
    }
}

pub(super) fn findings<P: Lift<f64>>(
    system: &P,
    stationary: &Stationary<P::State>,
    method: &dyn AnyMethod<f64, P>,
) -> Vec<Finding> {
    const FACTS: [&str; 2] = ["mean energy", "mean coordinates"];
    let claimed = method.claims().weak_order().is_some();
    let exact = match &stationary.means {
        Ok(means) => means,
        Err(why) => return FACTS.map(|fact| Finding::absent(fact, why)).into(),
    };
    let unknown = |why: String| {
        let finding = |fact| match claimed {
            true => Finding::not_measurable(fact, 0.0, 0.0).note(why.clone()),
            false => Finding::absent(fact, &why),
        };
        Vec::from(FACTS.map(finding))
    };
    let steps = (0..=HALVINGS).map(|halvings| stationary.step * 0.5_f64.powi(halvings as i32));
    let mut tried = steps.map(|step| (step, stationary.runs(system, method, step)));
    let Some((step, runs)) = tried.find_map(|(step, runs)| Some((step, runs?))) else {
        return unknown("not resolved: a step fails in long runs".to_owned());
    };
    let counting = (PARTS - 1) as f64;
    let found = |k: usize| {
        let mean = |run: &Run, size: usize, parts: std::ops::Range<usize>| {
            let length = parts.len() as f64;
            run[parts].iter().map(|part| part[size][k]).sum::<f64>() / length
        };
        let whole = |run: &Run, size: usize| mean(run, size, 1..PARTS);
        let middle = 1 + (counting / 2.0) as usize;
        Found {
            name: match k {
                0 => "H".to_owned(),
                _ => system.coordinate(k - 1).to_owned(),
            },
            exact: exact.mean[k],
            means: [
                over_runs(&runs, |run| whole(run, 0)),
                over_runs(&runs, |run| whole(run, 1)),
                over_runs(&runs, |run| 2.0 * whole(run, 1) - whole(run, 0)),
            ],
            drift: over_runs(&runs, |run| {
                mean(run, 1, middle..PARTS) - mean(run, 1, 1..middle)
            }),
            deviation: exact.deviation[k],
        }
    };
    let all: Vec<Found> = (0..exact.mean.len()).map(found).collect();
    let judge = |fact: &'static str, all: &[Found]| {
        let excess = |found: &Found| found.distance() / found.bound();
        let worst = all
            .iter()
            .max_by(|a, b| excess(a).total_cmp(&excess(b)))
            .expect("a function");
        let why = match all
            .iter()
            .find(|found| !found.is_resolved() || !found.is_at_rest())
        {
            Some(found) if !found.is_resolved() => "the runs are short for the time of relaxation",
            Some(_) => "the runs have not come to rest",
            None => {
                return Finding::zero(fact, claimed, worst.distance(), worst.bound())
                    .at_step(step)
                    .with_error(worst.means[2].1)
                    .note(worst.words());
            }
        };
        let note = format!("not resolved: {why}; {}", worst.words());
        match claimed {
            true => Finding::not_measurable(fact, 0.0, 0.0).note(note),
            false => Finding::absent(fact, &note),
        }
    };
    vec![judge(FACTS[0], &all[..1]), judge(FACTS[1], &all[1..])]
}
