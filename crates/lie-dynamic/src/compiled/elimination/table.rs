//! Sparse eliminations as tables.

use lie_codegen::plan::elimination::Elimination as Pattern;
use lie_core::newton::inverse_pivots_are_safe;
use lie_runtime::{Scalar, SquareMatrix, Unknown};
use std::collections::BTreeSet;

/// An elimination with pivots in a fixed order, as generated code writes it out.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pivots: Vec<Pivot>,
    /// Whether printed code is unrolled, which judges the pivots by their sum and not by the largest.
    unrolled: bool,
}

/// A pivot in its turn.
#[derive(Clone, Debug)]
pub struct Pivot {
    /// Its row and column.
    pub index: usize,
    /// Whether it is one.
    unit: bool,
    /// The rows of later pivots with an entry in its column.
    pub below: Vec<usize>,
    /// The columns of later pivots with an entry in its row.
    pub right: Vec<usize>,
}

impl Table {
    /// The table of an elimination.
    pub fn new(elimination: &Pattern) -> Self {
        let place = elimination.places();
        let pivots = elimination.acting().map(|index| {
            let later = elimination.order.iter().copied();
            let below =
                later.filter(|i| place[i] > place[&index] && elimination.rows[i].contains(&index));
            Pivot {
                index,
                unit: elimination.unit.contains(&index),
                below: below.collect(),
                right: elimination.split(index).1,
            }
        });
        Self {
            pivots: pivots.collect(),
            unrolled: elimination.is_unrolled(),
        }
    }

    /// The pivots in order.
    pub fn pivots(&self) -> &[Pivot] {
        &self.pivots
    }

    /// The entries that are read, in the order of rows.
    pub fn places(&self) -> BTreeSet<(usize, usize)> {
        let mut places = BTreeSet::new();
        for pivot in &self.pivots {
            if !self.keeps_one(pivot) {
                places.insert((pivot.index, pivot.index));
            }
            places.extend(pivot.below.iter().map(|row| (*row, pivot.index)));
            places.extend(pivot.right.iter().map(|column| (pivot.index, *column)));
        }
        places
    }

    /// Whether a pivot is one that nothing is divided by.
    pub fn keeps_one(&self, pivot: &Pivot) -> bool {
        pivot.unit && self.unrolled
    }

    /// The lanes in which every pivot was safe, by the inverse of each.
    pub fn are_safe<S: Scalar>(&self, inverse: impl Fn(usize) -> S) -> S::Mask {
        let mut measure: Option<S> = None;
        for pivot in &self.pivots {
            if self.keeps_one(pivot) {
                continue;
            }
            let size = inverse(pivot.index).abs();
            measure = Some(match measure {
                None => size,
                Some(sum) if self.unrolled => sum + size,
                Some(largest) => largest.max(size),
            });
        }
        inverse_pivots_are_safe(measure.unwrap_or_else(S::one))
    }

    /// Replaces a matrix by its triangular factors; the lanes in which every pivot was safe.
    pub fn factor<S: Scalar, M: SquareMatrix<S>>(&self, matrix: &mut M) -> S::Mask {
        for pivot in &self.pivots {
            let (index, keeps_one) = (pivot.index, self.keeps_one(pivot));
            if !keeps_one {
                let inverse = S::one() / matrix.get(index, index);
                matrix.set(index, index, inverse);
            }
            for &row in &pivot.below {
                let mut multiplier = matrix.get(row, index);
                if !keeps_one {
                    multiplier *= matrix.get(index, index);
                    matrix.set(row, index, multiplier);
                }
                for &column in &pivot.right {
                    let product = multiplier * matrix.get(index, column);
                    matrix.set(row, column, matrix.get(row, column) - product);
                }
            }
        }
        self.are_safe(|index| matrix.get(index, index))
    }

    /// Solves in place of the right side.
    pub fn solve<S: Scalar, M: SquareMatrix<S>, U: Unknown<S>>(&self, factors: &M, vector: &mut U) {
        for Pivot { index, below, .. } in &self.pivots {
            let value = vector.entry(*index);
            for &row in below {
                let product = factors.get(row, *index) * value;
                vector.set_entry(row, vector.entry(row) - product);
            }
        }
        for pivot in self.pivots.iter().rev() {
            let index = pivot.index;
            let mut sum = vector.entry(index);
            for &column in &pivot.right {
                sum -= factors.get(index, column) * vector.entry(column);
            }
            let value = match self.keeps_one(pivot) {
                true => sum,
                false => sum * factors.get(index, index),
            };
            vector.set_entry(index, value);
        }
    }
}
