//! Splittings of families: pieces of H whose flows are exact, each for as many sites at once as do not touch.
//!
//! A piece is a function of one coordinate of each site, a function of sums of such functions over all sites, or a bond of two
//! sites at a fixed distance: a product of a coordinate of each, or on so(3) the exchange `s_i . s_j`, along whose flow both
//! spins turn about their sum. Bonds of a kind are done in two pieces, those that begin at even and at odd places, or in three
//! where a ring has an odd number of them.
//!
//! Where a state carries the time, its momentum is the first piece: the time moves, and stands still in the flows of all others, along which its
//! momentum moves by what they change with the time. Friction and noise stand behind the pieces of H, as pieces of sites.

use super::bonds::Bonds;
use super::columns::Columns;
use super::energy::Totals;
use super::exchange::Exchange;
use super::rates::{Rate, data, rate};
use super::sites::{Sums, width};
use super::stencil::LAST;
use super::{Effects, Family, Kind, Pieces, Strip};
use crate::lattice::{self, AXES};
use crate::pieces::{FoundPoisson, PieceFlows};
use crate::poisson::Poisson as _;
use crate::scalar::Scalar;
use core::array::from_fn;
use core::ops::Range;
use std::vec::Vec;

/// A piece: a kind, of bonds those of one colour.
pub(super) struct Piece<S> {
    pub(super) place: usize,
    kind: Kind,
    colour: u8,
    bonds: Option<Bonds>,
    pub(super) effects: Effects,
    pub(super) exchange: Option<Rate<S>>,
}

