// A system on so(3)* with the Hamiltonian `x^2/2 + y^2 + x^4/4 + x y^2 z`, whose degree it may keep
// to itself.

use lie_runtime::{LiePoisson, Poisson, Scalar};
use nalgebra::{SMatrix, SVector};

/// No parameters; the degree of H is known or not.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quartic<const KNOWN: bool>;

impl<S: Scalar, const KNOWN: bool> Poisson<S> for Quartic<KNOWN> {
    type State = SVector<S, 3>;
    type Jacobian = SMatrix<S, 3, 3>;
    facts!(S, "Quartic", ["x", "y", "z"], ["C"]);
    fn hamiltonian_degree(&self) -> Option<u32> {
        if KNOWN { Some(4) } else { None }
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
    so3_poisson!(S);
}

impl<S: Scalar, const KNOWN: bool> LiePoisson<S> for Quartic<KNOWN> {
    so3_algebra!(S);
}

lie_runtime::generic_equations!([S: Scalar, const KNOWN: bool] Quartic<KNOWN>, S: midpoint, discrete_gradients, orbit_energy, cohen_hairer);
