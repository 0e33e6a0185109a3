//! The equation of Moser and Veselov's discrete rigid body on SO(n).

use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::newton::dense;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};
use crate::structure::{InertiaPoisson, Plane};

/// Terms of the logarithm; it converges where `|X| < 2`.
const LOGARITHM: usize = 200;

/// The discrete rigid body on so(n)* with the symmetric matrix J: `M = J W + W J` for the angular velocity `W = grad H(M)`. In the axes of
/// its moments `H = sum_(i<j) M_ij^2/(2 (J_i + J_j))`.
///
/// The rotation of the step is `g = (1 + X/2)(1 - X/2)^-1` with X antisymmetric, and
/// `h M = g J - J g^T` becomes `X J + J X = h (1 - X/2) M (1 + X/2)`, a polynomial equation in so(n).
///
/// Unknown: `U = (X J + J X)/h`, so that `X = h grad H(U)`. Equation:
/// `r(U) = U - (1 - X/2) M (1 + X/2)`. Jacobian, column c, with the basis element R and
/// `Y = M (1 + X/2)`: `e_c + sum_b (Y^T R_b + R_b Y)/2 h H''_bc`, of which H'' has the diagonal alone in those axes. New state: `g^T M g = M + [P, X]` with
/// `P = (1 + X/2)^-1 M (1 - X/2)^-1`. Start: `U = M + (h/2) f(M)`.
///
/// The solutions near the identity are those with the pivots of `(g J + J g^T)/2` positive, like those of
/// J (its congruent matrix `J + X J X/4` is looked at); where they are not, the new state is not a number.
#[derive(Debug)]
pub struct DiscreteBody<'a, S: Scalar, P: InertiaPoisson<S>> {
    system: &'a P,
    step: S,
    base: P::State,
    direction: P::State,
    hessian: P::Jacobian,
    /// M
    momentum: P::Matrix,
    /// X/2
    rotation: P::Matrix,
    /// `Y = M (1 + X/2)`, and other products
    product: P::Matrix,
    transformed: P::Matrix,
}

