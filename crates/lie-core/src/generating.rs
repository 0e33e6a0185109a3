//! Generating functions of Lie–Poisson steps, and the hook by which a system supplies fused ones.

use crate::matrix::SquareMatrix;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The generating function S of a step of fixed size, as its gradient `xi = grad S(p)` and its
/// Hessian. With a retraction `tau` the step is `(d tau_xi^-1)* p = mu`, `mu1 = Ad*_(tau(xi)) mu`.
///
/// The generic functions are [`crate::generic::Generating2`], [`crate::generic::Generating4`],
/// [`crate::generic::Generating6`], [`crate::generic::CayleyGenerating4`] and
/// [`crate::generic::SecondKind2`]; generated code brings fused ones for the methods that a
/// declaration asks for. Functions take `&mut self` so that scratch space may be kept.
pub trait GeneratingFunction<S: Scalar> {
    /// The state of the system.
    type State: State<S>;
    /// An n x n matrix.
    type Jacobian: SquareMatrix<S>;

    /// The gradient: `xi_i = dS/dp_i`.
    fn gradient(&mut self, p: &Self::State, xi: &mut Self::State);
    /// The motion `ad*_xi p` for the gradient xi at p.
    fn motion<P: LiePoisson<S, State = Self::State>>(
        &mut self,
        system: &P,
        p: &Self::State,
        xi: &Self::State,
        out: &mut Self::State,
    ) {
        system.ad_star(xi, p, out);
    }
    /// The gradient and the Hessian: `hessian_ij = d^2S/dp_i dp_j`, every entry.
    fn linearize(&mut self, p: &Self::State, xi: &mut Self::State, hessian: &mut Self::Jacobian);
}
