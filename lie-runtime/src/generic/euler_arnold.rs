//! The two halves of a step on `T*G` as equations.

use super::series::{Scratch, coadjoint_action_in, dexp_dual_in};
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::newton::dense;
use crate::scalar::{Mask, Scalar};
use crate::state::State;
use crate::structure::CotangentPoisson;

/// Terms of the series whose derivative enters the Jacobian, as in the Lie–Poisson midpoint method.
const TERMS: usize = 24;

/// Which half of a step: they are adjoint to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// The force acts at the beginning, where g is.
    First,
    /// The force acts at the end.
    Second,
}

/// One half of the method [`crate::methods::EulerArnold2`], a symplectic map of `T*G` of order 1.
///
/// The state is (mu, a): the momenta, then the coordinates a of the configuration, on which the group acts.
/// With the force `F = -ad*_(0, dH/da) (0, a)` in the momenta and an element `xi = (x, 0)`:
///
/// - first half: unknown m; `nu = mu - h F(a, m)`, `x = h dH/dmu (m, a)`,
///   `r(m) = m - phi1(ad*_xi) nu`; the new state is `exp(ad*_xi) (nu, a)`;
/// - second half: unknown `y = |mu| x`, so that an angle x is solved for to round-off whatever the units of mu;
///   `(mu', a1) = exp(ad*_xi) (mu, a)`, `m = phi1(ad*_xi) mu`, `r(y) = y - |mu| h dH/dmu (m, a1)`; the new
///   state is `(mu' - h F(a1, m), a1)`.
///
/// Both are products of two coadjoint actions, of `exp(xi)` and of `exp(h (0, dH/da))`, so the coadjoint orbit
/// is kept to round-off whatever the error of the unknown. Jacobians: the derivative of a series
/// `sum_k c_k (ad*_xi)^k nu` along (dx, dnu) by `e_k = (ad*_xi e_(k-1) + ad*_dx t_(k-1)) c_k/c_(k-1)`, `e_0 = dnu`.
#[derive(Debug)]
pub struct EulerArnoldHalf<'a, S: Scalar, P: CotangentPoisson<S>> {
    system: &'a P,
    half: Half,
    step: S,
    /// `|mu|`, or 1 where it is 0.
    size: S,
    base: P::State,
    /// (nu, a), or (mu, a) in the second half.
    start: P::State,
    /// (m, a) or (m, a1): where H is taken.
    point: P::State,
    gradient: P::State,
    /// (x, 0)
    direction: P::State,
    /// (0, h dH/da)
    force: P::State,
    hessian: P::Jacobian,
    scratch: Scratch<P::State>,
    terms: [P::State; TERMS],
    columns: [P::State; 6],
}