impl<'a, S: Scalar, P: InertiaPoisson<S>> DiscreteBody<'a, S, P> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        let matrix = system.zero_matrix();
        Self {
            system,
            step: h,
            base: zero.clone(),
            direction: zero,
            hessian: system.zero_jacobian(),
            momentum: matrix.clone(),
            rotation: matrix.clone(),
            product: matrix.clone(),
            transformed: matrix,
        }
    }

    /// Sets X/2, Y and `(1 - X/2) M (1 + X/2)`.
    fn set(&mut self, unknown: &P::State) {
        self.system.gradient(unknown, &mut self.direction);
        let half = self.step * S::ratio(1.0, 2.0);
        for entry in self.direction.as_mut_slice() {
            *entry = (half * *entry).quantity();
        }
        antisymmetric(self.system, &self.direction, &mut self.rotation);
        let size = self.momentum.dimension();
        for r in 0..size {
            for c in 0..size {
                let mut sum = S::zero();
                for k in 0..size {
                    sum += self.momentum.get(r, k) * self.rotation.get(k, c);
                }
                let entry = self.momentum.get(r, c) + sum;
                self.product.set(r, c, entry.quantity());
            }
        }
        for r in 0..size {
            for c in 0..size {
                let mut sum = S::zero();
                for k in 0..size {
                    sum += self.rotation.get(r, k) * self.product.get(k, c);
                }
                self.transformed.set(r, c, self.product.get(r, c) - sum);
            }
        }
    }

    /// The entry in a plane of `Y^T R + R Y` with the basis element R of another.
    fn turned(&self, turned: &Plane, plane: &Plane) -> S {
        // entry (p, q), R = E_ab - E_ba
        let ((b, a), (q, p)) = (axes(turned), axes(plane));
        let entry = |condition: bool, r: usize, c: usize| {
            if condition {
                self.product.get(r, c)
            } else {
                S::zero()
            }
        };
        let left = entry(q == b, a, p) - entry(q == a, b, p);
        let right = entry(p == a, b, q) - entry(p == b, a, q);
        left + right
    }

    /// `r = U - (1 - X/2) M (1 + X/2)`
    fn write_residual(&self, unknown: &P::State, residual: &mut P::State) {
        let planes = self.system.planes().iter().zip(unknown.as_slice());
        for (out, (plane, &u)) in residual.as_mut_slice().iter_mut().zip(planes) {
            let (from, to) = axes(plane);
            *out = u - self.transformed.get(to, from);
        }
    }

    /// The logarithm of `(1 - X/2)^-1 (1 + X/2)`, `2 artanh(X/2) = X + X^3/12 + X^5/80 + ...`, by its series;
    /// not a number where that does not converge.
    fn logarithm(&mut self, xi: &mut P::State) {
        let size = self.momentum.dimension();
        copy(&self.rotation, &mut self.product);
        xi.fill(S::zero());
        let mut settled = S::Mask::splat(false);
        for term in 0..LOGARITHM {
            let weight = S::ratio(2.0, (2 * term + 1) as f64);
            let mut largest = S::zero();
            for (out, plane) in xi.as_mut_slice().iter_mut().zip(self.system.planes()) {
                let (from, to) = axes(plane);
                let part = weight * self.product.get(to, from);
                largest = largest.max(part.magnitude());
                *out += part;
            }
            settled = largest.less_equal(S::epsilon() * xi.max_norm());
            if settled.all() {
                break;
            }
            // (X/2)^(2 k + 1) to (X/2)^(2 k + 3)
            for _ in 0..2 {
                for r in 0..size {
                    for c in 0..size {
                        let mut sum = S::zero();
                        for k in 0..size {
                            sum += self.rotation.get(r, k) * self.product.get(k, c);
                        }
                        self.transformed.set(r, c, sum);
                    }
                }
                copy(&self.transformed, &mut self.product);
            }
        }
        for entry in xi.as_mut_slice() {
            *entry = S::select(settled, *entry, S::from_f64(f64::NAN));
        }
    }

    /// 0 where the pivots of `J + X J X/4` have the signs of those of J, and not a number elsewhere.
    fn off_the_branch(&mut self) -> S {
        let size = self.momentum.dimension();
        let tilted = self.system.is_tilted();
        // a body that is flat along an axis has pivots that are zero, in other axes to round-off: a little is added to all
        let trace = (0..size).fold(S::zero(), |sum, k| sum + self.system.moment(k).abs());
        let little = trace * S::epsilon() * S::ratio(1024.0, 1.0);
        let diagonal = |r, c| if r == c { little } else { S::zero() };
        for r in 0..size {
            for c in 0..size {
                let mut sum = diagonal(r, c);
                for k in 0..size {
                    let moment = self.system.moment(k);
                    sum += self.rotation.get(r, k) * moment * self.rotation.get(k, c);
                    for l in (0..size).filter(|l| tilted && *l != k) {
                        let product = self.system.product(k, l);
                        sum += self.rotation.get(r, k) * product * self.rotation.get(l, c);
                    }
                }
                self.product.set(r, c, self.second_moment(r, c) + sum);
            }
        }
        dense::factor(&mut self.product);
        if tilted {
            for r in 0..size {
                for c in 0..size {
                    self.transformed
                        .set(r, c, self.second_moment(r, c) + diagonal(r, c));
                }
            }
            dense::factor(&mut self.transformed);
        }
        let mut good = S::Mask::splat(true);
        for k in 0..size {
            // inverse pivots have the signs of pivots
            let (sign, flat) = match tilted {
                true => {
                    let inverse = self.transformed.get(k, k);
                    let small = inverse.abs() * little * S::ratio(4.0, 1.0);
                    (inverse, S::one().less_equal(small))
                }
                false => {
                    let moment = self.system.moment(k);
                    (moment, moment.abs().less_equal(S::zero()))
                }
            };
            let same = S::zero().less(sign * self.product.get(k, k));
            good = good & (same | flat);
        }
        S::select(good, S::zero(), S::from_f64(f64::NAN))
    }

    /// `J_rc`
    fn second_moment(&self, r: usize, c: usize) -> S {
        match r == c {
            true => self.system.moment(r),
            false => self.system.product(r, c),
        }
    }
}

