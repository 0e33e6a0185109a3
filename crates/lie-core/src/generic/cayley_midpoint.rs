//! The equation of methods of coadjoint form along the Cayley map: the Lie–Poisson midpoint method
//! and the generating-function methods.

use super::acting::Acting;
use super::chart::cayley_chart;
use super::generating::Generating2;
use crate::equation::Equation;
use crate::generating::GeneratingFunction;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::CayleyPoisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::{State, copies};
use crate::structure::Spectrum;

/// The method `mu1 = Ad*_(cay xi) mu` of a generating function S, for an algebra with a triple-closed
/// representation.
///
/// Unknown: the momentum p of the function. Equation, polynomial in `xi = grad S(p)`:
/// `r(p) = p - ad*_xi p/2 - Q_y p - mu`, with `y = xi/2` and `(Q_y p)_b = T_abc^d y^a y^c p_d`.
/// New state: `mu + ad*_xi p`. Jacobian, column j: the terms linear in p applied to `e_j`, and with
/// `v = S''(p) e_j` the terms `-ad*_v p/2 - (T_abc^d v^a xi^c p_d)_b/2`.
/// Start: `p = mu + (h/2) f(mu)`.
///
/// Where forces act, the force at the midpoint moves p, which is what both ends are made of: with `A p = p - ad*_xi p/2 - Q_y p` and
/// `B p = p + ad*_xi p/2 - Q_y p` the equation is `A (p - (h/2) F(p)) = mu` and the new state `B (p + (h/2) F(p))`, which is
/// `mu + ad*_xi p + h (F - Q_y F)`. As `B = Ad*_(cay xi) A`, it is `Ad*_(cay xi) (mu + h A F(p))`: the spatial momentum
/// changes by exactly h times the force, carried to the beginning of the step by A.
#[derive(Debug)]
pub struct CayleyRetraction<'a, S: Scalar, P: CayleyPoisson<S>, G> {
    system: &'a P,
    function: G,
    step: S,
    base: P::State,
    direction: P::State,
    hessian: P::Jacobian,
    columns: [P::State; 4],
    /// `p - (h/2) F(p)` and its derivative, where forces act.
    forced: Acting<(P::State, P::Jacobian)>,
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
            columns: copies(&zero),
            forced: Acting::of(system, || (zero.clone(), system.zero_jacobian())),
        }
    }

    /// Sets `p - (h/2) F(p)`.
    fn set_forced(&mut self, unknown: &P::State) {
        if let Some((point, _)) = self.forced.get_mut(self.system) {
            let half = self.step * S::ratio(1.0, 2.0);
            self.system.force(unknown, point);
            for (entry, &p) in point.as_mut_slice().iter_mut().zip(unknown.as_slice()) {
                *entry = p - half * *entry;
            }
        }
    }

    /// Sets the derivative of `p - (h/2) F(p)`.
    fn set_slope(&mut self, unknown: &P::State) {
        if let Some((_, slope)) = self.forced.get_mut(self.system) {
            let half = self.step * S::ratio(1.0, 2.0);
            self.system.force_slope(unknown, slope);
            for row in 0..self.system.dimension() {
                for column in 0..self.system.dimension() {
                    let identity = if row == column { S::one() } else { S::zero() };
                    slope.set(row, column, identity - half * slope.get(row, column));
                }
            }
        }
    }

    /// Computes the residual for the direction.
    fn evaluate(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set_forced(unknown);
        let forced = self.forced.get(self.system);
        let point = forced.map_or(unknown, |(point, _)| point);
        let (function, direction) = (&mut self.function, &mut self.direction);
        set_action(self.system, function, point, direction, &mut self.columns);
        let half = S::ratio(1.0, 2.0);
        let [action, triple, y, _] = &mut self.columns;
        self.system.triple(y, y, point, triple);
        for (row, out) in residual.as_mut_slice().iter_mut().enumerate() {
            let corrections = half * action.as_slice()[row] + triple.as_slice()[row];
            *out = point.as_slice()[row] - corrections - self.base.as_slice()[row];
        }
    }
}

/// Computes `y = xi/2` and `ad*_xi p` for the direction xi.
fn set_action<S, P, G>(
    system: &P,
    function: &mut G,
    point: &P::State,
    direction: &mut P::State,
    [action, _, y, _]: &mut [P::State; 4],
) where
    S: Scalar,
    P: CayleyPoisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
{
    let directions = direction.as_mut_slice().iter_mut();
    for (y, x) in y.as_mut_slice().iter_mut().zip(directions) {
        *y = (S::ratio(1.0, 2.0) * *x).quantity();
        *x = *y + *y;
    }
    function.motion(system, point, direction, action);
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
        self.set_slope(unknown);
        let (half, quarter) = (S::ratio(1.0, 2.0), S::ratio(1.0, 4.0));
        let [along, unit, first, second] = &mut self.columns;
        let forced = self.forced.get(self.system);
        let point = forced.map_or(unknown, |(point, _)| point);
        for column in 0..self.system.dimension() {
            unit.fill(S::zero());
            unit.as_mut_slice()[column] = S::one();
            if let Some((_, slope)) = forced {
                for (row, entry) in unit.as_mut_slice().iter_mut().enumerate() {
                    *entry = slope.get(row, column);
                }
            }
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
            self.system.ad_star(along, point, first);
            self.system.triple(along, &self.direction, point, second);
            for row in 0..self.system.dimension() {
                let through_x = half * (first.as_slice()[row] + second.as_slice()[row]);
                matrix.set(row, column, matrix.get(row, column) - through_x);
            }
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.function.gradient(unknown, &mut self.direction);
        let (function, direction) = (&mut self.function, &mut self.direction);
        set_action(self.system, function, unknown, direction, &mut self.columns);
        let [action, triple, y, force] = &mut self.columns;
        for (row, out) in mu.as_mut_slice().iter_mut().enumerate() {
            *out = self.base.as_slice()[row] + action.as_slice()[row];
        }
        if self.system.is_forced() {
            self.system.force(unknown, force);
            self.system.triple(y, y, force, triple);
            mu.axpy(self.step, force);
            mu.axpy(-self.step, triple);
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
