//! A method at one accuracy after the other, until it is as good as the reference solution or takes too long.

use super::found::{Accuracy, Found, Point};
use super::timing::{Clock, Spent, summary};
use super::{Entry, RunControl};
use crate::facts::{rate, relative_error};
use lie_program::protocol::End;
use lie_program::session::Session;
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Poisson, State};

/// Rounds of timing; between two runs of one point all others run once.
const ROUNDS: usize = 7;
/// A run that is timed is repeated until it lasts about so many seconds.
const SAMPLE: f64 = 2e-3;

/// One run that can be repeated.
pub(super) struct Rung<'a> {
    /// Everything but the times.
    point: Point,
    /// What the first run took, and a run in each round.
    first: Spent,
    samples: Vec<Spent>,
    run: Box<dyn Fn() + 'a>,
}

struct Run<V> {
    end: V,
    steps: u64,
    evaluations: u64,
    newton: u64,
}

/// What the runs of a method are compared with.
pub(super) struct Ladder<'a, P: Poisson<f64>> {
    pub(super) system: &'a P,
    pub(super) mu: &'a P::State,
    pub(super) exact: &'a P::State,
    pub(super) until: f64,
    /// The relative error of the reference solution.
    pub(super) floor: f64,
    /// Seconds that one run may take.
    pub(super) budget: f64,
    pub(super) label: &'a str,
    pub(super) clock: &'a Clock,
}

impl<'a, P: Poisson<f64>> Ladder<'a, P> {
    pub(super) fn climb(
        self,
        entry: &'a Entry<P>,
        session: &mut Session<'_>,
        rungs: &mut Vec<Rung<'a>>,
    ) {
        let Self {
            system, mu, until, ..
        } = self;
        match entry {
            Entry::Method(make) => {
                let first = (until.abs() * rate(system, mu) / 6.0).ceil().max(2.0) as u64;
                let steps = (0..26).map(|k| first << k);
                self.go(
                    Accuracy::Step,
                    steps.map(|steps| (until / steps as f64, steps)),
                    &move |(h, steps)| by_steps(system, &*make(), mu, h, steps),
                    session,
                    rungs,
                );
            }
            Entry::Adaptive(make) => self.go(
                Accuracy::Tolerance,
                tolerances(),
                &move |(tolerance, _)| by_steps(system, &*make(tolerance), mu, until, 1),
                session,
                rungs,
            ),
            Entry::Control(run) => self.go(
                Accuracy::Tolerance,
                tolerances(),
                &move |(tolerance, _)| by_control(system, run, mu, until, tolerance),
                session,
                rungs,
            ),
        }
    }

    fn go(
        &self,
        control: Accuracy,
        values: impl Iterator<Item = (f64, u64)>,
        run: &(impl Fn((f64, u64)) -> Result<Run<P::State>, String> + Clone + 'a),
        session: &mut Session<'_>,
        rungs: &mut Vec<Rung<'a>>,
    ) {
        let mut at_floor = 0;
        let mut best = f64::INFINITY;
        for value in values {
            let (outcome, first) = self.clock.spent(|| run(value));
            let error = match &outcome {
                Ok(run) => relative_error(&run.end, self.exact),
                Err(_) => f64::NAN,
            };
            let stopped = |why: &str| Found::Stopped {
                method: self.label.to_owned(),
                control,
                value: value.0,
                why: why.to_owned(),
            };
            match outcome {
                Ok(outcome) if error.is_finite() => {
                    let run = run.clone();
                    rungs.push(Rung {
                        point: self.point(control, value.0, error, &outcome),
                        first,
                        samples: Vec::new(),
                        run: Box::new(move || {
                            // its result is known; it only has to take place
                            let _ = std::hint::black_box(run(std::hint::black_box(value)));
                        }),
                    });
                }
                Ok(_) => super::tell(session, stopped("a number is not finite")),
                Err(why) => super::tell(session, stopped(&why)),
            }
            // two points at the floor, or two that are worse than before, end the ladder
            at_floor += u32::from(error <= 3.0 * self.floor || (error > best && best < 1e-10));
            best = f64::min(best, error);
            if at_floor == 2 || first.seconds > self.budget {
                break;
            }
        }
    }

    fn point(&self, control: Accuracy, value: f64, error: f64, run: &Run<P::State>) -> Point {
        Point {
            method: self.label.to_owned(),
            control,
            value,
            error,
            seconds: f64::NAN,
            median: f64::NAN,
            wall: f64::NAN,
            steps: run.steps,
            evaluations: run.evaluations,
            newton: run.newton,
        }
    }
}

/// Half decades.
fn tolerances() -> impl Iterator<Item = (f64, u64)> {
    (4..28).map(|k| (10_f64.powf(-0.5 * f64::from(k)), 0))
}

fn by_steps<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    h: f64,
    steps: u64,
) -> Result<Run<P::State>, String> {
    let mut end = mu.clone();
    let mut stepper = method.any_stepper(system, h, &NewtonOptions::default());
    match stepper.advance(&mut end, steps) {
        Ok(stats) => Ok(Run {
            end,
            steps: stats.accepted,
            evaluations: stats.evaluations,
            newton: stats.newton,
        }),
        Err((step, failure)) => Err(format!("step {}: {failure}", step + 1)),
    }
}

fn by_control<P: Poisson<f64>>(
    system: &P,
    run: &RunControl<P>,
    mu: &P::State,
    until: f64,
    tolerance: f64,
) -> Result<Run<P::State>, String> {
    let run = run(system, mu.as_slice(), until, tolerance);
    let run = run.ok_or_else(|| "it gave up".to_owned())?;
    let mut end = mu.clone();
    end.as_mut_slice().copy_from_slice(&run.end);
    Ok(Run {
        end,
        steps: run.steps,
        evaluations: run.evaluations,
        newton: 0,
    })
}

/// Times every run, round after round, so that a slow moment of the machine does not fall on one method alone.
///
/// # Errors
/// The session ends.
pub(super) fn time(
    rungs: &mut [Rung<'_>],
    clock: &Clock,
    session: &mut Session<'_>,
) -> Result<(), End> {
    let all = (rungs.len() * ROUNDS) as u64;
    let mut done = 0;
    session.stage(all / 3, all, "times")?;
    for _ in 0..ROUNDS {
        for rung in &mut *rungs {
            session.progress(all / 3 + done * 2 / 3, all)?;
            done += 1;
            let times = (SAMPLE / rung.first.seconds).ceil().clamp(1.0, 1e5) as u32;
            let ((), spent) = clock.spent(|| (0..times).for_each(|_| (rung.run)()));
            rung.samples.push(spent.over(f64::from(times)));
        }
    }
    Ok(())
}

impl Rung<'_> {
    /// With the times of a run to this end.
    pub(super) fn timed(&self, until: f64) -> Point {
        let [seconds, median, wall] =
            summary(&self.samples, self.first).map(|time| time / until.abs());
        Point {
            seconds,
            median,
            wall,
            ..self.point.clone()
        }
    }
}
