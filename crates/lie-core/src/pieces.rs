//! Hamiltonians that are sums of functions of one coordinate each, and the flows of the pieces.

use crate::poisson::{LiePoisson, Poisson};
use crate::scalar::Scalar;
use crate::state::{State, Unknown as _};

/// The flows of the pieces of `$H = \sum_i f_i(\mu_i)$`, or of other pieces that are functions of quantities which commute.
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
    /// Whether friction and noise are among them, as in a family; else they stand behind these pieces
    /// ([`DrivenFlows`](crate::generic::DrivenFlows)).
    #[inline]
    fn has_acting(&self) -> bool {
        false
    }
    /// Copies a state as the other functions have it: a family has its sites in another order there, in which those that move
    /// together stand side by side.
    #[inline]
    fn gather(&mut self, mu: &Self::State, next: &mut Self::State) {
        next.copy_from(mu);
    }
    /// Copies such a state back, in the lanes of a mask.
    #[inline]
    fn scatter(&self, lanes: S::Mask, next: &Self::State, mu: &mut Self::State) {
        mu.assign_where(lanes, next);
    }
    /// The element of the algebra that a piece moves along, t times the gradient of the piece, `xi = t f_i'(mu_i) e_i`. Where it is constant
    /// along the flow, this is `Ad*_(exp xi)`.
    fn direction(&self, piece: usize, t: S, mu: &Self::State, xi: &mut Self::State);
    /// The flow of one piece over a time t.
    fn flow(&mut self, piece: usize, t: S, mu: &mut Self::State);

    /// The flow of one piece as a product of one-parameter groups: before each of them acts, `give` gets its element, which may
    /// be changed. One element, the direction, where the gradient of the piece is constant along its flow; of a function of a Casimir of a
    /// subalgebra, or of the whole algebra, whose gradient moves, several.
    ///
    /// `factor` is scratch space.
    fn follow(
        &mut self,
        piece: usize,
        t: S,
        mu: &mut Self::State,
        factor: &mut Self::State,
        give: &mut dyn FnMut(&mut Self::State),
    ) {
        self.direction(piece, t, mu, factor);
        give(factor);
        self.flow(piece, t, mu);
    }

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
    note = "splittings by coordinates need a Hamiltonian that is a sum of functions of one coordinate each: leave `.coordinate()` out for pieces that were found; see `lie_runtime::generic_equations!` for a system written by hand, or use `LieMidpoint::exp()` or a composition of it"
)]
pub trait SeparablePoisson<S: Scalar>: LiePoisson<S> {
    /// The flows; they may borrow the system.
    type Flows<'a>: PieceFlows<S, State = Self::State>
    where
        Self: 'a;
    /// The flows of the pieces.
    fn flows(&self) -> Self::Flows<'_>;
}

/// A system whose Hamiltonian is a sum of pieces with exact flows. On a bracket that is declared by its entries they are maps that were
/// found. A Lie–Poisson system is, up to a combination of Casimirs, a sum of functions of quantities that commute: `$H = \sum_a f_a(\langle v_{a1}, \mu\rangle, \dots, c_{a1}(\mu), \dots) + \sum_c \lambda_c C_c$`, the `$v$` elements
/// that commute, the `$c$` Casimirs of the algebra or of subalgebras.
///
/// Along the flow of a piece these quantities are constant, and each of them generates a one-parameter group. A Casimir of the
/// algebra generates no flow, so that the flows of the `$f_a$`
/// are those of pieces of the vector field of H. The pieces are the fewest that were found: two for the free rigid body,
/// whose H has three squares, and two for a top in a field along one of its axes; three for a ring of spins with exchange along three axes.
/// Where the functions of one coordinate each that H is declared as are as few, they are those.
///
/// Generated for systems that have the structure; by hand, for a sum of functions of one coordinate each, with
/// `lie_runtime::generic_equations!([S: Scalar] Body<S>, S: splitting);`.
#[diagnostic::on_unimplemented(
    message = "no pieces with exact flows are known for `{Self}` over the scalar `{S}`",
    note = "splittings need a Hamiltonian that is a sum of functions of commuting coordinates, of Casimirs of subalgebras and a quadratic function: `lie check` says what is found; see `lie_runtime::generic_equations!` for a system written by hand, or use `LieMidpoint::exp()` or a composition of it"
)]
pub trait FoundPoisson<S: Scalar>: Poisson<S> {
    /// The flows; they may borrow the system.
    type Found<'a>: PieceFlows<S, State = Self::State>
    where
        Self: 'a;
    /// The flows of the pieces that were found, and of what acts beside H.
    fn found(&self) -> Self::Found<'_>;
}
