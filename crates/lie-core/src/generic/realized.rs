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
/// Gradient `J'^T grad H`, Hessian `J'^T H'' J' + sum_k (dH/dmu_k) J_k''`, both at `mu = J(z)`; the generator and its derivative alike.
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

impl<P> Canonical<'_, P> {
    /// The pullback of a vector in the algebra at `J(z)`.
    fn pulled_back<S: Scalar>(
        &self,
        z: &P::Point,
        vector: impl Fn(&P, &P::State, &mut P::State),
        out: &mut P::Point,
    ) where
        P: RealizedPoisson<S>,
    {
        let (mut mu, mut xi) = (self.system.zero_state(), self.system.zero_state());
        self.system.momentum_map(z, &mut mu);
        vector(self.system, &mu, &mut xi);
        self.system.pullback(z, &xi, out);
    }

    /// The derivative of a pullback, from the vector and its derivative in mu.
    fn slope<S: Scalar>(
        &self,
        z: &P::Point,
        vector: impl Fn(&P, &P::State, &mut P::State),
        derivative: impl Fn(&P, &P::State, &mut P::Jacobian),
        out: &mut P::PointMatrix,
    ) where
        P: RealizedPoisson<S>,
    {
        let system = self.system;
        let (mut mu, mut xi) = (system.zero_state(), system.zero_state());
        system.momentum_map(z, &mut mu);
        vector(system, &mu, &mut xi);
        system.curvature(z, &xi, out);
        let mut second = system.zero_jacobian();
        derivative(system, &mu, &mut second);
        let (mut unit, mut column) = (system.zero_point(), system.zero_point());
        let (mut moved, mut turned) = (system.zero_state(), system.zero_state());
        for j in 0..system.point_dimension() {
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
        self.pulled_back(z, |system, mu, xi| system.gradient(mu, xi), out);
    }

    fn hessian(&self, z: &P::Point, out: &mut P::PointMatrix) {
        self.slope(
            z,
            |system, mu, xi| system.gradient(mu, xi),
            |system, mu, second| system.hessian(mu, second),
            out,
        );
    }

    fn is_damped(&self) -> bool {
        self.system.is_damped()
    }

    fn generator(&self, z: &P::Point, out: &mut P::Point) {
        self.pulled_back(z, |system, mu, xi| system.generator(mu, xi), out);
    }

    fn generator_slope(&self, z: &P::Point, out: &mut P::PointMatrix) {
        self.slope(
            z,
            |system, mu, xi| system.generator(mu, xi),
            |system, mu, second| system.generator_slope(mu, second),
            out,
        );
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
        self.generator(z, &mut slope);
        let half = self.system.point_dimension() / 2;
        for i in 0..half {
            out.as_mut_slice()[i] = slope.as_slice()[half + i];
            out.as_mut_slice()[half + i] = -slope.as_slice()[i];
        }
    }

    fn jacobian(&self, z: &P::Point, out: &mut P::PointMatrix) {
        let mut second = self.zero_jacobian();
        self.generator_slope(z, &mut second);
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
mod tests;
