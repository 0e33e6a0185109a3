//! A system over its realization: the canonical system of `H o J`, and points over a state.

use crate::matrix::SquareMatrix;
use crate::newton::dense;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;
use crate::structure::RealizedPoisson;

/// Iterations of a lift; it converges quadratically from the last point.
const ITERATIONS: usize = 40;
/// A lift is one if the state over it differs by so many units of round-off.
const CLOSE: f64 = 64.0;

/// The canonical Hamiltonian system of `H o J` on the points z = (q, p) of a realization J.
///
/// Gradient `J'^T grad H`, Hessian `J'^T H'' J' + sum_k (dH/dmu_k) J_k''`, both at `mu = J(z)`.
#[derive(Debug)]
pub struct Canonical<'a, P> {
    system: &'a P,
}

impl<'a, P> Canonical<'a, P> {
    /// The canonical system over a system.
    pub fn new(system: &'a P) -> Self {
        Self { system }
    }
}

impl<S: Scalar, P: RealizedPoisson<S>> Poisson<S> for Canonical<'_, P> {
    type State = P::Point;
    type Jacobian = P::PointMatrix;

    fn dimension(&self) -> usize {
        self.system.point_dimension()
    }
    fn name(&self) -> &str {
        self.system.name()
    }
    fn coordinate(&self, index: usize) -> &str {
        self.system.canonical_name(index)
    }
    fn poisson_degree(&self) -> Option<u32> {
        Some(0)
    }

    fn zero_state(&self) -> P::Point {
        self.system.zero_point()
    }

    fn zero_jacobian(&self) -> P::PointMatrix {
        self.system.zero_point_matrix()
    }

    fn hamiltonian(&self, z: &P::Point) -> S {
        let mut mu = self.system.zero_state();
        self.system.momentum_map(z, &mut mu);
        self.system.hamiltonian(&mu)
    }

    fn gradient(&self, z: &P::Point, out: &mut P::Point) {
        let (mut mu, mut slope) = (self.system.zero_state(), self.system.zero_state());
        self.system.momentum_map(z, &mut mu);
        self.system.gradient(&mu, &mut slope);
        self.system.pullback(z, &slope, out);
    }

    fn hessian(&self, z: &P::Point, out: &mut P::PointMatrix) {
        let system = self.system;
        let (mut mu, mut slope) = (system.zero_state(), system.zero_state());
        system.momentum_map(z, &mut mu);
        system.gradient(&mu, &mut slope);
        system.curvature(z, &slope, out);
        let mut second = system.zero_jacobian();
        system.hessian(&mu, &mut second);
        let (mut unit, mut column) = (system.zero_point(), system.zero_point());
        let (mut moved, mut turned) = (system.zero_state(), system.zero_state());
        for j in 0..self.system.point_dimension() {
            unit.fill(S::zero());
            unit.as_mut_slice()[j] = S::one();
            system.pushforward(z, &unit, &mut moved);
            super::multiply(&second, &moved, &mut turned);
            system.pullback(z, &turned, &mut column);
            for (i, &entry) in column.as_slice().iter().enumerate() {
                out.set(i, j, out.get(i, j) + entry);
            }
        }
    }

    fn poisson_matrix(&self, _z: &P::Point, out: &mut P::PointMatrix) {
        let half = self.system.point_dimension() / 2;
        for i in 0..self.system.point_dimension() {
            for j in 0..self.system.point_dimension() {
                let sign = if j == i + half {
                    S::one()
                } else if i == j + half {
                    -S::one()
                } else {
                    S::zero()
                };
                out.set(i, j, sign);
            }
        }
    }

    fn poisson_slope(&self, _z: &P::Point, _xi: &P::Point, out: &mut P::PointMatrix) {
        for i in 0..self.system.point_dimension() {
            for j in 0..self.system.point_dimension() {
                out.set(i, j, S::zero());
            }
        }
    }

    fn vector_field(&self, z: &P::Point, out: &mut P::Point) {
        let mut slope = self.zero_state();
        self.gradient(z, &mut slope);
        let half = self.system.point_dimension() / 2;
        for i in 0..half {
            out.as_mut_slice()[i] = slope.as_slice()[half + i];
            out.as_mut_slice()[half + i] = -slope.as_slice()[i];
        }
    }

    fn jacobian(&self, z: &P::Point, out: &mut P::PointMatrix) {
        let mut second = self.zero_jacobian();
        self.hessian(z, &mut second);
        let half = self.system.point_dimension() / 2;
        for j in 0..self.system.point_dimension() {
            for i in 0..half {
                out.set(i, j, second.get(half + i, j));
                out.set(half + i, j, -second.get(i, j));
            }
        }
    }

    fn casimirs(&self, _z: &P::Point, _out: &mut [S]) {}

    fn casimir_gradient(&self, _index: usize, _z: &P::Point, out: &mut P::Point) {
        out.fill(S::zero());
    }
}