impl<S: Scalar, P: InertiaPoisson<S>> Equation<S> for DiscreteBody<'_, S, P> {
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        antisymmetric(self.system, mu, &mut self.momentum);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.direction);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step * S::ratio(1.0, 2.0), &self.direction);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set(unknown);
        self.write_residual(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.set(unknown);
        self.write_residual(unknown, residual);
        self.system.hessian(unknown, &mut self.hessian);
        let half = self.step * S::ratio(1.0, 2.0);
        for (column, turned) in self.system.planes().iter().enumerate() {
            let factor = half * self.hessian.get(column, column);
            for (row, plane) in self.system.planes().iter().enumerate() {
                let identity = if row == column { S::one() } else { S::zero() };
                let mut entry = identity + factor * self.turned(turned, plane);
                if self.system.is_tilted() {
                    for (b, other) in self.system.planes().iter().enumerate() {
                        if b != column {
                            let factor = half * self.hessian.get(b, column);
                            entry += factor * self.turned(other, plane);
                        }
                    }
                }
                matrix.set(row, column, entry);
            }
        }
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.set(unknown);
        self.logarithm(xi);
        Some(Retraction::Exp)
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.set(unknown);
        let poison = self.off_the_branch();
        let size = self.momentum.dimension();
        // the leading minors of 1 + X/2 are at least 1
        for r in 0..size {
            for c in 0..size {
                let identity = if r == c { S::one() } else { S::zero() };
                self.product.set(r, c, identity + self.rotation.get(r, c));
            }
        }
        dense::factor(&mut self.product);
        // P = C M C^T = -C (C M)^T, C the inverse
        copy(&self.momentum, &mut self.transformed);
        solve_columns(&self.product, &mut self.transformed);
        transpose(&mut self.transformed);
        solve_columns(&self.product, &mut self.transformed);
        mu.copy_from(&self.base);
        for (out, plane) in mu.as_mut_slice().iter_mut().zip(self.system.planes()) {
            let (from, to) = axes(plane);
            let mut sum = S::zero();
            for k in 0..size {
                sum += self.rotation.get(to, k) * self.transformed.get(k, from);
                sum -= self.transformed.get(to, k) * self.rotation.get(k, from);
            }
            *out = *out + S::from_f64(2.0) * sum + poison;
        }
    }
}

/// From and to.
fn axes(plane: &Plane) -> (usize, usize) {
    (usize::from(plane.from), usize::from(plane.to))
}

/// `sum_k coordinates_k (E_(to, from) - E_(from, to))`
fn antisymmetric<S: Scalar, P: InertiaPoisson<S>>(
    system: &P,
    coordinates: &P::State,
    out: &mut P::Matrix,
) {
    for (plane, &coordinate) in system.planes().iter().zip(coordinates.as_slice()) {
        let (from, to) = axes(plane);
        out.set(to, from, coordinate);
        out.set(from, to, -coordinate);
    }
}

fn copy<S: Scalar, M: SquareMatrix<S>>(from: &M, to: &mut M) {
    for r in 0..from.dimension() {
        for c in 0..from.dimension() {
            to.set(r, c, from.get(r, c));
        }
    }
}

fn transpose<S: Scalar, M: SquareMatrix<S>>(matrix: &mut M) {
    for r in 0..matrix.dimension() {
        for c in 0..r {
            let (a, b) = (matrix.get(r, c), matrix.get(c, r));
            matrix.set(r, c, b);
            matrix.set(c, r, a);
        }
    }
}

/// Solves `A X = B` in place of B by the factors of A.
fn solve_columns<S: Scalar, M: SquareMatrix<S>>(factors: &M, matrix: &mut M) {
    let size = factors.dimension();
    for column in 0..size {
        for row in 1..size {
            let mut sum = matrix.get(row, column);
            for k in 0..row {
                sum -= factors.get(row, k) * matrix.get(k, column);
            }
            matrix.set(row, column, sum);
        }
        for row in (0..size).rev() {
            let mut sum = matrix.get(row, column);
            for k in row + 1..size {
                sum -= factors.get(row, k) * matrix.get(k, column);
            }
            matrix.set(row, column, sum * factors.get(row, row));
        }
    }
}
