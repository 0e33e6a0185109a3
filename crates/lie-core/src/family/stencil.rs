//! A site and its neighbours: where they stand in a state, and for which sites nothing wraps around.

use super::shape::{Of, Shape};
use super::sites::{Around, Site, Sums};
use super::{Family, Sites, Span};
use crate::lattice::{AXES, count, line, place, site, wrapped};
use crate::scalar::Scalar;
use core::array::from_fn;
use core::ops::Range;

/// So many numbers stand between the coordinates of the sites and the rates of Wiener processes, where the time is carried: its momentum, the
/// time, the unit, and the inputs.
#[inline]
pub(super) fn carried<S: Scalar, K: Sites<S>>(sites: &K) -> usize {
    UNIT + 1 + inputs(sites)
}

/// The place of the unit among what is carried.
pub(super) const UNIT: usize = 2;

/// The number of inputs, which all sites share as they do the time.
#[inline]
pub(super) fn inputs<S: Scalar, K: Sites<S>>(sites: &K) -> usize {
    sites.shared_count().saturating_sub(1)
}

/// What kernels of a site read at a place.
enum Entry {
    /// A coordinate of the site in a slot.
    Coordinate(usize, usize),
    /// The coefficient of the site in a slot.
    Data(usize, usize),
    /// The rate of a Wiener process of the site.
    Rate(usize),
}

/// What kernels of a site read, place by place.
#[inline(always)]
fn entries<S: Scalar, K: Sites<S>>(sites: &K) -> impl Fn(usize) -> Entry {
    let (dimension, places) = (sites.dimension(), sites.data_places());
    let coordinates = dimension * sites.offsets().len();
    move |place| match place.checked_sub(coordinates) {
        None => Entry::Coordinate(place / dimension, place % dimension),
        Some(place) => match places.get(place) {
            Some([slot, which]) => Entry::Data(*slot, *which),
            None => Entry::Rate(place - places.len()),
        },
    }
}

/// The number of coordinates and coefficients in all slots, and of rates of the site.
pub(super) fn around<S: Scalar, K: Sites<S>>(sites: &K) -> usize {
    let coordinates = sites.offsets().len() * sites.dimension();
    coordinates + sites.data_places().len() + sites.noise_count()
}

/// The axis of columns.
pub(super) const LAST: usize = AXES - 1;

/// A site of a line, by the first one.
#[inline]
pub(super) fn in_column(mut begin: [usize; AXES], column: usize) -> [usize; AXES] {
    begin[LAST] = column;
    begin
}

/// Columns of a line at which a site has all summands with it, and no neighbour is found by wrapping around.
#[derive(Clone, Debug)]
pub struct Stretch<'m, S> {
    mu: &'m [S],
    sizes: [usize; AXES],
    first: [usize; AXES],
    len: usize,
}

impl<'m, S: Scalar> Stretch<'m, S> {
    /// The number of sites.
    #[inline]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// A coordinate of the sites at a distance from those of the stretch.
    #[inline(always)]
    pub fn part(&self, offset: [isize; AXES], coordinate: usize) -> &'m [S] {
        self.along(&self.mu[coordinate * self.count()..], offset)
    }

    /// What there is for each site, of those at a distance from the sites of the stretch.
    #[inline(always)]
    pub fn along<'a>(&self, all: &'a [S], offset: [isize; AXES]) -> &'a [S] {
        // along columns nothing wraps around, and a neighbour is as far as its offset says
        let column = (self.first[LAST] as isize + offset[LAST]) as usize;
        let from = line(self.first, offset, self.sizes) * self.sizes[LAST] + column;
        &all[from..][..self.len]
    }

    /// The number of sites of the family.
    #[inline]
    fn count(&self) -> usize {
        count(self.sizes)
    }

    /// The coordinates of the sites and of their neighbours, slot after slot, and behind them their coefficients.
    #[inline(always)]
    pub fn around<'a, K: Sites<S>>(&self, sites: &'a K) -> Of<K::Around, &'a [S]>
    where
        'm: 'a,
    {
        let (dimension, offsets) = (sites.dimension(), sites.offsets());
        let entry = entries(sites);
        K::Around::make(around(sites), |place| match entry(place) {
            Entry::Coordinate(slot, k) => self.part(offsets[slot], k),
            Entry::Data(slot, which) => self.along(sites.data(which), offsets[slot]),
            Entry::Rate(which) => {
                let first = (dimension + which) * self.count() + carried(sites);
                self.along(&self.mu[first..], [0; AXES])
            }
        })
    }

    /// Where the coordinates of the sites are in another state.
    #[inline(always)]
    pub fn in_state<'o, A: Shape>(
        &self,
        dimension: usize,
        state: &'o mut [S],
    ) -> Of<A, &'o mut [S]> {
        let first = place(self.first, [0; AXES], self.sizes);
        let mut parts = state.chunks_exact_mut(self.count());
        A::make(dimension, |_| match parts.next() {
            Some(part) => &mut part[first..][..self.len],
            None => unreachable!("a part for each coordinate"),
        })
    }
}

/// The coordinates at a place of each slice: those of a site and of its neighbours.
#[inline(always)]
pub(super) fn gathered<A: Shape, S: Scalar>(along: &[&[S]], place: usize) -> Of<A, S> {
    A::make(along.len(), |k| along[k][place])
}

