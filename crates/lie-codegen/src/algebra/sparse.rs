//! Square matrices of rationals by their nonzero entries: those of representations are mostly zero.

use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// A square matrix, rows of `(column, value)` with ascending columns and no zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SparseMatrix(Vec<Vec<(usize, Rational)>>);

impl SparseMatrix {
    pub(super) fn from_rows(rows: &[Vec<Rational>]) -> Self {
        let sparse = |row: &Vec<Rational>| {
            row.iter()
                .enumerate()
                .filter(|(_, v)| !v.is_zero())
                .map(|(c, v)| (c, v.clone()))
                .collect()
        };
        Self(rows.iter().map(sparse).collect())
    }

    /// The matrix by full rows.
    pub(super) fn rows(&self) -> Vec<Vec<Rational>> {
        let n = self.0.len();
        let full = |row: &Vec<(usize, Rational)>| {
            let mut full = vec![Rational::ZERO; n];
            for (column, value) in row {
                full[*column] = value.clone();
            }
            full
        };
        self.0.iter().map(full).collect()
    }

    /// All entries row after row.
    pub(super) fn flat(&self) -> Vec<Rational> {
        self.rows().concat()
    }

    /// The nonzero entries by their position in [`SparseMatrix::flat`].
    pub(super) fn entries(&self) -> impl Iterator<Item = (usize, &Rational)> {
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
        let mut full = vec![Rational::ZERO; n];
        let mut rows = Vec::with_capacity(n);
        for r in 0..n {
            for (a, b, positive) in products {
                for (middle, left) in &a.0[r] {
                    for (column, right) in &b.0[*middle] {
                        let product = left * right;
                        budget.spend_on(&product)?;
                        let entry = &mut full[*column];
                        *entry = if *positive {
                            &*entry + &product
                        } else {
                            &*entry - &product
                        };
                    }
                }
            }
            let taken = full.iter_mut().enumerate().filter(|(_, v)| !v.is_zero());
            rows.push(
                taken
                    .map(|(c, v)| (c, std::mem::replace(v, Rational::ZERO)))
                    .collect(),
            );
        }
        Ok(Self(rows))
    }
}
