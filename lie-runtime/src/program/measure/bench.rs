//! The program behind `lie bench`: the error at the end of a run against the time that it takes.
//!
//! Further keys: `until` (the end), `budget` (seconds that one run may take). Lines:
//!
//! | line | |
//! |---|---|
//! | `reference <error> <difference> <evaluations>` | its own estimate, and the relative difference from a second method |
//! | `point <label> <kind> <value> <error> <seconds> <median> <wall> <steps> <evaluations> <newton>` | per unit of time; kind is `step` or `tolerance` |
//! | `clock <name>` | what the seconds are: `processor`, or `wall` where the system has no clock of the processor |
//! | `stopped <label> <kind> <value> <why>` | a run that did not come to its end |
//!
//! The seconds are the least of all rounds and their median, by the clock; `wall` is the median of what passed
//! meanwhile: where it is more, other programs ran.

use super::super::{Build, Tolerances};
use super::timing::{Clock, Spent, summary};
use super::{Ended, Request, Session, main, prepare};
use crate::diagnostics::verify::{rate, relative_error};
use crate::diagnostics::{AnyMethod, reference};
use crate::equation::Implicit;
use crate::methods::{Gauss6, Method};
use crate::newton::NewtonOptions;
use crate::parameter::ParameterError;
use crate::poisson::Poisson;
use crate::state::{State, Unknown};
use std::process::ExitCode;

/// Rounds of timing; between two runs of one point all others run once.
const ROUNDS: usize = 7;
/// A run that is timed is repeated until it lasts about so many seconds.
const SAMPLE: f64 = 2e-3;

/// The outcome of a run of a method from outside the catalogue.
#[derive(Clone, Debug)]
pub struct ControlRun {
    /// The state at the end.
    pub end: Vec<f64>,
    /// Evaluations of the vector field.
    pub evaluations: u64,
    /// Steps.
    pub steps: u64,
}

type RunControl<P> = Box<dyn Fn(&P, &[f64], f64, f64) -> Option<ControlRun>>;

/// An adaptive method from outside the catalogue, to compare with.
pub struct Control<P> {
    /// Its name.
    pub label: &'static str,
    /// A run from a state at time 0 to a time with both tolerances alike; none if it fails.
    pub run: RunControl<P>,
}

type Made<P> = Box<dyn AnyMethod<f64, P>>;

enum Entry<P> {
    Method(Box<dyn Fn() -> Made<P>>),
    Adaptive(Box<dyn Fn(f64) -> Made<P>>),
    Control(RunControl<P>),
}

/// A program that compares methods on one system.
pub struct Bench<P: Poisson<f64>> {
    defaults: Vec<f64>,
    build: Box<Build<P>>,
    entries: Vec<(&'static str, Entry<P>)>,
    clock: Clock,
}

/// One run that can be repeated.
struct Point<'a> {
    label: &'a str,
    kind: &'static str,
    value: f64,
    error: f64,
    counts: [u64; 3],
    /// What the first run took, and a run in each round.
    first: Spent,
    samples: Vec<Spent>,
    run: Box<dyn Fn() + 'a>,
}

struct Run<V> {
    end: V,
    counts: [u64; 3],
}

