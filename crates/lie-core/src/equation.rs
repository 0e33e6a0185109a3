//! Implicit steps as nonlinear equations, and the hook by which a system supplies fused ones.

use crate::clock::{self, Clock};
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::newton::dense;
use crate::poisson::Poisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::{State, Unknown};

/// One implicit step of fixed size as an equation `r(u) = 0`.
///
/// Newton's iteration knows only this trait. The fixed-point form of the equation is
/// `u -> u - r(u)`. Functions take `&mut self` so that an equation may keep scratch space; they
/// allocate nothing.
pub trait Equation<S: Scalar> {
    /// The state of the system.
    type State: State<S>;
    /// What is solved for.
    type Unknown: Unknown<S>;
    /// The Jacobian `dr/du`, later its factors.
    type Matrix: SquareMatrix<S>;

    /// An unknown of the right size, all entries 0.
    fn zero_unknown(&self) -> Self::Unknown;
    /// A matrix of the right size, all entries 0.
    fn zero_matrix(&self) -> Self::Matrix;

    /// Sets the state from which the step starts. Everything below refers to it.
    fn set_base(&mut self, mu: &Self::State);
    /// The size against which errors of the unknown are measured, for the base mu; the size of the unknown
    /// itself counts too.
    fn scale(&self, mu: &Self::State) -> S {
        clock::norm(self.clock(), mu)
    }
    /// Where unknowns are made of states: their coordinates that carry the time. They count in no norm.
    #[inline(always)]
    fn clock(&self) -> Option<Clock> {
        None
    }
    /// The size of an unknown, a residual or an update.
    #[inline(always)]
    fn norm(&self, unknown: &Self::Unknown) -> S {
        clock::norm(self.clock(), unknown)
    }
    /// The unknown with which the iteration starts.
    fn initial_guess(&mut self, unknown: &mut Self::Unknown);
    /// Gives the unknowns that the iteration leaves out the values of the state: no residual depends on them, but norms and
    /// predictions of the whole unknown do.
    #[inline(always)]
    fn leave_out(&self, _unknown: &mut Self::Unknown) {}
    /// The residual r(u).
    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown);
    /// The residual of an iteration without a Jacobian. An equation that solves another one within may go one step in that, in the
    /// active lanes: what is written is r(u) in the limit, where both iterations have converged. Returns the size of what that step
    /// changed, in the [`norm`](Equation::norm); 0 where nothing is solved within.
    fn approach(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        _active: S::Mask,
    ) -> S {
        self.residual(unknown, residual);
        S::zero()
    }
    /// The residual and its Jacobian `dr/du`. Writes every entry that can be nonzero before or
    /// after [`Equation::factor`] (pattern and fill-in); the others keep the 0 of
    /// [`Equation::zero_matrix`].
    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    );
    /// Replaces a Jacobian by its triangular factors, pivots in a fixed order; false in the lanes
    /// where a pivot is too small ([`crate::newton::inverse_pivots_are_safe`]). The default is dense elimination, for
    /// [`Equation::solve`] too.
    fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
        dense::factor(matrix)
    }
    /// Solves `(dr/du) x = r` by the factors, in place of r.
    fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
        dense::solve(factors, residual);
    }
    /// What Newton's iteration subtracts from an unknown, with the factors of its Jacobian: [`Equation::linearize`],
    /// [`Equation::factor`] and [`Equation::solve`] one after the other, or something that gives the same bits. Returns the
    /// size of the residual, and the lanes in which every pivot was safe.
    #[inline(always)]
    fn newton_update(
        &mut self,
        unknown: &Self::Unknown,
        update: &mut Self::Unknown,
        factors: &mut Self::Matrix,
    ) -> (S, S::Mask) {
        newton_update(self, unknown, update, factors)
    }
    /// What an iteration with a Jacobian costs, in evaluations of [`Equation::approach`]: [`Equation::linearize`],
    /// [`Equation::factor`] and [`Equation::solve`]. Decides whether iterations without one are tried. The default is
    /// that of n unknowns whose elimination is written out.
    fn jacobian_cost(&self) -> f64 {
        elimination_cost(self.zero_unknown().len())
    }
    /// The state at the end of the step for a solution u.
    fn result(&mut self, unknown: &Self::Unknown, mu: &mut Self::State);
    /// The lanes in which the step is what the method promises, for a solution u and the state at its
    /// end. Others are refused: a quadrature may not resolve the Hamiltonian along the step.
    fn resolved(&mut self, _unknown: &Self::Unknown, _end: &Self::State) -> S::Mask {
        S::Mask::splat(true)
    }
    /// The lanes in which a path joins the group element of a step, for a solution u, to the identity: the group
    /// elements of s times its algebra element, 0 <= s <= 1. In others the step is refused: beyond a pole of
    /// the Cayley map, or of a method that is a rational function, it may leave the coadjoint orbit.
    fn within_chart(&mut self, _unknown: &Self::Unknown) -> S::Mask {
        S::Mask::splat(true)
    }
    /// For a solution u of a method of coadjoint form whose step is by two elements, `mu1 = Ad*_(tau(xi)) Ad*_(sigma(eta)) mu`: writes eta
    /// and returns the retraction sigma of the one that comes first; [`group_factor`](Self::group_factor) has the other. None of other methods.
    fn earlier_factor(
        &mut self,
        _unknown: &Self::Unknown,
        _eta: &mut Self::State,
    ) -> Option<Retraction> {
        None
    }
    /// For a solution u of a method of coadjoint form, `mu1 = Ad*_(tau(xi)) mu`: writes xi and
    /// returns the retraction tau. None of other methods.
    fn group_factor(
        &mut self,
        _unknown: &Self::Unknown,
        _xi: &mut Self::State,
    ) -> Option<Retraction> {
        None
    }
    /// For a solution u of any other method: writes `h xi` of a stage, and returns the number of stages of the
    /// Gauss method that the step applies to `g' = g xi(t)`; 0 where that is not known.
    fn velocity(
        &mut self,
        _unknown: &Self::Unknown,
        _stage: usize,
        _xi: &mut Self::State,
    ) -> usize {
        0
    }
}

