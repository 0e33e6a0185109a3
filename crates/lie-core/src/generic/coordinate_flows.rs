//! The flows of the coordinate pieces of a separable Hamiltonian.

use super::series::{Scratch, coadjoint_action_in};
use crate::pieces::PieceFlows;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The flows of the pieces from gradient and ad*, for any system: one piece per coordinate.
#[derive(Debug)]
pub struct CoordinateFlows<'a, S: Scalar, P: LiePoisson<S>> {
    system: &'a P,
    direction: P::State,
    next: P::State,
    scratch: Scratch<P::State>,
}

impl<'a, S: Scalar, P: LiePoisson<S>> CoordinateFlows<'a, S, P> {
    /// The flows of the coordinate pieces of a system.
    pub fn new(system: &'a P) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            direction: zero.clone(),
            scratch: Scratch::new(&zero),
            next: zero,
        }
    }
}

impl<S: Scalar, P: LiePoisson<S>> PieceFlows<S> for CoordinateFlows<'_, S, P> {
    type State = P::State;

    fn pieces(&self) -> usize {
        self.system.dimension()
    }

    fn direction(&self, piece: usize, t: S, mu: &P::State, xi: &mut P::State) {
        piece_direction(self.system, piece, t, mu, xi);
    }

    fn flow(&mut self, piece: usize, t: S, mu: &mut P::State) {
        piece_direction(self.system, piece, t, mu, &mut self.direction);
        let (direction, scratch) = (&self.direction, &mut self.scratch);
        coadjoint_action_in(self.system, direction, mu, &mut self.next, scratch);
        mu.copy_from(&self.next);
    }
}

/// The element along which a coordinate piece moves in a time t: `xi = t (dH/dmu_i) e_i`.
pub fn piece_direction<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    coordinate: usize,
    t: S,
    mu: &P::State,
    xi: &mut P::State,
) {
    system.gradient(mu, xi);
    let speed = t * xi.as_slice()[coordinate];
    xi.fill(S::zero());
    xi.as_mut_slice()[coordinate] = speed;
}
