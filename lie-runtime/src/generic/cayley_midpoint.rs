//! The equation of the Lie–Poisson midpoint method with the Cayley map.

use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::newton::dense;
use crate::poisson::CayleyPoisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The retraction method `mu1 = Ad*_(cay x) mu` for an algebra with a triple-closed representation.
///
/// Unknown: the momentum m at the midpoint. Equation, polynomial in `x = h grad H(m)`:
/// `r(m) = m - ad*_x m/2 - Q_x m/4 - mu`, with `(Q_x m)_b = T_abc^d x^a x^c m_d`.
/// New state: `mu + ad*_x m`. Jacobian, column j: the terms linear in m applied to `e_j`, and with
/// `v = h H''(m) e_j` the terms `-ad*_v m/2 - (T_abc^d v^a x^c m_d)_b/2`.
/// Start: `m = mu + (h/2) f(mu)`.
#[derive(Debug)]
pub struct CayleyMidpoint<'a, S: Scalar, P: CayleyPoisson<S>> {
    system: &'a P,
    step: S,
    base: P::State,
    direction: P::State,
    hessian: P::Jacobian,
    columns: [P::State; 4],
}

impl<'a, S: Scalar, P: CayleyPoisson<S>> CayleyMidpoint<'a, S, P> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            step: h,
            base: zero.clone(),
            direction: zero.clone(),
            hessian: system.zero_jacobian(),
            columns: core::array::from_fn(|_| zero.clone()),
        }
    }

    /// Sets the direction to `x = h grad H(m)`.
    fn set_direction(&mut self, unknown: &P::State) {
        self.system.gradient(unknown, &mut self.direction);
        for entry in self.direction.as_mut_slice() {
            *entry *= self.step;
        }
    }
}

impl<S: Scalar, P: CayleyPoisson<S>> Equation<S> for CayleyMidpoint<'_, S, P> {
    type State = P::State;
    type Unknown = P::State;
    type Matrix = P::Jacobian;

    fn zero_unknown(&self) -> P::State {
        self.system.zero_state()
    }

    fn zero_matrix(&self) -> P::Jacobian {
        self.system.zero_jacobian()
    }

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.direction);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step * S::ratio(1.0, 2.0), &self.direction);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set_direction(unknown);
        let (half, quarter) = (S::ratio(1.0, 2.0), S::ratio(1.0, 4.0));
        let [action, triple, ..] = &mut self.columns;
        self.system.ad_star(&self.direction, unknown, action);
        self.system
            .triple(&self.direction, &self.direction, unknown, triple);
        for (row, out) in residual.as_mut_slice().iter_mut().enumerate() {
            let corrections = half * action.as_slice()[row] + quarter * triple.as_slice()[row];
            *out = unknown.as_slice()[row] - corrections - self.base.as_slice()[row];
        }
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.residual(unknown, residual);
        self.system.hessian(unknown, &mut self.hessian);
        let (half, quarter) = (S::ratio(1.0, 2.0), S::ratio(1.0, 4.0));
        let [along, unit, first, second] = &mut self.columns;
        for column in 0..P::DIM {
            unit.fill(S::zero());
            unit.as_mut_slice()[column] = S::one();
            self.system.ad_star(&self.direction, unit, first);
            self.system
                .triple(&self.direction, &self.direction, unit, second);
            for (row, &one) in unit.as_slice().iter().enumerate() {
                let linear = half * first.as_slice()[row] + quarter * second.as_slice()[row];
                matrix.set(row, column, one - linear);
            }
            for (row, entry) in along.as_mut_slice().iter_mut().enumerate() {
                *entry = self.step * self.hessian.get(row, column);
            }
            if along.as_slice().iter().all(|&entry| entry == S::zero()) {
                continue;
            }
            self.system.ad_star(along, unknown, first);
            self.system.triple(along, &self.direction, unknown, second);
            for row in 0..P::DIM {
                let through_x = half * (first.as_slice()[row] + second.as_slice()[row]);
                matrix.set(row, column, matrix.get(row, column) - through_x);
            }
        }
    }

    fn factor(&self, matrix: &mut P::Jacobian) -> S::Mask {
        dense::factor(matrix)
    }

    fn solve(&self, factors: &P::Jacobian, residual: &mut P::State) {
        dense::solve(factors, residual);
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.set_direction(unknown);
        let [action, ..] = &mut self.columns;
        self.system.ad_star(&self.direction, unknown, action);
        for (row, out) in mu.as_mut_slice().iter_mut().enumerate() {
            *out = self.base.as_slice()[row] + action.as_slice()[row];
        }
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.set_direction(unknown);
        xi.copy_from(&self.direction);
        Some(Retraction::Cayley)
    }
}
