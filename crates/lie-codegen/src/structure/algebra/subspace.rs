//! Subspaces of rational vectors by their reduced echelon basis, kernels, and the signature of a symmetric matrix.

use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// A vector by its entries.
pub type Vector = Vec<Rational>;

/// A subspace.
#[derive(Clone, Debug, PartialEq)]
pub struct Subspace {
    length: usize,
    /// The reduced echelon basis, rows by ascending pivots.
    rows: Vec<Vector>,
    pivots: Vec<usize>,
}

impl Subspace {
    /// The zero subspace of vectors of this length.
    pub fn zero(length: usize) -> Self {
        Self {
            length,
            rows: Vec::new(),
            pivots: Vec::new(),
        }
    }

    /// The span of vectors.
    pub fn span(
        length: usize,
        vectors: impl IntoIterator<Item = Vector>,
        budget: &Budget,
    ) -> Result<Self, Exhausted> {
        let mut space = Self::zero(length);
        for vector in vectors {
            if space.is_full() {
                break;
            }
            space.insert(vector, budget)?;
        }
        Ok(space)
    }

    /// Its dimension.
    pub fn dimension(&self) -> usize {
        self.rows.len()
    }

    /// Whether it is everything.
    pub fn is_full(&self) -> bool {
        self.rows.len() == self.length
    }

    /// The basis.
    pub fn basis(&self) -> &[Vector] {
        &self.rows
    }

    /// The entries that are the coordinates in the basis.
    pub fn pivots(&self) -> &[usize] {
        &self.pivots
    }

    /// The other entries, the coordinates of the quotient by the subspace.
    pub fn complement_places(&self) -> Vec<usize> {
        (0..self.length)
            .filter(|c| !self.pivots.contains(c))
            .collect()
    }

    /// What is left of a vector modulo the subspace: zero at the pivots.
    pub fn reduced(&self, mut vector: Vector, budget: &Budget) -> Result<Vector, Exhausted> {
        for (row, &pivot) in self.rows.iter().zip(&self.pivots) {
            if !vector[pivot].is_zero() {
                let factor = vector[pivot].clone();
                subtract(&mut vector, &factor, row, budget)?;
            }
        }
        Ok(vector)
    }

    /// Whether a vector is in it.
    pub fn contains(&self, vector: Vector, budget: &Budget) -> Result<bool, Exhausted> {
        Ok(self.reduced(vector, budget)?.iter().all(Rational::is_zero))
    }

    /// Adds a vector; whether it was not in the subspace.
    pub fn insert(&mut self, vector: Vector, budget: &Budget) -> Result<bool, Exhausted> {
        let mut vector = self.reduced(vector, budget)?;
        let Some(pivot) = vector.iter().position(|v| !v.is_zero()) else {
            return Ok(false);
        };
        if let Some(inverse) = vector[pivot].recip() {
            vector.iter_mut().filter(|v| !v.is_zero()).for_each(|v| {
                *v = &*v * &inverse;
            });
        }
        for row in &mut self.rows {
            if !row[pivot].is_zero() {
                let factor = row[pivot].clone();
                subtract(row, &factor, &vector, budget)?;
            }
        }
        let place = self.pivots.partition_point(|&p| p < pivot);
        self.pivots.insert(place, pivot);
        self.rows.insert(place, vector);
        Ok(true)
    }

    /// The vectors that all the rows of the basis annihilate.
    pub fn annihilated(&self) -> Vec<Vector> {
        let kernel = self.complement_places().into_iter().map(|free| {
            let mut vector = vec![Rational::ZERO; self.length];
            vector[free] = Rational::ONE;
            for (row, &pivot) in self.rows.iter().zip(&self.pivots) {
                vector[pivot] = -&row[free];
            }
            vector
        });
        kernel.collect()
    }

    /// The vectors in both.
    pub fn intersection(&self, other: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        // the equations of both
        let equations = self.annihilated().into_iter().chain(other.annihilated());
        let equations = Self::span(self.length, equations, budget)?;
        Self::span(self.length, equations.annihilated(), budget)
    }
}

