//! The equation of methods of coadjoint form along the Cayley map: the Lie–Poisson midpoint method
//! and the generating-function methods.

use super::chart::cayley_chart;
use super::generating::Generating2;
use crate::equation::Equation;
use crate::generating::GeneratingFunction;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::CayleyPoisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::State;
use crate::structure::Spectrum;

/// The method `mu1 = Ad*_(cay xi) mu` of a generating function S, for an algebra with a triple-closed
/// representation.
///
/// Unknown: the momentum p of the function. Equation, polynomial in `xi = grad S(p)`:
/// `r(p) = p - ad*_xi p/2 - Q_y p - mu`, with `y = xi/2` and `(Q_y p)_b = T_abc^d y^a y^c p_d`.
/// New state: `mu + ad*_xi p`. Jacobian, column j: the terms linear in p applied to `e_j`, and with
/// `v = S''(p) e_j` the terms `-ad*_v p/2 - (T_abc^d v^a xi^c p_d)_b/2`.
/// Start: `p = mu + (h/2) f(mu)`.
#[derive(Debug)]
pub struct CayleyRetraction<'a, S: Scalar, P: CayleyPoisson<S>, G> {
    system: &'a P,
    function: G,
    step: S,
    base: P::State,
    direction: P::State,
    hessian: P::Jacobian,
    columns: [P::State; 4],
}

/// The Lie–Poisson midpoint method with the Cayley map: [`CayleyRetraction`] with `S = h H`.
pub type CayleyMidpoint<'a, S, P> = CayleyRetraction<'a, S, P, Generating2<'a, S, P>>;

impl<'a, S: Scalar, P: CayleyPoisson<S>> CayleyMidpoint<'a, S, P> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        Self::with_function(system, Generating2::new(system, h), h)
    }
}

impl<'a, S, P, G> CayleyRetraction<'a, S, P, G>
where
    S: Scalar,
    P: CayleyPoisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
{
    /// The equation of the step of size h of a generating function.
    pub fn with_function(system: &'a P, function: G, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            function,
            step: h,
            base: zero.clone(),
            direction: zero.clone(),
            hessian: system.zero_jacobian(),
            columns: core::array::from_fn(|_| zero.clone()),
        }
    }

    /// Computes `y = xi/2` and `ad*_xi p` for the direction xi.
    fn set_action(&mut self, unknown: &P::State) {
        let [action, _, y, _] = &mut self.columns;
        let directions = self.direction.as_mut_slice().iter_mut();
        for (y, x) in y.as_mut_slice().iter_mut().zip(directions) {
            *y = (S::ratio(1.0, 2.0) * *x).quantity();
            *x = *y + *y;
        }
        self.function
            .motion(self.system, unknown, &self.direction, action);
    }

    /// Computes the residual for the direction.
    fn evaluate(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set_action(unknown);
        let half = S::ratio(1.0, 2.0);
        let [action, triple, y, _] = &mut self.columns;
        self.system.triple(y, y, unknown, triple);
        for (row, out) in residual.as_mut_slice().iter_mut().enumerate() {
            let corrections = half * action.as_slice()[row] + triple.as_slice()[row];
            *out = unknown.as_slice()[row] - corrections - self.base.as_slice()[row];
        }
    }
}

impl<S, P, G> Equation<S> for CayleyRetraction<'_, S, P, G>
where
    S: Scalar,
    P: CayleyPoisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.direction);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step * S::ratio(1.0, 2.0), &self.direction);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.function.gradient(unknown, &mut self.direction);
        self.evaluate(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.function
            .linearize(unknown, &mut self.direction, &mut self.hessian);
        self.evaluate(unknown, residual);
        let (half, quarter) = (S::ratio(1.0, 2.0), S::ratio(1.0, 4.0));
        let [along, unit, first, second] = &mut self.columns;
        for column in 0..self.system.dimension() {
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
                *entry = self.hessian.get(row, column);
            }
            if along.as_slice().iter().all(|&entry| entry == S::zero()) {
                continue;
            }
            self.system.ad_star(along, unknown, first);
            self.system.triple(along, &self.direction, unknown, second);
            for row in 0..self.system.dimension() {
                let through_x = half * (first.as_slice()[row] + second.as_slice()[row]);
                matrix.set(row, column, matrix.get(row, column) - through_x);
            }
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.function.gradient(unknown, &mut self.direction);
        self.set_action(unknown);
        let [action, ..] = &self.columns;
        for (row, out) in mu.as_mut_slice().iter_mut().enumerate() {
            *out = self.base.as_slice()[row] + action.as_slice()[row];
        }
    }

    fn within_chart(&mut self, unknown: &P::State) -> S::Mask {
        if matches!(self.system.spectrum(), Spectrum::Imaginary) {
            return S::Mask::splat(true);
        }
        self.function.gradient(unknown, &mut self.direction);
        cayley_chart(self.system, &self.direction)
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.function.gradient(unknown, xi);
        Some(Retraction::Cayley)
    }
}
