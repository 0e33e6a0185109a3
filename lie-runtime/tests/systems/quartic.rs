// A system on so(3)* with the Hamiltonian `x^2/2 + y^2 + x^4/4 + x y^2 z`, whose degree it may keep
// to itself.

use super::rigid_body::{cross, dot, hat};
use lie_runtime::{LiePoisson, Poisson, Scalar, generic};
use nalgebra::{SMatrix, SVector};

/// No parameters; the degree of H is known or not.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quartic<const KNOWN: bool>;

impl<S: Scalar, const KNOWN: bool> Poisson<S> for Quartic<KNOWN> {
    type State = SVector<S, 3>;
    type Jacobian = SMatrix<S, 3, 3>;
    fn dimension(&self) -> usize {
        3
    }
    fn casimir_count(&self) -> usize {
        1
    }
    fn name(&self) -> &str {
        "Quartic"
    }
    fn coordinate(&self, index: usize) -> &str {
        ["x", "y", "z"][index]
    }
    fn casimir_name(&self, index: usize) -> &str {
        ["C"][index]
    }
    fn hamiltonian_degree(&self) -> Option<u32> {
        if KNOWN { Some(4) } else { None }
    }

    fn zero_state(&self) -> Self::State {
        SVector::<S, 3>::repeat(S::zero())
    }
    fn zero_jacobian(&self) -> Self::Jacobian {
        SMatrix::<S, 3, 3>::repeat(S::zero())
    }
    fn hamiltonian(&self, mu: &Self::State) -> S {
        let (x, y, z) = (mu[0], mu[1], mu[2]);
        let half = S::ratio(1.0, 2.0);
        half * x * x + y * y + half * half * x * x * x * x + x * y * y * z
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        let (x, y, z) = (mu[0], mu[1], mu[2]);
        out[0] = x + x * x * x + y * y * z;
        out[1] = (y + y) * (S::one() + x * z);
        out[2] = x * y * y;
    }
    fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        let (x, y, z) = (mu[0], mu[1], mu[2]);
        let (one, three) = (S::one(), S::from_f64(3.0));
        let (xy, yz) = ((y + y) * z, (x + x) * y);
        let yy = (one + one) * (one + x * z);
        let xx = one + three * x * x;
        *out = SMatrix::<S, 3, 3>::new(xx, xy, y * y, xy, yy, yz, y * y, yz, S::zero());
    }
    fn poisson_matrix(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        *out = hat(mu.as_slice());
    }
    fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        generic::jacobian(self, mu, out);
    }
    fn casimirs(&self, mu: &Self::State, out: &mut [S]) {
        out[0] = dot(mu.as_slice(), mu.as_slice());
    }
    fn casimir_gradient(&self, _index: usize, mu: &Self::State, out: &mut Self::State) {
        for k in 0..3 {
            out[k] = mu[k] + mu[k];
        }
    }
}

impl<S: Scalar, const KNOWN: bool> LiePoisson<S> for Quartic<KNOWN> {
    fn ad(&self, xi: &SVector<S, 3>, eta: &SVector<S, 3>, out: &mut SVector<S, 3>) {
        *out = cross(xi.as_slice(), eta.as_slice()).into();
    }
    fn ad_star(&self, xi: &SVector<S, 3>, mu: &SVector<S, 3>, out: &mut SVector<S, 3>) {
        *out = cross(mu.as_slice(), xi.as_slice()).into();
    }
    fn ad_star_matrix(&self, xi: &SVector<S, 3>, out: &mut SMatrix<S, 3, 3>) {
        generic::ad_star_matrix(self, xi, out);
    }
}

lie_runtime::generic_equations!([S: Scalar, const KNOWN: bool] Quartic<KNOWN>, S: midpoint, discrete_gradients, orbit_energy, cohen_hairer);
