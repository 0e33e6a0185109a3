//! What generated code says of one site of a family.

use crate::scalar::{Dual, Scalar};
use core::ops::Range;

/// Over which sites a sum goes, along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Over all of them; their indices count modulo the size.
    All,
    /// From one on, so that as many as said are left at the end.
    Within {
        /// The first site.
        first: usize,
        /// How many there are behind the last one.
        left: usize,
    },
}

impl Span {
    /// The sites that a sum goes over, of so many.
    #[inline]
    #[must_use]
    pub fn range(self, size: usize) -> Range<usize> {
        match self {
            Self::All => 0..size,
            Self::Within { first, left } => first..size.saturating_sub(left).max(first),
        }
    }

    /// Whether a sum goes over a site, of so many.
    #[inline]
    #[must_use]
    pub fn holds(self, site: isize, size: usize) -> bool {
        match self {
            Self::All => true,
            Self::Within { first, left } => {
                site >= first as isize && site + (left as isize) < size as isize
            }
        }
    }
}

/// One of the sums of which H is a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Term {
    /// The slots that the summand depends on.
    pub slots: &'static [usize],
    /// The sites, by row and by column.
    pub spans: [Span; 2],
}

/// One site of a family: C coordinates, on which and on those of its neighbours (L slots, itself among them) T sums depend.
///
/// Generated; the kernels are straight-line code. `at[slot]` are the coordinates of a site and of its neighbours,
/// `weights[k]` is `dF/dT_k`, which is asked for only where it is no constant.
pub trait Sites<S: Scalar, const C: usize, const L: usize, const T: usize>: Clone {
    /// The same over eight numbers at once.
    type Widened: Sites<S::Wide, C, L, T>;
    /// The same over dual numbers.
    type Lifted: Sites<Dual<S>, C, L, T>;

    /// Whether some `dF/dT_k` depends on the state.
    const MEAN_FIELD: bool;
    /// The number of Casimirs of a site.
    const CASIMIRS: usize;
    /// The distances of the slots in rows and columns.
    const OFFSETS: [[isize; 2]; L];
    /// The sums.
    const TERMS: [Term; T];
    /// The total degree of H, where it is a polynomial.
    const DEGREE: Option<u32>;

    /// The name of the system.
    fn name(&self) -> &'static str;
    /// The names of the coordinates of a site.
    fn coordinates(&self) -> [&'static str; C];
    /// The name of a Casimir of a site.
    fn casimir_name(&self, index: usize) -> &'static str;
    /// Its total degree, where it is a polynomial.
    fn casimir_degree(&self, index: usize) -> Option<u32>;

    /// The vector field of a site of which every sum has all summands.
    fn field(&self, at: &[[S; C]; L], weights: &[S; T]) -> [S; C];
    /// `dF/dT_k` times the derivative of the summand k by the coordinates in a slot, `at` the site of the summand.
    fn slope(&self, term: usize, slot: usize, at: &[[S; C]; L], weights: &[S; T]) -> [S; C];
    /// The summands.
    fn summands(&self, at: &[[S; C]; L]) -> [S; T];
    /// `F(T_1, …)`.
    fn energy(&self, totals: &[S; T]) -> S;
    /// `dF/dT_k`; those that are constant may be left 0.
    fn weights(&self, totals: &[S; T]) -> [S; T];

    /// `[xi, eta]` of the algebra of a site.
    fn ad(&self, xi: &[S; C], eta: &[S; C]) -> [S; C];
    /// `ad*_xi mu` of the algebra of a site.
    fn ad_star(&self, xi: &[S; C], mu: &[S; C]) -> [S; C];
    /// A Casimir of a site.
    fn casimir(&self, index: usize, mu: &[S; C]) -> S;
    /// Its gradient.
    fn casimir_gradient(&self, index: usize, mu: &[S; C]) -> [S; C];

    /// The same with each constant eight times.
    fn widen(&self) -> Self::Widened;
    /// The same with each constant as a dual number.
    fn lift(&self) -> Self::Lifted;
}
