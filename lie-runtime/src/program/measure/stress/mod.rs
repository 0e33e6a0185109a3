//! The program behind `lie stress`: each method at the limits of steps, parameters and states, and over a long
//! run.
//!
//! Further keys: `steps` (of the long run), `only` (a bit for each experiment). Lines:
//!
//! | line | |
//! |---|---|
//! | `ground <step> <cells in all>` | the step h0 at which h0 times the largest rate of the field is 0.2 |
//! | `growth <label> <invariant> <exponent> <standard error> <end> <largest> <from> <to> <states> <step> <bound ratio>` | how the round-off of the claimed invariant that moves most grows with the steps, see `growth.rs` |
//! | `cell <label> <experiment> <name> <value> <step> <outcome> <steps> <newton> <energy> <growth> <casimirs> <growth> <orbit bound ratio> <what>` | see below |
//!
//! Drifts are relative to the size of the terms; `claimed` is the largest drift of a claimed invariant over its round-off
//! bound. The outcome is `kept`, `lost` (a claimed invariant beyond its bound, with no message), `stopped` (with the
//! step and the reason) or `domain` (H or the field is not finite there: nothing to integrate).

mod growth;
mod outcome;

use super::super::{Build, Tolerances};
use super::{Ended, Request, Session, main, prepare};
use crate::diagnostics::AnyMethod;
use crate::diagnostics::verify::rate;
use crate::methods::Method;
use crate::parameter::ParameterError;
use crate::poisson::Poisson;
use crate::state::{State, Unknown};
use growth::growth;
use outcome::{Outcome, bound, run};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// `h0` times the rate.
const REACH: f64 = 0.2;
/// The long run has so many times the steps of each state that is followed for the growth of round-off: both take
/// about as long.
const SHARE: u64 = growth::STATES as u64;
/// Steps of a cell other than the long run.
const STEPS: u64 = 400;

type Made<P> = Box<dyn AnyMethod<f64, P>>;
type SharedBuild<P> = dyn Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync;
type Make<P> = Box<dyn Fn() -> Made<P> + Send + Sync>;

/// A program that takes methods to their limits.
pub struct Stress<P: Poisson<f64>> {
    defaults: Vec<f64>,
    build: Box<SharedBuild<P>>,
    methods: Vec<(&'static str, Make<P>)>,
}

/// A state, parameters and a step.
#[derive(Clone)]
struct Cell {
    experiment: &'static str,
    name: String,
    value: f64,
    parameters: Vec<f64>,
    mu: Vec<f64>,
    /// None: 0.2 over the rate there.
    step: Option<f64>,
    steps: u64,
}

/// What is done with a method.
enum Task<'a> {
    Cell(&'a Cell),
    /// With so many steps.
    Growth(u64),
}

/// What all tasks share.
struct Start<'a> {
    parameters: &'a [f64],
    mu: &'a [f64],
    step: f64,
}

impl<P: Poisson<f64> + Sync> Stress<P> {
    /// A program from the default parameters and the function that makes a system of parameters.
    pub fn new(
        defaults: &[f64],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync + 'static,
    ) -> Self {
        Self {
            defaults: defaults.to_vec(),
            build: Box::new(build),
            methods: Vec::new(),
        }
    }

