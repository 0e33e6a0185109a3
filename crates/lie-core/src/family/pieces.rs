//! What generated code says of the pieces of H whose flows are exact, and of what acts beside them.

use super::rates::coefficients;
use super::shape::Shape as _;
use super::sites::{Around, Site, Sums};
use super::stencil::around;
use super::{Sites, Span};
use crate::lattice::AXES;
use crate::scalar::Scalar;

/// A kind of pieces: a function of one site, or a bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// The distance of the second site of a bond, in layers, rows and columns; 0 of a function of one site.
    pub offset: [isize; AXES],
    /// The sites that it goes over, the first ones of bonds.
    pub spans: [Span; AXES],
    /// Whether it is a function of sums over these sites, which its flow keeps.
    pub collective: bool,
}

/// What a piece does beside moving sites along their orbits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effects {
    /// It depends on the time by itself: its flow moves the momentum of the time.
    pub timed: bool,
    /// It is a force: sites leave their orbits.
    pub pushes: bool,
    /// It is a force whose work is taken from the momentum of the time; noise does none.
    pub works: bool,
}

/// Sites whose sums have pieces with exact flows. Generated where the compiler finds them.
#[diagnostic::on_unimplemented(
    message = "the family of `{Self}` cannot be split over the scalar `{S}`",
    note = "splittings need a Hamiltonian that consists of functions of one coordinate and of bonds with exact flows: `lie check` says what stands against it"
)]
pub trait Pieces<S: Scalar>: Sites<S> {
    /// The kinds of pieces.
    fn kinds(&self) -> &[Kind];
    /// The rate of an exchange, `s_1' = rate (s_1 + s_2) x s_1`; none of another kind.
    fn exchange(&self, _kind: usize) -> Option<S> {
        None
    }
    /// What a site adds to the sums of which a piece is a function; 0 of all other sums.
    fn share(&self, _kind: usize, _one: &Site<Self, S>) -> Sums<Self, S> {
        unreachable!("there is `share`, or `shared_share`")
    }
    /// The rate of an exchange whose coefficients, those behind the coordinates of `at` around its first site, differ from site
    /// to site.
    fn exchange_of(&self, kind: usize, _at: &Around<Self, S>) -> Option<S> {
        self.exchange(kind)
    }
    /// The same, with what all sites share behind the place of the sums.
    fn shared_exchange(
        &self,
        kind: usize,
        at: &Around<Self, S>,
        _shared: &Sums<Self, S>,
    ) -> Option<S> {
        self.exchange_of(kind, at)
    }
    /// [`Pieces::share`], with what all sites share behind the place of the sums.
    fn shared_share(
        &self,
        kind: usize,
        one: &Site<Self, S>,
        _shared: &Sums<Self, S>,
    ) -> Sums<Self, S> {
        self.share(kind, one)
    }
    /// What a piece does beside moving sites along their orbits.
    fn effects(&self, _kind: usize) -> Effects {
        Effects::default()
    }
    /// What a site or a bond adds to the derivative of a piece by the time.
    fn time_slope_of(
        &self,
        _kind: usize,
        (_sums, _at): (&Sums<Self, S>, &Around<Self, S>),
        _one: &Site<Self, S>,
        _other: &Site<Self, S>,
    ) -> S {
        S::zero()
    }
    /// What a piece that is a function of sums has of that derivative beside what its sites add.
    fn time_slope_of_sums(&self, _kind: usize, _sums: &Sums<Self, S>) -> S {
        S::zero()
    }
    /// What H is beside its pieces: a function of the time and of inputs.
    fn rest(&self, _shared: &Sums<Self, S>) -> S {
        S::zero()
    }