impl<'a, S: Scalar, P: CotangentPoisson<S>> EulerArnoldHalf<'a, S, P> {
    /// The equation of one half with the step h.
    pub fn new(system: &'a P, half: Half, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            half,
            step: h,
            size: S::one(),
            base: zero.clone(),
            start: zero.clone(),
            point: zero.clone(),
            gradient: zero.clone(),
            direction: zero.clone(),
            force: zero.clone(),
            hessian: system.zero_jacobian(),
            scratch: Scratch::new(&zero),
            terms: core::array::from_fn(|_| zero.clone()),
            columns: core::array::from_fn(|_| zero.clone()),
        }
    }

    /// Splits `h grad H` at the point into the direction and the force.
    fn split_gradient(&mut self) {
        self.system.gradient(&self.point, &mut self.gradient);
        self.direction.fill(S::zero());
        self.force.fill(S::zero());
        for (index, &slope) in self.gradient.as_slice().iter().enumerate() {
            let part = if index < P::MOMENTA {
                &mut self.direction
            } else {
                &mut self.force
            };
            part.as_mut_slice()[index] = self.step * slope;
        }
    }

    /// Adds `ad*_force a`, which changes the momenta only.
    fn push_force(
        system: &P,
        force: &P::State,
        at: &P::State,
        into: &mut P::State,
        free: &mut P::State,
    ) {
        system.ad_star(force, at, free);
        for index in 0..P::MOMENTA {
            into.as_mut_slice()[index] += free.as_slice()[index];
        }
    }

    /// `phi1(ad*_direction)` of the start into `sum`, the terms kept; the index of the last in each lane.
    fn momentum(&mut self, sum: &mut P::State) -> S {
        let terms = &mut self.terms;
        let keep = |index: usize, term: &P::State| {
            if let Some(kept) = terms.get_mut(index) {
                kept.copy_from(term);
            }
        };
        let scratch = &mut self.scratch;
        dexp_dual_in(
            self.system,
            &self.direction,
            &self.start,
            sum,
            scratch,
            keep,
        )
    }

    /// First half: sets direction, force and start for the momentum m.
    fn set_first(&mut self, m: &P::Momentum) {
        self.point.copy_from(&self.base);
        self.point.as_mut_slice()[..P::MOMENTA].copy_from_slice(m.as_slice());
        self.split_gradient();
        self.start.copy_from(&self.base);
        let free = &mut self.columns[0];
        Self::push_force(self.system, &self.force, &self.base, &mut self.start, free);
    }

    /// Second half: the configuration a1 for the element x, by the action on the whole state.
    fn set_second(&mut self, y: &P::Momentum) {
        self.start.copy_from(&self.base);
        self.direction.fill(S::zero());
        for (entry, &y) in self.direction.as_mut_slice().iter_mut().zip(y.as_slice()) {
            *entry = y / self.size;
        }
        let (system, scratch) = (self.system, &mut self.scratch);
        coadjoint_action_in(
            system,
            &self.direction,
            &self.base,
            &mut self.point,
            scratch,
        );
    }

    /// The residual; the index of the last term of the series in each lane.
    fn evaluate(&mut self, unknown: &P::Momentum, residual: &mut P::Momentum) -> S {
        let mut sum = self.columns[1].clone();
        let last = match self.half {
            Half::First => {
                self.set_first(unknown);
                let last = self.momentum(&mut sum);
                for (index, out) in residual.as_mut_slice().iter_mut().enumerate() {
                    *out = unknown.as_slice()[index] - sum.as_slice()[index];
                }
                last
            }
            Half::Second => {
                self.set_second(unknown);
                let last = self.momentum(&mut sum);
                let point = self.point.as_mut_slice();
                point[..P::MOMENTA].copy_from_slice(&sum.as_slice()[..P::MOMENTA]);
                self.system.gradient(&self.point, &mut self.gradient);
                for (index, out) in residual.as_mut_slice().iter_mut().enumerate() {
                    let velocity = self.step * self.gradient.as_slice()[index];
                    *out = unknown.as_slice()[index] - self.size * velocity;
                }
                last
            }
        };
        self.columns[1] = sum;
        last
    }

    /// The derivative of `sum_k shift!/(k + shift)! (ad*_direction)^k` of the kept terms' start along
    /// (along, first) into `columns[5]`, by the terms up to `last`.
    fn series_slope(&mut self, shift: usize, last: S) {
        let [along, derivative, first, second, start, total] = &mut self.columns;
        derivative.copy_from(start);
        total.copy_from(start);
        for index in 1..TERMS {
            let counted = S::from_f64(index as f64).less_equal(last);
            if !counted.any() {
                break;
            }
            self.system.ad_star(&self.direction, derivative, first);
            self.system.ad_star(along, &self.terms[index - 1], second);
            let weight = S::ratio(1.0, (index + shift) as f64);
            for row in 0..P::DIM {
                let term = (first.as_slice()[row] + second.as_slice()[row]) * weight;
                derivative.as_mut_slice()[row] = term;
                let sum = total.as_slice()[row];
                total.as_mut_slice()[row] = S::select(counted, sum + term, sum);
            }
        }
    }

    fn linearize_first(&mut self, last: S, matrix: &mut P::MomentumMatrix) {
        self.system.hessian(&self.point, &mut self.hessian);
        for column in 0..P::MOMENTA {
            let [along, _, first, force, start, _] = &mut self.columns;
            along.fill(S::zero());
            force.fill(S::zero());
            start.fill(S::zero());
            for row in 0..P::DIM {
                let part = if row < P::MOMENTA {
                    &mut *along
                } else {
                    &mut *force
                };
                part.as_mut_slice()[row] = self.step * self.hessian.get(row, column);
            }
            Self::push_force(self.system, force, &self.base, start, first);
            self.series_slope(1, last);
            for row in 0..P::MOMENTA {
                let identity = if row == column { S::one() } else { S::zero() };
                matrix.set(row, column, identity - self.columns[5].as_slice()[row]);
            }
        }
    }

    fn linearize_second(&mut self, last: S, matrix: &mut P::MomentumMatrix) {
        self.system.hessian(&self.point, &mut self.hessian);
        // derivatives of m first, kept in the matrix; then those of a1 from the terms of the action
        for column in 0..P::MOMENTA {
            self.columns[0].fill(S::zero());
            self.columns[0].as_mut_slice()[column] = S::one();
            self.columns[4].fill(S::zero());
            self.series_slope(1, last);
            for row in 0..P::MOMENTA {
                let mut sum = S::zero();
                for (inner, &slope) in self.columns[5].as_slice()[..P::MOMENTA].iter().enumerate() {
                    sum += self.hessian.get(row, inner) * slope;
                }
                let identity = if row == column { S::one() } else { S::zero() };
                matrix.set(row, column, identity - self.step * sum);
            }
        }
        self.terms[0].copy_from(&self.base);
        for index in 1..TERMS {
            let (before, after) = self.terms.split_at_mut(index);
            let (before, after) = (&before[index - 1], &mut after[0]);
            self.system.ad_star(&self.direction, before, after);
            let weight = S::ratio(1.0, index as f64);
            for entry in after.as_mut_slice() {
                *entry *= weight;
            }
        }
        for column in 0..P::MOMENTA {
            self.columns[0].fill(S::zero());
            self.columns[0].as_mut_slice()[column] = S::one();
            self.columns[4].fill(S::zero());
            // the action has terms 1/k!, one more than phi1 to the same size
            self.series_slope(0, last + S::one());
            for row in 0..P::MOMENTA {
                let mut sum = S::zero();
                for inner in P::MOMENTA..P::DIM {
                    sum += self.hessian.get(row, inner) * self.columns[5].as_slice()[inner];
                }
                matrix.set(row, column, matrix.get(row, column) - self.step * sum);
            }
        }
    }

    /// The element of each of the two actions of a solved half, in their order.
    pub(crate) fn factors(&mut self, unknown: &P::Momentum) -> [(Retraction, &P::State); 2] {
        let (first, second) = match self.half {
            Half::First => {
                self.set_first(unknown);
                (&self.force, &self.direction)
            }
            Half::Second => {
                self.solve_point(unknown);
                self.set_force();
                (&self.direction, &self.force)
            }
        };
        [(Retraction::Exp, first), (Retraction::Exp, second)]
    }

    /// Second half: the point (m, a1) of a solution; `columns[2]` holds `(mu', a1)`.
    fn solve_point(&mut self, unknown: &P::Momentum) {
        self.set_second(unknown);
        let mut sum = self.columns[1].clone();
        self.momentum(&mut sum);
        self.columns[2].copy_from(&self.point);
        let point = self.point.as_mut_slice();
        point[..P::MOMENTA].copy_from_slice(&sum.as_slice()[..P::MOMENTA]);
        self.columns[1] = sum;
    }

    /// The force at the point, the direction kept.
    fn set_force(&mut self) {
        self.system.gradient(&self.point, &mut self.gradient);
        self.force.fill(S::zero());
        for index in P::MOMENTA..P::DIM {
            self.force.as_mut_slice()[index] = self.step * self.gradient.as_slice()[index];
        }
    }
}

