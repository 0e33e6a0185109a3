//! Matrices of all coordinates of a family, which only measurements on small ones ask for.

use super::shape::Shape as _;
use super::sites::Site;
use super::{Family, Sites};
use crate::matrix::SquareMatrix;
use crate::poisson::{Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use std::vec::Vec;

/// A square matrix that takes no memory before an entry is set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LateMatrix<S> {
    dimension: usize,
    entries: Vec<S>,
}

impl<S: Scalar> LateMatrix<S> {
    /// Zero, of so many rows.
    #[must_use]
    pub fn new(dimension: usize) -> Self {
        Self {
            dimension,
            entries: Vec::new(),
        }
    }

    /// All entries, row after row; none before one is set.
    #[inline]
    pub fn as_slice(&self) -> &[S] {
        &self.entries
    }

    /// All entries, row after row.
    #[inline]
    pub fn as_mut_slice(&mut self) -> &mut [S] {
        if self.entries.is_empty() {
            self.entries = std::vec![S::zero(); self.dimension * self.dimension];
        }
        &mut self.entries
    }

    /// Sets every entry to 0.
    fn clear(&mut self) {
        self.entries.clear();
    }

    /// Sets a column.
    fn set_column(&mut self, column: usize, values: impl IntoIterator<Item = S>) {
        for (row, value) in values.into_iter().enumerate() {
            self.set(row, column, value);
        }
    }
}

impl<S: Scalar> SquareMatrix<S> for LateMatrix<S> {
    fn dimension(&self) -> usize {
        self.dimension
    }
    #[inline]
    fn get(&self, row: usize, column: usize) -> S {
        let entry = self.entries.get(row * self.dimension + column);
        entry.map_or(S::zero(), |entry| *entry)
    }
    #[inline]
    fn set(&mut self, row: usize, column: usize, value: S) {
        let place = row * self.dimension + column;
        self.as_mut_slice()[place] = value;
    }
}

impl<K> Family<K> {
    /// The matrix of a map of each site by itself, from what it makes of each unit vector.
    pub(super) fn by_sites<S: Scalar>(
        &self,
        out: &mut LateMatrix<S>,
        map: impl Fn(usize, &Site<K, S>) -> Site<K, S>,
    ) where
        K: Sites<S>,
    {
        out.clear();
        let dimension = self.kernels().dimension();
        for site in 0..self.count() {
            for k in 0..dimension {
                let one = |i: usize| if i == k { S::one() } else { S::zero() };
                let unit = K::Site::make(dimension, one);
                for (i, value) in map(site, &unit).as_ref().iter().enumerate() {
                    out.set(i * self.count() + site, k * self.count() + site, *value);
                }
            }
        }
    }

    /// The derivative of a vector by all coordinates, by dual numbers.
    pub(super) fn derivative<S: Scalar>(
        &self,
        mu: &[S],
        out: &mut LateMatrix<S>,
        vector: impl Fn(&Family<K::Lifted>, &Vec<Dual<S>>, &mut Vec<Dual<S>>),
    ) where
        K: Sites<S>,
    {
        let lifted = self.lift();
        let mut at: Vec<Dual<S>> = mu.iter().map(|value| Dual::constant_of(*value)).collect();
        let mut found = lifted.zero_state();
        for (column, value) in mu.iter().enumerate() {
            at[column] = Dual::variable(*value);
            vector(&lifted, &at, &mut found);
            at[column] = Dual::constant_of(*value);
            out.set_column(column, found.iter().map(|entry| entry.derivative));
        }
    }
}

impl<S, K> Lift<S> for Family<K>
where
    S: Scalar,
    K: Sites<S>,
{
    type Lifted = Family<K::Lifted>;
    fn lift(&self) -> Self::Lifted {
        Family::new(self.kernels().lift(), self.sizes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_takes_memory_with_its_first_entry() {
        let mut matrix = LateMatrix::<f64>::new(1_000_000);
        assert_eq!((matrix.get(3, 4), matrix.entries.capacity()), (0.0, 0));
        matrix = LateMatrix::new(3);
        matrix.set(2, 1, 5.0);
        assert_eq!((matrix.get(2, 1), matrix.get(1, 2)), (5.0, 0.0));
        matrix.clear();
        assert_eq!(matrix.get(2, 1), 0.0);
    }
}
