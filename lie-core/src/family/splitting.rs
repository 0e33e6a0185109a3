//! Splittings of families: pieces of H whose flows are exact, each for as many sites at once as do not touch.
//!
//! A piece is a function of one coordinate of each site, or a bond of two sites at a fixed distance: a product of a coordinate
//! of each, or on so(3) the exchange `s_i . s_j`, along whose flow both spins turn about their sum. Bonds of a kind are done
//! in two pieces, those that begin at even and at odd places, or in three where a ring has an odd number of them.

use super::stencil::wrapped;
use super::{Family, Sites, Span};
use crate::pieces::{FoundPoisson, PieceFlows};
use crate::scalar::{Scalar, largest};
use core::array::from_fn;
use std::vec::Vec;

/// A kind of pieces: a function of one site, or a bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// The distance of the second site of a bond, in rows and columns; 0 of a function of one site.
    pub offset: [isize; 2],
    /// The sites that it goes over, the first ones of bonds.
    pub spans: [Span; 2],
}

/// Sites whose sums have pieces with exact flows. Generated where the compiler finds them.
#[diagnostic::on_unimplemented(
    message = "the family of `{Self}` cannot be split over the scalar `{S}`",
    note = "splittings need a Hamiltonian that consists of functions of one coordinate and of bonds with exact flows: `lie check` says what stands against it"
)]
pub trait Pieces<S: Scalar, const C: usize, const L: usize, const T: usize>:
    Sites<S, C, L, T>
{
    /// The kinds of pieces.
    const KINDS: &'static [Kind];

    /// The rate of an exchange, `s_1' = rate (s_1 + s_2) x s_1`; none of another kind.
    fn exchange(&self, kind: usize) -> Option<S>;
    /// The flow of a piece over a time t, of a site or of a bond.
    fn flow(&self, kind: usize, t: S, one: &mut [S; C], other: &mut [S; C]);
}

/// Sites that are done together.
const BLOCK: usize = 32;

/// The flows of the pieces of a family.
pub struct FamilyFlows<'a, K, const C: usize, const L: usize, const T: usize> {
    family: &'a Family<K, C, L, T>,
    /// Kind and colour of each piece.
    pieces: Vec<(usize, u8)>,
}

/// The bonds of a kind along the axis by which they are coloured.
#[derive(Clone, Copy)]
struct Cycle {
    /// Sites on a cycle of bonds.
    length: usize,
    /// The number of cycles.
    count: usize,
    /// The place on a cycle goes up by this with each site.
    inverse: usize,
    distance: usize,
    open: bool,
}

fn greatest_divisor(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        greatest_divisor(b, a % b)
    }
}

impl Cycle {
    fn new(distance: usize, size: usize, open: bool) -> Self {
        let count = greatest_divisor(distance % size, size);
        let (length, step) = (size / count, distance / count);
        let inverse = (1..length).find(|k| k * step % length == 1 % length);
        Self {
            length,
            count,
            inverse: inverse.unwrap_or(0),
            distance,
            open,
        }
    }

    /// How many colours there are.
    fn colours(self) -> u8 {
        match self.length {
            _ if self.open => 2,
            1 => 1,
            length => 2 + (length % 2) as u8,
        }
    }

    /// The colour of the bond that begins at a place.
    fn colour(self, place: usize) -> u8 {
        if self.length == 1 && !self.open {
            return 0;
        }
        if self.open {
            return (place / self.distance % 2) as u8;
        }
        let at = place / self.count * self.inverse % self.length;
        if at + 1 == self.length && self.length % 2 == 1 {
            2
        } else {
            (at % 2) as u8
        }
    }
}

/// The axis by which the bonds of a kind are coloured; none of a function of one site.
fn axis(kind: Kind) -> Option<usize> {
    match kind.offset {
        [0, 0] => None,
        [_, 0] => Some(0),
        _ => Some(1),
    }
}

