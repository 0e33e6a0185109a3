//! The flows of pieces that were found, by the exponentials of their directions.

use core::marker::PhantomData;

use crate::pieces::PieceFlows;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::State;

/// Pieces of a Hamiltonian whose flows are products of one-parameter groups, part by part.
pub trait Parts<S: Scalar>: LiePoisson<S> {
    /// The parts of each piece, and whether they move mu: a Casimir of the algebra does not.
    fn parts(&self) -> &[&[bool]];
    /// Whether the pieces are all of H.
    fn are_whole(&self) -> bool;
    /// The gradient of a part, which is constant along the flow of the part.
    fn part_direction(&self, piece: usize, part: usize, mu: &Self::State, xi: &mut Self::State);
}

/// The flows of the pieces.
#[derive(Debug)]
pub struct PartFlows<'a, S: Scalar, P: Parts<S>> {
    system: &'a P,
    direction: P::State,
    next: P::State,
    scalar: PhantomData<S>,
}

impl<'a, S: Scalar, P: Parts<S>> PartFlows<'a, S, P> {
    /// The flows of the pieces of a system.
    pub fn new(system: &'a P) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            direction: zero.clone(),
            next: zero,
            scalar: PhantomData,
        }
    }
}

fn scale<S: Scalar>(t: S, xi: &mut impl State<S>) {
    for entry in xi.as_mut_slice() {
        *entry = t * *entry;
    }
}

impl<S: Scalar, P: Parts<S>> PieceFlows<S> for PartFlows<'_, S, P> {
    type State = P::State;

    fn pieces(&self) -> usize {
        self.system.parts().len()
    }

    fn direction(&self, piece: usize, t: S, mu: &P::State, xi: &mut P::State) {
        let mut of_part = self.system.zero_state();
        xi.fill(S::zero());
        for part in 0..self.system.parts()[piece].len() {
            self.system.part_direction(piece, part, mu, &mut of_part);
            for (sum, entry) in xi.as_mut_slice().iter_mut().zip(of_part.as_slice()) {
                *sum += *entry;
            }
        }
        scale(t, xi);
    }

    fn flow(&mut self, piece: usize, t: S, mu: &mut P::State) {
        let mut factor = self.system.zero_state();
        self.follow(piece, t, mu, &mut factor, &mut |_| {});
    }

    fn follow(
        &mut self,
        piece: usize,
        t: S,
        mu: &mut P::State,
        factor: &mut P::State,
        give: &mut dyn FnMut(&mut P::State),
    ) {
        for (part, moves) in self.system.parts()[piece].iter().enumerate() {
            self.system
                .part_direction(piece, part, mu, &mut self.direction);
            scale(t, &mut self.direction);
            factor.copy_from(&self.direction);
            give(factor);
            if *moves {
                self.system
                    .coadjoint_action(&self.direction, mu, &mut self.next);
                mu.copy_from(&self.next);
            }
        }
    }

    fn rest(&self, t: S, mu: &P::State, xi: &mut P::State) -> bool {
        if self.system.are_whole() {
            return false;
        }
        self.system.gradient(mu, xi);
        let mut of_part = self.system.zero_state();
        for (piece, parts) in self.system.parts().iter().enumerate() {
            for part in 0..parts.len() {
                self.system.part_direction(piece, part, mu, &mut of_part);
                for (rest, entry) in xi.as_mut_slice().iter_mut().zip(of_part.as_slice()) {
                    *rest -= *entry;
                }
            }
        }
        scale(t, xi);
        true
    }
}
