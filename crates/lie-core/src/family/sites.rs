//! What generated code says of one site of a family.

use super::shape::{Of, Shape};
use super::stencil::{Stretch, gathered};
use crate::lattice::AXES;
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
pub struct Term<'a> {
    /// The slots that the summand depends on.
    pub slots: &'a [usize],
    /// The sites, by layer, row and column.
    pub spans: [Span; AXES],
}

/// The coordinates of a site.
pub type Site<K, S> = Of<<K as Sites<S>>::Site, S>;
/// The coordinates of a site and of its neighbours, slot after slot, then the coefficients of [`Sites::data_places`] and the rates of the
/// Wiener processes of the site.
pub type Around<K, S> = Of<<K as Sites<S>>::Around, S>;
/// A number for each sum, and behind them what all sites share ([`Sites::shared_count`]).
pub type Sums<K, S> = Of<<K as Sites<S>>::Sums, S>;

/// The number of sums, and of what all sites share behind them.
pub(super) fn width<S: Scalar, K: Sites<S>>(sites: &K) -> usize {
    sites.count() + sites.shared_count()
}

/// One site of a family: its coordinates, on which and on those of its neighbours (in slots, itself among them) sums depend.
///
/// Generated, with straight-line kernels over arrays; lengths that are found at run time have another [`Shape`]. `at` are the
/// coordinates of a site and of its neighbours, slot after slot, and behind them coefficients that differ from site to site; `weights[k]` is `dF/dT_k`, which is asked for only where it
/// is no constant, and behind them stands what all sites share, the time and inputs.
pub trait Sites<S: Scalar>: Clone {
    /// How many coordinates a site has.
    type Site: Shape;
    /// How many coordinates all slots have, and coefficients that kernels read.
    type Around: Shape;
    /// How many sums there are.
    type Sums: Shape;
    /// The same over eight numbers at once.
    type Widened: Sites<S::Wide>;
    /// The same over dual numbers.
    type Lifted: Sites<Dual<S>>;

    /// The name of the system.
    fn name(&self) -> &str;
    /// The number of coordinates of a site.
    fn dimension(&self) -> usize;
    /// The name of a coordinate of a site.
    fn coordinate(&self, index: usize) -> &str;
    /// The distances of the slots in layers, rows and columns.
    fn offsets(&self) -> &[[isize; AXES]];
    /// The number of sums.
    fn count(&self) -> usize;
    /// A sum.
    fn term(&self, index: usize) -> Term<'_>;
    /// Which coefficients that have a value for each site kernels read: the slot, and which of them it is.
    fn data_places(&self) -> &[[usize; 2]] {
        &[]
    }
    /// The values of such a coefficient, site after site.
    fn data(&self, _index: usize) -> &[S] {
        &[]
    }
    /// Whether forces, damping or noise act on a site beside H.
    fn acts(&self) -> bool {
        false
    }
    /// Whether forces are among that: coadjoint orbits are left.
    fn is_forced(&self) -> bool {
        false
    }
    /// The number of Wiener processes of a site.
    fn noise_count(&self) -> usize {
        0
    }
    /// Whether damping along orbits is among what acts, and no force.
    fn is_damped(&self) -> bool {
        self.acts() && !self.is_forced()
    }
    /// Whether the state carries the time, with its momentum and a unit: something acts, or something depends on the time.
    fn is_timed(&self) -> bool {
        self.acts()
    }
    /// Whether H does not depend on the time.
    fn is_autonomous(&self) -> bool {
        true
    }
    /// How many numbers all sites share: the time and behind it the inputs, or none. They stand behind the sums.
    fn shared_count(&self) -> usize {
        0
    }
    /// The name of an input.
    fn input_name(&self, _index: usize) -> &str {
        ""
    }
    /// Its value where nobody sets it.
    fn input_default(&self, _index: usize) -> S {
        S::zero()
    }
    /// The time from one of its samplings to the next; every step where it is `None`.
    fn input_sampling(&self, _index: usize) -> Option<f64> {
        None
    }
    /// Whether the motion keeps a Casimir of a site.
    fn casimir_is_kept(&self, _index: usize) -> bool {
        true
    }
    /// Whether some `dF/dT_k` depends on the state.
    fn has_mean_field(&self) -> bool;
    /// The total degree of H, where it is a polynomial.
    fn degree(&self) -> Option<u32>;
    /// The number of Casimirs of a site.
    fn casimir_count(&self) -> usize;
    /// The name of a Casimir of a site.
    fn casimir_name(&self, index: usize) -> &str;
    /// Its total degree, where it is a polynomial.
    fn casimir_degree(&self, index: usize) -> Option<u32>;

    /// The vector field of a site of which every sum has all summands.
    fn field(&self, at: &Around<Self, S>, weights: &Sums<Self, S>) -> Site<Self, S>;
    /// `dF/dT_k` times the derivative of the summand k by the coordinates in a slot, `at` the site of the summand.
    fn slope(
        &self,
        term: usize,
        slot: usize,
        at: &Around<Self, S>,
        weights: &Sums<Self, S>,
    ) -> Site<Self, S>;
    /// The summands, where they depend on nothing that all sites share.
    fn summands(&self, _at: &Around<Self, S>) -> Sums<Self, S> {
        unreachable!("there are `summands`, or `shared_summands`")
    }
    /// The summands, with what all sites share behind the place of the sums.
    fn shared_summands(&self, at: &Around<Self, S>, _shared: &Sums<Self, S>) -> Sums<Self, S> {
        self.summands(at)
    }
    /// `F(T_1, …)`.
    fn energy(&self, totals: &Sums<Self, S>) -> S;
    /// `dH/dt`, from the sums and from those of `ds_k/dt`.
    fn time_slope(&self, _totals: &Sums<Self, S>) -> S {
        S::zero()
    }
    /// `dF/dT_k`; those that are constant may be left 0.
    fn weights(&self, totals: &Sums<Self, S>) -> Sums<Self, S>;

