//! The error at the end of a run, by a second one.

use super::course::{Beginning, Course};
use super::density::Density;
use super::grid::Grid;
use super::held::Held;
use super::kept::Kept;
use super::observer::{Observer, Progress};
use super::options::Save;
use super::problem::Problem;
use super::stats::Status;
use crate::clock::holds;
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;
use core::ops::ControlFlow;

/// How much shorter the steps of the second run are.
const SHORTER: f64 = 0.8;
/// By which part of the tolerance it starts elsewhere, of a method that chooses its own steps.
const CHANGE: f64 = 0.1;

/// A run that has ended.
pub(super) struct Ended<'a, S: Scalar, P: Poisson<S>> {
    pub(super) problem: &'a Problem<S, P>,
    pub(super) method: &'a Kept<'a, S, P>,
    pub(super) newton: NewtonOptions,
    /// None of a run whose step was given.
    pub(super) tolerance: Option<f64>,
    /// The size of the last steps.
    pub(super) step: f64,
    /// The first step counts where they follow the motion: all others change with it.
    pub(super) density: Density,
    pub(super) end: &'a P::State,
}

impl<S: Scalar, P: Poisson<S>> Ended<'_, S, P> {
    /// Its error relative to the state, if a second run tells it.
    ///
    /// Steps of four fifths leave `0.8^p` of the error, which is subtracted. Of a method that chooses its own steps
    /// a change of the start by a part of the tolerance has grown to it.
    pub(super) fn error(&self, observer: &mut dyn Observer<S, P>) -> Option<f64> {
        let (start, end) = self.problem.span;
        if start == end {
            return Some(0.0);
        }
        let mut mu = self.problem.start();
        let follows = self.density == Density::Reversible;
        let own = match follows {
            true => (end - start) / self.step,
            false => ((end - start) / self.step).round(),
        };
        let (steps, left) = if self.method.own_steps() {
            let by = self.problem.system.norm(&mu) * S::from_f64(CHANGE * self.tolerance?);
            let clock = self.problem.system.clock();
            let entries = mu.as_mut_slice().iter_mut().enumerate();
            for (k, entry) in entries.filter(|(k, _)| !holds(clock, *k)) {
                *entry += by * S::from_f64((1.0 + 1.7 * k as f64).cos());
            }
            (own, 0.0)
        } else if follows {
            (own / SHORTER, SHORTER.powi(self.method.order() as i32))
        } else {
            let steps = (own / SHORTER).ceil();
            (steps, (own / steps).powi(self.method.order() as i32))
        };
        let step = (end - start) / steps;
        let grid = Grid::new((start, end), step).ok()?;
        let divides = self.method.may_divide();
        let mut course = Course::new(grid, self.method, self.newton)
            .dividing(divides && !follows)
            .following(self.density);
        let mut last = Last {
            state: mu.clone(),
            held: observer.held().cloned(),
            observer,
        };
        let system = &self.problem.system;
        let run = course.run(system, mu, Beginning::Start, None, &Save::Ends, &mut last);
        let (_, Status::Finished) = run.ok()? else {
            return None;
        };
        let mut difference = last.state;
        let size = system.norm(self.end);
        difference.axpy(S::from_f64(-1.0), self.end);
        let difference = system.norm(&difference);
        if largest(difference) == 0.0 {
            // also of a state that is zero, of which nothing is a part
            return Some(0.0);
        }
        let error = largest(difference / size) / (1.0 - left);
        error.is_finite().then_some(error)
    }
}

/// Keeps the last state.
struct Last<'o, S: Scalar, P: Poisson<S>> {
    state: P::State,
    held: Option<Held>,
    observer: &'o mut dyn Observer<S, P>,
}

impl<S: Scalar, P: Poisson<S>> Observer<S, P> for Last<'_, S, P> {
    fn hold(&mut self, system: &P, step: (u64, f64, f64), mu: &mut P::State, element: &[S]) {
        self.held.hold(system, step, mu, element);
    }

    fn held(&self) -> Option<&Held> {
        self.held.as_ref()
    }

    fn step(&mut self, _system: &P, progress: Progress, _mu: &P::State) -> ControlFlow<()> {
        self.observer.compared(progress)
    }

    fn row(&mut self, _system: &P, _time: f64, mu: &P::State) -> ControlFlow<()> {
        self.state.copy_from(mu);
        ControlFlow::Continue(())
    }
}
