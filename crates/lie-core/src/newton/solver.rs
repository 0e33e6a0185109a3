//! The loop.

use super::convergence::{Convergence, Settling};
use super::count::Count;
use super::failed::{leave, refuse};
use super::options::{Iteration, NewtonOptions};
use super::predictor::is_far;
use super::report::{Failure, FailureReason, NewtonReport};
use super::sizes::Sizes;
use super::trial::Trial;
use super::update::{self, Workspace};
use crate::equation::Equation;
use crate::scalar::{Counted, Mask, Scalar};
use crate::state::Unknown;

/// A number is halved so often at most: the smallest entries have come to rest by then, or never do.
const LONGEST: u32 = 2200;

/// Newton's iteration `u <- u - (dr/du)^-1 r(u)`, or a cheaper variant, for all lanes together.
///
/// A lane that has converged is frozen, so that it keeps the digits of a run of its own; the loop
/// ends when every lane has converged or failed. Pivots are taken in the order fixed by the
/// equation; a lane in which one is too small is solved alone with row exchanges. Steps allocate
/// nothing (a heap matrix is allocated where row exchanges are needed).
#[derive(Clone, Debug)]
pub struct Newton<S: Scalar, U, M> {
    pub(super) options: NewtonOptions,
    pub(super) workspace: Workspace<S, U, M>,
    fixed: Trial<S>,
    chord: Trial<S>,
    pub(super) far: S::Mask,
    /// An update of Newton's method whose entries are smaller than their sizes by this factor is the last one, as shown by
    /// a step that was solved from the guess of its equation.
    pub(super) enough: S,
}

/// The lanes in which cheaper iterations are tried before Newton's method.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attempts<M> {
    /// Those without a Jacobian.
    fixed: M,
    /// Those among them that start from a prediction.
    predicted: M,
    /// Those with the Jacobian of the start.
    chord: M,
}

/// Where the iteration of a step starts.
pub(crate) struct Start<'a, U, M> {
    /// The lanes that start from a prediction.
    pub(crate) predicted: M,
    /// The lanes in which the step is to show how Newton's method converges, for predictions soon to come.
    pub(crate) shows: M,
    /// The unknown of the step before, where there may be any.
    pub(crate) before: Option<&'a U>,
}

impl<M: Mask> Attempts<M> {
    /// The lanes in which any is from a prediction.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn predictable(&self) -> M {
        self.predicted | self.chord
    }
}

