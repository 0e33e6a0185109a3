//! The program behind `lie stress`: each method at the limits of steps, parameters and states, and over a long
//! run.
//!
//! Drifts are relative to the size of the terms.

mod found;
mod growth;
mod outcome;
mod trials;

pub use found::{Cell, Experiment, Found, Growth, Moved, Outcome};

use crate::facts::rate;
use lie_program::Tolerances;
use lie_program::blueprint::{Blueprint, Built};
use lie_program::protocol::{End, Obstacle};
use lie_program::session::Session;
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::methods::Method;
use lie_runtime::{ParameterError, Poisson, State};
use serde::{Deserialize, Serialize};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use trials::Trial;

/// `h0` times the rate.
const REACH: f64 = 0.2;
/// Round-off is measured at this step, and at the first of [`LARGE`] at which states come to the end: a bias grows with the
/// step.
const USUAL: &[f64] = &[1.0];
const LARGE: &[f64] = &[8.0, 4.0, 2.0];
/// The long run has so many times the steps of each state that is followed for the growth of round-off: both take
/// about as long.
const SHARE: u64 = growth::STATES as u64;

type Made<P> = Box<dyn AnyMethod<f64, P>>;
type Make<P> = Box<dyn Fn() -> Made<P> + Send + Sync>;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// Steps of the long run.
    pub steps: u64,
}

talk!(Options, Found);

/// A program that takes methods to their limits.
pub struct Stress<P: Poisson<f64>> {
    blueprint: Blueprint<P>,
    methods: Vec<(String, Make<P>)>,
    /// Parameters that keep their values.
    left: Vec<String>,
}

/// What is done with a method.
enum Task {
    Trial(Trial),
    /// Follows the growth of round-off from a start for so many steps, with the first of these steps that goes.
    Growth {
        parameters: Vec<f64>,
        mu: Vec<f64>,
        h: Vec<f64>,
        steps: u64,
    },
}

/// A task with a method.
struct Job<'a, P> {
    label: &'a str,
    make: &'a Make<P>,
    task: &'a Task,
}

impl<P: Poisson<f64> + Sync> Stress<P> {
    /// A program from the parameters with their defaults and the function that makes a system of their values.
    pub fn new(
        parameters: &[(&str, f64)],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync + 'static,
    ) -> Self {
        Self {
            blueprint: Blueprint::new(parameters, build),
            methods: Vec::new(),
            left: Vec::new(),
        }
    }

    /// Leaves these parameters as they are, such as those that say how many coordinates there are.
    #[must_use]
    pub fn leaving(mut self, parameters: &[String]) -> Self {
        self.left.extend_from_slice(parameters);
        self
    }

    /// Adds a method under the name by which requests ask for it.
    #[must_use]
    pub fn method<M: Method<f64, P> + 'static>(
        mut self,
        label: &str,
        make: impl Fn(&Tolerances) -> M + Send + Sync + 'static,
    ) -> Self {
        let make = move || -> Made<P> { Box::new(make(&Tolerances::default())) };
        self.methods.push((label.to_owned(), Box::new(make)));
        self
    }

    /// Adds a method whose type is forgotten.
    #[must_use]
    pub fn any_method(
        mut self,
        label: &str,
        make: impl Fn() -> Box<dyn AnyMethod<f64, P>> + Send + Sync + 'static,
    ) -> Self {
        self.methods.push((label.to_owned(), Box::new(make)));
        self
    }

    /// Adds a method that chooses its own steps.
    #[must_use]
    pub fn adaptive<M: Method<f64, P> + 'static>(
        self,
        label: &str,
        make: impl Fn(&Tolerances) -> M + Send + Sync + 'static,
    ) -> Self {
        self.method(label, make)
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
        let long = request.options.steps;
        let step = REACH / rate(&system, &mu);
        if !(step.is_finite() && step > 0.0) {
            let why = "the Jacobian of the vector field is zero or not finite";
            return Err(End::refused(Obstacle::Ground, why));
        }
        let trials = self.trials(&system, &request.start, step, long)?;
        let mut tasks: Vec<Task> = trials.into_iter().map(Task::Trial).collect();
        for factors in [USUAL, LARGE] {
            tasks.push(Task::Growth {
                parameters: self.blueprint.values(&request.start)?,
                mu: request.start.initial.clone(),
                h: factors.iter().map(|factor| factor * step).collect(),
                steps: long / SHARE,
            });
        }
        let wanted = |label: &str| request.methods.iter().any(|method| method == label);
        let jobs: Vec<Job<'_, P>> = tasks
            .iter()
            .flat_map(|task| {
                let methods = self.methods.iter().filter(|(label, _)| wanted(label));
                methods.map(move |(label, make)| Job { label, make, task })
            })
            .collect();
        session.found(Found::Ground { step });
        session.stage(0, jobs.len() as u64, "experiments")?;
        self.all(&jobs, session)
    }

    /// All jobs, on as many threads as the machine has, reported in the order in which they end.
    fn all(&self, jobs: &[Job<'_, P>], session: &mut Session<'_, Found>) -> Result<(), End> {
        let next = AtomicUsize::new(0);
        let done = AtomicUsize::new(0);
        let stop = AtomicBool::new(false);
        let found: Mutex<Vec<Found>> = Mutex::new(Vec::new());
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let work = || {
            while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                let outcome = self.job(job, &stop);
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                if let Ok(mut found) = found.lock() {
                    found.extend(outcome);
                }
                done.fetch_add(1, Ordering::Relaxed);
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..threads.min(jobs.len()) {
                scope.spawn(work);
            }
            loop {
                // before the findings are taken: what is done by now is among them
                let finished = done.load(Ordering::Relaxed);
                let taken = found.lock().map(|mut found| core::mem::take(&mut *found));
                for found in taken.unwrap_or_default() {
                    session.found(found);
                }
                if finished == jobs.len() {
                    return Ok(());
                }
                if let Err(end) = session.progress(finished as u64, jobs.len() as u64) {
                    stop.store(true, Ordering::Relaxed);
                    return Err(end);
                }
                std::thread::sleep(std::time::Duration::from_millis(20));
            }
        })
    }

    fn job(&self, job: &Job<'_, P>, stop: &AtomicBool) -> Option<Found> {
        let method = &*(job.make)();
        let label = job.label.to_owned();
        match job.task {
            Task::Trial(trial) => Some(Found::Cell(match self.blueprint.make(&trial.parameters) {
                Err(error) => outcome::domain(label, trial, &error.to_string()),
                Ok(system) => outcome::run(&system, method, label, trial, stop),
            })),
            Task::Growth {
                parameters,
                mu,
                h,
                steps,
            } => {
                let system = self.blueprint.make(parameters).ok()?;
                let mut start = system.zero_state();
                start.as_mut_slice().copy_from_slice(mu);
                h.iter().find_map(|&h| {
                    let found = growth::growth(&system, method, &start, h, *steps, stop)?;
                    Some(Found::Growth(found.named(label.clone(), &system, h)))
                })
            }
        }
    }
}
