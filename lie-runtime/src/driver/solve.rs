//! The loop over the grid.

use super::assess::assess;
use super::error::{SolveError, StepError};
use super::grid::{Grid, Place, Rows};
use super::observer::{Observer, Progress, Recorder, Shown};
use super::options::{OptionError, Options, Save};
use super::pace::{Settled, settle};
use super::problem::Problem;
use super::solution::Solution;
use super::stats::{Stats, Status};
use super::watch::{Guard, MOST_SLOW, SLOW_PARTS, divided};
use crate::methods::{Method, StepFailure, StepReport, Stepper};
use crate::newton::{FailureReason, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};
use core::iter::Peekable;
use thiserror::Error;

/// A run without a recorder that could not start or failed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IntegrateError {
    /// The options are invalid.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// A step failed.
    #[error(transparent)]
    Step(#[from] Box<StepError>),
}

/// Integrates a problem and returns what was saved.
///
/// # Errors
/// [`SolveError::Option`] for invalid options; [`SolveError::Step`], which carries what
/// was saved before, if a step fails.
///
/// ```
/// use lie_runtime::prelude::*;
/// # include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/systems/rigid_body.rs"));
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let problem = Problem::new(RigidBody::<f64>::default(), [0.8, 0.1, 0.6], (0.0, 10.0));
/// let options = Options::new(0.1).save(Save::Ends);
/// let solution = solve(&problem, LieMidpoint::exp(), &options)?;
/// assert_eq!(solution.t, [0.0, 10.0]);
/// assert!(solution.drift().casimirs[0].max < 1e-14);
/// # Ok(())
/// # }
/// ```
pub fn solve<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &Problem<S, P>,
    method: M,
    options: &Options,
) -> Result<Solution<S, P::State>, SolveError<S, P::State>> {
    solve_observed(problem, method, options, ())
}

/// [`solve`] with an observer.
///
/// # Errors
/// As [`solve`].
pub fn solve_observed<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &Problem<S, P>,
    method: M,
    options: &Options,
    observer: impl Observer<S, P>,
) -> Result<Solution<S, P::State>, SolveError<S, P::State>> {
    let mut observers = (Recorder::new(&problem.system), observer);
    let outcome = integrate(problem, method, options, &mut observers);
    let mut solution = observers.0.solution;
    match outcome {
        Ok((stats, status)) => {
            solution.stats = stats;
            solution.status = status;
            Ok(solution)
        }
        Err(IntegrateError::Option(error)) => Err(SolveError::Option(error)),
        Err(IntegrateError::Step(error)) => {
            solution.stats = error.stats;
            solution.status = Status::Failed;
            Err(SolveError::Step {
                error,
                solution: Box::new(solution),
            })
        }
    }
}

/// Integrates a problem and shows every step and every saved state to an observer.
///
/// The trajectory goes along the grid `t0 + k h`. A saved time between two grid points is reached
/// by one shorter step from the grid point before it; the run then goes on from that grid point.
///
/// # Errors
/// [`IntegrateError::Option`] for invalid options, [`IntegrateError::Step`] if a step
/// fails or the system is not finite at the start.
pub fn integrate<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &Problem<S, P>,
    method: M,
    options: &Options,
    observer: &mut impl Observer<S, P>,
) -> Result<(Stats, Status), IntegrateError> {
    let (mut step, mut settled) = settle(problem, &method, options)?;
    let mut assessed = None;
    if let (Some(first), true) = (&settled, options.assess) {
        let (steps, found) = assess(problem, &method, options, &first.chosen)?;
        assessed = Some(found);
        step = steps;
        if let Some(settled) = &mut settled {
            settled.chosen.step = step;
        }
    }
    if let Some(settled) = &settled {
        observer.chosen(&settled.chosen);
    }
    let grid = Grid::new(problem.span, step)?;
    let divides = settled.is_some() && Course::<M>::may_divide::<S, P>();
    let newton = settled
        .as_ref()
        .map_or(options.newton, |settled| settled.newton(step));
    let mut course = Course::new(&grid, &method, newton, step).dividing(divides);
    let guard = settled.and_then(Settled::guard);
    let (system, mu) = (&problem.system, problem.mu0.clone());
    let (_, status) = course.run(system, mu, guard, &options.save, observer)?;
    if let Some(assessed) = &assessed {
        observer.assessed(assessed);
    }
    Ok((course.stats, status))
}

/// Why a stepper was left.
enum Left<P> {
    /// The run is at its end, or was ended.
    Over(Status),
    /// The system has another branch.
    Branch(P),
    /// Steps have another size.
    Divided,
}

/// How far a run has come.
pub(super) struct Course<'r, M> {
    grid: &'r Grid,
    method: &'r M,
    newton: NewtonOptions,
    stats: Stats,
    /// Steps done.
    index: u64,
    /// The step of the grid.
    step: f64,
    /// In so many parts each is made.
    parts: u32,
    /// Parts done of the step that is being made.
    done: u32,
    /// Whether a step may be divided.
    divides: bool,
    /// Jacobians that were factored, and steps since the last division for which some were.
    slow: (u64, u32),
}

