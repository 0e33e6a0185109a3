//! The equation of the spherical midpoint method.

use super::rotation::rotation_vector;
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::SpinPoisson;

/// `|mu| / |s|` for the momentum mu of a spin and the sum s of its ends, and `1 / s.s`; 1 and 0 where the sum
/// is zero and mu is, and not a number where only the sum is.
pub fn sphere_ratio<S: Scalar>(mu: [S; 3], sum: [S; 3]) -> [S; 2] {
    let square = |v: [S; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let (start, sum) = (square(mu), square(sum));
    let zero = S::zero();
    let resting = sum.less_equal(zero);
    let divisor = S::select(resting, S::one(), sum);
    let ratio = (start / divisor).sqrt();
    let antipodal = S::select(start.less_equal(zero), S::one(), S::from_f64(f64::NAN));
    [
        S::select(resting, antipodal, ratio),
        S::select(resting, zero, S::one() / divisor),
    ]
}

/// [`sphere_ratio`] of all spins, one after the other; K is twice their number.
pub fn sphere_ratios<S: Scalar, P: SpinPoisson<S>, const K: usize>(
    system: &P,
    mu: &P::State,
    unknown: &P::State,
) -> [S; K] {
    let mut ratios = [S::zero(); K];
    sphere_ratios_into(system, mu.as_slice(), unknown.as_slice(), &mut ratios);
    ratios
}

/// The same into a slice.
pub fn sphere_ratios_into<S: Scalar, P: SpinPoisson<S>>(
    system: &P,
    mu: &[S],
    unknown: &[S],
    ratios: &mut [S],
) {
    for (index, spin) in system.spins().iter().enumerate() {
        let sum = spin.map(|k| (mu[k] + mu[k]) + unknown[k]);
        let of_spin = sphere_ratio(spin.map(|k| mu[k]), sum);
        ratios[2 * index..][..2].copy_from_slice(&of_spin);
    }
}

/// The spherical midpoint method for a direct sum of algebras so(3).
///
/// Unknown: the increment d of the state. Equation: `r(d) = d - h f(w)` with `w = |mu| s/|s|`, `s = 2 mu + d` for each
/// spin, and the vector field f. Jacobian: `1 - h Df(w) dw/dd`, where
/// `dw/dd = (|mu|/|s|) (1 - s s^T/|s|^2)` for each spin. Start: `d = h f(mu)`.
///
/// Coordinates of no spin, which carry the time, its momentum and what is held over a step, have the midpoint `w = mu + d/2`: on the product
/// with the plane of the time that is the midpoint rule over both, and a Poisson map as on the spins alone.
///
/// An iteration ends a part of a unit of round-off early, always on the same side, which would add up: least where it finds
/// increments, whose units are smaller. What is left changes the length by `d.s = 2 mu.d + d.d`, which is 0 in the equation;
/// the result moves d along s until it is.
#[derive(Debug)]
pub struct Spherical<'a, S: Scalar, P: SpinPoisson<S>> {
    system: &'a P,
    step: S,
    base: P::State,
    point: P::State,
    field: P::State,
    jacobian: P::Jacobian,
    /// Whether each coordinate is one of a spin.
    alone: bool,
}

impl<'a, S: Scalar, P: SpinPoisson<S>> Spherical<'a, S, P> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            step: h,
            base: zero.clone(),
            point: zero.clone(),
            field: zero,
            jacobian: system.zero_jacobian(),
            alone: 3 * system.spins().len() == system.dimension(),
        }
    }

    /// The sum of the ends of a spin, and [`sphere_ratio`].
    fn sum(&self, index: usize, unknown: &P::State) -> ([S; 3], [S; 2]) {
        let (mu, unknown) = (self.base.as_slice(), unknown.as_slice());
        let spin = self.system.spins()[index];
        let sum = spin.map(|k| ((mu[k] + mu[k]) + unknown[k]).quantity());
        let ratios = S::given(2 * index, || sphere_ratio(spin.map(|k| mu[k]), sum));
        (sum, ratios)
    }

    /// Sets the point to w.
    fn set_point(&mut self, unknown: &P::State) {
        if !self.alone {
            self.point.copy_from(&self.base);
            self.point.axpy(S::ratio(1.0, 2.0), unknown);
        }
        for (index, spin) in self.system.spins().iter().enumerate() {
            let (sum, [ratio, _]) = self.sum(index, unknown);
            for (k, &coordinate) in spin.iter().enumerate() {
                self.point.as_mut_slice()[coordinate] = (ratio * sum[k]).quantity();
            }
        }
    }

    fn write_residual(&self, unknown: &P::State, residual: &mut P::State) {
        for (row, out) in residual.as_mut_slice().iter_mut().enumerate() {
            let moved = self.step * self.field.as_slice()[row];
            *out = unknown.as_slice()[row] - moved;
        }
    }
}

