//! The equation of the method that keeps orbit and energy.

use super::acting::Acting;
use super::discrete_gradient::DiscreteGradient;
use super::frozen_flow::FrozenFlow;
use super::motion::{Coadjoint, Motion};
use super::orbit_beside::OrbitBeside;
use crate::equation::{Equation, elimination_cost};
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, copies};

/// Motion along a discrete gradient: on the coadjoint orbit for any Lie algebra, on the symplectic leaf for any Poisson matrix
/// ([`FrozenStep`]).
///
/// Unknown: the new state u. Equation: `r(u) = u - E(x, mu)` with `x = h g(mu, u)`, the discrete gradient g and the motion
/// `E(x, mu)`, `exp(ad*_x) mu` of a Lie algebra. New state: `E(x, mu)`, on the leaf of mu to round-off whatever the
/// error of u. Jacobian: `1 - h Pi(mu1) dexp_(-x) dg/du` with `mu1 = exp(ad*_x) mu` and
/// `dexp_(-x) = sum_k (-ad_x)^k/(k + 1)!`, of other motions an approximation; where x is so large that this series has no digits left, 1,
/// which makes the iteration one of fixed point. Start: `mu + h f(mu)`.
///
/// Where forces act, half of `h F((mu + u)/2)` is added before the motion and half after it; where something damps, it is in the
/// direction: `x = h (g + c G v)` with the mean v of `Pi(y) g` on the way from the state y where the motion begins.
#[derive(Debug)]
pub struct LeafStep<'a, S: Scalar, P: Poisson<S>, G, M> {
    system: &'a P,
    gradient: G,
    step: S,
    base: P::State,
    direction: P::State,
    moved: P::State,
    spare: P::State,
    motion: M,
    derivative: P::Jacobian,
    columns: [P::State; 3],
    beside: Beside<S, P>,
}

/// What there is where something acts beside the Hamiltonian.
type Beside<S, P> = Acting<OrbitBeside<S, <P as Poisson<S>>::State, <P as Poisson<S>>::Jacobian>>;

/// The step for any Lie algebra.
pub type OrbitEnergyStep<'a, S, P, G> = LeafStep<'a, S, P, G, Coadjoint<<P as Poisson<S>>::State>>;

/// The step for any Poisson matrix.
pub type FrozenStep<'a, S, P, G> =
    LeafStep<'a, S, P, G, FrozenFlow<S, <P as Poisson<S>>::State, <P as Poisson<S>>::Jacobian>>;

impl<'a, S, P, G, M> LeafStep<'a, S, P, G, M>
where
    S: Scalar,
    P: Poisson<S>,
    G: DiscreteGradient<S, P>,
    M: Motion<S, P>,
{
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
            spare: zero.clone(),
            motion: M::new(system),
            derivative: system.zero_jacobian(),
            columns: copies(&zero),
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
        let (direction, motion) = (&mut self.direction, &mut self.motion);
        if let Some(beside) = self.beside.get_mut(self.system) {
            let ends = [&self.base, unknown];
            beside.complete(self.system, self.step, ends, direction, motion);
            return;
        }
        for entry in direction.as_mut_slice() {
            *entry *= self.step;
        }
    }

    /// `r = u - E(x, mu)` with the new state in `moved`, with forces the state before their second half.
    fn write_residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        let pairs = unknown.as_slice().iter().zip(self.moved.as_slice());
        for (out, (&u, &moved)) in residual.as_mut_slice().iter_mut().zip(pairs) {
            *out = u - moved;
        }
        if let Some(OrbitBeside { beside, .. }) = self.beside.get(self.system) {
            residual.axpy(-self.step * S::ratio(1.0, 2.0), &beside.force);
        }
    }

    /// Moves along the direction.
    fn carry(&mut self) {
        let start = start(self.system, &self.beside, &self.base);
        let (motion, moved) = (&mut self.motion, &mut self.moved);
        motion.carry(self.system, &self.direction, start, moved);
    }

    /// Adds to the derivative of the discrete gradient that of what damps, with the mean on the way that of the ends.
    fn damp_derivative(&mut self) {
        let (system, motion) = (self.system, &mut self.motion);
        let Some(OrbitBeside {
            beside, gradient, ..
        }) = self.beside.get_mut(system)
        else {
            return;
        };
        if !system.is_damped() {
            return;
        }
        let [along, turned, unit] = &mut self.columns;
        beside.damp_columns(system, &mut self.derivative, |derivative, column, v| {
            for (row, entry) in along.as_mut_slice().iter_mut().enumerate() {
                *entry = derivative.get(row, column);
            }
            motion.mean_slope(system, [gradient, along], column, [v, unit, turned]);
        });
    }
}

