//! Splittings of families: pieces of H whose flows are exact, each for as many sites at once as do not touch.
//!
//! A piece is a function of one coordinate of each site, a function of sums of such functions over all sites, or a bond of two
//! sites at a fixed distance: a product of a coordinate of each, or on so(3) the exchange `s_i . s_j`, along whose flow both
//! spins turn about their sum. Bonds of a kind are done in two pieces, those that begin at even and at odd places, or in three
//! where a ring has an odd number of them.

use super::bonds::Bonds;
use super::columns::Columns;
use super::energy::Totals;
use super::exchange::Exchange;
use super::rates::{Rate, coefficients, data, rate};
use super::shape::Shape as _;
use super::sites::{Around, Site, Sums};
use super::stencil::{around, wrapped};
use super::{Family, Sites, Span};
use crate::pieces::{FoundPoisson, PieceFlows};
use crate::scalar::Scalar;
use core::array::from_fn;
use core::ops::Range;
use std::vec::Vec;

/// A kind of pieces: a function of one site, or a bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// The distance of the second site of a bond, in rows and columns; 0 of a function of one site.
    pub offset: [isize; 2],
    /// The sites that it goes over, the first ones of bonds.
    pub spans: [Span; 2],
    /// Whether it is a function of sums over these sites, which its flow keeps.
    pub collective: bool,
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
    fn exchange(&self, kind: usize) -> Option<S>;
    /// What a site adds to the sums of which a piece is a function; 0 of all other sums.
    fn share(&self, kind: usize, one: &Site<Self, S>) -> Sums<Self, S>;
    /// The rate of an exchange whose coefficients, those behind the coordinates of `at` around its first site, differ from site
    /// to site.
    fn exchange_of(&self, kind: usize, _at: &Around<Self, S>) -> Option<S> {
        self.exchange(kind)
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
    let dimension = kernels.dimension();
    let site = |mu: &[S], place: usize| K::Site::make(dimension, |k| mu[k * strip.sites + place]);
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

/// Sites of a row, or bonds, that are done together: where the first and where the second ones stand, one behind the other.
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

/// A piece: a kind, of bonds those of one colour.
struct Piece<S> {
    place: usize,
    kind: Kind,
    colour: u8,
    bonds: Option<Bonds>,
    exchange: Option<Rate<S>>,
}

/// The flows of the pieces of a family. They act on states in an order of their own, see [`PieceFlows::gather`].
pub struct FamilyFlows<'a, S, K> {
    family: &'a Family<K>,
    columns: Columns,
    pieces: Vec<Piece<S>>,
    /// The coefficients that kernels read, of each as many as there are sites, in the order of the states.
    data: Vec<S>,
    /// A bound of the squares of all spins, which exchanges ask for.
    largest: S,
}

impl<'a, S, K> FamilyFlows<'a, S, K>
where
    S: Scalar,
    K: Pieces<S>,
{
    fn new(family: &'a Family<K>) -> Self {
        let (mut pieces, mut modulus) = (Vec::new(), 1);
        for (place, &kind) in family.kernels().kinds().iter().enumerate() {
            let bonds = Bonds::new(kind, family.sizes());
            if let Some(bonds) = bonds.filter(|bonds| bonds.axis == 1) {
                modulus = bonds.period().max(modulus);
            }
            for colour in 0..bonds.map_or(1, Bonds::colours) {
                pieces.push(Piece {
                    place,
                    kind,
                    colour,
                    bonds,
                    exchange: None,
                });
            }
        }
        let columns = Columns::new(family.sizes()[1], modulus);
        let data = data(family, columns);
        for piece in &mut pieces {
            piece.exchange = rate(family, (&data, columns), (piece.place, piece.kind));
        }
        Self {
            family,
            columns,
            pieces,
            data,
            // the flow of an exchange of any spins, until a state is taken
            largest: S::one() / S::zero(),
        }
    }

    /// The strips of a piece whose first sites are in a row.
    fn strips(&self, piece: &Piece<S>, row: usize, mut then: impl FnMut(Strip)) {
        let [rows, columns] = self.family.sizes();
        let Piece {
            kind,
            bonds,
            colour,
            ..
        } = *piece;
        let strip = |places: [usize; 2], count: usize| Strip {
            places,
            count,
            sites: rows * columns,
            bonds: bonds.is_some(),
        };
        let own = |axis: usize, place: usize| {
            bonds.is_none_or(|bonds| bonds.axis != axis || bonds.colour(place) == colour)
        };
        if !kind.spans[0].holds(row as isize, rows) || !own(0, row) {
            return;
        }
        let begin = row * columns;
        let below = wrapped(row as isize + kind.offset[0], rows) * columns;
        let span = kind.spans[1].range(columns);
        let of_columns = bonds.filter(|bonds| bonds.axis == 1);
        if of_columns.is_none() && span == (0..columns) {
            // whole rows, whatever the order of their columns is
            return then(strip([begin, below], columns));
        }
        let parts = of_columns.map_or([(span.clone(), 0), (0..0, 0)], |bonds| {
            bonds.stretches(span)
        });
        let step = self.columns.modulus();
        for (Range { start, end }, shift) in parts {
            for first in (start..end.min(start + step)).filter(|first| own(1, *first)) {
                let second = (first as isize + shift) as usize;
                let places = [
                    begin + self.columns.place(first),
                    below + self.columns.place(second),
                ];
                then(strip(places, (end - first).div_ceil(step)));
            }
        }
    }

    /// The sums of which a piece is a function.
    fn sums(&self, piece: &Piece<S>, mu: &[S]) -> Sums<K, S> {
        let (family, kernels) = (self.family, self.family.kernels());
        let mut totals = Totals::<K::Sums, S>::new(kernels.count());
        if piece.kind.collective {
            for row in 0..family.sizes()[0] {
                self.strips(piece, row, |strip| {
                    let first = strip.places[0];
                    for site in first..first + strip.count {
                        let share = kernels.share(piece.place, &family.site(mu, site));
                        totals.add(share.as_ref());
                    }
                });
            }
        }
        totals.end()
    }

    /// The flow of a piece that is no exchange.
    fn sites(&self, piece: &Piece<S>, t: S, mu: &mut [S]) {
        let sums = self.sums(piece, mu);
        for row in 0..self.family.sizes()[0] {
            self.strips(piece, row, |strip| {
                let kernels = self.family.kernels();
                kernels.flows(piece.place, t, (&sums, &self.data), &strip, mu);
            });
        }
    }

    /// The flow of exchanges.
    fn exchanges(&self, piece: &Piece<S>, rate: &Rate<S>, t: S, mu: &mut [S]) {
        let exchange = match rate {
            Rate::Same(rate) => Exchange::new(*rate * t, self.largest),
            Rate::Each(_, most) => Exchange::of_each(t, *most, self.largest),
        };
        for row in 0..self.family.sizes()[0] {
            self.strips(piece, row, |strip| {
                let mut parts = mu.chunks_exact_mut(self.family.count());
                let components: [_; 3] = from_fn(|_| match parts.next() {
                    Some(part) => strip.pair(part),
                    None => unreachable!("a spin has three components"),
                });
                let [[x1, x2], [y1, y2], [z1, z2]] = components;
                let pairs = [[x1, y1, z1], [x2, y2, z2]];
                match rate {
                    Rate::Same(_) => exchange.flow(pairs),
                    Rate::Each(rates, _) => {
                        exchange.flow_of_each(pairs, &rates[strip.places[0]..][..strip.count]);
                    }
                }
            });
        }
    }
}