/// Space for lifts; made once so that a step allocates nothing.
#[derive(Clone, Debug)]
pub struct Lifting<V, M, Z> {
    over: V,
    gap: V,
    unit: V,
    column: V,
    matrix: M,
    step: Z,
}

impl<V, M, Z> Lifting<V, M, Z> {
    /// The space for a system.
    pub fn new<S, P>(system: &P) -> Self
    where
        S: Scalar,
        V: State<S>,
        P: RealizedPoisson<S, State = V, Jacobian = M, Point = Z>,
    {
        let zero = system.zero_state();
        Self {
            over: zero.clone(),
            gap: zero.clone(),
            unit: zero.clone(),
            column: zero,
            matrix: system.zero_jacobian(),
            step: system.zero_point(),
        }
    }

    /// What counts as round-off in `J(z) - mu`: units of the size of mu and of the terms of J at z.
    fn round_off<S, P>(&mut self, system: &P, mu: &V, z: &Z) -> S
    where
        S: Scalar,
        V: State<S>,
        Z: State<S>,
        P: RealizedPoisson<S, State = V, Jacobian = M, Point = Z>,
    {
        let mut size = mu.max_norm();
        for k in 0..system.dimension() {
            self.unit.fill(S::zero());
            self.unit.as_mut_slice()[k] = S::one();
            system.pullback(z, &self.unit, &mut self.step);
            let mut terms = S::zero();
            for (&slope, &z) in self.step.as_slice().iter().zip(z.as_slice()) {
                terms += (slope * z).abs();
            }
            size = size.max(terms);
        }
        S::from_f64(CLOSE) * S::epsilon() * size
    }

    /// Scales a point so that the state over it has the size of mu, if J is homogeneous of degree two.
    pub fn scale<S, P>(&mut self, system: &P, mu: &V, z: &mut Z)
    where
        S: Scalar,
        V: State<S>,
        Z: State<S>,
        P: RealizedPoisson<S, State = V, Jacobian = M, Point = Z>,
    {
        system.momentum_map(z, &mut self.over);
        let ratio = (mu.max_norm() / self.over.max_norm()).sqrt();
        let usable = ratio.finite() & S::zero().less(ratio);
        for entry in z.as_mut_slice() {
            *entry = S::select(usable, *entry * ratio, *entry);
        }
    }

    /// Moves z to a point over mu, `J(z) = mu`, the nearest one to first order: `z += J'^T (J' J'^T)^-1 (mu - J(z))`.
    /// Returns the lanes in which there is one.
    pub fn lift<S, P>(&mut self, system: &P, mu: &V, z: &mut Z) -> S::Mask
    where
        S: Scalar,
        V: State<S>,
        M: SquareMatrix<S>,
        Z: State<S>,
        P: RealizedPoisson<S, State = V, Jacobian = M, Point = Z>,
    {
        let mut bound = self.round_off(system, mu, z);
        let mut best = S::from_f64(f64::INFINITY);
        for _ in 0..ITERATIONS {
            system.momentum_map(z, &mut self.over);
            for (index, gap) in self.gap.as_mut_slice().iter_mut().enumerate() {
                *gap = mu.as_slice()[index] - self.over.as_slice()[index];
            }
            let size = self.gap.max_norm();
            let done = size.less_equal(S::zero()) | !size.less(best) | !size.finite();
            // round-off does not get smaller: one more step after it was reached
            if (size.less_equal(bound) & done).all() || (!size.finite()).all() {
                break;
            }
            best = S::select(size.less(best), size, best);
            for k in 0..system.dimension() {
                self.unit.fill(S::zero());
                self.unit.as_mut_slice()[k] = S::one();
                system.pullback(z, &self.unit, &mut self.step);
                system.pushforward(z, &self.step, &mut self.column);
                for (row, &entry) in self.column.as_slice().iter().enumerate() {
                    self.matrix.set(row, k, entry);
                }
            }
            dense::factor(&mut self.matrix);
            dense::solve(&self.matrix, &mut self.gap);
            system.pullback(z, &self.gap, &mut self.step);
            let open = S::zero().less(size);
            for (entry, &step) in z.as_mut_slice().iter_mut().zip(self.step.as_slice()) {
                *entry = S::select(open, *entry + step, *entry);
            }
        }
        bound = bound.max(self.round_off(system, mu, z));
        system.momentum_map(z, &mut self.over);
        let mut distance = S::zero();
        for (&here, &there) in self.over.as_slice().iter().zip(mu.as_slice()) {
            distance = distance.max((here - there).magnitude());
        }
        distance.less_equal(bound)
    }
}

#[cfg(test)]
mod tests {
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
}