    /// The flow of a piece over a time t, of a site or of a bond, at these values of its sums. Implemented where no coefficient
    /// differs from site to site.
    #[inline]
    fn flow(
        &self,
        kind: usize,
        t: S,
        sums: &Sums<Self, S>,
        one: &mut Site<Self, S>,
        other: &mut Site<Self, S>,
    ) {
        let none = Self::Around::make(around(self), |_| S::zero());
        self.flow_of(kind, t, (sums, &none), one, other);
    }
    /// The same with coefficients, those behind the coordinates of `at` around the first site.
    #[inline]
    fn flow_of(
        &self,
        kind: usize,
        t: S,
        (sums, _at): (&Sums<Self, S>, &Around<Self, S>),
        one: &mut Site<Self, S>,
        other: &mut Site<Self, S>,
    ) {
        self.flow(kind, t, sums, one, other);
    }

    /// The flow of a piece over a time t for many sites or bonds of a state: [`Pieces::flow`] of each. `data` are the coefficients
    /// that kernels read, of each as many as there are sites, in the order of the state.
    #[inline(always)]
    fn flows(
        &self,
        kind: usize,
        t: S,
        (sums, data): (&Sums<Self, S>, &[S]),
        strip: &Strip,
        mu: &mut [S],
    ) {
        site_by_site(self, kind, t, (sums, data), strip, mu);
    }

    /// [`Pieces::time_slope_of`] of all sites or bonds of a strip, added one after the other.
    #[inline(always)]
    fn time_slopes(
        &self,
        kind: usize,
        (sums, data): (&Sums<Self, S>, &[S]),
        strip: &Strip,
        mu: &[S],
    ) -> S {
        let site = |place: usize| strip.site(self, mu, place);
        let mut sum = S::zero();
        for i in 0..strip.count {
            let [first, second] = strip.places.map(|place| place + i);
            let at = coefficients(self, data, strip.sites, first);
            sum += self.time_slope_of(kind, (sums, &at), &site(first), &site(second));
        }
        sum
    }
}

/// [`Pieces::flow`] of one site or bond of a strip after the other.
#[inline(always)]
pub fn site_by_site<S: Scalar, K: Pieces<S>>(
    kernels: &K,
    kind: usize,
    t: S,
    (sums, data): (&Sums<K, S>, &[S]),
    strip: &Strip,
    mu: &mut [S],
) {
    let site = |mu: &[S], place: usize| strip.site(kernels, mu, place);
    let set = |mu: &mut [S], place: usize, value: &Site<K, S>| {
        for (k, value) in value.as_ref().iter().enumerate() {
            mu[k * strip.sites + place] = *value;
        }
    };
    for i in 0..strip.count {
        let [first, second] = strip.places.map(|place| place + i);
        let (mut one, mut other) = (site(mu, first), site(mu, second));
        if data.is_empty() {
            kernels.flow(kind, t, sums, &mut one, &mut other);
        } else {
            let at = coefficients(kernels, data, strip.sites, first);
            kernels.flow_of(kind, t, (sums, &at), &mut one, &mut other);
        }
        if strip.bonds {
            set(mu, second, &other);
        }
        set(mu, first, &one);
    }
}

/// Sites of a line, or bonds, that are done together: where the first and where the second ones stand, one behind the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strip {
    /// The places of the first sites.
    pub places: [usize; 2],
    /// How many there are.
    pub count: usize,
    /// The number of sites of the family: how far apart the coordinates of a site are.
    pub sites: usize,
    /// Whether they are bonds; else first and second sites are the same.
    pub bonds: bool,
}

impl Strip {
    /// The coordinates of the site at a place.
    #[inline(always)]
    fn site<S: Scalar, K: Sites<S>>(&self, kernels: &K, mu: &[S], place: usize) -> Site<K, S> {
        K::Site::make(kernels.dimension(), |k| mu[k * self.sites + place])
    }

    /// The first and the second numbers, which are apart.
    pub(super) fn pair<'m, S>(&self, numbers: &'m mut [S]) -> [&'m mut [S]; 2] {
        let ([first, second], count) = (self.places, self.count);
        let (before, behind) = numbers.split_at_mut(first.max(second));
        if first < second {
            [&mut before[first..][..count], &mut behind[..count]]
        } else {
            [&mut behind[..count], &mut before[second..][..count]]
        }
    }
}