impl<'a, K, const C: usize, const L: usize, const T: usize> FamilyFlows<'a, K, C, L, T> {
    fn new<S: Scalar>(family: &'a Family<K, C, L, T>) -> Self
    where
        K: Pieces<S, C, L, T>,
    {
        let kinds = K::KINDS.iter().enumerate();
        let pieces = kinds.flat_map(|(place, kind)| {
            let colours = Self::cycle(family, *kind).map_or(1, |(_, cycle)| cycle.colours());
            (0..colours).map(move |colour| (place, colour))
        });
        Self {
            family,
            pieces: pieces.collect(),
        }
    }

    fn cycle(family: &Family<K, C, L, T>, kind: Kind) -> Option<(usize, Cycle)> {
        let axis = axis(kind)?;
        let (distance, size) = (kind.offset[axis].unsigned_abs(), family.sizes()[axis]);
        let open = kind.spans[axis] != Span::All;
        Some((axis, Cycle::new(distance, size, open)))
    }

    /// The flow of the pieces of a kind and a colour whose first sites are in a row.
    fn row<S: Scalar>(&self, (place, colour): (usize, u8), row: usize, t: S, mu: &mut [S])
    where
        K: Pieces<S, C, L, T>,
    {
        let (family, kind) = (self.family, K::KINDS[place]);
        let [rows, columns] = family.sizes();
        let cycle = Self::cycle(family, kind);
        let of_rows = |(axis, cycle): (usize, Cycle)| axis == 0 && cycle.colour(row) != colour;
        if !kind.spans[0].holds(row as isize, rows) || cycle.is_some_and(of_rows) {
            return;
        }
        let cycle = cycle.filter(|(axis, _)| *axis == 1).map(|(_, cycle)| cycle);
        let below = wrapped(row as isize + kind.offset[0], rows) * columns;
        let (from, end) = match kind.spans[1] {
            Span::All => (0, columns),
            Span::Within { first, left } => (first, columns.saturating_sub(left)),
        };
        // columns in which nothing wraps around, every one or every second
        let (first, last, stride) = match (kind.offset[1], cycle) {
            (0, _) => (from, end, 1),
            (1, Some(_)) if colour < 2 => {
                let odd = (from + usize::from(colour)) % 2;
                (from + odd, end.min(columns - 1), 2)
            }
            (1, Some(_)) => (end, end.min(columns - 1), 2),
            _ => (end, from, 1),
        };
        let shift = kind.offset[1] as usize;
        for column in (first..last).step_by(stride * BLOCK) {
            let count = (last - column).div_ceil(stride).min(BLOCK);
            let places = [row * columns + column, below + column + shift];
            self.block(place, t, mu, places, (stride, count));
        }
        for column in last.max(from)..end {
            if cycle.is_none_or(|cycle| cycle.colour(column) == colour) {
                let other = below + wrapped(column as isize + kind.offset[1], columns);
                self.block(place, t, mu, [row * columns + column, other], (1, 1));
            }
        }
    }

    /// The flow of so many pieces, whose sites begin at places and are a stride apart.
    #[inline(always)]
    fn block<S: Scalar>(
        &self,
        kind: usize,
        t: S,
        mu: &mut [S],
        places: [usize; 2],
        (stride, count): (usize, usize),
    ) where
        K: Pieces<S, C, L, T>,
    {
        let (family, bond) = (self.family, K::KINDS[kind].offset != [0, 0]);
        let sites = family.count();
        let beside = stride == 2 && places[1] == places[0] + 1;
        let mut taken = [[[S::zero(); BLOCK]; C]; 2];
        let [one, other] = &mut taken;
        for (k, (one, other)) in one.iter_mut().zip(other.iter_mut()).enumerate() {
            let [first, second] = places.map(|place| &mu[k * sites + place..]);
            if beside {
                let pairs = first[..2 * count].chunks_exact(2);
                for ((one, other), pair) in one.iter_mut().zip(other).zip(pairs) {
                    (*one, *other) = (pair[0], pair[1]);
                }
            } else {
                for i in 0..count {
                    (one[i], other[i]) = (first[stride * i], second[stride * i]);
                }
            }
        }
        let [one, other] = &mut taken;
        if bond && places[0] == places[1] {
            // a bond of a site with itself is no such piece
            *one = [[S::zero() / S::zero(); BLOCK]; C];
        } else if let Some(rate) = family.kernels().exchange(kind) {
            exchange(rate * t, one, other, count);
        } else {
            for i in 0..count {
                let mut first = from_fn(|k| one[k][i]);
                let mut second = from_fn(|k| other[k][i]);
                family.kernels().flow(kind, t, &mut first, &mut second);
                for k in 0..C {
                    (one[k][i], other[k][i]) = (first[k], second[k]);
                }
            }
        }
        for (k, (one, other)) in one.iter().zip(other.iter()).enumerate() {
            if beside {
                let pairs = mu[k * sites + places[0]..][..2 * count].chunks_exact_mut(2);
                for ((one, other), pair) in one.iter().zip(other).zip(pairs) {
                    (pair[0], pair[1]) = (*one, *other);
                }
                continue;
            }
            for i in 0..count {
                if bond {
                    mu[k * sites + places[1] + stride * i] = other[i];
                }
                mu[k * sites + places[0] + stride * i] = one[i];
            }
        }
    }
}

/// Both spins of each bond turn about their sum S, by the angle `|S| t`. With `x = |S|^2 t^2`, `t sin(|S| t)/(|S| t)` and
/// `(1 - cos(|S| t))/|S|^2` are series in x, of which as many terms are taken as round-off needs.
fn exchange<S: Scalar, const C: usize>(
    t: S,
    one: &mut [[S; BLOCK]; C],
    other: &mut [[S; BLOCK]; C],
    count: usize,
) {
    // the largest |S|^2, in parts that do not wait for each other
    let mut parts = [S::zero(); 8];
    for from in (0..BLOCK).step_by(8) {
        for (part, i) in parts.iter_mut().zip(from..from + 8) {
            let sum: [S; 3] = from_fn(|k| one[k][i] + other[k][i]);
            let square = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
            *part = S::select(square.less(*part), *part, square);
        }
    }
    let most = parts.into_iter().fold(S::zero(), S::max);
    match largest(most * (t * t)) {
        x if x < 3e-4 => by_series::<S, C, 4>(t, one, other),
        x if x < 2e-2 => by_series::<S, C, 6>(t, one, other),
        x if x < 0.4 => by_series::<S, C, 8>(t, one, other),
        x if x < 4.0 => by_series::<S, C, 11>(t, one, other),
        _ => (0..count).for_each(|i| {
            turn(one, other, i, |square| {
                // opposite spins do not turn, whatever the functions are
                let square = S::select(S::zero().less(square), square, S::one());
                let size = square.sqrt();
                let half = S::ratio(1.0, 2.0) * size * t;
                let (sine, cosine) = half.sin_cos();
                let two = S::from_f64(2.0);
                (two * sine * cosine / size, two * sine * sine / square)
            });
        }),
    }
}

fn by_series<S: Scalar, const C: usize, const TERMS: usize>(
    t: S,
    one: &mut [[S; BLOCK]; C],
    other: &mut [[S; BLOCK]; C],
) {
    // (-1)^k t / (2k + 1)! and (-1)^k t^2 / (2k + 2)!
    let (mut sines, mut cosines) = ([t; TERMS], [S::ratio(1.0, 2.0) * t * t; TERMS]);
    for k in 1..TERMS {
        let n = 2.0 * k as f64;
        sines[k] = -sines[k - 1] * S::ratio(1.0, n * (n + 1.0));
        cosines[k] = -cosines[k - 1] * S::ratio(1.0, (n + 1.0) * (n + 2.0));
    }
    let squared = t * t;
    for i in 0..BLOCK {
        turn(one, other, i, |square| {
            let x = square * squared;
            let (mut sine, mut cosine) = (sines[TERMS - 1], cosines[TERMS - 1]);
            for k in (0..TERMS - 1).rev() {
                sine = sine * x + sines[k];
                cosine = cosine * x + cosines[k];
            }
            (sine, cosine)
        });
    }
}

/// Turns the two spins of a bond about their sum, of whose square the two functions are given.
#[inline(always)]
fn turn<S: Scalar, const C: usize>(
    one: &mut [[S; BLOCK]; C],
    other: &mut [[S; BLOCK]; C],
    i: usize,
    functions: impl Fn(S) -> (S, S),
) {
    let a: [S; 3] = from_fn(|k| one[k][i]);
    let b: [S; 3] = from_fn(|k| other[k][i]);
    let s: [S; 3] = from_fn(|k| a[k] + b[k]);
    let cross = |u: [S; 3], v: [S; 3]| {
        [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ]
    };
    // S x a = b x a
    let w = cross(b, a);
    let v = cross(s, w);
    let (sine, cosine) = functions(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    for k in 0..3 {
        let change = sine * w[k] + cosine * v[k];
        one[k][i] = a[k] + change;
        other[k][i] = b[k] - change;
    }
}

impl<S, K, const C: usize, const L: usize, const T: usize> PieceFlows<S>
    for FamilyFlows<'_, K, C, L, T>
where
    S: Scalar,
    K: Pieces<S, C, L, T>,
{
    type State = Vec<S>;

    fn pieces(&self) -> usize {
        self.pieces.len()
    }

    fn direction(&self, _piece: usize, _t: S, _mu: &Vec<S>, _xi: &mut Vec<S>) {
        unreachable!("nobody follows the group element of a family")
    }

    fn flow(&mut self, piece: usize, t: S, mu: &mut Vec<S>) {
        let [rows, _] = self.family.sizes();
        for row in 0..rows {
            self.row(self.pieces[piece], row, t, mu);
        }
    }
}

impl<S, K, const C: usize, const L: usize, const T: usize> FoundPoisson<S> for Family<K, C, L, T>
where
    S: Scalar,
    K: Pieces<S, C, L, T>,
{
    type Found<'a>
        = FamilyFlows<'a, K, C, L, T>
    where
        Self: 'a;

    fn found(&self) -> Self::Found<'_> {
        FamilyFlows::new(self)
    }
}
