//! The update of one iteration, for each kind of iteration.

use super::options::Iteration;
use super::pivoted;
use crate::equation::Equation;
use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// Residual, factors, and what a lane with a small pivot needs.
#[derive(Clone, Debug)]
pub(super) struct Workspace<S: Scalar, U, M> {
    /// The residual, then the update.
    pub(super) update: U,
    spare: U,
    pub(super) factors: M,
    /// The lanes whose factors may be used.
    safe: S::Mask,
}

/// What the computation of an update has found, per lane.
pub(super) struct Outcome<S: Scalar> {
    /// Size of the residual.
    pub(super) residual: S,
    /// Size of the update.
    pub(super) update: S,
    /// Lanes solved with row exchanges.
    pub(super) pivoted: S::Mask,
    /// Lanes whose Jacobian has no inverse.
    pub(super) singular: S::Mask,
    /// How many Jacobians were computed.
    pub(super) factorizations: u32,
}

/// Computes the update of an iteration at an unknown into `workspace.update`; it is to be
/// subtracted from the unknown.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn compute<S: Scalar, E: Equation<S>>(
    equation: &mut E,
    unknown: &E::Unknown,
    iteration: Iteration,
    first: bool,
    active: S::Mask,
    workspace: &mut Workspace<S, E::Unknown, E::Matrix>,
) -> Outcome<S> {
    let mut outcome = Outcome {
        residual: S::zero(),
        update: S::zero(),
        pivoted: S::Mask::splat(false),
        singular: S::Mask::splat(false),
        factorizations: 0,
    };
    let Workspace {
        update,
        factors,
        safe,
        ..
    } = &mut *workspace;
    if iteration == Iteration::Newton || (first && iteration == Iteration::Simplified) {
        (outcome.residual, *safe) = equation.newton_update(unknown, update, factors);
        outcome.factorizations += 1;
    } else {
        equation.residual(unknown, update);
        outcome.residual = equation.norm(update);
        if iteration != Iteration::Simplified {
            outcome.update = outcome.residual;
            return outcome;
        }
        equation.solve(factors, update);
    }
    if !(workspace.safe | !active).all() {
        outcome.pivoted = !workspace.safe & active & outcome.residual.finite();
        if outcome.pivoted.any() {
            outcome.singular = redo(equation, unknown, outcome.pivoted, workspace);
            outcome.factorizations += 1;
        }
    }
    outcome.update = equation.norm(&workspace.update);
    outcome
}

/// Solves the lanes of a mask one by one with row exchanges; returns those that are singular.
#[cold]
#[inline(never)]
fn redo<S: Scalar, E: Equation<S>>(
    equation: &mut E,
    unknown: &E::Unknown,
    lanes: S::Mask,
    workspace: &mut Workspace<S, E::Unknown, E::Matrix>,
) -> S::Mask {
    // row exchanges fill entries that a linearization does not write: start from a clean matrix
    let mut matrix = equation.zero_matrix();
    equation.linearize(unknown, &mut workspace.spare, &mut matrix);
    let mut singular = 0;
    for lane in lanes.lanes() {
        if !pivoted::solve_lane(&mut matrix, &mut workspace.spare, lane) {
            singular |= 1 << lane;
        }
    }
    workspace.update.assign_where(lanes, &workspace.spare);
    S::Mask::from_bits(singular)
}

impl<S: Scalar, U: Clone, M> Workspace<S, U, M> {
    pub(super) fn new(unknown: U, matrix: M) -> Self {
        Self {
            update: unknown.clone(),
            spare: unknown,
            factors: matrix,
            safe: S::Mask::splat(false),
        }
    }

    /// An unknown whose entries do not matter between two iterations.
    pub(super) fn spare(&mut self) -> &mut U {
        &mut self.spare
    }
}
