//! A site and its neighbours: where they stand in a state, and for which sites nothing wraps around.

use super::{Family, Sites, Span};
use crate::scalar::Scalar;
use core::array::from_fn;
use core::ops::Range;

/// An index modulo the size.
#[inline]
pub(super) fn wrapped(index: isize, size: usize) -> usize {
    index.rem_euclid(size as isize) as usize
}

impl<K, const C: usize, const L: usize, const T: usize> Family<K, C, L, T> {
    /// The columns in which a site has all summands with it, and no neighbour is found by wrapping around; none where
    /// that is not so of the row.
    pub(super) fn inner<S: Scalar>(&self, row: usize) -> Range<usize>
    where
        K: Sites<S, C, L, T>,
    {
        let [rows, columns] = self.sizes();
        let columns = columns as isize;
        let (mut first, mut end) = (0, columns);
        for [_, offset] in K::OFFSETS {
            first = first.max(-offset);
            end = end.min(columns - offset);
        }
        for term in K::TERMS {
            for &slot in term.slots {
                let [down, right] = K::OFFSETS[slot];
                if !term.spans[0].holds(row as isize - down, rows) {
                    return 0..0;
                }
                if let Span::Within { first: from, left } = term.spans[1] {
                    first = first.max(from as isize + right);
                    end = end.min(columns - left as isize + right);
                }
            }
        }
        if first < end {
            first as usize..end as usize
        } else {
            0..0
        }
    }

    /// The coordinates of a site and of its neighbours, wherever they are.
    #[inline]
    pub(super) fn around<S: Scalar>(&self, mu: &[S], [row, column]: [usize; 2]) -> [[S; C]; L]
    where
        K: Sites<S, C, L, T>,
    {
        let [rows, columns] = self.sizes();
        from_fn(|slot| {
            let [down, right] = K::OFFSETS[slot];
            let site = wrapped(row as isize + down, rows) * columns
                + wrapped(column as isize + right, columns);
            self.site(mu, site)
        })
    }

    /// The coordinates of a site.
    #[inline]
    pub(super) fn site<S: Scalar>(&self, mu: &[S], site: usize) -> [S; C] {
        from_fn(|k| mu[k * self.count() + site])
    }

    /// Sets the coordinates of a site.
    #[inline]
    pub(super) fn set_site<S: Scalar>(&self, out: &mut [S], site: usize, value: [S; C]) {
        for (k, value) in value.into_iter().enumerate() {
            out[k * self.count() + site] = value;
        }
    }

    /// The coordinates of the neighbours of a stretch of columns in a row: slices, slot after slot.
    #[inline(always)]
    pub(super) fn along<'m, S: Scalar>(
        &self,
        mu: &'m [S],
        row: usize,
        stretch: &Range<usize>,
    ) -> [[&'m [S]; C]; L]
    where
        K: Sites<S, C, L, T>,
    {
        let [rows, columns] = self.sizes();
        from_fn(|slot| {
            let [down, right] = K::OFFSETS[slot];
            let row = wrapped(row as isize + down, rows);
            let from = row * columns + (stretch.start as isize + right) as usize;
            from_fn(|k| &mu[k * self.count() + from..][..stretch.len()])
        })
    }

    /// `dH/dmu` at a site, term by term.
    pub(super) fn slope<S: Scalar>(
        &self,
        mu: &[S],
        [row, column]: [usize; 2],
        weights: &[S; T],
    ) -> [S; C]
    where
        K: Sites<S, C, L, T>,
    {
        let [rows, columns] = self.sizes();
        let mut sum = [S::zero(); C];
        for (k, term) in K::TERMS.iter().enumerate() {
            for &slot in term.slots {
                let [down, right] = K::OFFSETS[slot];
                let (above, before) = (row as isize - down, column as isize - right);
                if term.spans[0].holds(above, rows) && term.spans[1].holds(before, columns) {
                    let at = self.around(mu, [wrapped(above, rows), wrapped(before, columns)]);
                    let slope = self.kernels().slope(k, slot, &at, weights);
                    for (sum, slope) in sum.iter_mut().zip(slope) {
                        *sum += slope;
                    }
                }
            }
        }
        sum
    }
}