impl<'r, M> Course<'r, M> {
    /// Whether steps of a method may be divided: of one trajectory, and those that it does not choose itself.
    pub(super) fn may_divide<S: Scalar, P: Poisson<S>>() -> bool
    where
        M: Method<S, P>,
    {
        !M::OWN_STEPS && S::LANES == 1
    }

    /// In how many parts the last steps were made.
    pub(super) fn parts(&self) -> u32 {
        self.parts
    }

    /// Divides steps where need be.
    pub(super) fn dividing(mut self, divides: bool) -> Self {
        self.divides = divides;
        self
    }

    /// At the start of a grid, with its whole steps.
    pub(super) fn new(grid: &'r Grid, method: &'r M, newton: NewtonOptions, step: f64) -> Self {
        Self {
            grid,
            method,
            newton,
            stats: Stats::default(),
            index: 0,
            step,
            parts: 1,
            done: 0,
            divides: false,
            slow: (0, 0),
        }
    }

    /// Goes along the grid; the state at its end.
    pub(super) fn run<S: Scalar, P: Poisson<S>>(
        &mut self,
        system: &P,
        mut mu: P::State,
        mut guard: Option<Guard<'_, S, P, M>>,
        save: &Save,
        observer: &mut impl Observer<S, P>,
    ) -> Result<(P::State, Status), IntegrateError>
    where
        M: Method<S, P>,
    {
        let mut rows = self.grid.rows(save)?.peekable();
        let mut between = mu.clone();
        let first = system;
        let mut followed = system.following(&mu);
        let system = followed.as_ref().unwrap_or(first);
        check_start(system, &mu).map_err(|failure| self.failed(failure))?;
        observer.start(system, self.progress(), &mu);
        // once, and again with each branch of the system that has to be followed, and each size of steps
        loop {
            let system = followed.as_ref().unwrap_or(first);
            let mut states = (&mut mu, &mut between);
            match self.go(system, &mut states, &mut rows, &mut guard, observer)? {
                Left::Over(status) => return Ok((mu, status)),
                Left::Branch(next) => followed = Some(next),
                Left::Divided => {}
            }
        }
    }

    /// Goes on with one system and one size of steps.
    #[inline(always)]
    fn go<S: Scalar, P: Poisson<S>, O: Observer<S, P>>(
        &mut self,
        system: &P,
        (mu, between): &mut (&mut P::State, &mut P::State),
        rows: &mut Peekable<Rows<'_>>,
        guard: &mut Option<Guard<'_, S, P, M>>,
        observer: &mut O,
    ) -> Result<Left<P>, IntegrateError>
    where
        M: Method<S, P>,
    {
        let size = S::from_f64(self.step / f64::from(self.parts));
        let mut stepper = self.method.stepper(system, size, &self.newton);
        loop {
            while let Some(row) =
                rows.next_if(|row| row.place.index() == self.index && self.done == 0)
            {
                let looked = match row.place {
                    Place::On(_) => observer.row(system, row.time, mu),
                    Place::After(_, rest) => {
                        between.copy_from(mu);
                        self.off_grid(system, rest, mu, between, observer)?;
                        let looked = observer.row(system, row.time, between);
                        observer.return_to_grid();
                        looked
                    }
                };
                if looked.is_break() {
                    return Ok(Left::Over(Status::Stopped));
                }
            }
            if self.index == self.grid.steps() {
                return Ok(Left::Over(Status::Finished));
            }
            let watched = self.done == 0 && guard.as_mut().is_some_and(|guard| guard.begins(mu));
            while self.done < self.parts {
                match stepper.step(mu, &mut Shown::to(observer, system)) {
                    Ok(report) => self.arrived(system, mu, report)?,
                    Err(failure) => return self.divided(system, failure, mu),
                }
                self.done += 1;
                if M::FIXED_POINT && self.divides && self.is_slow() {
                    return Ok(Left::Divided);
                }
            }
            self.done = 0;
            if let Some(guard) = guard.as_mut().filter(|_| watched) {
                let parts = guard.parts(system, (self.step, self.parts), mu);
                if parts > self.parts {
                    self.parts = parts;
                    observer.divided(self.progress(), parts);
                    // what has been shown of the motion on the group stays
                    if !O::MOTION {
                        mu.copy_from(guard.before());
                        return Ok(Left::Divided);
                    }
                    stepper = self.method.stepper(
                        system,
                        S::from_f64(self.step / f64::from(parts)),
                        &self.newton,
                    );
                }
            }
            self.index += 1;
            let looked = observer.step(system, self.progress(), mu);
            if looked.is_break() {
                return Ok(Left::Over(Status::Stopped));
            }
            if let Some(next) = system.following(mu) {
                return Ok(Left::Branch(next));
            }
        }
    }

