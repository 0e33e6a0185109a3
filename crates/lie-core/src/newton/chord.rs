//! One Jacobian a step: an iteration of Newton's method from a prediction, and where that is not known to be enough,
//! iterations with its factors.
//!
//! After an iteration of Newton's method the error is `c e^2`. A step that starts from the guess of its equation shows c by its
//! first two updates. Errors are relative to the [sizes](Sizes) of the entries, each its own.

use super::convergence::{curvature, ends, is_round_off};
use super::count::Count;
use super::predictor::is_far;
use super::report::NewtonReport;
use super::sizes::Sizes;
use super::solver::Newton;
use super::update::Workspace;
use crate::equation::Equation;
use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// At most so many iterations follow the one with a Jacobian of its own, and their updates shrink by this factor until they
/// are round-off.
const CHORDS: u32 = 4;
const CHORD_RATE: f64 = 1.0 / 64.0;

impl<S: Scalar, U: Unknown<S>, M: Clone> Newton<S, U, M> {
    /// Iterates with the Jacobian of a prediction in the lanes of a mask, as long as that converges fast; returns those in
    /// which it led to the solution.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn by_one_jacobian<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (lanes, sizes): (S::Mask, Sizes<'_, U>),
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> S::Mask
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let Workspace {
            update, factors, ..
        } = &mut self.workspace;
        let (residual, safe) = equation.newton_update(unknown, update, factors);
        let safe = safe & lanes;
        report.factorizations += 1;
        unknown.subtract_where(lanes, update);
        count.add(lanes);
        let solved = sizes.small_lanes(update, unknown, self.enough) & safe;
        count.saw(lanes, residual);
        report.residual = count.residual();
        if (solved | !lanes).all() {
            return solved;
        }
        let counts = (report, count);
        self.with_its_factors(equation, unknown, scale, (safe, solved, sizes), counts)
    }

    /// Goes on with the factors in those lanes of a mask that are not solved yet; returns the solved ones.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn with_its_factors<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (lanes, mut solved, sizes): (S::Mask, S::Mask, Sizes<'_, U>),
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> S::Mask
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let first = equation.norm(&self.workspace.update);
        let far = is_far(first, scale) & lanes & !solved;
        self.far = self.far | far;
        let mut before = sizes.relative(&self.workspace.update, unknown);
        let sound = lanes & first.finite() & !far;
        solved = solved | before.less_equal(S::epsilon()) & sound;
        let mut active = sound & !solved;
        let Workspace {
            update, factors, ..
        } = &mut self.workspace;
        for _ in 0..CHORDS {
            if !active.any() {
                break;
            }
            equation.residual(unknown, update);
            count.saw(active, equation.norm(update));
            equation.solve(factors, update);
            unknown.subtract_where(active, update);
            count.add(active);
            let step = sizes.relative(update, unknown);
            let size = S::largest_magnitude(&[scale, equation.norm(unknown)]);
            let settled = is_round_off(equation.norm(update), size);
            let converged = ends(step, before, settled, self.options.tolerance);
            solved = solved | converged & active;
            let fast = step.less(before * S::from_f64(CHORD_RATE));
            active = active & !converged & (fast | settled);
            before = step;
        }
        report.residual = count.residual();
        solved
    }

    /// Takes the second update of Newton's method in the lanes of a mask, after a first one of this size.
    #[inline(never)]
    pub(super) fn show_curvature(
        &mut self,
        first: S,
        unknown: &U,
        lanes: S::Mask,
        (shows, sizes): (S::Mask, Sizes<'_, U>),
    ) {
        let second = sizes.relative(&self.workspace.update, unknown);
        let curvature = curvature(first / sizes.largest(unknown), second);
        let goal = S::from_f64(self.options.tolerance) * S::epsilon();
        let enough = (curvature / goal).sqrt();
        self.enough = S::select(lanes & shows, enough, self.enough);
    }
}
