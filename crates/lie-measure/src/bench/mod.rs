//! The program behind `lie bench`: the error at the end of a run against the time that it takes.

mod found;
mod ladder;
mod measure;
mod timing;

pub use found::{Accuracy, ClockKind, Found, Point, Reference};
pub use measure::{Measure, Plane};

use crate::facts::{rate, relative_error};
use ladder::Ladder;
use lie_program::Tolerances;
use lie_program::blueprint::{Blueprint, Built};
use lie_program::protocol::{End, Obstacle, number};
use lie_program::session::Session;
use lie_runtime::diagnostics::{AnyMethod, reference};
use lie_runtime::methods::Method;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{ParameterError, Poisson, State, Unknown};
use measure::{Judge, NoSection};
use serde::{Deserialize, Serialize};
use std::process::ExitCode;
use timing::Clock;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// The end of the runs.
    #[serde(with = "number")]
    pub until: f64,
    /// Seconds that one run may take.
    #[serde(with = "number")]
    pub budget: f64,
    /// The error that is set against the time.
    pub measure: Measure,
}

talk!(Options, Found);

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

/// Takes the times and states of a run after every step.
pub type Watch<'a> = &'a mut dyn FnMut(f64, &[f64]);

type RunControl<P> = Box<dyn Fn(&P, &[f64], f64, f64, Option<Watch<'_>>) -> Option<ControlRun>>;

/// An adaptive method from outside the catalogue, to compare with.
pub struct Control<P> {
    /// Its name.
    pub label: &'static str,
    /// A run from a state at time 0 to a time with both tolerances alike, which may be watched; none if it fails.
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
    blueprint: Blueprint<P>,
    entries: Vec<(String, Entry<P>)>,
    clock: Clock,
    confirming: Made<P>,
}

impl<P: Poisson<f64> + 'static> Bench<P> {
    /// A program from the parameters with their defaults, the function that makes a system of their values, and the method
    /// that confirms the reference solution.
    pub fn new<M: Method<f64, P> + 'static>(
        parameters: &[(&str, f64)],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync + 'static,
        confirming: M,
    ) -> Self {
        Self::with_any(parameters, build, Box::new(confirming))
    }

    /// The same with a method whose type is forgotten.
    pub fn with_any(
        parameters: &[(&str, f64)],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync + 'static,
        confirming: Box<dyn AnyMethod<f64, P>>,
    ) -> Self {
        Self {
            blueprint: Blueprint::new(parameters, build),
            entries: Vec::new(),
            clock: Clock::wall(),
            confirming,
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
        self,
        label: &str,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self {
        self.any_method(label, move || Box::new(make(&Tolerances::default())))
    }

    /// Adds a method whose type is forgotten.
    #[must_use]
    pub fn any_method(
        mut self,
        label: &str,
        make: impl Fn() -> Box<dyn AnyMethod<f64, P>> + 'static,
    ) -> Self {
        let entry = Entry::Method(Box::new(make));
        self.entries.push((label.to_owned(), entry));
        self
    }

    /// Adds a method that chooses its own steps.
    #[must_use]
    pub fn adaptive<M: Method<f64, P> + 'static>(
        self,
        label: &str,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self {
        self.any_adaptive(label, move |tolerances| Box::new(make(tolerances)))
    }

    /// Adds a method that chooses its own steps, whose type is forgotten.
    #[must_use]
    pub fn any_adaptive(
        mut self,
        label: &str,
        make: impl Fn(&Tolerances) -> Box<dyn AnyMethod<f64, P>> + 'static,
    ) -> Self {
        let make = move |tolerance| make(&Tolerances::both(tolerance));
        let entry = Entry::Adaptive(Box::new(make));
        self.entries.push((label.to_owned(), entry));
        self
    }

    /// Adds methods from outside.
    #[must_use]
    pub fn controls(mut self, controls: Vec<Control<P>>) -> Self {
        for control in controls {
            self.entries
                .push((control.label.to_owned(), Entry::Control(control.run)));
        }
        self
    }

    /// Serves the request on standard input.
    pub fn main(&self) -> ExitCode {
        main(&|request, session| self.work(&request, session))
    }

    /// Does what is asked for.
    ///
    /// # Errors
    /// Why not everything was measured.
    pub fn work(
        &self,
        request: &crate::Request<Options>,
        session: &mut Session<'_, Found>,
    ) -> Result<(), End> {
        let Built { system, mu } = self.blueprint.build(&request.start)?;
        let Options { until, budget, .. } = request.options;
        let (judge, floor) = judge(&system, &mu, &request.options, &*self.confirming, session)?;
        session.found(Found::Clock(self.clock.kind()));
        let asked_for = |(label, entry): &&(String, Entry<P>)| {
            matches!(entry, Entry::Control(_)) || request.methods.iter().any(|m| m == label)
        };
        let wanted: Vec<_> = self.entries.iter().filter(asked_for).collect();
        let stop = session.interruption();
        let mut rungs = Vec::new();
        for (index, (label, entry)) in wanted.iter().enumerate() {
            let ladder = Ladder {
                system: &system,
                mu: &mu,
                judge: &judge,
                until,
                floor,
                budget,
                label,
                clock: &self.clock,
                stop: &stop,
                before: (index as u64, (wanted.len() * 4) as u64),
            };
            ladder.climb(entry, session, &mut rungs)?;
            let method = label.clone();
            session.found(Found::Climbed { method });
        }
        ladder::time(&mut rungs, until, &self.clock, session)
    }
}

/// What runs are compared with, and the least error that says something.
fn judge<P: Poisson<f64>>(
    system: &P,
    mu: &P::State,
    options: &Options,
    confirming: &dyn AnyMethod<f64, P>,
    session: &mut Session<'_, Found>,
) -> Result<(Judge<P::State>, f64), End> {
    let Options { until, measure, .. } = *options;
    if let Measure::Energy | Measure::Casimirs = measure {
        let mut field = system.zero_state();
        system.vector_field(mu, &mut field);
        if field.max_norm() * until.abs() <= 4.0 * f64::EPSILON * mu.max_norm() {
            let why = format!("the state does not move until t = {until:?}");
            return Err(End::refused(Obstacle::Still, why));
        }
        let judge = Judge::drift(system, mu, measure == Measure::Casimirs);
        return Ok((judge, ROUND_OFF));
    }
    session.stage(0, 1, "the reference solution")?;
    let (exact, floor) = confirmed(system, mu, options, confirming, session)?;
    let rate = rate(system, mu);
    let judge = match measure {
        Measure::Phase => Judge::Phase { exact, rate },
        Measure::Section(plane) => {
            let section = measure::Section::new(system, mu, until, plane, rate);
            let section = section.map_err(|why| no_section(system, until, &why))?;
            session.found(Found::Section {
                plane: section.plane(),
                passages: section.passages() as u64,
            });
            Judge::Section(section)
        }
        _ => Judge::State(exact),
    };
    Ok((judge, floor))
}

fn no_section<P: Poisson<f64>>(system: &P, until: f64, why: &NoSection) -> End {
    let why = match why {
        NoSection::NotPassed(place, value, (low, high)) => {
            let name = system.coordinate(*place);
            format!(
                "{name} does not pass {value:?} upward until t = {until:?}: it goes from {low:.3e} to {high:.3e}"
            )
        }
        NoSection::Unreachable => {
            format!("its passages until t = {until:?} cannot be computed")
        }
    };
    End::refused(Obstacle::Section, why)
}

/// Relative errors below this are round-off.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// The error of a measure that a relative error of the state at the end amounts to.
fn in_measure<P: Poisson<f64>>(system: &P, end: &P::State, relative: f64, measure: Measure) -> f64 {
    if measure != Measure::Phase {
        return relative;
    }
    let mut field = end.clone();
    system.vector_field(end, &mut field);
    relative * end.max_norm() / field.max_norm()
}

/// The reference solution, which is told of, with the least error that is told from 0.
fn confirmed<P: Poisson<f64>>(
    system: &P,
    mu: &P::State,
    &Options { until, measure, .. }: &Options,
    confirming: &dyn AnyMethod<f64, P>,
    session: &mut Session<'_, Found>,
) -> Result<(P::State, f64), End> {
    let exact = reference(system, mu, until).ok_or_else(|| {
        let why = "a number becomes infinite, or the steps too small";
        End::refused(Obstacle::Reference, why)
    })?;
    let error = exact.error / exact.mu.max_norm();
    let moved = exact.mu.as_slice().iter().zip(mu.as_slice());
    let moved = moved.fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()));
    if error.is_nan() || moved <= 4.0 * f64::EPSILON * mu.max_norm() {
        let why = format!("the state does not move until t = {until:?}");
        return Err(End::refused(Obstacle::Still, why));
    }
    let difference = confirm(system, mu, until, &exact.mu, confirming);
    let relative = error.max(difference).max(ROUND_OFF);
    let floor = in_measure(system, &exact.mu, relative, measure);
    session.found(Found::Reference(Reference {
        error,
        difference,
        floor,
    }));
    if difference > 1e-8 {
        let why = format!(
            "extrapolation and Gauss collocation differ by {difference:.1e} at t = {until:?}"
        );
        return Err(End::refused(Obstacle::Reference, why));
    }
    Ok((exact.mu, floor))
}

/// The relative difference of a second method, at steps that are halved until it no longer
/// falls.
fn confirm<P: Poisson<f64>>(
    system: &P,
    mu: &P::State,
    until: f64,
    exact: &P::State,
    confirming: &dyn AnyMethod<f64, P>,
) -> f64 {
    let mut steps = (until.abs() * rate(system, mu)).ceil().max(8.0) as u64;
    let mut best = f64::INFINITY;
    for _ in 0..14 {
        let h = until / steps as f64;
        let mut state = mu.clone();
        let newton = NewtonOptions::default();
        let mut stepper = confirming.any_stepper(system, h, &newton);
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
