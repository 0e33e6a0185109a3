// `H = q^2/2 + log p`, or `q^2/2 + p^2/2`, with canonical brackets, the energy `H + q` to be shown, and a count of
// how often H is evaluated.

use core::cell::Cell;
use lie_runtime::Poisson;
use nalgebra::{SMatrix, SVector};

type Vector = SVector<f64, 2>;
type Matrix = SMatrix<f64, 2, 2>;

/// With H a polynomial or not.
#[derive(Clone, Debug, Default)]
pub struct Logarithmic<const POLYNOMIAL: bool> {
    /// How many values of H were asked for.
    pub values: Cell<u32>,
}

impl<const POLYNOMIAL: bool> Logarithmic<POLYNOMIAL> {
    fn value(mu: &Vector) -> f64 {
        let of_p = if POLYNOMIAL {
            0.5 * mu[1] * mu[1]
        } else {
            mu[1].ln()
        };
        0.5 * mu[0] * mu[0] + of_p
    }
}

impl<const POLYNOMIAL: bool> Poisson<f64> for Logarithmic<POLYNOMIAL> {
    type State = Vector;
    type Jacobian = Matrix;
    facts!(f64, "Logarithmic", ["q", "p"], []);
    fn hamiltonian_degree(&self) -> Option<u32> {
        if POLYNOMIAL { Some(2) } else { None }
    }
    fn hamiltonian(&self, mu: &Vector) -> f64 {
        self.values.set(self.values.get() + 1);
        Self::value(mu)
    }
    fn energy(&self, mu: &Vector) -> f64 {
        Self::value(mu) + mu[0]
    }
    fn gradient(&self, mu: &Vector, out: &mut Vector) {
        let slope = if POLYNOMIAL { mu[1] } else { 1.0 / mu[1] };
        *out = Vector::new(mu[0], slope);
    }
    fn hessian(&self, mu: &Vector, out: &mut Matrix) {
        let curvature = if POLYNOMIAL {
            1.0
        } else {
            -1.0 / (mu[1] * mu[1])
        };
        *out = Matrix::new(1.0, 0.0, 0.0, curvature);
    }
    fn poisson_matrix(&self, _mu: &Vector, out: &mut Matrix) {
        *out = Matrix::new(0.0, 1.0, -1.0, 0.0);
    }
    fn jacobian(&self, mu: &Vector, out: &mut Matrix) {
        let mut hessian = self.zero_jacobian();
        self.hessian(mu, &mut hessian);
        *out = Matrix::new(0.0, 1.0, -1.0, 0.0) * hessian;
    }
    fn casimirs(&self, _mu: &Vector, _out: &mut [f64]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &Vector, _out: &mut Vector) {}
}
