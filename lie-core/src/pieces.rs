//! Hamiltonians that are sums of functions of one coordinate each, and the flows of the pieces.

use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::{State, Unknown as _};

/// The flows of the pieces of `$H = \sum_i f_i(\mu_i)$`, or of other pieces whose gradients are constant along their flows.
///
/// Along the flow of one piece its coordinate is constant, and with it the velocity `f_i'(mu_i) e_i`:
/// the flow over a time t is `exp(t f_i'(mu_i) ad*_(e_i)) mu`, a constant matrix to a varying power.
///
/// Pieces are counted from 0, in the order of their coordinates. Functions take `&mut self` so that
/// flows may keep scratch space; they allocate nothing.
pub trait PieceFlows<S: Scalar> {
    /// The state of the system.
    type State: State<S>;

    /// The number of pieces.
    fn pieces(&self) -> usize;
    /// Copies a state as the other functions have it: a family has its sites in another order there, in which those that move
    /// together stand side by side.
    #[inline]
    fn take(&mut self, mu: &Self::State, next: &mut Self::State) {
        next.copy_from(mu);
    }
    /// Copies such a state back, in the lanes of a mask.
    #[inline]
    fn give(&self, lanes: S::Mask, next: &Self::State, mu: &mut Self::State) {
        mu.assign_where(lanes, next);
    }
    /// The element of the algebra that a piece moves along in a time t, t times the gradient of the piece, `xi = t f_i'(mu_i) e_i`: its
    /// flow is `Ad*_(exp xi)`.
    fn direction(&self, piece: usize, t: S, mu: &Self::State, xi: &mut Self::State);
    /// The flow of one piece over a time t.
    fn flow(&mut self, piece: usize, t: S, mu: &mut Self::State);

    /// What H is beside the pieces generates no flow of mu, but moves the group element that mu
    /// comes from: the element of the algebra that is left of `t grad H(mu)` without the gradients of the pieces. False where the
    /// pieces are all of H.
    #[inline]
    fn rest(&self, _t: S, _mu: &Self::State, _xi: &mut Self::State) -> bool {
        false
    }

    /// The flow of the first piece over a time `first`, then those of all others but the last over a
    /// time t, in ascending order. There are at least two pieces.
    #[inline]
    fn ascend(&mut self, first: S, t: S, mu: &mut Self::State) {
        self.flow(0, first, mu);
        for piece in 1..self.pieces() - 1 {
            self.flow(piece, t, mu);
        }
    }
    /// The flow of the last piece over a time `last`, then those of all others but the first over a
    /// time t, in descending order. There are at least two pieces.
    #[inline]
    fn descend(&mut self, last: S, t: S, mu: &mut Self::State) {
        let end = self.pieces() - 1;
        self.flow(end, last, mu);
        for piece in (1..end).rev() {
            self.flow(piece, t, mu);
        }
    }
}

/// A Lie–Poisson system whose Hamiltonian is a sum of functions of one coordinate each.
///
/// Generated for systems that have the structure; by hand, with
/// `lie_runtime::generic_equations!([S: Scalar] Body<S>, S: splitting);`. Nobody else checks that H is
/// such a sum.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be split into coordinate pieces over the scalar `{S}`",
    note = "splittings need a Hamiltonian that is a sum of functions of one coordinate each: see `lie_runtime::generic_equations!` for a system written by hand, or use `LieMidpoint::exp()` or a composition of it"
)]
pub trait SeparablePoisson<S: Scalar>: LiePoisson<S> {
    /// The flows; they may borrow the system.
    type Flows<'a>: PieceFlows<S, State = Self::State>
    where
        Self: 'a;
    /// The flows of the pieces.
    fn flows(&self) -> Self::Flows<'_>;
}

/// A Lie–Poisson system whose Hamiltonian is, up to a combination of Casimirs, a sum of functions of linear forms
/// whose elements commute: `$H = \sum_a f_a(\langle v_{a1}, \mu\rangle, \dots) + \sum_c \lambda_c C_c$`.
///
/// Along the flow of a piece its forms and its gradient are constant. A Casimir generates no flow, so that the flows of the `$f_a$`
/// are those of pieces of the vector field of H. The pieces are the fewest that were found: two for the free rigid body,
/// whose H has three squares; three for a ring of spins with exchange along three axes.
///
/// Generated for systems that have the structure, where `methods` names a splitting.
#[diagnostic::on_unimplemented(
    message = "no pieces were found for `{Self}` over the scalar `{S}`",
    note = "found pieces need a splitting among the `methods` of the declaration, and a Hamiltonian that is a sum of functions of commuting coordinates and a quadratic function; `lie check` says what is found"
)]
pub trait FoundPoisson<S: Scalar>: LiePoisson<S> {
    /// The flows; they may borrow the system.
    type Found<'a>: PieceFlows<S, State = Self::State>
    where
        Self: 'a;
    /// The flows of the pieces that were found.
    fn found(&self) -> Self::Found<'_>;
}
