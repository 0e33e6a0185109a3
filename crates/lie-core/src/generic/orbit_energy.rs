//! The equation of the method that keeps orbit and energy.

use super::discrete_gradient::DiscreteGradient;
use super::series::{Scratch, coadjoint_action_in};
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::LiePoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Terms of the series in the Jacobian beyond which no argument of use goes.
const MAX_TERMS: usize = 60;
/// The series in the Jacobian ends where its terms are below that part of the first. An error e of the
/// Jacobian leaves e times the last update, which itself is below the root of round-off: 2^-30
/// costs no iteration.
const TOLERANCE: f64 = 1.0 / 1_073_741_824.0;
/// A series whose terms rise beyond that many times the first has lost too many digits.
const MAX_RISE: f64 = 1_048_576.0;

/// Coadjoint motion along a discrete gradient, for any Lie algebra.
///
/// Unknown: the new state u. Equation: `r(u) = u - exp(ad*_x) mu` with `x = h g(mu, u)` and the discrete
/// gradient g. New state: `exp(ad*_x) mu`, on the coadjoint orbit of mu to round-off whatever the
/// error of u. Jacobian: `1 - h Pi(mu1) dexp_(-x) dg/du` with `mu1 = exp(ad*_x) mu` and
/// `dexp_(-x) = sum_k (-ad_x)^k/(k + 1)!`; where x is so large that this series has no digits left, 1,
/// which makes the iteration one of fixed point. Start: `mu + h f(mu)`.
#[derive(Debug)]
pub struct OrbitEnergyStep<'a, S: Scalar, P: LiePoisson<S>, G> {
    system: &'a P,
    gradient: G,
    step: S,
    base: P::State,
    direction: P::State,
    moved: P::State,
    scratch: Scratch<P::State>,
    derivative: P::Jacobian,
    columns: [P::State; 3],
}

impl<'a, S: Scalar, P: LiePoisson<S>, G: DiscreteGradient<S, P>> OrbitEnergyStep<'a, S, P, G> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            gradient: G::new(system),
            step: h,
            base: zero.clone(),
            direction: zero.clone(),
            moved: zero.clone(),
            scratch: Scratch::new(&zero),
            derivative: system.zero_jacobian(),
            columns: core::array::from_fn(|_| zero.clone()),
        }
    }

    /// Sets the direction to `x = h g(mu, u)`.
    fn set_direction(&mut self, unknown: &P::State) {
        let direction = &mut self.direction;
        self.gradient.value(self.system, unknown, direction);
        for entry in direction.as_mut_slice() {
            *entry *= self.step;
        }
    }

    /// `r = u - exp(ad*_x) mu`; leaves the new state in `moved`.
    fn write_residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        let (moved, scratch) = (&mut self.moved, &mut self.scratch);
        coadjoint_action_in(self.system, &self.direction, &self.base, moved, scratch);
        let pairs = unknown.as_slice().iter().zip(self.moved.as_slice());
        for (out, (&u, &moved)) in residual.as_mut_slice().iter_mut().zip(pairs) {
            *out = u - moved;
        }
    }

    /// Replaces the first column by `dexp_(-x)` of it; returns the lanes in which the series has kept
    /// its digits.
    fn apply_dexp(&mut self) -> S::Mask {
        let [sum, term, next] = &mut self.columns;
        let size = sum.max_norm();
        let end = size * S::from_f64(TOLERANCE);
        let mut active = !end.less_equal(S::zero());
        let mut peak = size;
        term.copy_from(sum);
        for index in 1..MAX_TERMS {
            if !active.any() {
                break;
            }
            self.system.ad(&self.direction, term, next);
            let weight = S::ratio(-1.0, (index + 1) as f64);
            let pairs = term.as_mut_slice().iter_mut().zip(next.as_slice());
            for ((term, &next), sum) in pairs.zip(sum.as_mut_slice()) {
                *term = weight * next;
                *sum = S::select(active, *sum + *term, *sum);
            }
            let norm = term.max_norm();
            peak = S::select(active, peak.max(norm), peak);
            active = active & !norm.less_equal(end);
        }
        !active & peak.less_equal(size * S::from_f64(MAX_RISE))
    }
}

impl<S, P, G> Equation<S> for OrbitEnergyStep<'_, S, P, G>
where
    S: Scalar,
    P: LiePoisson<S>,
    G: DiscreteGradient<S, P>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.gradient.set_start(self.system, mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.moved);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step, &self.moved);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set_direction(unknown);
        self.write_residual(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        let (direction, derivative) = (&mut self.direction, &mut self.derivative);
        self.gradient
            .linearize(self.system, unknown, direction, derivative);
        for entry in direction.as_mut_slice() {
            *entry *= self.step;
        }
        self.write_residual(unknown, residual);
        let mut kept = S::Mask::splat(true);
        for column in 0..self.system.dimension() {
            for (row, entry) in self.columns[0].as_mut_slice().iter_mut().enumerate() {
                *entry = self.step * self.derivative.get(row, column);
            }
            kept = kept & self.apply_dexp();
            let [along, change, _] = &mut self.columns;
            self.system.ad_star(along, &self.moved, change);
            for (row, &entry) in change.as_slice().iter().enumerate() {
                let identity = if row == column { S::one() } else { S::zero() };
                matrix.set(row, column, identity - entry);
            }
        }
        if kept.all() {
            return;
        }
        for row in 0..self.system.dimension() {
            for column in 0..self.system.dimension() {
                let identity = if row == column { S::one() } else { S::zero() };
                let entry = S::select(kept, matrix.get(row, column), identity);
                matrix.set(row, column, entry);
            }
        }
    }

    fn resolved(&mut self, unknown: &P::State, _end: &P::State) -> S::Mask {
        self.gradient.resolved(self.system, unknown)
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.set_direction(unknown);
        let scratch = &mut self.scratch;
        coadjoint_action_in(self.system, &self.direction, &self.base, mu, scratch);
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.set_direction(unknown);
        xi.copy_from(&self.direction);
        Some(Retraction::Exp)
    }
}
