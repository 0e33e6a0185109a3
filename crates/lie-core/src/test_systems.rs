//! Small systems for unit tests.

use crate::poisson::Poisson;
use crate::state::State;
use nalgebra::{SMatrix, SVector};

/// The harmonic oscillator `q' = p`, `p' = -q`: a Poisson system that is not Lie–Poisson.
pub(crate) struct Spring;

impl Poisson<f64> for Spring {
    type State = SVector<f64, 2>;
    type Jacobian = SMatrix<f64, 2, 2>;
    fn dimension(&self) -> usize {
        2
    }
    fn name(&self) -> &str {
        "Spring"
    }
    fn coordinate(&self, index: usize) -> &str {
        ["q", "p"][index]
    }

    fn zero_state(&self) -> Self::State {
        Self::State::repeat(0.0)
    }
    fn zero_jacobian(&self) -> Self::Jacobian {
        Self::Jacobian::repeat(0.0)
    }
    fn hamiltonian(&self, mu: &Self::State) -> f64 {
        0.5 * (mu[0] * mu[0] + mu[1] * mu[1])
    }
    /// Twice H, to be told from it.
    fn energy(&self, mu: &Self::State) -> f64 {
        mu[0] * mu[0] + mu[1] * mu[1]
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        State::copy_from(out, mu);
    }
    fn hessian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = Self::Jacobian::new(1.0, 0.0, 0.0, 1.0);
    }
    fn poisson_matrix(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = Self::Jacobian::new(0.0, 1.0, -1.0, 0.0);
    }
    fn jacobian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = Self::Jacobian::new(0.0, 1.0, -1.0, 0.0);
    }
    fn casimirs(&self, _mu: &Self::State, _out: &mut [f64]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &Self::State, _out: &mut Self::State) {}
}
