// A system on so(3)* with the Hamiltonian `sin x + exp(y/2) + sqrt(1 + z^2) + x y^2 z`.

use lie_runtime::{CayleyPoisson, LiePoisson, Lift, MatrixPoisson, Poisson, Scalar, SpinPoisson};
use nalgebra::{SMatrix, SVector};

/// No parameters.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nonpolynomial;

impl<S: Scalar> Poisson<S> for Nonpolynomial {
    type State = SVector<S, 3>;
    type Jacobian = SMatrix<S, 3, 3>;
    facts!(S, "Nonpolynomial", ["x", "y", "z"], ["C"]);
    fn hamiltonian(&self, mu: &Self::State) -> S {
        let (x, y, z) = (mu[0], mu[1], mu[2]);
        let root = (S::one() + z * z).sqrt();
        x.sin() + (y * S::ratio(1.0, 2.0)).exp() + root + x * y * y * z
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        let (x, y, z) = (mu[0], mu[1], mu[2]);
        let half = S::ratio(1.0, 2.0);
        out[0] = x.cos() + y * y * z;
        out[1] = (y * half).exp() * half + (x + x) * y * z;
        out[2] = z / (S::one() + z * z).sqrt() + x * y * y;
    }
    fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        let (x, y, z) = (mu[0], mu[1], mu[2]);
        let square = S::one() + z * z;
        let xy = (y + y) * z;
        let yz = (x + x) * y;
        let yy = (y * S::ratio(1.0, 2.0)).exp() * S::ratio(1.0, 4.0) + (x + x) * z;
        let zz = S::one() / (square * square.sqrt());
        *out = SMatrix::<S, 3, 3>::new(-x.sin(), xy, y * y, xy, yy, yz, y * y, yz, zz);
    }
    so3_poisson!(S);
}

impl<S: Scalar> LiePoisson<S> for Nonpolynomial {
    so3_algebra!(S);
}

impl<S: Scalar> Lift<S> for Nonpolynomial {
    type Lifted = Self;
    fn lift(&self) -> Self::Lifted {
        Self
    }
}

impl<S: Scalar> CayleyPoisson<S> for Nonpolynomial {
    so3_cayley!(S);
}

lie_runtime::generic_equations!([S: Scalar] Nonpolynomial, S: midpoint, gauss4, gauss6, exp, cayley, generating, generating_cayley);
lie_runtime::generic_equations!([S: Scalar] Nonpolynomial, S: discrete_gradients, orbit_energy, cohen_hairer);

impl<S: Scalar> MatrixPoisson<S> for Nonpolynomial {
    so3_matrices!(S);
}

impl<S: Scalar> SpinPoisson<S> for Nonpolynomial {
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

lie_runtime::generic_equations!([S: Scalar] Nonpolynomial, S: isospectral2, isospectral4, isospectral6, hopf, spherical);
