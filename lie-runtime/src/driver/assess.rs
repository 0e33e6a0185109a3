//! The error at the end of a run, by a second one, and a step that keeps it.

use super::course::Course;
use super::grid::Grid;
use super::observer::Observer;
use super::options::{Options, Save};
use super::pace::{Assessed, Chosen, count, settle};
use super::problem::Problem;
use super::solve::IntegrateError;
use super::stats::Status;
use crate::clock::holds;
use crate::methods::Method;
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;
use core::ops::ControlFlow;

/// A run that nobody sees has no more steps, the parts of divided ones counted.
const MOST_STEPS: f64 = 200_000.0;
/// How much shorter its steps are.
const SHORTER: f64 = 0.8;
/// By which part of the tolerance it starts elsewhere, of a method that chooses its own steps.
const CHANGE: f64 = 0.1;

/// Times the tolerance that an error may be without another, shorter step, and that it should then be.
const AIM: (f64, f64) = (10.0, 3.0);
/// Steps that are tried.
const ATTEMPTS: u32 = 3;
/// By how much a step is shortened at most at once.
const SHORTENED: f64 = 4.0;

/// The step for a run, from the one that the start suggests, and what its error is.
///
/// Two runs with different steps that nobody sees tell the error at the end. Where that is more than ten times the tolerance,
/// the step is shortened as much as the order says, and tried again.
pub(super) fn assess<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &Problem<S, P>,
    method: &M,
    options: &Options,
    first: &Chosen,
) -> Result<(f64, Assessed), IntegrateError> {
    let (tolerance, span) = (first.tolerance, problem.span.1 - problem.span.0);
    if span == 0.0 {
        let error = Some(0.0);
        return Ok((first.step, Assessed { tolerance, error }));
    }
    let mut step = first.step;
    let mut attempt = 0;
    loop {
        attempt += 1;
        let error = error_of(problem, method, options, step);
        let large = error.filter(|error| *error > AIM.0 * tolerance && !method.own_steps());
        let assessed = Assessed { tolerance, error };
        let Some(large) = large.filter(|_| attempt < ATTEMPTS) else {
            return Ok((step, assessed));
        };
        let order = f64::from(method.order().max(1));
        let factor = (large / (AIM.1 * tolerance))
            .powf(1.0 / order)
            .min(SHORTENED);
        let steps = count(span, (span / step * factor).ceil());
        if steps > MOST_STEPS {
            return Ok((step, assessed));
        }
        step = span / steps;
    }
}

/// The error at the end of a run with steps of a size, if it can be told.
fn error_of<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &Problem<S, P>,
    method: &M,
    options: &Options,
    step: f64,
) -> Option<f64> {
    let grid = Grid::new(problem.span, step).ok()?;
    if grid.steps() as f64 > MOST_STEPS {
        return None;
    }
    let (_, settled) = settle(problem, method, options).ok()?;
    let settled = settled?;
    let tolerance = settled.chosen.tolerance;
    let divides = Course::<M>::may_divide::<S, P>(method);
    let newton = settled.newton(step);
    let mut course = Course::new(&grid, method, newton, step)
        .dividing(divides)
        .at_most(MOST_STEPS as u64);
    let start = problem.start();
    let run = course.run(
        &problem.system,
        start,
        None,
        settled.guard(),
        &Save::Ends,
        &mut (),
    );
    let (end, Status::Finished) = run.ok()? else {
        return None;
    };
    let ended = Ended {
        problem,
        method,
        newton: options.newton,
        tolerance,
        steps: grid.steps() as f64 * f64::from(course.parts()),
        end: &end,
    };
    ended.error()
}

/// A run that has ended.
struct Ended<'a, S: Scalar, P: Poisson<S>, M> {
    problem: &'a Problem<S, P>,
    method: &'a M,
    newton: NewtonOptions,
    tolerance: f64,
    /// Steps, in the parts in which the last ones were made.
    steps: f64,
    end: &'a P::State,
}

impl<S: Scalar, P: Poisson<S>, M: Method<S, P>> Ended<'_, S, P, M> {
    /// Its error relative to the state, if a second run tells it.
    ///
    /// Steps of four fifths leave `0.8^p` of the error, which is subtracted. Of a method that chooses its own steps
    /// a change of the start by a part of the tolerance has grown to it.
    fn error(&self) -> Option<f64> {
        let (start, end) = self.problem.span;
        let mut mu = self.problem.start();
        let (steps, left) = if self.method.own_steps() {
            let by = self.problem.system.norm(&mu) * S::from_f64(CHANGE * self.tolerance);
            let clock = self.problem.system.clock();
            let entries = mu.as_mut_slice().iter_mut().enumerate();
            for (k, entry) in entries.filter(|(k, _)| !holds(clock, *k)) {
                *entry += by * S::from_f64((1.0 + 1.7 * k as f64).cos());
            }
            (self.steps, 0.0)
        } else {
            let steps = (self.steps / SHORTER).ceil();
            (steps, (self.steps / steps).powi(self.method.order() as i32))
        };
        if steps > MOST_STEPS {
            return None;
        }
        let mut last = Last(mu.clone());
        let step = (end - start) / steps;
        let grid = Grid::new((start, end), step).ok()?;
        let divides = Course::<M>::may_divide::<S, P>(self.method);
        let mut course = Course::new(&grid, self.method, self.newton, step)
            .dividing(divides)
            .at_most(MOST_STEPS as u64);
        let run = course.run(&self.problem.system, mu, None, None, &Save::Ends, &mut last);
        let (_, Status::Finished) = run.ok()? else {
            return None;
        };
        let system = &self.problem.system;
        let size = system.norm(self.end);
        last.0.axpy(S::from_f64(-1.0), self.end);
        let difference = system.norm(&last.0);
        if largest(difference) == 0.0 {
            // also of a state that is zero, of which nothing is a part
            return Some(0.0);
        }
        let error = largest(difference / size) / (1.0 - left);
        error.is_finite().then_some(error)
    }
}

/// Keeps the last state.
struct Last<V>(V);

impl<S: Scalar, P: Poisson<S>> Observer<S, P> for Last<P::State> {
    fn row(&mut self, _system: &P, _time: f64, mu: &P::State) -> ControlFlow<()> {
        self.0.copy_from(mu);
        ControlFlow::Continue(())
    }
}
