//! The vector field a few sites at a time.

use super::energy::Totals;
use super::shape::Fixed;
use super::sites::Sums;
use super::stencil::{LAST, in_column};
use super::{Family, Sites};
use crate::lattice::{AXES, shown};
use crate::scalar::Scalar;
use core::ops::Range;
use std::vec::Vec;

/// Sites whose slopes are computed one behind the other: with eight stages each they and what they are computed from fit into the
/// cache.
const PART: usize = 128;

/// The power of what acts on sites, which is 0 where nothing does.
pub(super) type Power<S> = Totals<Fixed<1>, S>;

impl<K> Family<K> {
    /// The vector field on some columns of a line, `inner` being those of the line that have all neighbours.
    #[inline]
    pub(super) fn field_of_line<S: Scalar>(
        &self,
        mu: &[S],
        (line, part): (usize, Range<usize>),
        inner: Range<usize>,
        weights: &Sums<K, S>,
        out: &mut [S],
        power: &mut Power<S>,
    ) where
        K: Sites<S>,
    {
        let (kernels, columns) = (self.kernels(), self.columns());
        let begin = self.begin(line);
        // where something acts, the field is no sum of what parts of the slope make
        let bonds = !kernels.bonds().is_empty();
        let inner = match kernels.acts() && bonds {
            true => 0..0,
            false => inner,
        };
        let at_ends = [0..inner.start, inner.end..columns];
        let outer = at_ends.map(|end| end.start.max(part.start)..end.end.min(part.end));
        for column in outer.into_iter().flatten() {
            let (site, at) = (line * columns + column, in_column(begin, column));
            let slope = self.slope(mu, at, weights);
            let slope = self.with_bonds(slope, mu, site, weights);
            if kernels.acts() {
                let at = self.around(mu, at);
                let (field, part) = kernels.shared_act(&slope, &at, weights);
                self.set_site(out, site, field.as_ref());
                power.add(&[part]);
                continue;
            }
            let field = kernels.ad_star(&slope, &self.site(mu, site));
            self.set_site(out, site, field.as_ref());
        }
        let inner = inner.start.max(part.start)..inner.end.min(part.end);
        if !inner.is_empty() {
            let stretch = self.stretch(mu, line, inner.clone());
            match kernels.acts() {
                true => power.add(&[kernels.driven_fields(&stretch, weights, out)]),
                false => kernels.fields(&stretch, weights, out),
            }
            if bonds {
                let sites = line * columns + inner.start..line * columns + inner.end;
                self.add_field_of_bonds(mu, sites, weights, out);
            }
        }
    }

    /// How far before and behind a site those are on which its slope depends, where nothing wraps around: the neighbours of the
    /// sites whose summands it is in.
    fn reach<S: Scalar>(&self) -> usize
    where
        K: Sites<S>,
    {
        let sizes = self.sizes();
        let axis = AXES - shown(&sizes).len();
        let distances = self.kernels().offsets().iter();
        let distances = distances.map(|offset| offset[axis].unsigned_abs());
        let farthest = 2 * distances.max().unwrap_or(0);
        match axis {
            LAST => farthest,
            // along the axes behind it sites wrap around
            _ => (farthest + 1) * sizes[axis + 1..].iter().product::<usize>(),
        }
    }