impl Strip {
    /// The first and the second numbers, which are apart.
    fn pair<'m, S>(&self, numbers: &'m mut [S]) -> [&'m mut [S]; 2] {
        let ([first, second], count) = (self.places, self.count);
        let (before, behind) = numbers.split_at_mut(first.max(second));
        if first < second {
            [&mut before[first..][..count], &mut behind[..count]]
        } else {
            [&mut behind[..count], &mut before[second..][..count]]
        }
    }
}

/// The largest square of the first three coordinates of a site, in parts that do not wait for each other.
fn largest_square<S: Scalar>(mu: &[S], sites: usize) -> S {
    let components: [&[S]; 3] = from_fn(|k| &mu[k * sites..][..sites]);
    let [(x, x_rest), (y, y_rest), (z, z_rest)] = components.map(|part| part.as_chunks::<8>());
    let larger = |most: S, x: S, y: S, z: S| {
        let square = x * x + y * y + z * z;
        S::select(square.less(most), most, square)
    };
    let mut parts = [S::zero(); 8];
    for ((x, y), z) in x.iter().zip(y).zip(z) {
        for (k, part) in parts.iter_mut().enumerate() {
            *part = larger(*part, x[k], y[k], z[k]);
        }
    }
    for (part, ((x, y), z)) in parts.iter_mut().zip(x_rest.iter().zip(y_rest).zip(z_rest)) {
        *part = larger(*part, *x, *y, *z);
    }
    parts.into_iter().fold(S::zero(), S::max)
}

impl<S, K> PieceFlows<S> for FamilyFlows<'_, S, K>
where
    S: Scalar,
    K: Pieces<S>,
{
    type State = Vec<S>;

    fn pieces(&self) -> usize {
        self.pieces.len()
    }

    fn direction(&self, _piece: usize, _t: S, _mu: &Vec<S>, _xi: &mut Vec<S>) {
        unreachable!("nobody follows the group element of a family")
    }

    fn gather(&mut self, mu: &Vec<S>, next: &mut Vec<S>) {
        self.columns.gather(mu, next);
        if self.pieces.iter().any(|piece| piece.exchange.is_some()) {
            self.largest = largest_square(mu, self.family.count());
        }
    }

    fn scatter(&self, lanes: S::Mask, next: &Vec<S>, mu: &mut Vec<S>) {
        self.columns.scatter(lanes, next, mu);
    }

    fn flow(&mut self, piece: usize, t: S, mu: &mut Vec<S>) {
        let piece = &self.pieces[piece];
        if piece.bonds.is_none() && piece.kind.offset != [0, 0] {
            // a bond of a site with itself is no such piece
            return mu.fill(S::zero() / S::zero());
        }
        match &piece.exchange {
            Some(rate) => self.exchanges(piece, rate, t, mu),
            None => self.sites(piece, t, mu),
        }
    }
}

impl<S, K> FoundPoisson<S> for Family<K>
where
    S: Scalar,
    K: Pieces<S>,
{
    type Found<'a>
        = FamilyFlows<'a, S, K>
    where
        Self: 'a;

    fn found(&self) -> Self::Found<'_> {
        FamilyFlows::new(self)
    }
}
