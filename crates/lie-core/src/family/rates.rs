//! The coefficients of the pieces of a family in the order of their states, and the rates of exchanges.

use super::columns::Columns;
use super::shape::Shape as _;
use super::sites::{Around, width};
use super::stencil::{around, in_column};
use super::{Family, Kind, Pieces, Sites};
use crate::lattice::AXES;
use crate::scalar::Scalar;
use std::vec::Vec;

/// The rate of exchanges.
pub(super) enum Rate<S> {
    /// The same for all bonds.
    Same(S),
    /// One for each bond.
    Each {
        /// At the place of its first site.
        rates: Vec<S>,
        /// The largest size of them.
        most: S,
        /// When they were computed: how often what all sites share had changed.
        at: u64,
    },
}

/// The coefficients around the site at a place, behind coordinates that nobody reads.
#[inline(always)]
pub(super) fn coefficients<S: Scalar, K: Sites<S>>(
    kernels: &K,
    data: &[S],
    sites: usize,
    place: usize,
) -> Around<K, S> {
    let coordinates = kernels.offsets().len() * kernels.dimension();
    K::Around::make(around(kernels), |k| match k.checked_sub(coordinates) {
        Some(number) => data[number * sites + place],
        None => S::zero(),
    })
}

/// The coefficients that kernels read, in the order of the columns, and space for the rates of noise.
pub(super) fn data<S: Scalar, K: Sites<S>>(family: &Family<K>, order: Columns) -> Vec<S> {
    let (kernels, columns) = (family.kernels(), family.columns());
    let places = kernels.data_places();
    let mut all = std::vec![S::zero(); (places.len() + kernels.noise_count()) * family.count()];
    let mut parts = all.chunks_exact_mut(family.count());
    for (&[slot, which], part) in places.iter().zip(&mut parts) {
        let (values, offset) = (kernels.data(which), kernels.offsets()[slot]);
        for line in 0..family.lines() {
            let begin = family.begin(line);
            for column in 0..columns {
                let site = family.neighbour(in_column(begin, column), offset);
                part[line * columns + order.place(column)] = values[site];
            }
        }
    }
    all
}

/// The rate of a piece, if it is an exchange; at the time 0 and with inputs of 0 where it depends on them.
pub(super) fn rate<S: Scalar, K: Pieces<S>>(
    family: &Family<K>,
    (data, order): (&[S], Columns),
    (number, kind): (usize, Kind),
) -> Option<Rate<S>> {
    let (kernels, count) = (family.kernels(), family.count());
    let shared = K::Sums::make(width(kernels), |_| S::zero());
    if kernels.data_places().is_empty() {
        let at = K::Around::make(around(kernels), |_| S::zero());
        return kernels
            .shared_exchange(number, &at, &shared)
            .map(Rate::Same);
    }
    let (columns, span) = (family.columns(), kind.spans[AXES - 1]);
    // bonds alone count: behind the ends of a chain there are no values
    let (mut rates, mut most) = (std::vec![S::zero(); count], S::zero());
    let lines =
        (0..family.lines()).filter(|line| family.line_holds(family.begin(*line), &kind.spans));
    for line in lines {
        for column in span.range(columns) {
            let place = line * columns + order.place(column);
            let at = coefficients(kernels, data, count, place);
            rates[place] = kernels.shared_exchange(number, &at, &shared)?;
            most = most.max(rates[place].abs());
        }
    }
    Some(Rate::Each { rates, most, at: 0 })
}