    /// The bonds between any two sites, for each the sites i and j and a value.
    fn bonds(&self) -> &[S] {
        &[]
    }
    /// What a bond adds to the sums.
    fn bond_summands(
        &self,
        _one: &Site<Self, S>,
        _other: &Site<Self, S>,
        _value: S,
    ) -> Sums<Self, S> {
        unreachable!("there are no bonds")
    }
    /// The same, with what all sites share behind the place of the sums.
    fn shared_bond_summands(
        &self,
        one: &Site<Self, S>,
        other: &Site<Self, S>,
        value: S,
        _shared: &Sums<Self, S>,
    ) -> Sums<Self, S> {
        self.bond_summands(one, other, value)
    }
    /// What it adds to dH/dmu at its sites.
    fn bond_slopes(
        &self,
        _one: &Site<Self, S>,
        _other: &Site<Self, S>,
        _value: S,
        _weights: &Sums<Self, S>,
    ) -> [Site<Self, S>; 2] {
        unreachable!("there are no bonds")
    }
    /// The number of functions of the sums that are recorded.
    fn observable_count(&self) -> usize {
        0
    }
    /// The name of one.
    fn observable_name(&self, _index: usize) -> &str {
        ""
    }
    /// Whether it is an angle, whose jumps by 2 pi a driver takes out along a run.
    fn observable_unwraps(&self, _index: usize) -> bool {
        false
    }
    /// Its value.
    fn observable(&self, _index: usize, _totals: &Sums<Self, S>) -> S {
        S::zero()
    }

    /// The motion of a site from `dH/dmu` there, and the power of what acts on it: `ad*_xi mu + F` with `xi = dH/dmu + c G ad*_(dH/dmu) mu`
    /// and what noise adds, and `<F, dH/dmu> - c <v, G v>` with `v = ad*_(dH/dmu) mu`. Where nothing acts nobody asks.
    fn act(&self, _slope: &Site<Self, S>, _at: &Around<Self, S>) -> (Site<Self, S>, S) {
        unreachable!("nothing acts beside H")
    }
    /// The same, with what all sites share behind the place of the sums.
    fn shared_act(
        &self,
        slope: &Site<Self, S>,
        at: &Around<Self, S>,
        _shared: &Sums<Self, S>,
    ) -> (Site<Self, S>, S) {
        self.act(slope, at)
    }
    /// The same of a site of which every sum has all summands.
    fn driven(&self, at: &Around<Self, S>, weights: &Sums<Self, S>) -> (Site<Self, S>, S) {
        (self.field(at, weights), S::zero())
    }

    /// `[xi, eta]` of the algebra of a site.
    fn ad(&self, xi: &Site<Self, S>, eta: &Site<Self, S>) -> Site<Self, S>;
    /// `ad*_xi mu` of the algebra of a site.
    fn ad_star(&self, xi: &Site<Self, S>, mu: &Site<Self, S>) -> Site<Self, S>;
    /// A Casimir of a site.
    fn casimir(&self, index: usize, mu: &Site<Self, S>) -> S;
    /// Its gradient.
    fn casimir_gradient(&self, index: usize, mu: &Site<Self, S>) -> Site<Self, S>;

    /// The same with each constant eight times.
    fn widen(&self) -> Self::Widened;
    /// The same with each constant as a dual number.
    fn lift(&self) -> Self::Lifted;

    /// The vector field on a stretch, into a state: [`Sites::field`] of each of its sites.
    #[inline(always)]
    fn fields(&self, stretch: &Stretch<'_, S>, weights: &Sums<Self, S>, out: &mut [S]) {
        let along = stretch.around(self);
        let mut to = stretch.in_state::<Self::Site>(self.dimension(), out);
        for i in 0..stretch.len() {
            let at = gathered::<Self::Around, S>(along.as_ref(), i);
            let field = self.field(&at, weights);
            for (to, value) in to.as_mut().iter_mut().zip(field.as_ref()) {
                to[i] = *value;
            }
        }
    }

    /// [`Sites::driven`] of each site of a stretch, into a state; the power of all of them, added one after the other.
    #[inline(always)]
    fn driven_fields(&self, stretch: &Stretch<'_, S>, weights: &Sums<Self, S>, out: &mut [S]) -> S {
        let along = stretch.around(self);
        let mut to = stretch.in_state::<Self::Site>(self.dimension(), out);
        let mut power = S::zero();
        for i in 0..stretch.len() {
            let at = gathered::<Self::Around, S>(along.as_ref(), i);
            let (field, part) = self.driven(&at, weights);
            for (to, value) in to.as_mut().iter_mut().zip(field.as_ref()) {
                to[i] = *value;
            }
            power += part;
        }
        power
    }

    /// The summands of all sites of a stretch, added one after the other.
    #[inline(always)]
    fn sum(&self, stretch: &Stretch<'_, S>, shared: &Sums<Self, S>) -> Sums<Self, S> {
        let along = stretch.around(self);
        let mut sum = Self::Sums::make(width(self), |_| S::zero());
        (0..stretch.len()).for_each(|i| {
            let at = gathered::<Self::Around, S>(along.as_ref(), i);
            let summands = self.shared_summands(&at, shared);
            for (sum, summand) in sum.as_mut().iter_mut().zip(summands.as_ref()) {
                *sum += *summand;
            }
        });
        sum
    }
}