impl<S: Scalar, U: Unknown<S>, M: Clone> Newton<S, U, M> {
    /// A solver for equations of the shape of this one.
    pub fn new<E>(equation: &E, options: &NewtonOptions) -> Self
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let workspace = Workspace::new(equation.zero_unknown(), equation.zero_matrix());
        Self {
            options: *options,
            workspace,
            fixed: Trial::of_fixed_point(options, equation.jacobian_cost()),
            chord: Trial::of_one_jacobian(options),
            far: S::Mask::splat(false),
            enough: S::from_f64(f64::INFINITY),
        }
    }

    /// Solves `r(u) = 0` from the unknown given. Where an automatic iteration leaves what it tried for Newton's method,
    /// that starts from [`Equation::initial_guess`].
    ///
    /// `scale` is the size of the state; errors are measured relative to it and to the unknown.
    ///
    /// # Errors
    /// A [`Failure`] if some lane did not converge; the unknown then is the solution in the others.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn solve<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
    ) -> Result<NewtonReport, Failure>
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let attempts = self.attempts();
        let start = Start {
            predicted: S::Mask::splat(false),
            shows: S::Mask::splat(false),
            before: None,
        };
        self.solve_trying(equation, unknown, scale, attempts, &start)
    }

    /// Shows what is remembered from step to step.
    pub(crate) fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) {
        self.fixed.carry(visit);
        self.chord.carry(visit);
        visit(&mut self.enough);
    }

    /// What is tried in the next step, to be asked once for each.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn attempts(&mut self) -> Attempts<S::Mask> {
        self.far = S::Mask::splat(false);
        let fixed = self.fixed.lanes();
        Attempts {
            fixed,
            predicted: fixed & S::Mask::splat(self.fixed.predictable()),
            chord: self.chord.lanes(),
        }
    }

    /// The lanes in which a prediction for the last step was far from the solution.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn started_far(&self) -> S::Mask {
        self.far
    }

    /// [`Newton::solve`] with these attempts, from this start.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn solve_trying<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        attempts: Attempts<S::Mask>,
        start: &Start<'_, U, S::Mask>,
    ) -> Result<NewtonReport, Failure>
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut report = NewtonReport::default();
        let mut count = Count::default();
        let mut lanes = S::Mask::splat(true);
        let mut predicted = start.predicted;
        let sizes = Sizes {
            before: start.before,
            clock: equation.clock(),
        };
        // the last steps before predictions show how Newton's method converges
        let fixed = attempts.fixed & (attempts.predicted | !(predicted | start.shows));
        if fixed.any() {
            let counts = (&mut report, &mut count);
            let trying = (fixed, predicted, sizes);
            let solved = self.by_fixed_point(equation, unknown, scale, trying, counts);
            report.fixed_point = count.most(Counted::WithoutJacobian);
            lanes = !solved;
            if lanes.any() {
                let left = fixed & lanes;
                let slow = left & !self.far;
                restart(equation, unknown, left, &mut self.workspace);
                predicted = predicted & !left;
                self.fixed.given_up(slow);
            }
        }
        let trying = attempts.chord & predicted & lanes;
        if trying.any() {
            let counts = (&mut report, &mut count);
            let trying_them = (trying, sizes);
            let solved = self.by_one_jacobian(equation, unknown, scale, trying_them, counts);
            lanes = lanes & !solved;
            if lanes.any() {
                let left = trying & lanes;
                let slow = left & !self.far;
                restart(equation, unknown, left, &mut self.workspace);
                self.chord.given_up(slow);
            }
        }
        if lanes.any() {
            let shows = (start.shows & attempts.chord, sizes);
            let counts = (report, count);
            return self.by_newton(equation, unknown, scale, (lanes, shows), counts);
        }
        report.iterations = count.most(Counted::Iterations);
        Ok(report)
    }

    /// Solves by the iteration of the options in the lanes of a mask, after what was tried.
    #[inline(never)]
    fn by_newton<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (lanes, shows): (S::Mask, (S::Mask, Sizes<'_, U>)),
        (mut report, mut count): (NewtonReport, Count<S>),
    ) -> Result<NewtonReport, Failure>
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let iteration = match self.options.iteration {
            Iteration::Automatic => Iteration::Newton,
            chosen => chosen,
        };
        let counts = (&mut report, &mut count);
        let failed = self.iterate(equation, unknown, scale, (iteration, lanes, shows), counts);
        report.iterations = count.most(Counted::Iterations);
        if iteration == Iteration::FixedPoint {
            report.fixed_point = count.most(Counted::WithoutJacobian);
        }
        match failed {
            None => Ok(report),
            Some((reason, lanes)) => Err(Failure {
                reason,
                lanes,
                report,
            }),
        }
    }

    /// Iterates without a Jacobian in the lanes of a mask, as long as that pays; returns those in which it led to the
    /// solution.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn by_fixed_point<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (lanes, predicted, sizes): (S::Mask, S::Mask, Sizes<'_, U>),
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> S::Mask
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut convergence = Convergence::new(Iteration::FixedPoint, self.options.tolerance);
        let mut bound = self.fixed.bound();
        let mut settling = Settling::new(Iteration::FixedPoint);
        let mut active = lanes;
        let mut solved = S::Mask::splat(false);
        let mut size = scale;
        while active.any() {
            let update = &mut self.workspace.update;
            let within = equation.approach(unknown, update, active);
            let residual = equation.norm(update);
            let step = S::largest_magnitude(&[residual, within]);
            count.saw(active, residual);
            unknown.subtract_where(active, update);
            let index = count.add(active);
            if index % REVIEW == 1 {
                size = S::largest_magnitude(&[scale, equation.norm(unknown)]);
                if index == 1 {
                    self.far = is_far(residual, scale) & lanes & predicted;
                    active = active & !self.far;
                }
            }
            let converged = convergence.observe(step, size) & active;
            let pair = (&self.workspace.update, &*unknown);
            let converged = settling.observe(converged, sizes, pair) & active;
            solved = solved | converged;
            active = active & !converged;
            if active.any() {
                let keeps = bound.keeps(step, convergence.is_round_off(step, size));
                let rests = settling.ending() & step.finite() & size.finite();
                active = active & (keeps | rests & S::Mask::splat(index < LONGEST));
            }
        }
        report.residual = count.residual();
        solved
    }

    /// Iterates in the lanes of a mask, and says in which it failed.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn iterate<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (iteration, lanes, shows): (Iteration, S::Mask, (S::Mask, Sizes<'_, U>)),
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> Option<(FailureReason, u64)>
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut convergence = Convergence::new(iteration, self.options.tolerance);
        let mut settling = Settling::new(iteration);
        let mut active = lanes;
        let (mut failed, mut factored) = (None, Count::<S>::default());
        let mut first = S::zero();
        let mut size = scale;
        for index in 0..self.options.max_iterations {
            let outcome = update::compute(
                equation,
                unknown,
                iteration,
                index == 0,
                active,
                &mut self.workspace,
            );
            count.add(active);
            for _ in 0..outcome.factorizations {
                factored.add(active);
            }
            report.pivoted |= outcome.pivoted.bits();
            count.saw(active, outcome.residual);

            let sound = outcome.update.finite() & !outcome.singular;
            if !(sound | !active).all() {
                refuse(&mut failed, active, outcome.singular, sound);
                active = active & sound;
                if !active.any() {
                    break;
                }
            }
            unknown.subtract_where(active, &self.workspace.update);
            if index % REVIEW == 0 {
                size = S::largest_magnitude(&[scale, equation.norm(unknown)]);
            }
            match index {
                0 => first = outcome.update,
                1 if (shows.0 & active).any() => self.show_curvature(first, unknown, active, shows),
                _ => {}
            }
            let converged = convergence.observe(outcome.update, size) & active;
            let pair = (&self.workspace.update, &*unknown);
            active = active & !settling.observe(converged, shows.1, pair);
            if !active.any() {
                break;
            }
        }
        report.residual = count.residual();
        report.factorizations += factored.most(Counted::Factorizations);
        active = active & !settling.ending();
        if active.any() {
            leave(&mut failed, active, convergence.growing());
        }
        failed
    }
}

/// The unknown is measured with the first iteration, and again after so many.
const REVIEW: u32 = 4;

/// Lanes in which what was tried did not pay start anew.
#[cold]
#[inline(never)]
fn restart<S: Scalar, E: Equation<S>>(
    equation: &mut E,
    unknown: &mut E::Unknown,
    lanes: S::Mask,
    workspace: &mut Workspace<S, E::Unknown, E::Matrix>,
) {
    let start = workspace.spare();
    equation.initial_guess(start);
    unknown.assign_where(lanes, start);
}