impl<P: Implicit<f64, Gauss6> + 'static> Bench<P> {
    /// A program from the default parameters and the function that makes a system of parameters.
    pub fn new(
        defaults: &[f64],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + 'static,
    ) -> Self {
        Self {
            defaults: defaults.to_vec(),
            build: Box::new(build),
            entries: Vec::new(),
            clock: Clock::wall(),
        }
    }

    /// Takes a clock of the processor, which answers none where there is none.
    #[must_use]
    pub fn clock(self, processor: fn() -> Option<f64>) -> Self {
        let clock = Clock::new(processor);
        Self { clock, ..self }
    }

    /// Adds a method under the name by which requests ask for it.
    #[must_use]
    pub fn method<M: Method<f64, P> + 'static>(
        mut self,
        label: &'static str,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self {
        let make = move || -> Made<P> { Box::new(make(&Tolerances::default())) };
        self.entries.push((label, Entry::Method(Box::new(make))));
        self
    }

    /// Adds a method that chooses its own steps.
    #[must_use]
    pub fn adaptive<M: Method<f64, P> + 'static>(
        mut self,
        label: &'static str,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self {
        let make = move |tolerance| -> Made<P> {
            Box::new(make(&Tolerances {
                rtol: tolerance,
                atol: tolerance,
            }))
        };
        self.entries.push((label, Entry::Adaptive(Box::new(make))));
        self
    }

    /// Adds methods from outside.
    #[must_use]
    pub fn controls(mut self, controls: Vec<Control<P>>) -> Self {
        for control in controls {
            self.entries
                .push((control.label, Entry::Control(control.run)));
        }
        self
    }

    /// Serves the request on standard input.
    pub fn main(&self) -> ExitCode {
        main(&self.defaults, &|request, session| {
            self.work(request, session)
        })
    }

    fn work(&self, request: &Request, session: &mut Session<'_>) -> Ended {
        let (system, mu) = prepare(&*self.build, &request.parameters, &request.initial)?;
        let until = request.number("until").unwrap_or(10.0);
        let budget = request.number("budget").unwrap_or(0.2);
        session.stage(0, 1, "the reference solution")?;
        let exact = reference(&system, &mu, until).ok_or((
            2,
            "reference a number becomes infinite, or the steps too small".to_owned(),
        ))?;
        let own = exact.error / exact.mu.max_norm();
        let moved = exact.mu.as_slice().iter().zip(mu.as_slice());
        let moved = moved.fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()));
        if own.is_nan() || moved <= 4.0 * f64::EPSILON * mu.max_norm() {
            let text = format!("still the state does not move until t = {until:?}");
            return Err((2, text));
        }
        let difference = confirm(&system, &mu, until, &exact.mu);
        session.line(&[
            "reference",
            &format!("{own:?}"),
            &format!("{difference:?}"),
            &exact.evaluations.to_string(),
        ]);
        if difference > 1e-8 {
            let text = format!(
                "reference extrapolation and gauss6 differ by {difference:.1e} at t = {until:?}"
            );
            return Err((2, text));
        }
        session.line(&["clock", self.clock.name()]);
        let floor = own.max(difference).max(4.0 * f64::EPSILON);
        let mut points = Vec::new();
        let mut ended = Ok(());
        let wanted = self
            .entries
            .iter()
            .filter(|(label, entry)| {
                matches!(entry, Entry::Control(_)) || request.methods.iter().any(|m| m == label)
            })
            .collect::<Vec<_>>();
        for (index, (label, entry)) in wanted.iter().enumerate() {
            ended = session.stage(index as u64, (wanted.len() * 4) as u64, label);
            if ended.is_err() {
                break;
            }
            let ladder = Ladder {
                system: &system,
                mu: &mu,
                exact: &exact.mu,
                until,
                floor,
                budget,
                label,
                clock: &self.clock,
            };
            ladder.climb(entry, session, &mut points);
        }
        if ended.is_ok() {
            ended = time(&mut points, &self.clock, session);
        }
        for point in &points {
            point.report(until, session);
        }
        ended
    }
}

/// The relative difference of the three-stage Gauss method, at steps that are halved until it no longer
/// falls.
fn confirm<P: Implicit<f64, Gauss6>>(
    system: &P,
    mu: &P::State,
    until: f64,
    exact: &P::State,
) -> f64 {
    let mut steps = (until.abs() * rate(system, mu)).ceil().max(8.0) as u64;
    let mut best = f64::INFINITY;
    for _ in 0..14 {
        let h = until / steps as f64;
        let mut state = mu.clone();
        let newton = NewtonOptions::default();
        let mut stepper = Gauss6.any_stepper(system, h, &newton);
        if stepper.advance(&mut state, steps).is_ok() {
            let difference = relative_error(&state, exact);
            if difference > 0.5 * best && best < 1e-9 {
                break;
            }
            best = best.min(difference);
        }
        steps *= 2;
    }
    best
}

struct Ladder<'a, P: Poisson<f64>> {
    system: &'a P,
    mu: &'a P::State,
    exact: &'a P::State,
    until: f64,
    floor: f64,
    budget: f64,
    label: &'a str,
    clock: &'a Clock,
}

