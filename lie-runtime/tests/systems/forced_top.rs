// The heavy top with a force on all six coordinates, and a double bracket with a metric that couples momenta and the vertical. No time is
// in it.

use super::heavy_top::HeavyTop;
use lie_runtime::{CayleyPoisson, LiePoisson, Poisson};
use nalgebra::{SMatrix, SVector};

type Vector = SVector<f64, 6>;
type Matrix = SMatrix<f64, 6, 6>;

/// No parameters.
#[derive(Clone, Copy, Debug, Default)]
pub struct ForcedTop;

fn top() -> HeavyTop {
    HeavyTop::default()
}

impl Poisson<f64> for ForcedTop {
    type State = Vector;
    type Jacobian = Matrix;
    facts!(
        f64,
        "ForcedTop",
        ["m1", "m2", "m3", "g1", "g2", "g3"],
        ["length", "area"]
    );
    fn hamiltonian(&self, mu: &Vector) -> f64 {
        top().hamiltonian(mu)
    }
    fn gradient(&self, mu: &Vector, out: &mut Vector) {
        top().gradient(mu, out);
    }
    fn hessian(&self, mu: &Vector, out: &mut Matrix) {
        top().hessian(mu, out);
    }
    fn poisson_matrix(&self, mu: &Vector, out: &mut Matrix) {
        top().poisson_matrix(mu, out);
    }
    fn jacobian(&self, mu: &Vector, out: &mut Matrix) {
        lie_runtime::generic::jacobian(self, mu, out);
    }
    fn is_forced(&self) -> bool {
        true
    }
    fn force(&self, mu: &Vector, out: &mut Vector) {
        *out = Vector::zeros();
        for k in 0..6 {
            let next = (k + 1) % 6;
            out[k] = mu[k] * mu[next] / 7.0 - mu[k] / 5.0 + mu[(k + 2) % 6].sin() / 9.0;
        }
    }
    fn force_slope(&self, mu: &Vector, out: &mut Matrix) {
        *out = Matrix::zeros();
        for k in 0..6 {
            let (next, last) = ((k + 1) % 6, (k + 2) % 6);
            out[(k, k)] = mu[next] / 7.0 - 0.2;
            out[(k, next)] = mu[k] / 7.0;
            out[(k, last)] = mu[last].cos() / 9.0;
        }
    }
    fn is_damped(&self) -> bool {
        true
    }
    fn damping(&self, _mu: &Vector, v: &Vector, out: &mut Vector) {
        for k in 0..6 {
            out[k] = 0.3 * (v[k] + 0.2 * v[(k + 3) % 6]);
        }
    }
    fn casimirs(&self, mu: &Vector, out: &mut [f64]) {
        top().casimirs(mu, out);
    }
    fn casimir_gradient(&self, index: usize, mu: &Vector, out: &mut Vector) {
        top().casimir_gradient(index, mu, out);
    }
}

impl LiePoisson<f64> for ForcedTop {}

impl CayleyPoisson<f64> for ForcedTop {
    fn triple(&self, x: &Vector, z: &Vector, mu: &Vector, out: &mut Vector) {
        top().triple(x, z, mu, out);
    }
}

lie_runtime::generic_equations!([] ForcedTop, f64: gauss6, exp, cayley, gonzalez, orbit_gonzalez, cohen_hairer4);
