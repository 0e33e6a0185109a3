//! Square matrices by their nonzero entries: those of representations are mostly zero.

use super::ring::Ring;
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// A square matrix, rows of `(column, value)` with ascending columns and no zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SparseMatrix<T = Rational>(Vec<Vec<(usize, T)>>);

impl<T: Ring> SparseMatrix<T> {
    pub(super) fn from_rows(rows: &[Vec<T>]) -> Self {
        let sparse = |row: &Vec<T>| {
            row.iter()
                .enumerate()
                .filter(|(_, v)| !v.is_zero())
                .map(|(c, v)| (c, v.clone()))
                .collect()
        };
        Self(rows.iter().map(sparse).collect())
    }

    /// The matrix by full rows.
    pub(super) fn rows(&self) -> Vec<Vec<T>> {
        let n = self.0.len();
        let full = |row: &Vec<(usize, T)>| {
            let mut full = vec![T::zero(); n];
            for (column, value) in row {
                full[*column] = value.clone();
            }
            full
        };
        self.0.iter().map(full).collect()
    }

    /// All entries row after row.
    pub(super) fn flat(&self) -> Vec<T> {
        self.rows().concat()
    }

    /// The nonzero entries by their position in [`SparseMatrix::flat`].
    pub(super) fn entries(&self) -> impl Iterator<Item = (usize, &T)> {
        let n = self.0.len();
        self.0
            .iter()
            .enumerate()
            .flat_map(move |(r, row)| row.iter().map(move |(c, v)| (r * n + c, v)))
    }

    /// `a b`.
    pub(super) fn product(a: &Self, b: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        Self::combine(&[(a, b, true)], budget)
    }

    /// `a b - b a`.
    pub(super) fn commutator(a: &Self, b: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        Self::combine(&[(a, b, true), (b, a, false)], budget)
    }

    /// The sum of the products, those with a false flag subtracted.
    pub(super) fn combine(
        products: &[(&Self, &Self, bool)],
        budget: &Budget,
    ) -> Result<Self, Exhausted> {
        let n = products.first().map_or(0, |(a, ..)| a.0.len());
        let mut full = vec![T::zero(); n];
        let mut rows = Vec::with_capacity(n);
        for r in 0..n {
            for (a, b, positive) in products {
                for (middle, left) in &a.0[r] {
                    let left = match positive {
                        true => left.clone(),
                        false => left.negative(),
                    };
                    for (column, right) in &b.0[*middle] {
                        full[*column].add_product(&left, right, budget)?;
                    }
                }
            }
            let taken = full.iter_mut().enumerate().filter(|(_, v)| !v.is_zero());
            rows.push(
                taken
                    .map(|(c, v)| (c, std::mem::replace(v, T::zero())))
                    .collect(),
            );
        }
        Ok(Self(rows))
    }
}
