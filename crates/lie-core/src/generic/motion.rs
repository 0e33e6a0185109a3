//! How a momentum moves along a direction that is held.

use super::dexp_series::dexp_of_minus;
use super::series::{Scratch, coadjoint_action_in, phi1_in};
use crate::methods::Retraction;
use crate::poisson::{LiePoisson, Poisson};
use crate::scalar::{Mask as _, Scalar};
use crate::state::State;

/// The flow of `y' = Pi(y) x` over unit time with a fixed direction x: of a Lie algebra the coadjoint action of `exp(x)`
/// ([`Coadjoint`]), of any Poisson matrix the [`FrozenFlow`](super::FrozenFlow). It moves along the symplectic leaf of y, and
/// `<x, y>` is constant along it.
pub trait Motion<S: Scalar, P: Poisson<S>> {
    /// The motion with its scratch space.
    fn new(system: &P) -> Self;
    /// A new step begins: nothing of the last one is to be seen in it.
    fn begin(&mut self) {}
    /// The end of the motion: `out = y(1)`, `y(0) = start`.
    fn carry(&mut self, system: &P, x: &P::State, start: &P::State, out: &mut P::State);
    /// The same as far as an iteration has come that changes x too, where the motion is found by one itself: it goes one step in the
    /// active lanes. Returns the size of what that changed.
    fn approach(
        &mut self,
        system: &P,
        ends: [&P::State; 2],
        out: &mut P::State,
        _active: S::Mask,
    ) -> S {
        let [x, start] = ends;
        self.carry(system, x, start, out);
        S::zero()
    }
    /// The direction is found: what comes depends on it, and on what each lane has approached, alone.
    fn conclude(&mut self) {}
    /// The mean of `Pi(y) g` along the way, for x, the start and g, such that `y(1) - y(0)` is that of x.
    fn mean(&mut self, system: &P, given: [&P::State; 3], out: &mut P::State);
    /// Makes ready for the derivatives below, of the motion from `start` to `end`.
    fn linearize(&mut self, system: &P, x: &P::State, ends: [&P::State; 2]);
    /// The derivative of the end in x along the first of three states, which is lost: what changes is in the second, the
    /// third is space. Returns the lanes in which it has digits.
    fn slope(
        &mut self,
        system: &P,
        x: &P::State,
        space: [&mut P::State; 3],
        end: &P::State,
    ) -> S::Mask;
    /// The derivative of the end in the start along the first of three states, which is lost, in the second.
    fn push(&mut self, system: &P, x: &P::State, space: [&mut P::State; 3]);
    /// The derivative of the mean in the first of three states, where g changes by `along`, and the mean of the states by half of a unit.
    fn mean_slope(
        &mut self,
        system: &P,
        g_along: [&P::State; 2],
        unit: usize,
        space: [&mut P::State; 3],
    );
    /// See [`Equation::jacobian_cost`](crate::Equation::jacobian_cost), of so many coordinates, where it is more than the elimination.
    fn jacobian_cost(_dimension: usize) -> Option<f64> {
        None
    }
    /// The lanes in which the last motion is as exact as its scalar.
    fn resolved(&self) -> S::Mask {
        S::Mask::splat(true)
    }
    /// The map into the group whose coadjoint action it is.
    fn retraction() -> Option<Retraction>;
}

/// The coadjoint action `exp(ad*_x)` of a Lie algebra, in closed form or as a series.
#[derive(Clone, Debug)]
pub struct Coadjoint<V> {
    scratch: Scratch<V>,
    /// `phi1(ad*_x) y`, the mean of the states.
    mean: V,
}

impl<S: Scalar, P: LiePoisson<S>> Motion<S, P> for Coadjoint<P::State> {
    fn new(system: &P) -> Self {
        let zero = system.zero_state();
        Self {
            scratch: Scratch::new(&zero),
            mean: zero,
        }
    }

    fn carry(&mut self, system: &P, x: &P::State, start: &P::State, out: &mut P::State) {
        coadjoint_action_in(system, x, start, out, &mut self.scratch);
    }

    fn mean(&mut self, system: &P, [x, start, g]: [&P::State; 3], out: &mut P::State) {
        phi1_in(system, x, start, &mut self.mean, &mut self.scratch);
        system.ad_star(g, &self.mean, out);
    }

    fn linearize(&mut self, _system: &P, _x: &P::State, _ends: [&P::State; 2]) {}

    /// `ad*_w y(1)` with `w = dexp_(-x) v` along v, exactly.
    fn slope(
        &mut self,
        system: &P,
        x: &P::State,
        [along, out, spare]: [&mut P::State; 3],
        end: &P::State,
    ) -> S::Mask {
        let kept = dexp_of_minus(system, x, [&mut *along, &mut *out, spare]);
        system.ad_star(along, end, out);
        kept
    }

    fn push(&mut self, system: &P, x: &P::State, [along, out, _]: [&mut P::State; 3]) {
        coadjoint_action_in(system, x, along, out, &mut self.scratch);
    }

    fn mean_slope(
        &mut self,
        system: &P,
        [g, along]: [&P::State; 2],
        unit: usize,
        [out, spare, turned]: [&mut P::State; 3],
    ) {
        system.ad_star(along, &self.mean, out);
        spare.fill(S::zero());
        spare.as_mut_slice()[unit] = S::ratio(1.0, 2.0);
        system.ad_star(g, spare, turned);
        out.axpy(S::one(), turned);
    }

    fn retraction() -> Option<Retraction> {
        Some(Retraction::Exp)
    }
}
