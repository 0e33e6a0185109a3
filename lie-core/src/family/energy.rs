//! Sums over all sites.

use super::{Family, Sites};
use crate::scalar::Scalar;
use core::array::from_fn;

/// So many summands are added before rounding errors are carried.
const BLOCK: usize = 128;

/// Sums that carry their rounding errors: `sum + low` is the sum of what was added, to twice the digits.
pub(super) struct Totals<S, const T: usize> {
    sum: [S; T],
    low: [S; T],
}

impl<S: Scalar, const T: usize> Totals<S, T> {
    pub(super) fn new() -> Self {
        Self {
            sum: [S::zero(); T],
            low: [S::zero(); T],
        }
    }

    /// Knuth's sum of two numbers with its error.
    pub(super) fn add(&mut self, values: [S; T]) {
        for (k, value) in values.into_iter().enumerate() {
            let before = self.sum[k];
            let sum = before + value;
            let part = sum - before;
            self.low[k] += (before - (sum - part)) + (value - part);
            self.sum[k] = sum;
        }
    }

    pub(super) fn end(self) -> [S; T] {
        from_fn(|k| self.sum[k] + self.low[k])
    }
}

impl<K, const C: usize, const L: usize, const T: usize> Family<K, C, L, T> {
    /// `T_1, …, T_m`.
    pub(super) fn totals<S: Scalar>(&self, mu: &[S]) -> [S; T]
    where
        K: Sites<S, C, L, T>,
    {
        let [rows, columns] = self.sizes();
        let mut totals = Totals::new();
        for row in 0..rows {
            let inner = self.inner::<S>(row);
            for column in (0..inner.start).chain(inner.end..columns) {
                totals.add(self.summands_at(mu, [row, column]));
            }
            for from in inner.clone().step_by(BLOCK) {
                let stretch = from..inner.end.min(from + BLOCK);
                let along = self.along(mu, row, &stretch);
                let mut block = [S::zero(); T];
                (0..stretch.len()).for_each(|i| {
                    let at = from_fn(|slot| from_fn(|k| along[slot][k][i]));
                    let summands = self.kernels().summands(&at);
                    for (sum, summand) in block.iter_mut().zip(summands) {
                        *sum += summand;
                    }
                });
                totals.add(block);
            }
        }
        totals.end()
    }

    /// The summands of a site, 0 where a sum does not go over it.
    fn summands_at<S: Scalar>(&self, mu: &[S], [row, column]: [usize; 2]) -> [S; T]
    where
        K: Sites<S, C, L, T>,
    {
        let [rows, columns] = self.sizes();
        let summands = self.kernels().summands(&self.around(mu, [row, column]));
        from_fn(|k| {
            let [down, right] = K::TERMS[k].spans;
            let there = down.holds(row as isize, rows) && right.holds(column as isize, columns);
            if there { summands[k] } else { S::zero() }
        })
    }

    /// `dF/dT_k` where they depend on the state, else nothing that is read.
    #[inline]
    pub(super) fn weights<S: Scalar>(&self, mu: &[S]) -> [S; T]
    where
        K: Sites<S, C, L, T>,
    {
        if K::MEAN_FIELD {
            self.kernels().weights(&self.totals(mu))
        } else {
            [S::zero(); T]
        }
    }
}
