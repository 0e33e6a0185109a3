//! Matrices of the group, of a size that is known at run time.

use crate::matrix::SquareMatrix;
use crate::newton::dense;
use crate::scalar::{Mask, Scalar, largest};

/// A square matrix on the heap, by rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GroupMatrix<S> {
    size: usize,
    entries: Vec<S>,
}

impl<S: Scalar> GroupMatrix<S> {
    pub(super) fn zero(size: usize) -> Self {
        let entries = vec![S::zero(); size * size];
        Self { size, entries }
    }

    pub(super) fn identity(size: usize) -> Self {
        let mut matrix = Self::zero(size);
        for k in 0..size {
            matrix.set_at(k, k, S::one());
        }
        matrix
    }

    pub(super) fn entries_mut(&mut self) -> &mut [S] {
        &mut self.entries
    }

    pub(super) fn entries(&self) -> &[S] {
        &self.entries
    }

    pub(super) fn at(&self, row: usize, column: usize) -> S {
        self.entries[row * self.size + column]
    }

    pub(super) fn set_at(&mut self, row: usize, column: usize, value: S) {
        self.entries[row * self.size + column] = value;
    }

    pub(super) fn times(&self, other: &Self) -> Self {
        let mut product = Self::zero(self.size);
        product.set_product(self, other);
        product
    }

    /// `A B`, in the place of what was here.
    fn set_product(&mut self, a: &Self, b: &Self) {
        let size = self.size;
        let rows = self.entries.chunks_exact_mut(size);
        for (out, row) in rows.zip(a.entries.chunks_exact(size)) {
            out.fill(S::zero());
            for (&entry, others) in row.iter().zip(b.entries.chunks_exact(size)) {
                for (sum, &other) in out.iter_mut().zip(others) {
                    *sum += entry * other;
                }
            }
        }
    }

    fn scale(&mut self, factor: S) {
        for entry in &mut self.entries {
            *entry = factor * *entry;
        }
    }

    fn add(&mut self, other: &Self) {
        for (entry, &other) in self.entries.iter_mut().zip(&other.entries) {
            *entry += other;
        }
    }

    fn add_identity(&mut self) {
        for k in 0..self.size {
            self.entries[k * self.size + k] += S::one();
        }
    }

    /// The largest sum of absolute values in a row, in any lane.
    fn norm(&self) -> f64 {
        let rows = self.entries.chunks(self.size);
        let sums = rows.map(|row| row.iter().fold(S::zero(), |sum, &x| sum + x.magnitude()));
        sums.map(largest).fold(0.0, f64::max)
    }

    /// One step of Newton's iteration to the nearest orthogonal matrix: `A (3 - A^T A)/2`.
    pub(super) fn orthogonalize(&mut self) {
        let size = self.size;
        let mut correction = Self::zero(size);
        for row in 0..size {
            for column in 0..size {
                let mut sum = S::zero();
                for k in 0..size {
                    sum += self.at(k, row) * self.at(k, column);
                }
                let identity = if row == column { S::one() } else { S::zero() };
                correction.set_at(row, column, (identity - sum) * S::ratio(1.0, 2.0));
            }
        }
        let product = self.times(&correction);
        self.add(&product);
    }

    /// The inverse of a matrix near 1; not a number where a pivot is small.
    pub(super) fn inverse(&self) -> Self {
        let Some(columns) = self.clone().solve_identities(self.size) else {
            let mut none = Self::identity(self.size);
            none.scale(S::from_f64(f64::NAN));
            return none;
        };
        let mut inverse = Self::zero(self.size);
        for (column, values) in columns.iter().enumerate() {
            for (row, &value) in values.iter().enumerate() {
                inverse.set_at(row, column, value);
            }
        }
        inverse
    }

    /// The columns of `A^-1 (1, …, 1)^T`, identities of a size on top of each other; none where a pivot is small.
    pub(super) fn solve_identities(mut self, size: usize) -> Option<Vec<Vec<S>>> {
        if !dense::factor(&mut self).all() {
            return None;
        }
        let columns = (0..size).map(|column| {
            let mut vector = vec![S::zero(); self.size];
            for row in (column..self.size).step_by(size) {
                vector[row] = S::one();
            }
            dense::solve(&self, &mut vector);
            vector
        });
        Some(columns.collect())
    }
}

impl<S: Scalar> SquareMatrix<S> for GroupMatrix<S> {
    fn dimension(&self) -> usize {
        self.size
    }
    fn get(&self, row: usize, column: usize) -> S {
        self.at(row, column)
    }
    fn set(&mut self, row: usize, column: usize, value: S) {
        self.set_at(row, column, value);
    }
}

/// No motion is that large: `|A|` below 2^63.
const MAX_HALVINGS: u32 = 64;

