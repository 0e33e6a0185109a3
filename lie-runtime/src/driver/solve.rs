//! Runs: what is saved of them, and how they end.

use super::assess::Ended;
use super::course::{Beginning, Course};
use super::density::{self, Density, Growth};
use super::error::{SolveError, StepError};
use super::grid::Grid;
use super::held::Held;
use super::kept::Kept;
use super::milestone::Milestone;
use super::observer::Observer;
use super::options::{OptionError, Options, Pace};
use super::pace::{Assessed, Settled, settle};
use super::problem::Problem;
use super::recorder::Recorder;
use super::solution::Solution;
use super::stats::{Stats, Status};
use crate::methods::Method;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State as _;
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

/// Integrates a problem and returns what was saved. Events that the system declares are in [`Solution::events`]; one that stops ends
/// the run there, with [`Status::Event`]. Inputs have their defaults, and noise has the seed 1; [`solve_observed`] with [`Held`] gives
/// others.
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
    let streams: Vec<u64> = (0..).take(S::LANES).collect();
    let held = Held::of(&problem.system, problem.span.0, (1, &streams));
    let held = held.map(|held| held.bounded(!M::EXPLICIT));
    solve_observed(problem, method, options, held)
}

/// [`solve`] with an observer. Inputs and noise are the observer's: [`Held`] gives them, as one of a pair of observers does; without it inputs
/// stay as the initial state has them, and noise is none.
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
    run(problem, Kept::alone(&method), options, None, observer)
}

/// [`integrate`] with milestones, where steppers forget, from one of the same problem with the same method and options: what
/// follows has the bits of the run that it was taken from. Without one, from the start.
///
/// # Errors
/// As [`integrate`], and [`OptionError::Milestone`] for one of another run, as far as that shows.
pub fn take_up<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &Problem<S, P>,
    method: M,
    options: &Options,
    milestone: Option<&Milestone<P::State>>,
    observer: &mut impl Observer<S, P>,
) -> Result<(Stats, Status), IntegrateError> {
    let method = Kept::alone(&method);
    run(problem, method, options, Some(milestone), observer)
}

/// A run with milestones, from one of them, or without.
fn run<S: Scalar, P: Poisson<S>>(
    problem: &Problem<S, P>,
    method: Kept<'_, S, P>,
    options: &Options,
    milestones: Option<Option<&Milestone<P::State>>>,
    observer: &mut dyn Observer<S, P>,
) -> Result<(Stats, Status), IntegrateError> {
    let (expected, found) = (problem.system.dimension(), problem.mu0.as_slice().len());
    if expected != found {
        return Err(OptionError::StateLength { expected, found }.into());
    }
    let method = method.keeping(problem, options.keep)?;
    let follows = options.density == Density::Reversible;
    if follows {
        density::check(&problem.system, &method)?;
    }
    if problem.system.noise_count() > 0 && !matches!(options.pace, Pace::Step(_)) {
        return Err(OptionError::Noise.into());
    }
    let (mut step, mut settled) = settle(problem, &method, options, observer.held().cloned())?;
    if let Some(settled) = settled.as_mut().filter(|_| follows) {
        let mu = problem.start();
        let followed = problem.system.following(&mu);
        let system = followed.as_ref().unwrap_or(&problem.system);
        let longest = Growth::new(system).longest(system, &mu);
        step = step.signum() * step.abs().min(longest);
        settled.chosen.step = step;
    }
    let tolerance = settled.as_ref().map(|settled| settled.chosen.tolerance);
    if let Some(settled) = &settled {
        observer.chosen(&settled.chosen);
    }
    let grid = Grid::new(problem.span, step)?;
    let divides = settled.is_some() && !follows && method.may_divide();
    let newton = settled
        .as_ref()
        .map_or(options.newton, |settled| settled.newton(step));
    let mut course = Course::new(grid, &method, newton)
        .dividing(divides)
        .following(options.density)
        .with_milestones(milestones.is_some());
    let settled = settled.filter(|_| !follows);
    let (guard, begun) = settled.map_or((None, None), Settled::begin);
    let beginning = match (milestones.flatten(), begun) {
        (Some(milestone), _) => Beginning::Milestone(milestone),
        (None, Some(begun)) => Beginning::Step(begun),
        (None, None) => Beginning::Start,
    };
    let (system, mu) = (&problem.system, problem.start());
    let (end, status) = course.run(system, mu, beginning, guard, &options.save, observer)?;
    let repeats = observer.held().is_none_or(Held::repeats);
    if course.stats.steps <= options.assess && status == Status::Finished && repeats {
        let end = match follows {
            true => course.at_the_end(system, end)?,
            false => end,
        };
        let ended = Ended {
            problem,
            method: &method,
            newton: options.newton,
            tolerance,
            step: if follows { step } else { course.size() },
            density: options.density,
            end: &end,
        };
        // a change of the start would be brought back, and not grow as the errors of steps do
        let told = !(method.keeps() && method.own_steps());
        let error = told.then(|| ended.error(observer)).flatten();
        observer.assessed(&Assessed { tolerance, error });
    }
    Ok((course.stats, status))
}