impl<K> Family<K> {
    /// How many sites stand one behind the other along the last axis: a line.
    #[inline]
    pub(super) fn columns(&self) -> usize {
        self.sizes()[LAST]
    }

    /// The number of lines.
    #[inline]
    pub(super) fn lines(&self) -> usize {
        self.sizes()[..LAST].iter().product()
    }

    /// The first site of a line.
    #[inline]
    pub(super) fn begin(&self, line: usize) -> [usize; AXES] {
        let [layers, rows, _] = self.sizes();
        site(line, [layers, rows, 1])
    }

    /// Whether sums over these sites go over some of the line that begins at a site.
    #[inline]
    pub(super) fn line_holds(&self, at: [usize; AXES], spans: &[Span; AXES]) -> bool {
        let sizes = self.sizes();
        (0..LAST).all(|axis| spans[axis].holds(at[axis] as isize, sizes[axis]))
    }

    /// The columns in which a site has all summands with it, and no neighbour is found by wrapping around; none where
    /// that is not so of the line.
    pub(super) fn inner<S: Scalar>(&self, line: usize) -> Range<usize>
    where
        K: Sites<S>,
    {
        let (sizes, at) = (self.sizes(), self.begin(line));
        let columns = self.columns() as isize;
        let (mut first, mut end) = (0, columns);
        let offsets = self.kernels().offsets();
        for offset in offsets.iter().map(|offset| offset[LAST]) {
            first = first.max(-offset);
            end = end.min(columns - offset);
        }
        for term in (0..self.kernels().count()).map(|k| self.kernels().term(k)) {
            // its own summand too, of which H may not depend
            let slots = term.slots.iter().map(|&slot| offsets[slot]);
            for offset in slots.chain([[0; AXES]]) {
                let holds = |axis: usize| {
                    term.spans[axis].holds(at[axis] as isize - offset[axis], sizes[axis])
                };
                if !(0..LAST).all(holds) {
                    return 0..0;
                }
                if let Span::Within { first: from, left } = term.spans[LAST] {
                    first = first.max(from as isize + offset[LAST]);
                    end = end.min(columns - left as isize + offset[LAST]);
                }
            }
        }
        if first < end {
            first as usize..end as usize
        } else {
            0..0
        }
    }

    /// Some columns of a line, among those in which a site has all neighbours.
    #[inline]
    pub(super) fn stretch<'m, S>(
        &self,
        mu: &'m [S],
        line: usize,
        columns: Range<usize>,
    ) -> Stretch<'m, S> {
        Stretch {
            mu,
            sizes: self.sizes(),
            first: in_column(self.begin(line), columns.start),
            len: columns.len(),
        }
    }

    /// The coordinates of a site and of its neighbours, wherever they are, and behind them their coefficients.
    #[inline]
    pub(super) fn around<S: Scalar>(&self, mu: &[S], site: [usize; AXES]) -> Around<K, S>
    where
        K: Sites<S>,
    {
        let kernels = self.kernels();
        let offsets = kernels.offsets();
        let entry = entries(kernels);
        K::Around::make(around(kernels), |place| match entry(place) {
            Entry::Coordinate(slot, k) => {
                mu[k * self.count() + self.neighbour(site, offsets[slot])]
            }
            Entry::Data(slot, which) => kernels.data(which)[self.neighbour(site, offsets[slot])],
            Entry::Rate(which) => {
                let first = (kernels.dimension() + which) * self.count() + carried(kernels);
                mu[first + self.neighbour(site, [0; AXES])]
            }
        })
    }

    /// The site at a distance from another one.
    #[inline]
    pub(super) fn neighbour(&self, site: [usize; AXES], offset: [isize; AXES]) -> usize {
        place(site, offset, self.sizes())
    }

    /// The coordinates of a site.
    #[inline]
    pub(super) fn site<S: Scalar>(&self, mu: &[S], site: usize) -> Site<K, S>
    where
        K: Sites<S>,
    {
        K::Site::make(self.kernels().dimension(), |k| mu[k * self.count() + site])
    }

    /// Sets the coordinates of a site.
    #[inline]
    pub(super) fn set_site<S: Scalar>(&self, out: &mut [S], site: usize, value: &[S]) {
        for (k, value) in value.iter().enumerate() {
            out[k * self.count() + site] = *value;
        }
    }

    /// `dH/dmu` at a site, term by term.
    pub(super) fn slope<S: Scalar>(
        &self,
        mu: &[S],
        site: [usize; AXES],
        weights: &Sums<K, S>,
    ) -> Site<K, S>
    where
        K: Sites<S>,
    {
        let (kernels, sizes) = (self.kernels(), self.sizes());
        let mut sum = K::Site::make(kernels.dimension(), |_| S::zero());
        for k in 0..kernels.count() {
            let term = kernels.term(k);
            for &slot in term.slots {
                let offset = kernels.offsets()[slot];
                let from: [isize; AXES] = from_fn(|axis| site[axis] as isize - offset[axis]);
                if (0..AXES).all(|axis| term.spans[axis].holds(from[axis], sizes[axis])) {
                    let from = from_fn(|axis| wrapped(from[axis], sizes[axis]));
                    let at = self.around(mu, from);
                    let slope = kernels.slope(k, slot, &at, weights);
                    for (sum, slope) in sum.as_mut().iter_mut().zip(slope.as_ref()) {
                        *sum += *slope;
                    }
                }
            }
        }
        sum
    }
}