impl<S: Scalar, P: SpinPoisson<S>> Equation<S> for Spherical<'_, S, P> {
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.field);
        unknown.fill(S::zero());
        unknown.axpy(self.step, &self.field);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set_point(unknown);
        self.system.vector_field(&self.point, &mut self.field);
        self.write_residual(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.set_point(unknown);
        self.system
            .linearize(&self.point, &mut self.field, &mut self.jacobian);
        self.write_residual(unknown, residual);
        if !self.alone {
            let half = S::ratio(1.0, 2.0) * self.step;
            for row in 0..self.system.dimension() {
                for column in 0..self.system.dimension() {
                    let identity = if row == column { S::one() } else { S::zero() };
                    matrix.set(
                        row,
                        column,
                        identity - half * self.jacobian.get(row, column),
                    );
                }
            }
        }
        for (index, spin) in self.system.spins().iter().enumerate() {
            let (sum, [ratio, inverse]) = self.sum(index, unknown);
            let factor = (self.step * ratio).quantity();
            let scaled = sum.map(|entry| (entry * inverse).quantity());
            for row in 0..self.system.dimension() {
                let slopes = spin.map(|k| (factor * self.jacobian.get(row, k)).quantity());
                let along = slopes[0] * sum[0] + slopes[1] * sum[1] + slopes[2] * sum[2];
                let along = along.quantity();
                for (k, &column) in spin.iter().enumerate() {
                    let identity = if row == column { S::one() } else { S::zero() };
                    matrix.set(row, column, identity - (slopes[k] - along * scaled[k]));
                }
            }
        }
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.set_point(unknown);
        self.system.generator(&self.point, &mut self.field);
        if !self.alone {
            xi.fill(S::zero());
            xi.axpy(self.step, &self.field);
        }
        for (index, spin) in self.system.spins().iter().enumerate() {
            // d = ad*_x s/2 with x = 2 h (|mu|/|s|) grad H: the rotation of the quaternion (1, c x/2)
            let (scale, (_, [ratio, _])) = (self.system.scale(index), self.sum(index, unknown));
            let factor = scale * self.step * ratio;
            let axis = spin.map(|k| factor * self.field.as_slice()[k]);
            for (&k, entry) in spin.iter().zip(rotation_vector(S::one(), axis)) {
                xi.as_mut_slice()[k] = entry / scale;
            }
        }
        Some(Retraction::Exp)
    }

    /// `mu + d`, of which the sum `s = 2 mu + d` is orthogonal to d.
    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        let dot = |a: [S; 3], b: [S; 3]| (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).quantity();
        if !self.alone {
            mu.copy_from(&self.base);
            mu.axpy(S::one(), unknown);
        }
        for (index, spin) in self.system.spins().iter().enumerate() {
            let (sum, [_, inverse]) = self.sum(index, unknown);
            let start = spin.map(|k| self.base.as_slice()[k]);
            let moved = spin.map(|k| unknown.as_slice()[k]);
            let along = dot(moved, start);
            let off = ((along + along) + dot(moved, moved)) * inverse;
            let off = off.quantity();
            for (k, &coordinate) in spin.iter().enumerate() {
                let corrected = (moved[k] - off * sum[k]).quantity();
                mu.as_mut_slice()[coordinate] = start[k] + corrected;
            }
        }
    }
}
