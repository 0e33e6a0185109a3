//! The loop.

use super::convergence::{Convergence, curvature, ends};
use super::count::Count;
use super::failed::{leave, refuse};
use super::options::{Iteration, NewtonOptions};
use super::predictor::is_far;
use super::report::{Failure, FailureReason, NewtonReport};
use super::trial::Trial;
use super::update::{self, Workspace};
use crate::equation::Equation;
use crate::scalar::{Mask, Scalar, largest};
use crate::state::Unknown;

/// Newton's iteration `u <- u - (dr/du)^-1 r(u)`, or a cheaper variant, for all lanes together.
///
/// A lane that has converged is frozen, so that it keeps the digits of a run of its own; the loop
/// ends when every lane has converged or failed. Pivots are taken in the order fixed by the
/// equation; a lane in which one is too small is solved alone with row exchanges. Steps allocate
/// nothing (a heap matrix is allocated where row exchanges are needed).
#[derive(Clone, Debug)]
pub struct Newton<S: Scalar, U, M> {
    options: NewtonOptions,
    workspace: Workspace<S, U, M>,
    fixed: Trial<S>,
    chord: Trial<S>,
    far: S::Mask,
    /// The error after an iteration of Newton's method is at most this times that before it squared, as shown by a step
    /// that was solved from the guess of its equation.
    curvature: S,
}

/// The lanes in which cheaper iterations are tried before Newton's method.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attempts<M> {
    /// Those without a Jacobian.
    fixed: M,
    /// Those with the Jacobian of the start.
    chord: M,
}