/// The state from which the motion begins, where forces act after half of them.
fn start<'s, S: Scalar, P: Poisson<S>>(
    system: &P,
    beside: &'s Beside<S, P>,
    base: &'s P::State,
) -> &'s P::State {
    let beside = beside.get(system);
    beside.map_or(base, |beside| &beside.pushed)
}

impl<S, P, G, M> Equation<S> for LeafStep<'_, S, P, G, M>
where
    S: Scalar,
    P: Poisson<S>,
    G: DiscreteGradient<S, P>,
    M: Motion<S, P>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.gradient.set_start(self.system, mu);
        self.motion.begin();
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.moved);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step, &self.moved);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set_direction(unknown);
        self.carry();
        self.write_residual(unknown, residual);
    }

    fn approach(&mut self, unknown: &P::State, residual: &mut P::State, active: S::Mask) -> S {
        self.set_direction(unknown);
        let start = start(self.system, &self.beside, &self.base);
        let ends = [&self.direction, start];
        let moved = &mut self.moved;
        let changed = self.motion.approach(self.system, ends, moved, active);
        self.write_residual(unknown, residual);
        changed
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        let (direction, derivative) = (&mut self.direction, &mut self.derivative);
        self.gradient
            .linearize(self.system, unknown, direction, derivative);
        self.complete(unknown);
        self.carry();
        self.write_residual(unknown, residual);
        let start = start(self.system, &self.beside, &self.base);
        let (motion, ends) = (&mut self.motion, [start, &self.moved]);
        motion.linearize(self.system, &self.direction, ends);
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
            let (motion, direction) = (&mut self.motion, &self.direction);
            let [along, change, turned] = &mut self.columns;
            let space = [&mut *along, &mut *change, &mut *turned];
            kept = kept & motion.slope(self.system, direction, space, &self.moved);
            if let Some(OrbitBeside { beside, .. }) = self.beside.get(self.system) {
                for (row, entry) in along.as_mut_slice().iter_mut().enumerate() {
                    *entry = beside.slope(row, column);
                }
                change.axpy(S::one(), along);
                let space = [&mut *along, &mut *turned, &mut self.spare];
                motion.push(self.system, direction, space);
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

    fn jacobian_cost(&self) -> f64 {
        let dimension = self.system.dimension();
        // the direction of what is damped takes whole motions, which an iteration without derivatives repeats
        let motion = M::jacobian_cost(dimension).filter(|_| !self.system.is_damped());
        motion.unwrap_or_else(|| elimination_cost(dimension))
    }

    fn resolved(&mut self, unknown: &P::State, _end: &P::State) -> S::Mask {
        let resolved = self.gradient.resolved(self.system, unknown) & self.motion.resolved();
        match self.beside.get(self.system) {
            Some(beside) => resolved & beside.settled(),
            None => resolved,
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        // lanes that were solved earlier have seen more iterations
        self.motion.conclude();
        self.set_direction(unknown);
        self.carry();
        mu.copy_from(&self.moved);
        if let Some(OrbitBeside { beside, .. }) = self.beside.get(self.system) {
            mu.axpy(self.step * S::ratio(1.0, 2.0), &beside.force);
        }
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.set_direction(unknown);
        xi.copy_from(&self.direction);
        M::retraction()
    }
}