    /// The vector field at a state whose entries `before` sets, while those of `after` are computed: first the sites that depend
    /// on some before and behind them, then those at the ends.
    pub(super) fn field_by_parts<S: Scalar>(
        &self,
        mu: &mut Vec<S>,
        out: &mut [S],
        mut before: impl FnMut(&mut [S], Range<usize>),
        mut after: impl FnMut(&mut [S], Range<usize>),
    ) where
        K: Sites<S>,
    {
        let (count, columns) = (self.count(), self.columns());
        let carried = self.kernels().dimension() * count..mu.len();
        if !carried.is_empty() {
            before(mu, carried.clone());
        }
        let of_sites = |sites: &Range<usize>, done: &mut dyn FnMut(Range<usize>)| {
            let coordinates = 0..self.kernels().dimension();
            coordinates.for_each(|k| done(k * count + sites.start..k * count + sites.end));
        };
        let mut set = 0;
        let mut set_to = |end: usize, mu: &mut Vec<S>| {
            if set < end {
                of_sites(&(set..end), &mut |entries| before(mu, entries));
                set = end;
            }
        };
        let far = self.is_far() || !self.kernels().bonds().is_empty();
        let local = match far {
            // every site depends on all
            true => count,
            false => self.reach(),
        };
        let is_local = |sites: &Range<usize>| local <= sites.start && sites.end + local <= count;
        let mut power = Power::new(1);
        for at_ends in [false, true] {
            if at_ends {
                set_to(count, mu);
            }
            let weights = match at_ends || !far {
                true => self.weights(mu),
                false => continue,
            };
            let (weights, of_time) = weights;
            power.add(&[of_time]);
            for line in 0..self.lines() {
                let inner = self.inner::<S>(line);
                for start in (0..columns).step_by(PART) {
                    let part = start..columns.min(start + PART);
                    let sites = line * columns + part.start..line * columns + part.end;
                    if is_local(&sites) == at_ends {
                        continue;
                    }
                    if !at_ends {
                        set_to(sites.end + local, mu);
                    }
                    self.field_of_line(mu, (line, part), inner.clone(), &weights, out, &mut power);
                    of_sites(&sites, &mut |entries| after(out, entries));
                }
            }
        }
        if !carried.is_empty() {
            self.set_carried(out, [-power.end()[0], S::one()]);
            after(out, carried);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::{Around, Fixed, Site, Term, unit_spheres};
    use crate::family::{Span, Sums};
    use crate::poisson::Poisson;
    use core::cell::Cell;

    /// Sites with one coordinate coupled to those around them by made-up functions, or all to all.
    #[derive(Clone)]
    struct Net {
        mean_field: bool,
        offsets: [[isize; AXES]; 7],
    }

    impl Net {
        /// Along so many axes.
        fn new(axes: usize, mean_field: bool) -> Self {
            let [down, below] = [1, 2].map(|others| isize::from(axes > others));
            let behind = [[0, 0, 1], [0, down, 0], [below, 0, 0]];
            let [right, down, below] = behind;
            let [left, up, above] = behind.map(|offset| offset.map(|distance| -distance));
            Self {
                mean_field,
                offsets: [[0; AXES], left, right, up, down, above, below],
            }
        }
    }

    impl<S: Scalar> Sites<S> for Net {
        type Site = Fixed<1>;
        type Around = Fixed<7>;
        type Sums = Fixed<1>;
        type Widened = Self;
        type Lifted = Self;

        fn name(&self) -> &str {
            "Net"
        }
        fn dimension(&self) -> usize {
            1
        }
        fn coordinate(&self, _index: usize) -> &str {
            "x"
        }
        fn offsets(&self) -> &[[isize; AXES]] {
            &self.offsets
        }
        fn count(&self) -> usize {
            1
        }
        fn term(&self, _index: usize) -> Term<'_> {
            Term {
                slots: &[0, 1, 2, 3, 4, 5, 6],
                spans: [Span::All; AXES],
            }
        }
        fn has_mean_field(&self) -> bool {
            self.mean_field
        }
        fn degree(&self) -> Option<u32> {
            None
        }
        fn casimir_count(&self) -> usize {
            0
        }
        fn casimir_name(&self, _index: usize) -> &str {
            ""
        }
        fn casimir_degree(&self, _index: usize) -> Option<u32> {
            None
        }
        fn field(&self, at: &Around<Self, S>, weights: &Sums<Self, S>) -> Site<Self, S> {
            let [x, left, right, up, down, above, below] = *at;
            [x * (left - right) + up * down + above * below + weights[0]]
        }
        fn slope(
            &self,
            _term: usize,
            slot: usize,
            at: &Around<Self, S>,
            weights: &Sums<Self, S>,
        ) -> Site<Self, S> {
            [at[slot] * at[(slot + 1) % 7] + weights[0]]
        }
        fn summands(&self, at: &Around<Self, S>) -> Sums<Self, S> {
            [at[0] * at[2]]
        }
        fn energy(&self, totals: &Sums<Self, S>) -> S {
            totals[0]
        }
        fn weights(&self, totals: &Sums<Self, S>) -> Sums<Self, S> {
            *totals
        }
        fn ad(&self, xi: &Site<Self, S>, _eta: &Site<Self, S>) -> Site<Self, S> {
            *xi
        }
        fn ad_star(&self, xi: &Site<Self, S>, mu: &Site<Self, S>) -> Site<Self, S> {
            [xi[0] * mu[0]]
        }
        fn casimir(&self, _index: usize, _mu: &Site<Self, S>) -> S {
            S::zero()
        }
        fn casimir_gradient(&self, _index: usize, mu: &Site<Self, S>) -> Site<Self, S> {
            *mu
        }
        fn widen(&self) -> Self {
            self.clone()
        }
        fn lift(&self) -> Self {
            self.clone()
        }
    }

    /// Compares slopes that come part by part with those of the whole, from a state whose entries are not numbers before they are
    /// asked for. How many entries were there when the first slopes were.
    fn compare(net: Net, sizes: [usize; AXES]) -> usize {
        let family = Family::new(net, sizes);
        let mu: Vec<f64> = unit_spheres(family.count(), 1, 5);
        let mu: Vec<f64> = mu.iter().zip(1..).map(|(x, k)| x / f64::from(k)).collect();
        let (mut whole, mut parts) = (mu.clone(), std::vec![f64::NAN; mu.len()]);
        family.vector_field(&mu, &mut whole);
        let (mut late, mut times) = (parts.clone(), std::vec![0; mu.len()]);
        let (there, mut first) = (Cell::new(0), None);
        let before = |state: &mut [f64], entries: Range<usize>| {
            there.set(there.get() + entries.len());
            state[entries.clone()].copy_from_slice(&mu[entries]);
        };
        let after = |slopes: &mut [f64], entries: Range<usize>| {
            first.get_or_insert(there.get());
            for entry in entries {
                times[entry] += 1;
                slopes[entry] *= 2.0;
            }
        };
        family.vector_field_by_parts(&mut late, &mut parts, before, after);
        assert_eq!((&late, there.get()), (&mu, mu.len()), "each is set once");
        assert!(times.iter().all(|times| *times == 1), "{times:?}");
        let doubled = whole.iter().map(|slope| (2.0 * slope).to_bits());
        assert!(doubled.eq(parts.iter().map(|slope| slope.to_bits())));
        first.expect("there are slopes")
    }

    #[test]
    fn slopes_that_come_part_by_part_are_those_of_the_whole() {
        for n in [1, 2, 3, 7, 127, 128, 129, 132, 260, 1000] {
            let there = compare(Net::new(1, false), [1, 1, n]);
            assert_eq!(there < n, n > 258, "{n}: {there}");
            assert_eq!(compare(Net::new(1, true), [1, 1, n]), n);
        }
        for [rows, columns] in [[2, 2], [3, 5], [6, 9], [7, 300], [20, 11], [40, 130]] {
            let count = rows * columns;
            let there = compare(Net::new(2, false), [1, rows, columns]);
            assert_eq!(there < count, rows > 6, "{rows} {columns}: {there}");
            assert_eq!(compare(Net::new(2, true), [1, rows, columns]), count);
        }
        for sizes in [[2, 2, 2], [4, 3, 5], [7, 2, 9], [9, 1, 140], [12, 5, 131]] {
            let count = sizes.iter().product();
            let there = compare(Net::new(3, false), sizes);
            assert_eq!(there < count, sizes[0] > 6, "{sizes:?}: {there}");
            assert_eq!(compare(Net::new(3, true), sizes), count);
        }
    }
}