    /// Adds a method under the name by which requests ask for it.
    #[must_use]
    pub fn method<M: Method<f64, P> + 'static>(
        mut self,
        label: &'static str,
        make: impl Fn(&Tolerances) -> M + Send + Sync + 'static,
    ) -> Self {
        let make = move || -> Made<P> { Box::new(make(&Tolerances::default())) };
        self.methods.push((label, Box::new(make)));
        self
    }

    /// Adds a method that chooses its own steps.
    #[must_use]
    pub fn adaptive<M: Method<f64, P> + 'static>(
        self,
        label: &'static str,
        make: impl Fn(&Tolerances) -> M + Send + Sync + 'static,
    ) -> Self {
        self.method(label, make)
    }

    /// Serves the request on standard input.
    pub fn main(&self) -> ExitCode {
        main(&self.defaults, &|request, session| {
            self.work(request, session)
        })
    }

    fn work(&self, request: &Request, session: &mut Session<'_>) -> Ended {
        let build: &Build<P> = &*self.build;
        let (system, mu) = prepare(build, &request.parameters, &request.initial)?;
        let steps = request.number("steps").unwrap_or(1e7) as u64;
        let step = REACH / rate(&system, &mu);
        if !(step.is_finite() && step > 0.0) {
            return Err((
                2,
                "ground the Jacobian of the vector field is zero or not finite".into(),
            ));
        }
        let cells = self.cells(&system, request, &mu, step, steps);
        // what takes longest comes first: the long run, then growth
        let growth = Task::Growth(steps / SHARE);
        let mut tasks: Vec<Task<'_>> = cells.iter().map(Task::Cell).collect();
        tasks.insert(1, growth);
        let jobs: Vec<(&str, &Make<P>, &Task<'_>)> = tasks
            .iter()
            .flat_map(|task| {
                let wanted = self
                    .methods
                    .iter()
                    .filter(|(label, _)| request.methods.iter().any(|m| m == label));
                wanted.map(move |(label, make)| (*label, make, task))
            })
            .collect();
        session.line(&["ground", &format!("{step:?}"), &jobs.len().to_string()]);
        session.stage(0, jobs.len() as u64, "experiments")?;
        let start = Start {
            parameters: &request.parameters,
            mu: mu.as_slice(),
            step,
        };
        self.all(&jobs, &start, session)
    }

    /// All tasks, on as many threads as the machine has, reported in the order in which they end.
    fn all(
        &self,
        jobs: &[(&str, &Make<P>, &Task<'_>)],
        start: &Start<'_>,
        session: &mut Session<'_>,
    ) -> Ended {
        let next = AtomicUsize::new(0);
        let done = AtomicUsize::new(0);
        let stop = std::sync::atomic::AtomicBool::new(false);
        let lines: Mutex<Vec<Vec<String>>> = Mutex::new(Vec::new());
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let taken = || {
            lines
                .lock()
                .map_or_else(|_| Vec::new(), |mut lines| core::mem::take(&mut *lines))
        };
        std::thread::scope(|scope| {
            for _ in 0..threads.min(jobs.len()) {
                scope.spawn(|| {
                    loop {
                        let index = next.fetch_add(1, Ordering::Relaxed);
                        let Some((label, make, task)) = jobs.get(index) else {
                            break;
                        };
                        let line = match task {
                            Task::Cell(cell) => self.cell(label, &*make(), cell, &stop),
                            Task::Growth(steps) => {
                                self.growth(label, &*make(), start, *steps, &stop)
                            }
                        };
                        if stop.load(Ordering::Relaxed) {
                            break;
                        }
                        if let Ok(mut lines) = lines.lock() {
                            lines.push(line);
                        }
                        done.fetch_add(1, Ordering::Relaxed);
                    }
                });
            }
            let mut ended = Ok(());
            loop {
                // before the lines are taken: what is done by now is among them
                let finished = done.load(Ordering::Relaxed);
                for line in taken() {
                    session.line(&line.iter().map(String::as_str).collect::<Vec<_>>());
                }
                if finished == jobs.len() {
                    return ended;
                }
                ended = session.progress(finished as u64, jobs.len() as u64);
                if ended.is_err() {
                    stop.store(true, Ordering::Relaxed);
                    return ended;
                }
                std::thread::sleep(std::time::Duration::from_millis(20));
            }
        })
    }

    fn cells(
        &self,
        system: &P,
        request: &Request,
        mu: &P::State,
        step: f64,
        steps: u64,
    ) -> Vec<Cell> {
        let plain = Cell {
            experiment: "step",
            name: "h/h0".to_owned(),
            value: 1.0,
            parameters: request.parameters.clone(),
            mu: mu.as_slice().to_vec(),
            step: Some(step),
            steps: STEPS,
        };
        let mut cells = Vec::new();
        // the long run first: it takes longest
        cells.push(Cell {
            experiment: "long",
            name: "steps".to_owned(),
            value: steps as f64,
            steps,
            ..plain.clone()
        });
        for exponent in [-12, -9, -6, -4, -3, -2, -1, 0, 1, 2, 3, 4, 6, 8] {
            // powers of ten up to the step of the system's own time, then of two
            let factor = if exponent <= 0 {
                10_f64.powi(exponent)
            } else {
                2_f64.powi(exponent)
            };
            cells.push(Cell {
                value: factor,
                step: Some(factor * step),
                ..plain.clone()
            });
        }
        for index in 0..request.parameters.len() {
            for exponent in 1..=6 {
                let factor = 10_f64.powi(exponent);
                let mut parameters = request.parameters.clone();
                parameters[index] *= factor;
                cells.push(Cell {
                    experiment: "parameter",
                    name: index.to_string(),
                    value: factor,
                    parameters,
                    ..plain.clone()
                });
            }
        }
        for exponent in [-100, -50, -20, -10, -5, -2, 2, 5, 10, 20, 50, 100] {
            let factor = 10_f64.powi(exponent);
            cells.push(Cell {
                experiment: "scale",
                name: "state".to_owned(),
                value: factor,
                mu: mu.as_slice().iter().map(|x| x * factor).collect(),
                step: None,
                ..plain.clone()
            });
        }
        for index in 0..system.dimension() {
            for factor in [1e-8, 0.0] {
                let mut mu = mu.as_slice().to_vec();
                mu[index] *= factor;
                cells.push(Cell {
                    experiment: "component",
                    name: system.coordinate(index).to_owned(),
                    value: factor,
                    mu,
                    step: None,
                    ..plain.clone()
                });
            }
        }
        for index in 0..system.casimir_count() {
            for factor in [1e-4, 1e-12, 0.0] {
                let moved = towards_zero(system, mu, index, factor);
                cells.extend(moved.map(|mu| Cell {
                    experiment: "casimir",
                    name: system.casimir_name(index).to_owned(),
                    value: factor,
                    mu,
                    step: None,
                    ..plain.clone()
                }));
            }
        }
        cells
    }

    fn growth(
        &self,
        label: &str,
        method: &dyn AnyMethod<f64, P>,
        start: &Start<'_>,
        steps: u64,
        stop: &std::sync::atomic::AtomicBool,
    ) -> Vec<String> {
        let mut line = vec!["growth".to_owned(), label.to_owned()];
        let Ok(system) = (self.build)(start.parameters) else {
            return line;
        };
        let found = {
            let mut mu = system.zero_state();
            mu.as_mut_slice().copy_from_slice(start.mu);
            growth(&system, method, &mu, start.step, steps, stop)
        };
        let Some(found) = found else { return line };
        let casimir = found.invariant.checked_sub(1);
        line.push(
            casimir
                .map_or("energy", |index| system.casimir_name(index))
                .to_owned(),
        );
        let (exponent, error) = found.exponent;
        let (end, largest) = found.end;
        line.extend([exponent, error, end, largest].map(|value| format!("{value:?}")));
        let (from, to) = found.steps;
        line.extend([from, to, found.states as u64].map(|count| count.to_string()));
        let ratio = largest / bound(to, false);
        line.extend([start.step, ratio].map(|value| format!("{value:?}")));
        line
    }

    fn cell(
        &self,
        label: &str,
        method: &dyn AnyMethod<f64, P>,
        cell: &Cell,
        stop: &std::sync::atomic::AtomicBool,
    ) -> Vec<String> {
        let mut line = vec![
            "cell".to_owned(),
            label.to_owned(),
            cell.experiment.to_owned(),
        ];
        line.extend([cell.name.clone(), format!("{:?}", cell.value)]);
        let outcome = match (self.build)(&cell.parameters) {
            Err(error) => Outcome::domain(&error.to_string()),
            Ok(system) => run(&system, method, cell, stop),
        };
        line.extend(outcome.fields());
        line
    }
}

/// The state nearest to mu, about, at which a Casimir is so much smaller: along its gradient.
fn towards_zero<P: Poisson<f64>>(
    system: &P,
    mu: &P::State,
    index: usize,
    factor: f64,
) -> Option<Vec<f64>> {
    let mut values = vec![0.0; system.casimir_count()];
    system.casimirs(mu, &mut values);
    let goal = factor * values[index];
    let mut state = mu.clone();
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
    let moves = state.max_norm() > 1e-30 * mu.max_norm();
    (state.finite() && moves).then(|| state.as_slice().to_vec())
}
