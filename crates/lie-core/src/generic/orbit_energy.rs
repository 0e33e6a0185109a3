//! The equation of the method that keeps orbit and energy.

use super::acting::Acting;
use super::dexp_series::dexp_of_minus;
use super::discrete_gradient::DiscreteGradient;
use super::orbit_beside::OrbitBeside;
use super::series::{Scratch, coadjoint_action_in};
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::LiePoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// Coadjoint motion along a discrete gradient, for any Lie algebra.
///
/// Unknown: the new state u. Equation: `r(u) = u - exp(ad*_x) mu` with `x = h g(mu, u)` and the discrete
/// gradient g. New state: `exp(ad*_x) mu`, on the coadjoint orbit of mu to round-off whatever the
/// error of u. Jacobian: `1 - h Pi(mu1) dexp_(-x) dg/du` with `mu1 = exp(ad*_x) mu` and
/// `dexp_(-x) = sum_k (-ad_x)^k/(k + 1)!`; where x is so large that this series has no digits left, 1,
/// which makes the iteration one of fixed point. Start: `mu + h f(mu)`.
///
/// Where forces act, half of `h F((mu + u)/2)` is added before the motion and half after it; where something damps, it is in the
/// direction: `x = h (g + c G v)` with `v = ad*_g phi1(ad*_x) y` and the state y from which the motion goes.
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
    beside: Acting<OrbitBeside<S, P::State, P::Jacobian>>,
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
            beside: Acting::of(system, || OrbitBeside::new(system)),
        }
    }

    /// Sets the direction to `x = h g(mu, u)`.
    fn set_direction(&mut self, unknown: &P::State) {
        let direction = &mut self.direction;
        self.gradient.value(self.system, unknown, direction);
        self.complete(unknown);
    }

    /// Makes the direction of the discrete gradient that stands there.
    fn complete(&mut self, unknown: &P::State) {
        let (direction, scratch) = (&mut self.direction, &mut self.scratch);
        if let Some(beside) = self.beside.get_mut(self.system) {
            let ends = [&self.base, unknown];
            beside.complete(self.system, self.step, ends, direction, scratch);
            return;
        }
        for entry in direction.as_mut_slice() {
            *entry *= self.step;
        }
    }

    /// `r = u - exp(ad*_x) mu`; leaves the new state in `moved`, with forces the state before their second half.
    fn write_residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        let (moved, scratch) = (&mut self.moved, &mut self.scratch);
        let beside = self.beside.get(self.system);
        let base = beside.map_or(&self.base, |beside| &beside.pushed);
        coadjoint_action_in(self.system, &self.direction, base, moved, scratch);
        let pairs = unknown.as_slice().iter().zip(self.moved.as_slice());
        for (out, (&u, &moved)) in residual.as_mut_slice().iter_mut().zip(pairs) {
            *out = u - moved;
        }
        if let Some(OrbitBeside { beside, .. }) = self.beside.get(self.system) {
            residual.axpy(-self.step * S::ratio(1.0, 2.0), &beside.force);
        }
    }

    /// Adds to the derivative of the discrete gradient that of what damps, with the mean on the way that of the ends.
    fn damp_derivative(&mut self) {
        let system = self.system;
        if let Some(acting) = self.beside.get_mut(self.system)
            && system.is_damped()
        {
            let (mean, gradient) = (&acting.mean, &acting.gradient);
            let [along, turned, unit] = &mut self.columns;
            acting
                .beside
                .damp_columns(system, &mut self.derivative, |derivative, column, v| {
                    for (row, entry) in along.as_mut_slice().iter_mut().enumerate() {
                        *entry = derivative.get(row, column);
                    }
                    system.ad_star(along, mean, v);
                    unit.fill(S::zero());
                    unit.as_mut_slice()[column] = S::ratio(1.0, 2.0);
                    system.ad_star(gradient, unit, turned);
                    v.axpy(S::one(), turned);
                });
        }
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
        self.complete(unknown);
        self.write_residual(unknown, residual);
        self.damp_derivative();
        if let Some(OrbitBeside { beside, .. }) = self.beside.get_mut(self.system) {
            // half of the force, at half of the end
            beside.linearize(self.system, self.step * S::ratio(1.0, 4.0));
        }
        let mut kept = S::Mask::splat(true);
        for column in 0..self.system.dimension() {
            for (row, entry) in self.columns[0].as_mut_slice().iter_mut().enumerate() {
                *entry = self.step * self.derivative.get(row, column);
            }
            kept = kept & dexp_of_minus(self.system, &self.direction, &mut self.columns);
            let [along, change, turned] = &mut self.columns;
            self.system.ad_star(along, &self.moved, change);
            if let Some(OrbitBeside { beside, .. }) = self.beside.get(self.system) {
                for (row, entry) in along.as_mut_slice().iter_mut().enumerate() {
                    *entry = beside.slope(row, column);
                }
                change.axpy(S::one(), along);
                let scratch = &mut self.scratch;
                coadjoint_action_in(self.system, &self.direction, along, turned, scratch);
                change.axpy(S::one(), turned);
            }
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
        let resolved = self.gradient.resolved(self.system, unknown);
        match self.beside.get(self.system) {
            Some(beside) => resolved & beside.settled(),
            None => resolved,
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.set_direction(unknown);
        let scratch = &mut self.scratch;
        let beside = self.beside.get(self.system);
        let base = beside.map_or(&self.base, |beside| &beside.pushed);
        coadjoint_action_in(self.system, &self.direction, base, mu, scratch);
        if let Some(OrbitBeside { beside, .. }) = self.beside.get(self.system) {
            mu.axpy(self.step * S::ratio(1.0, 2.0), &beside.force);
        }
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.set_direction(unknown);
        xi.copy_from(&self.direction);
        Some(Retraction::Exp)
    }
}