/// The flows of the pieces of a family. They act on states in an order of their own, see [`PieceFlows::gather`].
pub struct FamilyFlows<'a, S, K> {
    pub(super) family: &'a Family<K>,
    pub(super) columns: Columns,
    pub(super) pieces: Vec<Piece<S>>,
    /// The coefficients that kernels read, of each as many as there are sites, in the order of the states; behind them the rates of noise.
    pub(super) data: Vec<S>,
    /// A bound of the squares of all spins, which exchanges ask for.
    largest: S,
    /// How often what all sites share has changed.
    pub(super) turn: u64,
    /// Space for a state in its own order, where work is done.
    pub(super) state: Vec<S>,
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
            if let Some(bonds) = bonds.filter(|bonds| bonds.axis == LAST) {
                modulus = bonds.period().max(modulus);
            }
            for colour in 0..bonds.map_or(1, Bonds::colours) {
                pieces.push(Piece {
                    place,
                    kind,
                    colour,
                    bonds,
                    effects: family.kernels().effects(place),
                    exchange: None,
                });
            }
        }
        let columns = Columns::new(family.columns(), modulus);
        let data = data(family, columns);
        for piece in &mut pieces {
            piece.exchange = rate(family, (&data, columns), (piece.place, piece.kind));
        }
        let works = pieces.iter().any(|piece| piece.effects.works);
        let state = if works {
            family.zero_state()
        } else {
            Vec::new()
        };
        Self {
            family,
            columns,
            pieces,
            data,
            // the flow of an exchange of any spins, until a state is taken
            largest: S::one() / S::zero(),
            turn: 0,
            state,
        }
    }

    /// The strips of a piece whose first sites are in a line.
    pub(super) fn strips(&self, piece: &Piece<S>, line: usize, mut then: impl FnMut(Strip)) {
        let (family, columns) = (self.family, self.family.columns());
        let Piece {
            kind,
            bonds,
            colour,
            ..
        } = *piece;
        let strip = |places: [usize; 2], count: usize| Strip {
            places,
            count,
            sites: family.count(),
            bonds: bonds.is_some(),
        };
        let own = |axis: usize, place: usize| {
            bonds.is_none_or(|bonds| bonds.axis != axis || bonds.colour(place) == colour)
        };
        let at = family.begin(line);
        let is_own = (0..LAST).all(|axis| own(axis, at[axis]));
        if !is_own || !family.line_holds(at, &kind.spans) {
            return;
        }
        let below = lattice::line(at, kind.offset, family.sizes()) * columns;
        let begin = line * columns;
        let span = kind.spans[LAST].range(columns);
        let of_columns = bonds.filter(|bonds| bonds.axis == LAST);
        if of_columns.is_none() && span == (0..columns) {
            // whole lines, whatever the order of their columns is
            return then(strip([begin, below], columns));
        }
        let parts = of_columns.map_or([(span.clone(), 0), (0..0, 0)], |bonds| {
            bonds.stretches(span)
        });
        let step = self.columns.modulus();
        for (Range { start, end }, shift) in parts {
            for first in (start..end.min(start + step)).filter(|first| own(LAST, *first)) {
                let second = (first as isize + shift) as usize;
                let places = [
                    begin + self.columns.place(first),
                    below + self.columns.place(second),
                ];
                then(strip(places, (end - first).div_ceil(step)));
            }
        }
    }

    /// The sums of which a piece is a function, with what all sites share behind them.
    pub(super) fn sums(&self, piece: &Piece<S>, mu: &[S]) -> Sums<K, S> {
        let (family, kernels) = (self.family, self.family.kernels());
        if !piece.kind.collective {
            return family.shared(mu);
        }
        let mut totals = Totals::<K::Sums, S>::new(width(kernels));
        let shared = family.shared(mu);
        for line in 0..family.lines() {
            self.strips(piece, line, |strip| {
                let first = strip.places[0];
                for site in first..first + strip.count {
                    let one = family.site(mu, site);
                    let share = kernels.shared_share(piece.place, &one, &shared);
                    totals.add(share.as_ref());
                }
            });
        }
        family.with_shared(totals.end(), mu)
    }

    /// The flow of a piece that is no exchange.
    pub(super) fn sites(&self, piece: &Piece<S>, t: S, sums: &Sums<K, S>, mu: &mut [S]) {
        for line in 0..self.family.lines() {
            self.strips(piece, line, |strip| {
                let kernels = self.family.kernels();
                kernels.flows(piece.place, t, (sums, &self.data), &strip, mu);
            });
        }
    }

    /// Takes the bound of the squares of all spins, where there are exchanges.
    fn measure(&mut self, mu: &[S]) {
        if self.pieces.iter().any(|piece| piece.exchange.is_some()) {
            self.largest = largest_square(mu, self.family.count());
        }
    }

    /// The flow of exchanges.
    fn exchanges(&self, piece: &Piece<S>, rate: &Rate<S>, t: S, mu: &mut [S]) {
        let exchange = match rate {
            Rate::Same(rate) => Exchange::new(*rate * t, self.largest),
            Rate::Each { most, .. } => Exchange::of_each(t, *most, self.largest),
        };
        for line in 0..self.family.lines() {
            self.strips(piece, line, |strip| {
                let mut parts = mu.chunks_exact_mut(self.family.count());
                let components: [_; 3] = from_fn(|_| match parts.next() {
                    Some(part) => strip.pair(part),
                    None => unreachable!("a spin has three components"),
                });
                let [[x1, x2], [y1, y2], [z1, z2]] = components;
                let pairs = [[x1, y1, z1], [x2, y2, z2]];
                match rate {
                    Rate::Same(_) => exchange.flow(pairs),
                    Rate::Each { rates, .. } => {
                        exchange.flow_of_each(pairs, &rates[strip.places[0]..][..strip.count]);
                    }
                }
            });
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
        self.pieces.len() + self.carries_time()
    }

    fn has_acting(&self) -> bool {
        true
    }

    fn direction(&self, _piece: usize, _t: S, _mu: &Vec<S>, _xi: &mut Vec<S>) {
        unreachable!("nobody follows the group element of a family")
    }

    fn gather(&mut self, mu: &Vec<S>, next: &mut Vec<S>) {
        let own = self.family.own();
        self.columns.gather(&mu[..own], &mut next[..own]);
        self.take_shared(&mu[own..], &mut next[own..]);
        self.measure(next);
    }

    fn scatter(&self, lanes: S::Mask, next: &Vec<S>, mu: &mut Vec<S>) {
        let own = self.family.own();
        self.columns.scatter(lanes, &next[..own], &mut mu[..own]);
        for place in own..own + 2 * self.carries_time() {
            mu[place] = S::select(lanes, next[place], mu[place]);
        }
    }

    fn flow(&mut self, piece: usize, t: S, mu: &mut Vec<S>) {
        let Some(place) = piece.checked_sub(self.carries_time()) else {
            return self.advance(t, mu);
        };
        let Piece {
            bonds,
            kind,
            effects,
            ..
        } = self.pieces[place];
        if bonds.is_none() && kind.offset != [0; AXES] {
            // a bond of a site with itself is no such piece
            return mu.fill(S::zero() / S::zero());
        }
        if effects.works {
            self.work(place, t, mu);
        } else if self.pieces[place].exchange.is_some() {
            self.refresh(place, mu);
            let piece = &self.pieces[place];
            if effects.timed {
                self.take_from_momentum(piece, t, &self.family.shared(mu), mu);
            }
            if let Some(rate) = &piece.exchange {
                self.exchanges(piece, rate, t, mu);
            }
        } else {
            let piece = &self.pieces[place];
            let sums = self.sums(piece, mu);
            if effects.timed {
                self.take_from_momentum(piece, t, &sums, mu);
            }
            self.sites(piece, t, &sums, mu);
        }
        if effects.pushes {
            self.measure(mu);
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