/// `exp A`, by the series of a part of A that is small, squared as often as it takes.
pub(super) fn exponential<S: Scalar>(matrix: &GroupMatrix<S>) -> GroupMatrix<S> {
    let norm = matrix.norm();
    let (mut halvings, mut factor) = (0, 1.0);
    while norm * factor > 0.5 && halvings < MAX_HALVINGS {
        factor *= 0.5;
        halvings += 1;
    }
    let mut small = matrix.clone();
    small.scale(S::from_f64(factor));
    // exp A - 1, so that the squares of what is near 1 keep their digits: (1 + D)^2 - 1 = 2 D + D^2
    let mut rest = small.clone();
    let mut term = small.clone();
    let mut product = small.clone();
    let bound = small.norm() * largest(S::epsilon()) / 8.0;
    for k in 2..30 {
        product.set_product(&term, &small);
        core::mem::swap(&mut term, &mut product);
        term.scale(S::ratio(1.0, f64::from(k)));
        rest.add(&term);
        if term.norm() <= bound {
            break;
        }
    }
    for _ in 0..halvings {
        product.set_product(&rest, &rest);
        rest.scale(S::ratio(2.0, 1.0));
        rest.add(&product);
    }
    rest.add_identity();
    rest
}

/// The Cayley map `(1 - A/2)^-1 (1 + A/2)`; not a number where a pivot is small.
pub(super) fn rational<S: Scalar>(matrix: &GroupMatrix<S>) -> GroupMatrix<S> {
    let mut right = matrix.clone();
    right.scale(S::ratio(1.0, 2.0));
    let mut left = right.clone();
    left.scale(-S::one());
    left.add_identity();
    right.add_identity();
    left.inverse().times(&right)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(entries: [f64; 9]) -> GroupMatrix<f64> {
        GroupMatrix {
            size: 3,
            entries: entries.to_vec(),
        }
    }

    /// The largest entry of `A^T A - 1`.
    fn from_orthogonal(a: &GroupMatrix<f64>) -> f64 {
        let mut largest = 0.0_f64;
        for row in 0..3 {
            for column in 0..3 {
                let sum: f64 = (0..3).map(|k| a.at(k, row) * a.at(k, column)).sum();
                let one = if row == column { 1.0 } else { 0.0 };
                largest = f64::max(largest, (sum - one).abs());
            }
        }
        largest
    }

    fn distance(a: &GroupMatrix<f64>, b: &GroupMatrix<f64>) -> f64 {
        let pairs = a.entries.iter().zip(&b.entries);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    const TURN: [f64; 9] = [0.0, -0.3, 0.2, 0.3, 0.0, -0.7, -0.2, 0.7, 0.0];

    #[test]
    fn orthogonalizing_squares_the_distance() {
        let mut near = exponential(&matrix(TURN));
        assert!(from_orthogonal(&near) < 1e-15);
        for (place, entry) in near.entries.iter_mut().enumerate() {
            *entry += 1e-4 * (place as f64 - 4.0);
        }
        let before = from_orthogonal(&near);
        near.orthogonalize();
        let once = from_orthogonal(&near);
        assert!(
            before > 1e-4 && once < 4.0 * before * before,
            "{before:e} {once:e}"
        );
        for _ in 0..3 {
            near.orthogonalize();
        }
        assert!(from_orthogonal(&near) < 1e-15);
    }

    #[test]
    fn exponential_and_cayley_map_of_a_rotation() {
        // about (a, b, c) by its length: cos 1 + (1 - cos) n n^T + sin [n]
        let n = [0.7, 0.2, 0.3];
        let angle = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        for (map, angle_of_map) in [
            (exponential as fn(&GroupMatrix<f64>) -> _, angle),
            (rational, 2.0 * (0.5 * angle).atan()),
        ] {
            let mut expected = GroupMatrix::identity(3);
            let (sine, cosine) = (angle_of_map.sin(), angle_of_map.cos());
            for r in 0..3 {
                for c in 0..3 {
                    let one = if r == c { cosine } else { 0.0 };
                    let along = n[r] * n[c] / (angle * angle) * (1.0 - cosine);
                    let turned = sine * TURN[3 * r + c] / angle;
                    expected.set_at(r, c, one + along + turned);
                }
            }
            let error = distance(&map(&matrix(TURN)), &expected);
            assert!(error < 1e-15, "{error:e}");
        }
        // several turns: twenty times a motion is its twentieth power
        let long = exponential(&matrix(TURN.map(|entry| 20.0 * entry)));
        let single = exponential(&matrix(TURN));
        let power = (1..20).fold(single.clone(), |power, _| power.times(&single));
        let error = distance(&long, &power);
        assert!(error < 2e-14, "{error:e}");
        let product = exponential(&matrix(TURN)).inverse();
        let back = exponential(&matrix(TURN.map(|entry| -entry)));
        assert!(distance(&product, &back) < 1e-15);
    }
}