impl<M: Mask> Attempts<M> {
    /// The lanes in which any is.
    #[inline(always)]
    pub(crate) fn any(&self) -> M {
        self.fixed | self.chord
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
            curvature: S::from_f64(f64::INFINITY),
        }
    }

    /// Solves `r(u) = 0` from the unknown given. Where an automatic iteration leaves what it tried for Newton's method,
    /// that starts from [`Equation::initial_guess`].
    ///
    /// `scale` is the size of the state; errors are measured relative to it and to the unknown.
    ///
    /// # Errors
    /// A [`Failure`] if some lane did not converge; the unknown then is the solution in the others.
    #[inline(always)]
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
        self.solve_trying(equation, unknown, scale, attempts, S::Mask::splat(false))
    }

    /// What is tried in the next step, to be asked once for each.
    #[inline(always)]
    pub(crate) fn attempts(&mut self) -> Attempts<S::Mask> {
        self.far = S::Mask::splat(false);
        let fixed = self.fixed.lanes();
        Attempts {
            fixed,
            chord: self.chord.lanes(),
        }
    }

    /// Whether anything is tried at all.
    pub(crate) fn is_automatic(&self) -> bool {
        self.options.iteration == Iteration::Automatic
    }

    /// The lanes in which a prediction for the last step was far from the solution.
    #[inline(always)]
    pub(crate) fn started_far(&self) -> S::Mask {
        self.far
    }

    /// [`Newton::solve`] with these attempts, from a prediction in the lanes of a mask.
    #[inline(always)]
    pub(crate) fn solve_trying<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        attempts: Attempts<S::Mask>,
        mut predicted: S::Mask,
    ) -> Result<NewtonReport, Failure>
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut report = NewtonReport::default();
        let mut count = Count::default();
        let mut lanes = S::Mask::splat(true);
        if attempts.fixed.any() {
            let counts = (&mut report, &mut count);
            let trying = (attempts.fixed, predicted);
            let solved = self.by_fixed_point(equation, unknown, scale, trying, counts);
            report.fixed_point = count.most();
            lanes = !solved;
            if lanes.any() {
                let left = attempts.fixed & lanes;
                let slow = left & !self.far;
                restart(equation, unknown, left, &mut self.workspace);
                predicted = predicted & !left;
                self.fixed.given_up(slow);
            }
        }
        let trying = attempts.chord & lanes;
        if trying.any() {
            let counts = (&mut report, &mut count);
            let solved =
                self.by_one_jacobian(equation, unknown, scale, (trying, predicted), counts);
            lanes = lanes & !solved;
            if lanes.any() {
                let left = trying & lanes;
                let slow = left & !self.far;
                restart(equation, unknown, left, &mut self.workspace);
                self.chord.given_up(slow);
            }
        }
        if lanes.any() {
            return self.by_newton(equation, unknown, scale, lanes, (report, count));
        }
        report.iterations = count.most();
        Ok(report)
    }

    /// Solves by the iteration of the options in the lanes of a mask, after what was tried.
    #[inline(never)]
    fn by_newton<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        lanes: S::Mask,
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
        let failed = self.iterate(equation, unknown, scale, (iteration, lanes), counts);
        report.iterations = count.most();
        if iteration == Iteration::FixedPoint {
            report.fixed_point = report.iterations;
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

    /// Iterates with the Jacobian of the start in the lanes of a mask, as long as that converges fast; returns those in
    /// which it led to the solution.
    #[inline(always)]
    fn by_one_jacobian<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (lanes, predicted): (S::Mask, S::Mask),
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> S::Mask
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let Workspace {
            update, factors, ..
        } = &mut self.workspace;
        equation.linearize(unknown, update, factors);
        let mut residual = update.max_norm();
        let safe = equation.factor(factors);
        report.factorizations += 1;
        equation.solve(factors, update);
        unknown.subtract_where(lanes, update);
        count.add(lanes);
        let first = update.max_norm();
        let far = is_far(first, scale) & lanes & predicted;
        self.far = self.far | far;
        let sound = lanes & safe & first.finite() & !far;
        let round_off = S::epsilon() * scale;
        let left = self.curvature * first * first;
        let enough = left.less_equal(S::from_f64(self.options.tolerance) * round_off);
        let mut solved = (enough & predicted | first.less_equal(round_off)) & sound;
        let mut active = sound & !solved;
        if active.any() {
            let mut before = first;
            let mut size = scale;
            for index in 0..CHORDS {
                equation.residual(unknown, update);
                residual = S::select(active, update.max_norm(), residual);
                equation.solve(factors, update);
                unknown.subtract_where(active, update);
                count.add(active);
                let step = update.max_norm();
                if index == 0 && !predicted.all() {
                    let measured = curvature(first, step, scale);
                    self.curvature = S::select(active & !predicted, measured, self.curvature);
                }
                let mut converged = ends(step, before, size, self.options.tolerance);
                if !(converged | !active).all() {
                    size = S::largest_magnitude(&[scale, unknown.max_norm()]);
                    converged = converged | ends(step, before, size, self.options.tolerance);
                }
                solved = solved | converged & active;
                active = active & !converged & step.less(before * S::from_f64(CHORD_RATE));
                if !active.any() {
                    break;
                }
                before = step;
            }
        }
        report.residual = largest(S::select(solved, residual, S::zero()));
        solved
    }

    /// Iterates without a Jacobian in the lanes of a mask, as long as that pays; returns those in which it led to the
    /// solution.
    #[inline(always)]
    fn by_fixed_point<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (lanes, predicted): (S::Mask, S::Mask),
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> S::Mask
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut convergence = Convergence::new(Iteration::FixedPoint, self.options.tolerance);
        let mut bound = self.fixed.bound();
        let mut active = lanes;
        let mut solved = S::Mask::splat(false);
        let mut residual = S::zero();
        let mut size = scale;
        while active.any() {
            let update = &mut self.workspace.update;
            equation.residual(unknown, update);
            let step = update.max_norm();
            residual = S::select(active, step, S::zero());
            unknown.subtract_where(active, update);
            let index = count.add(active);
            if index % REVIEW == 1 {
                size = S::largest_magnitude(&[scale, unknown.max_norm()]);
                if index == 1 {
                    self.far = is_far(step, scale) & lanes & predicted;
                    active = active & !self.far;
                }
            }
            let converged = convergence.observe(step, size) & active;
            solved = solved | converged;
            active = active & !converged;
            if active.any() {
                active = active & bound.keeps(step, convergence.is_round_off(step, size));
            }
        }
        report.residual = largest(residual);
        solved
    }

    /// Iterates in the lanes of a mask, and says in which it failed.
    #[inline(always)]
    fn iterate<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (iteration, lanes): (Iteration, S::Mask),
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> Option<(FailureReason, u64)>
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut convergence = Convergence::new(iteration, self.options.tolerance);
        let mut active = lanes;
        let mut failed = None;
        let mut residual = S::zero();
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
            report.factorizations += outcome.factorizations;
            report.pivoted |= outcome.pivoted.bits();
            residual = S::select(active, outcome.residual, S::zero());

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
                size = S::largest_magnitude(&[scale, unknown.max_norm()]);
            }
            active = active & !convergence.observe(outcome.update, size);
            if !active.any() {
                break;
            }
        }
        report.residual = largest(residual);
        if active.any() {
            leave(&mut failed, active, convergence.growing());
        }
        failed
    }
}

/// The unknown is measured with the first iteration, and again after so many.
const REVIEW: u32 = 4;

/// So many iterations follow the one with a Jacobian of its own, and their updates shrink by this factor at least.
const CHORDS: u32 = 3;
const CHORD_RATE: f64 = 1.0 / 64.0;

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
