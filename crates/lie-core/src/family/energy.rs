//! Sums over all sites.

use super::shape::{Of, Shape};
use super::sites::{Sums, width};
use super::stencil::in_column;
use super::{Family, Sites};
use crate::lattice::AXES;
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
    /// `T_1, …, T_m`, and behind them what all sites share.
    pub(super) fn totals<S: Scalar>(&self, mu: &[S]) -> Sums<K, S>
    where
        K: Sites<S>,
    {
        let columns = self.columns();
        let mut totals = Totals::<K::Sums, S>::new(width(self.kernels()));
        let shared = self.shared(mu);
        for line in 0..self.lines() {
            let (begin, inner) = (self.begin(line), self.inner::<S>(line));
            for column in (0..inner.start).chain(inner.end..columns) {
                let site = in_column(begin, column);
                totals.add(self.summands_at(mu, site, &shared).as_ref());
            }
            for from in inner.clone().step_by(BLOCK) {
                let stretch = self.stretch(mu, line, from..inner.end.min(from + BLOCK));
                totals.add(self.kernels().sum(&stretch, &shared).as_ref());
            }
        }
        self.add_bonds(mu, &shared, |summands| totals.add(summands.as_ref()));
        self.with_shared(totals.end(), mu)
    }

    /// The summands of a site, 0 where a sum does not go over it.
    fn summands_at<S: Scalar>(
        &self,
        mu: &[S],
        site: [usize; AXES],
        shared: &Sums<K, S>,
    ) -> Sums<K, S>
    where
        K: Sites<S>,
    {
        let (sizes, kernels) = (self.sizes(), self.kernels());
        let mut summands = kernels.shared_summands(&self.around(mu, site), shared);
        let of_sums = summands.as_mut().iter_mut().take(kernels.count());
        for (k, summand) in of_sums.enumerate() {
            let spans = kernels.term(k).spans;
            if !(0..AXES).all(|axis| spans[axis].holds(site[axis] as isize, sizes[axis])) {
                *summand = S::zero();
            }
        }
        summands
    }

    /// `dF/dT_k` where they depend on the state, else nothing that is read, with what all sites share behind them; and `dH/dt`.
    #[inline]
    pub(super) fn weights<S: Scalar>(&self, mu: &[S]) -> (Sums<K, S>, S)
    where
        K: Sites<S>,
    {
        if !self.is_far() {
            return (self.shared(mu), S::zero());
        }
        let (kernels, totals) = (self.kernels(), self.totals(mu));
        let weights = match kernels.has_mean_field() {
            true => self.with_shared(kernels.weights(&totals), mu),
            false => self.shared(mu),
        };
        (weights, kernels.time_slope(&totals))
    }

    /// Whether the motion depends on sums over all sites.
    #[inline]
    pub(super) fn is_far<S: Scalar>(&self) -> bool
    where
        K: Sites<S>,
    {
        self.kernels().has_mean_field() || !self.kernels().is_autonomous()
    }
}