    /// Divides the steps, where too many did not contract.
    fn is_slow(&mut self) -> bool {
        let slow = self.stats.factorizations > self.slow.0;
        self.slow.0 = self.stats.factorizations;
        self.slow.1 += u32::from(slow);
        if self.slow.1 <= MOST_SLOW || self.parts >= SLOW_PARTS {
            return false;
        }
        self.slow.1 = 0;
        (self.parts, self.done) = (2 * self.parts, 2 * self.done);
        true
    }

    /// Goes on in smaller steps after one that failed, where that may be.
    #[cold]
    fn divided<S: Scalar, P: Poisson<S>>(
        &mut self,
        system: &P,
        failure: StepFailure,
        mu: &P::State,
    ) -> Result<Left<P>, IntegrateError>
    where
        M: Method<S, P>,
    {
        let Some(parts) = divided(self.parts).filter(|_| self.divides) else {
            let size = self.step / f64::from(self.parts);
            return Err(self.stopped(system, failure, size, mu));
        };
        self.stats.add_failure(&failure.report);
        self.done *= parts / self.parts;
        self.parts = parts;
        Ok(Left::Divided)
    }

    fn progress(&self) -> Progress {
        Progress {
            step: self.index,
            steps: self.grid.steps(),
            time: self.grid.time(self.index),
        }
    }

    /// The error of the step that comes next.
    fn failed(&self, failure: StepFailure) -> Box<StepError> {
        let mut stats = self.stats;
        stats.add_failure(&failure.report);
        Box::new(StepError {
            step: self.index + 1,
            time: self.grid.time(self.index),
            failure,
            stats,
            works: None,
        })
    }

    /// The same of a step of h from a state: where it left its chart, with one that does not.
    fn stopped<S: Scalar, P: Poisson<S>>(
        &self,
        system: &P,
        failure: StepFailure,
        h: f64,
        mu: &P::State,
    ) -> IntegrateError
    where
        M: Method<S, P>,
    {
        let left = failure.reason == FailureReason::OutsideChart;
        let works = left.then(|| smaller(system, self.method, &self.newton, h, mu));
        let error = StepError {
            works: works.flatten(),
            ..*self.failed(failure)
        };
        IntegrateError::from(Box::new(error))
    }

    /// Counts a step that ended at a state.
    fn arrived<S: Scalar, P: Poisson<S>>(
        &mut self,
        system: &P,
        mu: &P::State,
        report: StepReport,
    ) -> Result<(), Box<StepError>> {
        check_domain(system, mu, report).map_err(|failure| self.failed(failure))?;
        self.stats.add(&report);
        Ok(())
    }

    /// A shorter step, from a state of the grid to a row between two of them.
    fn off_grid<S: Scalar, P: Poisson<S>>(
        &mut self,
        system: &P,
        rest: f64,
        mu: &P::State,
        between: &mut P::State,
        observer: &mut impl Observer<S, P>,
    ) -> Result<(), IntegrateError>
    where
        M: Method<S, P>,
    {
        let parts = (rest / self.step * f64::from(self.parts)).ceil().max(1.0);
        let rest_step = S::from_f64(rest / parts);
        let mut shorter = self.method.stepper(system, rest_step, &self.newton);
        observer.leave_grid();
        for _ in 0..parts as u32 {
            match shorter.step(between, &mut Shown::to(observer, system)) {
                Ok(report) => self.arrived(system, between, report)?,
                Err(failure) => return Err(self.stopped(system, failure, rest, mu)),
            }
        }
        Ok(())
    }
}

/// Halvings of a step that is too large.
const HALVINGS: u32 = 30;

/// The largest of the halves, quarters, … of a step that succeeds from a state, if there is one.
fn smaller<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    system: &P,
    method: &M,
    newton: &NewtonOptions,
    h: f64,
    mu: &P::State,
) -> Option<f64> {
    let mut h = h;
    (0..HALVINGS).find_map(|_| {
        h *= 0.5;
        let mut stepper = method.stepper(system, S::from_f64(h), newton);
        stepper.step(&mut mu.clone(), &mut ()).ok().map(|_| h)
    })
}

/// The energy must be finite after a step, where H is no polynomial: a step may jump over a singularity.
fn check_domain<S: Scalar, P: Poisson<S>>(
    system: &P,
    mu: &P::State,
    report: StepReport,
) -> Result<(), StepFailure> {
    if system.hamiltonian_degree().is_some() {
        return Ok(());
    }
    let finite = system.hamiltonian(mu).finite();
    if finite.all() {
        return Ok(());
    }
    Err(StepFailure {
        reason: FailureReason::OutsideDomain,
        lanes: (!finite).bits(),
        report,
    })
}

/// The state, its energy and its velocity must be finite before the first step.
fn check_start<S: Scalar, P: Poisson<S>>(system: &P, mu: &P::State) -> Result<(), StepFailure> {
    let mut field = system.zero_state();
    system.vector_field(mu, &mut field);
    let finite = mu.finite() & field.finite() & system.hamiltonian(mu).finite();
    if finite.all() {
        return Ok(());
    }
    Err(StepFailure {
        reason: FailureReason::NotFinite,
        lanes: (!finite).bits(),
        report: StepReport::default(),
    })
}