/// [`Equation::newton_update`] by its parts.
#[inline(always)]
pub fn newton_update<S: Scalar, E: Equation<S> + ?Sized>(
    equation: &mut E,
    unknown: &E::Unknown,
    update: &mut E::Unknown,
    factors: &mut E::Matrix,
) -> (S, S::Mask) {
    equation.linearize(unknown, update, factors);
    let residual = equation.norm(update);
    let safe = equation.factor(factors);
    equation.solve(factors, update);
    (residual, safe)
}

/// What an iteration with a Jacobian of so many unknowns costs, `1.5 + n^2/20` evaluations of the residual, as counted of equations whose
/// elimination is written out.
pub(crate) fn elimination_cost(unknowns: usize) -> f64 {
    let size = unknowns as f64;
    1.5 + size * size / 20.0
}

/// A borrowed equation, whose type may be forgotten: what solves it is compiled for its unknown alone.
impl<S: Scalar, E: Equation<S> + ?Sized> Equation<S> for &mut E {
    type State = E::State;
    type Unknown = E::Unknown;
    type Matrix = E::Matrix;

    fn zero_unknown(&self) -> Self::Unknown {
        (**self).zero_unknown()
    }
    fn zero_matrix(&self) -> Self::Matrix {
        (**self).zero_matrix()
    }
    fn set_base(&mut self, mu: &Self::State) {
        (**self).set_base(mu);
    }
    fn scale(&self, mu: &Self::State) -> S {
        (**self).scale(mu)
    }
    fn clock(&self) -> Option<Clock> {
        (**self).clock()
    }
    fn norm(&self, unknown: &Self::Unknown) -> S {
        (**self).norm(unknown)
    }
    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        (**self).initial_guess(unknown);
    }
    fn leave_out(&self, unknown: &mut Self::Unknown) {
        (**self).leave_out(unknown);
    }
    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        (**self).residual(unknown, residual);
    }
    fn approach(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        active: S::Mask,
    ) -> S {
        (**self).approach(unknown, residual, active)
    }
    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        (**self).linearize(unknown, residual, matrix);
    }
    fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
        (**self).factor(matrix)
    }
    fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
        (**self).solve(factors, residual);
    }
    fn newton_update(
        &mut self,
        unknown: &Self::Unknown,
        update: &mut Self::Unknown,
        factors: &mut Self::Matrix,
    ) -> (S, S::Mask) {
        (**self).newton_update(unknown, update, factors)
    }
    fn jacobian_cost(&self) -> f64 {
        (**self).jacobian_cost()
    }
    fn result(&mut self, unknown: &Self::Unknown, mu: &mut Self::State) {
        (**self).result(unknown, mu);
    }
    fn resolved(&mut self, unknown: &Self::Unknown, end: &Self::State) -> S::Mask {
        (**self).resolved(unknown, end)
    }
    fn within_chart(&mut self, unknown: &Self::Unknown) -> S::Mask {
        (**self).within_chart(unknown)
    }
    fn earlier_factor(
        &mut self,
        unknown: &Self::Unknown,
        eta: &mut Self::State,
    ) -> Option<Retraction> {
        (**self).earlier_factor(unknown, eta)
    }
    fn group_factor(
        &mut self,
        unknown: &Self::Unknown,
        xi: &mut Self::State,
    ) -> Option<Retraction> {
        (**self).group_factor(unknown, xi)
    }
    fn velocity(&mut self, unknown: &Self::Unknown, stage: usize, xi: &mut Self::State) -> usize {
        (**self).velocity(unknown, stage, xi)
    }
}

/// The equation of one step of the implicit method M for a system.
///
/// The generated code returns a fused equation for the methods that the declaration asks for, and
/// the generic one of [`crate::generic`] for all others; by hand, `generic_equations!`
/// implements it with the generic ones.
#[diagnostic::on_unimplemented(
    message = "the system `{Self}` has no equation for a step of `{M}` over the scalar `{S}`",
    note = "either it lacks what the method needs (`lie check` says which methods apply, and why others do not), or it is written by hand: then see `lie_runtime::generic_equations!`"
)]
pub trait Implicit<S: Scalar, M>: Poisson<S> {
    /// The equation; it may borrow the system.
    type Equation<'a>: Equation<S, State = Self::State>
    where
        Self: 'a;
    /// The equation of a step of size h.
    fn equation<'a>(&'a self, method: &M, h: S) -> Self::Equation<'a>;
}
