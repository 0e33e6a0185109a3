//! Hamiltonians that are sums of functions of one coordinate each, and the flows of the pieces.

use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The flows of the pieces of `$H = \sum_i f_i(\mu_i)$`.
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
    /// The element `xi = t f_i'(mu_i) e_i` of the algebra that a piece moves along in a time t: its
    /// flow is `Ad*_(exp xi)`.
    fn direction(&self, piece: usize, t: S, mu: &Self::State, xi: &mut Self::State);
    /// The flow of one piece over a time t.
    fn flow(&mut self, piece: usize, t: S, mu: &mut Self::State);

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