/// `vector -= factor * row`
fn subtract(
    vector: &mut Vector,
    factor: &Rational,
    row: &Vector,
    budget: &Budget,
) -> Result<(), Exhausted> {
    budget.spend(row.len() as u64 / 8)?;
    for (entry, value) in vector.iter_mut().zip(row) {
        if !value.is_zero() {
            let product = factor * value;
            budget.spend_on(&product)?;
            *entry = &*entry - &product;
        }
    }
    Ok(())
}

/// How many positive, negative and zero squares a quadratic form has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signature {
    /// Positive squares.
    pub positive: usize,
    /// Negative squares.
    pub negative: usize,
    /// The dimension of the radical.
    pub zero: usize,
}

/// The signature of a symmetric matrix, by Lagrange's completion of squares.
pub fn signature(mut form: Vec<Vector>, budget: &Budget) -> Result<Signature, Exhausted> {
    let mut found = Signature {
        positive: 0,
        negative: 0,
        zero: 0,
    };
    while !form.is_empty() {
        let size = form.len();
        let square = (0..size)
            .filter(|&i| !form[i][i].is_zero())
            .min_by_key(|&i| form[i][i].bits());
        let square = match square {
            Some(square) => square,
            None => {
                let pairs = (0..size).flat_map(|i| (0..i).map(move |j| (i, j)));
                let Some((i, j)) = pairs.into_iter().find(|&(i, j)| !form[i][j].is_zero()) else {
                    found.zero += size;
                    break;
                };
                // x_i x_j alone: with e_i + e_j in place of e_i there is a square
                let (row, other) = (form[i].clone(), form[j].clone());
                form[i] = row.iter().zip(&other).map(|(a, b)| a + b).collect();
                for line in &mut form {
                    line[i] = &line[i] + &line[j];
                }
                i
            }
        };
        let pivot = form.swap_remove(square);
        let value = &pivot[square];
        match value.is_negative() {
            true => found.negative += 1,
            false => found.positive += 1,
        }
        for row in &mut form {
            let factor = &row[square] / value;
            if !factor.is_zero() {
                subtract(row, &factor, &pivot, budget)?;
            }
            row.swap_remove(square);
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[i64]]) -> Vec<Vector> {
        let row = |row: &&[i64]| row.iter().map(|&v| Rational::from(v)).collect();
        rows.iter().map(row).collect()
    }

    #[test]
    fn signatures() {
        let budget = Budget::new(10_000);
        let of = |rows: &[&[i64]]| {
            let found = signature(matrix(rows), &budget).unwrap();
            (found.positive, found.negative, found.zero)
        };
        assert_eq!(of(&[&[0, 1], &[1, 0]]), (1, 1, 0));
        assert_eq!(of(&[&[1, 2], &[2, 4]]), (1, 0, 1));
        assert_eq!(of(&[&[-2, 1, 0], &[1, -2, 1], &[0, 1, -2]]), (0, 3, 0));
        assert_eq!(of(&[&[0, 0, 3], &[0, -1, 0], &[3, 0, 0]]), (1, 2, 0));
        assert_eq!(of(&[&[0, 0], &[0, 0]]), (0, 0, 2));
    }

    #[test]
    fn subspaces() {
        let budget = Budget::new(10_000);
        let a = Subspace::span(3, matrix(&[&[1, 1, 0], &[2, 2, 0], &[0, 0, 3]]), &budget).unwrap();
        assert_eq!((a.dimension(), a.complement_places()), (2, vec![1]));
        let b = Subspace::span(3, matrix(&[&[1, 0, 0], &[0, 1, 0]]), &budget).unwrap();
        let both = a.intersection(&b, &budget).unwrap();
        assert_eq!(both.basis(), matrix(&[&[1, 1, 0]]));
        assert!(
            a.contains(matrix(&[&[5, 5, -1]]).remove(0), &budget)
                .unwrap()
        );
        assert!(
            !a.contains(matrix(&[&[5, 4, 0]]).remove(0), &budget)
                .unwrap()
        );
        assert_eq!(a.annihilated(), matrix(&[&[-1, 1, 0]]));
    }
}
