//! Forces and damping of the method that keeps orbit and energy.

use super::beside::Beside;
use super::motion::Motion;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// Iterations for the direction of a damped step beyond which the step is refused.
const MOST: usize = 100;
/// The direction is found where an iteration changes it by so many units of round-off.
const CLOSE: f64 = 8.0;

/// Half of the force before the motion and half after it, and a direction that damps.
///
/// `y = mu + (h/2) F` moves along `x = h (g + c G v)`, with the mean `v` of `Pi(y) g` on the way; of a Lie algebra it is
/// `ad*_g phi1(ad*_x) y`. As `y1 - y` is that mean of x, H changes by `h <F, g> - h c <v, G v>`. The direction stands on both sides; it is
/// found by iteration from `h g`, which contracts by a factor of the size of `h^2 c`.
#[derive(Debug)]
pub(super) struct OrbitBeside<S: Scalar, V, M> {
    pub(super) beside: Beside<V, M>,
    /// The discrete gradient g.
    pub(super) gradient: V,
    /// `mu + (h/2) F`
    pub(super) pushed: V,
    /// v
    velocity: V,
    /// The lanes in which the direction was found.
    settled: S::Mask,
}

impl<S: Scalar, V: State<S>, M> OrbitBeside<S, V, M> {
    /// The space of a system.
    pub(super) fn new<P>(system: &P) -> Self
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let zero = system.zero_state();
        Self {
            beside: Beside::new(system),
            gradient: zero.clone(),
            pushed: zero.clone(),
            velocity: zero,
            settled: S::Mask::splat(true),
        }
    }

    /// Makes the direction x of a discrete gradient, for a step of size h from mu to u.
    pub(super) fn complete<P>(
        &mut self,
        system: &P,
        h: S,
        [mu, unknown]: [&V; 2],
        direction: &mut V,
        motion: &mut impl Motion<S, P>,
    ) where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let half = h * S::ratio(1.0, 2.0);
        self.beside.set_middle(system, mu, unknown);
        self.gradient.copy_from(direction);
        self.pushed.copy_from(mu);
        self.pushed.axpy(half, &self.beside.force);
        for entry in direction.as_mut_slice() {
            *entry *= h;
        }
        if system.is_damped() {
            self.find(system, h, direction, motion);
        }
        self.beside.balance(system, &self.gradient, &self.velocity);
        self.pushed.copy_from(mu);
        self.pushed.axpy(half, &self.beside.force);
    }

    /// Finds the direction of a damped step.
    fn find<P>(&mut self, system: &P, h: S, direction: &mut V, motion: &mut impl Motion<S, P>)
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        self.settled = S::Mask::splat(false);
        for _ in 0..MOST {
            self.set_velocity(system, direction, motion);
            let mut change = S::zero();
            let new = self.gradient.as_slice().iter();
            let new = new.zip(self.beside.damping.as_slice());
            for (entry, (&gradient, &damping)) in direction.as_mut_slice().iter_mut().zip(new) {
                let next = h * (gradient + damping);
                change = change.max((next - *entry).abs());
                *entry = S::select(self.settled, *entry, next);
            }
            let end = S::from_f64(CLOSE) * S::epsilon() * direction.max_norm();
            self.settled = self.settled | change.less_equal(end);
            if self.settled.all() {
                break;
            }
        }
        // those of the direction that was found, in each lane
        self.set_velocity(system, direction, motion);
    }

    /// Sets v and what damps for a direction.
    fn set_velocity<P>(&mut self, system: &P, direction: &V, motion: &mut impl Motion<S, P>)
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let ways = [direction, &self.pushed, &self.gradient];
        motion.mean(system, ways, &mut self.velocity);
        self.beside.damp(system, &self.velocity);
    }

    /// The lanes in which the direction was found.
    pub(super) fn settled(&self) -> S::Mask {
        self.settled
    }
}
