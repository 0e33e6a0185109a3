// The system of `nonpolynomial.rs` with a double bracket of strength 3/10 and a generic metric. There is no time in it, so that methods
// on spaces over so(3)* apply.

use super::driven_body::metric;
use super::nonpolynomial::Nonpolynomial;
use lie_runtime::{CayleyPoisson, LiePoisson, MatrixPoisson, Poisson, Scalar, SpinPoisson, Widen};
use nalgebra::{SMatrix, SVector};

/// No parameters.
#[derive(Clone, Copy, Debug, Default)]
pub struct DampedBody;

impl<S: Scalar> Poisson<S> for DampedBody {
    type State = SVector<S, 3>;
    type Jacobian = SMatrix<S, 3, 3>;
    facts!(S, "DampedBody", ["x", "y", "z"], ["C"]);
    fn hamiltonian(&self, mu: &Self::State) -> S {
        Nonpolynomial.hamiltonian(mu)
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        Nonpolynomial.gradient(mu, out);
    }
    fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        Nonpolynomial.hessian(mu, out);
    }
    fn is_damped(&self) -> bool {
        true
    }
    fn damping(&self, _mu: &Self::State, v: &Self::State, out: &mut Self::State) {
        let turned = metric([v[0], v[1], v[2]]);
        *out = turned.map(|entry| entry * S::ratio(3.0, 10.0)).into();
    }
    so3_poisson!(S);
}

impl<S: Scalar> LiePoisson<S> for DampedBody {
    so3_algebra!(S);
}

impl<S: Scalar> Widen<S> for DampedBody {
    type Widened = Self;
    fn widen(&self) -> Self::Widened {
        Self
    }
}

impl<S: Scalar> CayleyPoisson<S> for DampedBody {
    so3_cayley!(S);
}

impl<S: Scalar> MatrixPoisson<S> for DampedBody {
    so3_matrices!(S);
}

impl<S: Scalar> SpinPoisson<S> for DampedBody {
    fn spins(&self) -> &[[usize; 3]] {
        &[[0, 1, 2]]
    }
    fn scale(&self, _spin: usize) -> S {
        S::one()
    }
    type Spinors = [S; 4];
    fn zero_spinors(&self) -> [S; 4] {
        [S::zero(); 4]
    }
}

lie_runtime::generic_equations!([S: Scalar] DampedBody, S: midpoint, exp, cayley, isospectral2, isospectral4, isospectral6, hopf, spherical);
lie_runtime::generic_equations!([S: Scalar] DampedBody, S: discrete_gradients, orbit_energy);
