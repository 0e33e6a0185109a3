//! Lifts, and the canonical system over a state.

use super::*;
use crate::generic::multiply;
use nalgebra::{SMatrix, SVector};

type Vector<const N: usize> = SVector<f64, N>;
type Matrix<const N: usize> = SMatrix<f64, N, N>;

/// Two actions `I_k = (q_k^2 + p_k^2)/2`, which are never negative.
struct Actions;

impl Poisson<f64> for Actions {
    type State = Vector<2>;
    type Jacobian = Matrix<2>;
    fn dimension(&self) -> usize {
        2
    }
    fn name(&self) -> &str {
        "Actions"
    }
    fn coordinate(&self, index: usize) -> &str {
        ["I1", "I2"][index]
    }
    fn zero_state(&self) -> Vector<2> {
        Vector::repeat(0.0)
    }
    fn zero_jacobian(&self) -> Matrix<2> {
        Matrix::repeat(0.0)
    }
    fn hamiltonian(&self, mu: &Vector<2>) -> f64 {
        mu[0] * mu[0] + 3.0 * mu[1]
    }
    fn gradient(&self, mu: &Vector<2>, out: &mut Vector<2>) {
        *out = Vector::<2>::new(2.0 * mu[0], 3.0);
    }
    fn hessian(&self, _mu: &Vector<2>, out: &mut Matrix<2>) {
        *out = Matrix::<2>::new(2.0, 0.0, 0.0, 0.0);
    }
    fn poisson_matrix(&self, _mu: &Vector<2>, out: &mut Matrix<2>) {
        *out = Matrix::repeat(0.0);
    }
    fn jacobian(&self, _mu: &Vector<2>, out: &mut Matrix<2>) {
        *out = Matrix::repeat(0.0);
    }
    fn casimirs(&self, _mu: &Vector<2>, _out: &mut [f64]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &Vector<2>, _out: &mut Vector<2>) {}
}

impl RealizedPoisson<f64> for Actions {
    type Point = Vector<4>;
    type PointMatrix = Matrix<4>;
    fn point_dimension(&self) -> usize {
        4
    }
    fn canonical_name(&self, index: usize) -> &str {
        ["q1", "q2", "p1", "p2"][index]
    }
    fn start_is_given(&self) -> bool {
        false
    }
    fn zero_point(&self) -> Vector<4> {
        Vector::repeat(0.0)
    }
    fn zero_point_matrix(&self) -> Matrix<4> {
        Matrix::repeat(0.0)
    }
    fn momentum_map(&self, z: &Vector<4>, out: &mut Vector<2>) {
        for k in 0..2 {
            out[k] = 0.5 * (z[k] * z[k] + z[k + 2] * z[k + 2]);
        }
    }
    fn pullback(&self, z: &Vector<4>, xi: &Vector<2>, out: &mut Vector<4>) {
        for k in 0..4 {
            out[k] = xi[k % 2] * z[k];
        }
    }
    fn pushforward(&self, z: &Vector<4>, v: &Vector<4>, out: &mut Vector<2>) {
        for k in 0..2 {
            out[k] = z[k] * v[k] + z[k + 2] * v[k + 2];
        }
    }
    fn curvature(&self, _z: &Vector<4>, xi: &Vector<2>, out: &mut Matrix<4>) {
        *out = Matrix::from_diagonal(&Vector::<4>::from_fn(|k, _| xi[k % 2]));
    }
    fn start(&self, out: &mut Vector<4>) {
        *out = Vector::<4>::new(0.6, 0.3, -0.2, 0.5);
    }
}

#[test]
fn a_point_lies_over_a_state_or_there_is_none() {
    let lift = |second: f64| {
        let mut z = Actions.zero_point();
        Actions.start(&mut z);
        let mu = Vector::<2>::new(1.0, second);
        let found = Lifting::new(&Actions).lift(&Actions, &mu, &mut z);
        let mut over = Actions.zero_state();
        Actions.momentum_map(&z, &mut over);
        (found, (over - mu).amax())
    };
    for second in [2.0, 0.1, 1e-6, 1e-11] {
        let (found, distance) = lift(second);
        assert!(found && distance < 1e-14, "{second:e}: {distance:e}");
    }
    // an action below 0, by a part of the state that is small and no round-off
    for second in [-1e-13, -1e-12, -1e-11, -1e-3] {
        let (found, distance) = lift(second);
        assert!(!found, "{second:e}: {distance:e}");
    }
}

#[test]
fn the_canonical_system_has_its_derivatives() {
    let system = Canonical::new(&Actions);
    let z = Vector::<4>::new(0.6, 0.3, -0.2, 0.5);
    let (mut field, mut hessian) = (z, system.zero_jacobian());
    system.vector_field(&z, &mut field);
    system.hessian(&z, &mut hessian);
    let mut gradient = z;
    system.gradient(&z, &mut gradient);
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(&z, &mut matrix);
    let mut expected = z;
    multiply(&matrix, &gradient, &mut expected);
    assert!((field - expected).amax() < 1e-15);
    let difference = 1e-5;
    for column in 0..4 {
        let slope = |sign: f64| {
            let (mut place, mut slope) = (z, z);
            place[column] += sign * difference;
            system.gradient(&place, &mut slope);
            slope
        };
        let expected = (slope(1.0) - slope(-1.0)) / (2.0 * difference);
        assert!((hessian.column(column) - expected).amax() < 1e-9);
    }
}
