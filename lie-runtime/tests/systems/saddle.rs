// A canonical system with `H = q p + p^2/2 - c q^2/2`: `q' = q + p`, `p' = c q - p`. The matrix of the
// midpoint rule, `1 - (h/2) Df`, has the first pivot `1 - h/2`: zero at h = 2, where the matrix
// is singular only if c is 0.

use lie_runtime::{Poisson, Scalar};
use nalgebra::{SMatrix, SVector};

/// The coefficient c.
#[derive(Clone, Copy, Debug)]
pub struct Saddle<S>(pub S);

impl<S: Scalar> Poisson<S> for Saddle<S> {
    type State = SVector<S, 2>;
    type Jacobian = SMatrix<S, 2, 2>;
    facts!(S, "Saddle", ["q", "p"], []);
    fn hamiltonian(&self, mu: &Self::State) -> S {
        mu[0] * mu[1] + (mu[1] * mu[1] - self.0 * mu[0] * mu[0]) * S::ratio(1.0, 2.0)
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        *out = SVector::<S, 2>::new(mu[1] - self.0 * mu[0], mu[0] + mu[1]);
    }
    fn hessian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = SMatrix::<S, 2, 2>::new(-self.0, S::one(), S::one(), S::one());
    }
    fn poisson_matrix(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = SMatrix::<S, 2, 2>::new(S::zero(), S::one(), -S::one(), S::zero());
    }
    fn jacobian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = SMatrix::<S, 2, 2>::new(S::one(), S::one(), self.0, -S::one());
    }
    fn casimirs(&self, _mu: &Self::State, _out: &mut [S]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &Self::State, _out: &mut Self::State) {}
}

lie_runtime::generic_equations!([S: Scalar] Saddle<S>, S: midpoint, gauss4, gauss6, discrete_gradients, cohen_hairer);
