//! The error at the end of a run, by a second one.

use super::grid::Grid;
use super::observer::Observer;
use super::options::Save;
use super::problem::Problem;
use super::solve::Course;
use crate::methods::Method;
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::{State, Unknown};
use core::ops::ControlFlow;

/// A second run of more steps is not made.
const MOST_STEPS: f64 = 200_000.0;
/// How much shorter its steps are.
const SHORTER: f64 = 0.8;
/// By which part of the tolerance it starts elsewhere, of a method that chooses its own steps.
const CHANGE: f64 = 0.1;

/// A run that has ended.
pub(super) struct Ended<'a, S: Scalar, P: Poisson<S>, M> {
    pub(super) problem: &'a Problem<S, P>,
    pub(super) method: &'a M,
    pub(super) newton: NewtonOptions,
    pub(super) tolerance: f64,
    /// Steps, in the parts in which the last ones were made.
    pub(super) steps: f64,
    pub(super) end: &'a P::State,
}

impl<S: Scalar, P: Poisson<S>, M: Method<S, P>> Ended<'_, S, P, M> {
    /// Its error relative to the state, if a second run tells it.
    ///
    /// Steps of four fifths leave `0.8^p` of the error, which is subtracted. Of a method that chooses its own steps
    /// a change of the start by a part of the tolerance has grown to it.
    pub(super) fn error(&self) -> Option<f64> {
        let (start, end) = self.problem.span;
        let mut mu = self.problem.mu0.clone();
        let (steps, left) = if M::OWN_STEPS {
            let by = mu.max_norm() * S::from_f64(CHANGE * self.tolerance);
            for (k, entry) in mu.as_mut_slice().iter_mut().enumerate() {
                *entry += by * S::from_f64((1.0 + 1.7 * k as f64).cos());
            }
            (self.steps, 0.0)
        } else {
            let steps = (self.steps / SHORTER).ceil();
            (steps, (self.steps / steps).powi(M::ORDER as i32))
        };
        if steps > MOST_STEPS {
            return None;
        }
        let mut last = Last(mu.clone());
        let step = (end - start) / steps;
        let grid = Grid::new((start, end), step).ok()?;
        let mut course = Course::new(&grid, self.method, self.newton, step);
        course
            .run(&self.problem.system, mu, None, &Save::Ends, &mut last)
            .ok()?;
        let size = self.end.max_norm();
        last.0.axpy(S::from_f64(-1.0), self.end);
        let error = largest(last.0.max_norm() / size) / (1.0 - left);
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