impl<S: Scalar, P: CotangentPoisson<S>> Equation<S> for EulerArnoldHalf<'_, S, P> {
    type State = P::State;
    type Unknown = P::Momentum;
    type Matrix = P::MomentumMatrix;

    fn zero_unknown(&self) -> P::Momentum {
        self.system.zero_momentum()
    }

    fn zero_matrix(&self) -> P::MomentumMatrix {
        self.system.zero_momentum_matrix()
    }

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        let mut size = S::zero();
        for &momentum in &mu.as_slice()[..P::MOMENTA] {
            size = size.max(momentum.magnitude());
        }
        self.size = S::select(S::zero().less(size), size, S::one());
    }

    fn scale(&self, _mu: &P::State) -> S {
        self.size
    }

    fn initial_guess(&mut self, unknown: &mut P::Momentum) {
        let half = self.step * S::ratio(1.0, 2.0);
        self.system.vector_field(&self.base, &mut self.gradient);
        self.point.copy_from(&self.base);
        self.point.axpy(half, &self.gradient);
        if self.half == Half::Second {
            let point = self.point.clone();
            self.system.gradient(&point, &mut self.point);
            for entry in self.point.as_mut_slice() {
                *entry *= self.step * self.size;
            }
        }
        let guess = &self.point.as_slice()[..P::MOMENTA];
        unknown.as_mut_slice().copy_from_slice(guess);
    }

    fn residual(&mut self, unknown: &P::Momentum, residual: &mut P::Momentum) {
        self.evaluate(unknown, residual);
    }

    fn linearize(
        &mut self,
        unknown: &P::Momentum,
        residual: &mut P::Momentum,
        matrix: &mut P::MomentumMatrix,
    ) {
        let last = self.evaluate(unknown, residual);
        match self.half {
            Half::First => self.linearize_first(last, matrix),
            Half::Second => self.linearize_second(last, matrix),
        }
    }

    fn factor(&self, matrix: &mut P::MomentumMatrix) -> S::Mask {
        dense::factor(matrix)
    }

    fn solve(&self, factors: &P::MomentumMatrix, residual: &mut P::Momentum) {
        dense::solve(factors, residual);
    }

    fn result(&mut self, unknown: &P::Momentum, mu: &mut P::State) {
        match self.half {
            Half::First => {
                self.set_first(unknown);
                let (system, scratch) = (self.system, &mut self.scratch);
                coadjoint_action_in(system, &self.direction, &self.start, mu, scratch);
            }
            Half::Second => {
                self.solve_point(unknown);
                self.set_force();
                mu.copy_from(&self.columns[2]);
                let free = &mut self.columns[0];
                Self::push_force(self.system, &self.force, &self.point, mu, free);
            }
        }
    }
}
