// Systems by a Lagrangian that is not quadratic in the velocity, written by hand; their Hamiltonians come from
// Newton's iteration.

use super::rigid_body::{dot, hat};
use lie_runtime::lagrangian::legendre;
use lie_runtime::{
    CayleyPoisson, CotangentPoisson, LagrangianPoisson, LiePoisson, Lift, Poisson, Scalar, generic,
};
use nalgebra::{SMatrix, SVector};

/// `l = x^2 + y^2/2 + z^2/3 + x^4/10 + y^2 z^2/5` on so(3).
#[derive(Clone, Copy, Debug, Default)]
pub struct QuarticBody;

/// `l = x^2 + y^2/2 + x y/3 + y^4/5` on aff(1), `[e1, e2] = e2`.
#[derive(Clone, Copy, Debug, Default)]
pub struct QuarticLine;

macro_rules! by_newton {
    ($system:ident, $n:literal, $name:literal, $coordinates:expr, $casimirs:expr, $matrix:expr) => {
        impl<S: Scalar> Poisson<S> for $system {
            type State = SVector<S, $n>;
            type Jacobian = SMatrix<S, $n, $n>;
            facts!(S, $name, $coordinates, $casimirs);
            fn hamiltonian(&self, mu: &Self::State) -> S {
                legendre::hamiltonian(self, mu)
            }
            fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
                legendre::velocity(self, mu, out);
            }
            fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
                legendre::hessian(self, mu, out);
            }
            fn poisson_matrix(&self, mu: &Self::State, out: &mut Self::Jacobian) {
                *out = $matrix(mu);
            }
            fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
                generic::jacobian(self, mu, out);
            }
            fn casimirs(&self, mu: &Self::State, out: &mut [S]) {
                for out in out {
                    *out = dot(mu.as_slice(), mu.as_slice());
                }
            }
            fn casimir_gradient(&self, _index: usize, mu: &Self::State, out: &mut Self::State) {
                *out = mu + mu;
            }
        }

        impl<S: Scalar> Lift<S> for $system {
            type Lifted = Self;
            fn lift(&self) -> Self {
                *self
            }
        }

        lie_runtime::generic_equations!([S: Scalar] $system, S: midpoint, gauss4, gauss6, exp, generating, variational);
    };
}

fn line_matrix<S: Scalar>(mu: &SVector<S, 2>) -> SMatrix<S, 2, 2> {
    SMatrix::<S, 2, 2>::new(S::zero(), -mu[1], mu[1], S::zero())
}

by_newton!(
    QuarticBody,
    3,
    "QuarticBody",
    ["x", "y", "z"],
    ["C"],
    |mu: &SVector<S, 3>| hat(mu.as_slice())
);
by_newton!(QuarticLine, 2, "QuarticLine", ["a", "b"], [], line_matrix);
lie_runtime::generic_equations!([S: Scalar] QuarticBody, S: cayley, variational_cayley);

impl<S: Scalar> LiePoisson<S> for QuarticBody {
    so3_algebra!(S);
}

impl<S: Scalar> CayleyPoisson<S> for QuarticBody {
    so3_cayley!(S);
}

impl<S: Scalar> LagrangianPoisson<S> for QuarticBody {
    fn lagrangian(&self, xi: &SVector<S, 3>) -> S {
        let [x, y, z] = [xi[0] * xi[0], xi[1] * xi[1], xi[2] * xi[2]];
        let (half, third) = (S::ratio(1.0, 2.0), S::ratio(1.0, 3.0));
        x + half * y + third * z + S::ratio(1.0, 10.0) * x * x + S::ratio(1.0, 5.0) * y * z
    }
    fn momentum(&self, xi: &SVector<S, 3>, out: &mut SVector<S, 3>) {
        let (x, y, z) = (xi[0], xi[1], xi[2]);
        let (two_fifths, two) = (S::ratio(2.0, 5.0), S::from_f64(2.0));
        out[0] = two * x + two_fifths * x * x * x;
        out[1] = y + two_fifths * y * z * z;
        out[2] = S::ratio(2.0, 3.0) * z + two_fifths * y * y * z;
    }
    fn inertia(&self, xi: &SVector<S, 3>, out: &mut SMatrix<S, 3, 3>) {
        let (x, y, z) = (xi[0], xi[1], xi[2]);
        let two_fifths = S::ratio(2.0, 5.0);
        let zero = S::zero();
        let mixed = S::ratio(4.0, 5.0) * y * z;
        *out = SMatrix::<S, 3, 3>::new(
            S::from_f64(2.0) + S::ratio(6.0, 5.0) * x * x,
            zero,
            zero,
            zero,
            S::one() + two_fifths * z * z,
            mixed,
            zero,
            mixed,
            S::ratio(2.0, 3.0) + two_fifths * y * y,
        );
    }
}

/// Momenta alone: nothing is beside them.
impl<S: Scalar> CotangentPoisson<S> for QuarticBody {
    momenta!(S, 3);
}

impl<S: Scalar> LiePoisson<S> for QuarticLine {
    fn ad(&self, xi: &SVector<S, 2>, eta: &SVector<S, 2>, out: &mut SVector<S, 2>) {
        *out = SVector::from([S::zero(), xi[0] * eta[1] - xi[1] * eta[0]]);
    }
    fn ad_star(&self, xi: &SVector<S, 2>, mu: &SVector<S, 2>, out: &mut SVector<S, 2>) {
        *out = SVector::from([-xi[1] * mu[1], xi[0] * mu[1]]);
    }
    fn ad_star_matrix(&self, xi: &SVector<S, 2>, out: &mut SMatrix<S, 2, 2>) {
        *out = SMatrix::<S, 2, 2>::new(S::zero(), -xi[1], S::zero(), xi[0]);
    }
}

impl<S: Scalar> LagrangianPoisson<S> for QuarticLine {
    fn lagrangian(&self, xi: &SVector<S, 2>) -> S {
        let (x, y) = (xi[0], xi[1]);
        let (half, third) = (S::ratio(1.0, 2.0), S::ratio(1.0, 3.0));
        x * x + half * y * y + third * x * y + S::ratio(1.0, 5.0) * y * y * y * y
    }
    fn momentum(&self, xi: &SVector<S, 2>, out: &mut SVector<S, 2>) {
        let (x, y) = (xi[0], xi[1]);
        let third = S::ratio(1.0, 3.0);
        out[0] = x + x + third * y;
        out[1] = y + third * x + S::ratio(4.0, 5.0) * y * y * y;
    }
    fn inertia(&self, xi: &SVector<S, 2>, out: &mut SMatrix<S, 2, 2>) {
        let third = S::ratio(1.0, 3.0);
        let last = S::one() + S::ratio(12.0, 5.0) * xi[1] * xi[1];
        *out = SMatrix::<S, 2, 2>::new(S::from_f64(2.0), third, third, last);
    }
}

/// `l'(xi)` at `xi = (0.4, 0.5, 0.7)`.
pub const BODY: [f64; 3] = [0.8256, 0.598, 161.0 / 300.0];
/// `l'(xi)` at `xi = (0.3, 0.4)`.
pub const LINE: [f64; 2] = [11.0 / 15.0, 0.5512];
