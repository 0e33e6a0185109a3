// A Lagrangian on so(3) that is not convex, `l = u^2/2 - u^4/4 + u^6/20 + v^2 + 3 w^2/2`. Its first momentum
// `u - u^3 + 3 u^5/10` has folds at u = 0.650 (0.410) and u = 1.256 (0.213): between these momenta there are three
// velocities, beyond them one.

use lie_runtime::lagrangian::legendre;
use lie_runtime::{LagrangianPoisson, LiePoisson, Lift, Poisson, Scalar};
use nalgebra::{SMatrix, SVector};

/// A velocity of the branch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Folded<S>(pub Option<SVector<S, 3>>);

impl<S: Scalar> Poisson<S> for Folded<S> {
    type State = SVector<S, 3>;
    type Jacobian = SMatrix<S, 3, 3>;
    facts!(S, "Folded", ["x", "y", "z"], ["C"]);
    fn following(&self, mu: &Self::State) -> Option<Self> {
        legendre::follow(self, mu).map(|velocity| Self(Some(velocity)))
    }
    fn hamiltonian(&self, mu: &Self::State) -> S {
        legendre::hamiltonian(self, mu)
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        legendre::velocity(self, mu, out);
    }
    fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        legendre::hessian(self, mu, out);
    }
    so3_poisson!(S);
}

impl<S: Scalar> LiePoisson<S> for Folded<S> {
    so3_algebra!(S);
}

impl<S: Scalar> LagrangianPoisson<S> for Folded<S> {
    fn lagrangian(&self, xi: &Self::State) -> S {
        let u = xi[0] * xi[0];
        let first = u * (S::ratio(1.0, 2.0) - u * (S::ratio(1.0, 4.0) - u * S::ratio(1.0, 20.0)));
        first + xi[1] * xi[1] + S::ratio(3.0, 2.0) * xi[2] * xi[2]
    }
    fn momentum(&self, xi: &Self::State, out: &mut Self::State) {
        let u = xi[0] * xi[0];
        out[0] = xi[0] * (S::one() - u * (S::one() - u * S::ratio(3.0, 10.0)));
        out[1] = S::from_f64(2.0) * xi[1];
        out[2] = S::from_f64(3.0) * xi[2];
    }
    fn inertia(&self, xi: &Self::State, out: &mut Self::Jacobian) {
        let u = xi[0] * xi[0];
        *out = SMatrix::<S, 3, 3>::repeat(S::zero());
        out[(0, 0)] = S::one() - u * (S::from_f64(3.0) - u * S::ratio(3.0, 2.0));
        out[(1, 1)] = S::from_f64(2.0);
        out[(2, 2)] = S::from_f64(3.0);
    }
    fn branch(&self) -> Option<Self::State> {
        self.0
    }
}

impl<S: Scalar> Lift<S> for Folded<S> {
    type Lifted = Folded<lie_runtime::Dual<S>>;
    fn lift(&self) -> Self::Lifted {
        Folded(
            self.0
                .map(|branch| branch.map(lie_runtime::Dual::constant_of)),
        )
    }
}

lie_runtime::generic_equations!([S: Scalar] Folded<S>, S: midpoint, gauss4, gauss6, exp, generating, variational);