impl<'a, P: Poisson<f64>> Ladder<'a, P> {
    fn climb(self, entry: &'a Entry<P>, session: &mut Session<'_>, points: &mut Vec<Point<'a>>) {
        let Self {
            system, mu, until, ..
        } = self;
        match entry {
            Entry::Method(make) => {
                let first = (until.abs() * rate(system, mu) / 6.0).ceil().max(2.0) as u64;
                let steps = (0..26).map(|k| first << k);
                self.go(
                    "step",
                    steps.map(|steps| (until / steps as f64, steps)),
                    &move |(h, steps)| by_steps(system, &*make(), mu, h, steps),
                    session,
                    points,
                );
            }
            Entry::Adaptive(make) => self.go(
                "tolerance",
                tolerances(),
                &move |(tolerance, _)| by_steps(system, &*make(tolerance), mu, until, 1),
                session,
                points,
            ),
            Entry::Control(run) => self.go(
                "tolerance",
                tolerances(),
                &move |(tolerance, _)| {
                    let run = run(system, mu.as_slice(), until, tolerance)
                        .ok_or_else(|| "it gave up".to_owned())?;
                    let mut end = mu.clone();
                    end.as_mut_slice().copy_from_slice(&run.end);
                    Ok(Run {
                        end,
                        counts: [run.steps, run.evaluations, 0],
                    })
                },
                session,
                points,
            ),
        }
    }

    fn go(
        &self,
        kind: &'static str,
        values: impl Iterator<Item = (f64, u64)>,
        run: &(impl Fn((f64, u64)) -> Result<Run<P::State>, String> + Clone + 'a),
        session: &mut Session<'_>,
        points: &mut Vec<Point<'a>>,
    ) {
        let mut at_floor = 0;
        let mut best = f64::INFINITY;
        for value in values {
            let (outcome, first) = self.clock.spent(|| run(value));
            let error = match &outcome {
                Ok(run) => relative_error(&run.end, self.exact),
                Err(_) => f64::NAN,
            };
            match outcome {
                Ok(outcome) if error.is_finite() => {
                    let run = run.clone();
                    points.push(Point {
                        label: self.label,
                        kind,
                        value: value.0,
                        error,
                        counts: outcome.counts,
                        first,
                        samples: Vec::new(),
                        run: Box::new(move || {
                            // its result is known; it only has to take place
                            let _ = std::hint::black_box(run(std::hint::black_box(value)));
                        }),
                    });
                }
                Ok(_) => self.stopped(session, kind, value.0, "a number is not finite"),
                Err(why) => self.stopped(session, kind, value.0, &why),
            }
            // two points at the floor, or two that are worse than before, end the ladder
            at_floor += u32::from(error <= 3.0 * self.floor || (error > best && best < 1e-10));
            best = f64::min(best, error);
            if at_floor == 2 || first.seconds > self.budget {
                break;
            }
        }
    }

    fn stopped(&self, session: &mut Session<'_>, kind: &str, value: f64, why: &str) {
        session.line(&["stopped", self.label, kind, &format!("{value:?}"), why]);
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
            counts: [stats.accepted, stats.evaluations, stats.newton],
        }),
        Err((step, failure)) => Err(format!("step {}: {failure}", step + 1)),
    }
}

/// Times every point, round after round, so that a slow moment of the machine does not fall on one
/// method alone.
fn time(points: &mut [Point<'_>], clock: &Clock, session: &mut Session<'_>) -> Ended {
    let all = (points.len() * ROUNDS) as u64;
    let mut done = 0;
    session.stage(all / 3, all, "times")?;
    for _ in 0..ROUNDS {
        for point in &mut *points {
            session.progress(all / 3 + done * 2 / 3, all)?;
            done += 1;
            let times = (SAMPLE / point.first.seconds).ceil().clamp(1.0, 1e5) as u32;
            let ((), spent) = clock.spent(|| (0..times).for_each(|_| (point.run)()));
            point.samples.push(spent.over(f64::from(times)));
        }
    }
    Ok(())
}

impl Point<'_> {
    fn report(&self, until: f64, session: &mut Session<'_>) {
        let [least, median, wall] = summary(&self.samples, self.first);
        let [steps, evaluations, newton] = self.counts;
        session.line(&[
            "point",
            self.label,
            self.kind,
            &format!("{:?}", self.value),
            &format!("{:?}", self.error),
            &format!("{:?}", least / until.abs()),
            &format!("{:?}", median / until.abs()),
            &format!("{:?}", wall / until.abs()),
            &steps.to_string(),
            &evaluations.to_string(),
            &newton.to_string(),
        ]);
    }
}
