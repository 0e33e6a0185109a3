//! Sums over all sites.

use super::shape::{Of, Shape};
use super::sites::Sums;
use super::{Family, Sites};
use crate::scalar::Scalar;

/// So many summands are added before rounding errors are carried.
const BLOCK: usize = 128;

/// Sums that carry their rounding errors: `sum + low` is the sum of what was added, to twice the digits.
pub(super) struct Totals<A: Shape, S> {
    sum: Of<A, S>,
    low: Of<A, S>,
}

impl<A: Shape, S: Scalar> Totals<A, S> {
    /// So many sums.
    pub(super) fn new(count: usize) -> Self {
        let zero = || A::make(count, |_| S::zero());
        Self {
            sum: zero(),
            low: zero(),
        }
    }

    /// Knuth's sum of two numbers with its error.
    pub(super) fn add(&mut self, values: &[S]) {
        let sums = self.sum.as_mut().iter_mut().zip(self.low.as_mut());
        for ((total, low), &value) in sums.zip(values) {
            let before = *total;
            let sum = before + value;
            let part = sum - before;
            *low += (before - (sum - part)) + (value - part);
            *total = sum;
        }
    }

    pub(super) fn end(mut self) -> Of<A, S> {
        for (sum, low) in self.sum.as_mut().iter_mut().zip(self.low.as_ref()) {
            *sum += *low;
        }
        self.sum
    }
}

impl<K> Family<K> {
    /// `T_1, …, T_m`.
    pub(super) fn totals<S: Scalar>(&self, mu: &[S]) -> Sums<K, S>
    where
        K: Sites<S>,
    {
        let [rows, columns] = self.sizes();
        let mut totals = Totals::<K::Sums, S>::new(self.kernels().count());
        for row in 0..rows {
            let inner = self.inner::<S>(row);
            for column in (0..inner.start).chain(inner.end..columns) {
                totals.add(self.summands_at(mu, [row, column]).as_ref());
            }
            for from in inner.clone().step_by(BLOCK) {
                let stretch = self.stretch(mu, row, from..inner.end.min(from + BLOCK));
                totals.add(self.kernels().sum(&stretch).as_ref());
            }
        }
        self.add_bonds(mu, |summands| totals.add(summands.as_ref()));
        totals.end()
    }

    /// The summands of a site, 0 where a sum does not go over it.
    fn summands_at<S: Scalar>(&self, mu: &[S], [row, column]: [usize; 2]) -> Sums<K, S>
    where
        K: Sites<S>,
    {
        let [rows, columns] = self.sizes();
        let mut summands = self.kernels().summands(&self.around(mu, [row, column]));
        for (k, summand) in summands.as_mut().iter_mut().enumerate() {
            let [down, right] = self.kernels().term(k).spans;
            if !(down.holds(row as isize, rows) && right.holds(column as isize, columns)) {
                *summand = S::zero();
            }
        }
        summands
    }

    /// `dF/dT_k` where they depend on the state, else nothing that is read.
    #[inline]
    pub(super) fn weights<S: Scalar>(&self, mu: &[S]) -> Sums<K, S>
    where
        K: Sites<S>,
    {
        let kernels = self.kernels();
        if kernels.has_mean_field() {
            kernels.weights(&self.totals(mu))
        } else {
            K::Sums::make(kernels.count(), |_| S::zero())
        }
    }
}
