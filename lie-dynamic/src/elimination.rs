//! Sparse eliminations as tables.

use lie_codegen::plan::elimination::Elimination;
use lie_core::newton::inverse_pivots_are_safe;
use lie_runtime::{Scalar, SquareMatrix, Unknown};

/// An elimination with pivots in a fixed order, as generated code writes it out.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pivots: Vec<Pivot>,
    /// Whether printed code is unrolled, which judges the pivots by their sum and not by the largest.
    unrolled: bool,
}

#[derive(Clone, Debug)]
struct Pivot {
    index: usize,
    /// Whether it is one.
    unit: bool,
    below: Vec<usize>,
    right: Vec<usize>,
}

impl Table {
    /// The table of an elimination.
    pub fn new(elimination: &Elimination) -> Self {
        let place = elimination.places();
        let pivots = elimination.order.iter().map(|&index| {
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

    /// Replaces a matrix by its triangular factors; the lanes in which every pivot was safe.
    pub fn factor<S: Scalar, M: SquareMatrix<S>>(&self, matrix: &mut M) -> S::Mask {
        let mut measure: Option<S> = None;
        for Pivot {
            index,
            unit,
            below,
            right,
        } in &self.pivots
        {
            let index = *index;
            let keeps_one = *unit && self.unrolled;
            if !keeps_one {
                let inverse = S::one() / matrix.get(index, index);
                matrix.set(index, index, inverse);
                let size = inverse.abs();
                measure = Some(match measure {
                    None => size,
                    Some(sum) if self.unrolled => sum + size,
                    Some(largest) => largest.max(size),
                });
            }
            for &row in below {
                let mut multiplier = matrix.get(row, index);
                if !keeps_one {
                    multiplier *= matrix.get(index, index);
                    matrix.set(row, index, multiplier);
                }
                for &column in right {
                    let product = multiplier * matrix.get(index, column);
                    matrix.set(row, column, matrix.get(row, column) - product);
                }
            }
        }
        inverse_pivots_are_safe(measure.unwrap_or_else(S::one))
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
        for Pivot {
            index, unit, right, ..
        } in self.pivots.iter().rev()
        {
            let mut sum = vector.entry(*index);
            for &column in right {
                sum -= factors.get(*index, column) * vector.entry(column);
            }
            let keeps_one = *unit && self.unrolled;
            let value = if keeps_one {
                sum
            } else {
                sum * factors.get(*index, *index)
            };
            vector.set_entry(*index, value);
        }
    }
}
