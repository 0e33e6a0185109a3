//! Linear algebra of matrices in square blocks, one for each pair of stages.

use super::tableau::Tableau;
use crate::matrix::{SquareMatrix, StageMatrix};
use crate::newton::inverse_pivots_are_safe;
use crate::scalar::Scalar;

/// The larger of the largest absolute sums of a row and of a column.
pub(super) fn size<S: Scalar, M: SquareMatrix<S>>(matrix: &M) -> S {
    let mut largest = S::zero();
    for i in 0..matrix.dimension() {
        let (mut row, mut column) = (S::zero(), S::zero());
        for j in 0..matrix.dimension() {
            row += matrix.get(i, j).abs();
            column += matrix.get(j, i).abs();
        }
        largest = largest.max(row).max(column);
    }
    largest
}

/// `out = a b`
pub(super) fn multiply<S: Scalar, M: SquareMatrix<S>>(size: usize, a: &M, b: &M, out: &mut M) {
    for r in 0..size {
        for c in 0..size {
            let mut sum = S::zero();
            for k in 0..size {
                sum += a.get(r, k) * b.get(k, c);
            }
            out.set(r, c, sum);
        }
    }
}

/// [`dense::factor`](crate::newton::dense::factor) block by block, without an index that is to be divided.
pub(super) fn factor<S: Scalar, M: SquareMatrix<S>, const STAGES: usize>(
    matrix: &mut StageMatrix<M, STAGES>,
) -> S::Mask {
    let size = matrix.0[0][0].dimension();
    let mut largest = S::zero();
    for pivot in 0..STAGES {
        for k in 0..size {
            let inverse = S::one() / matrix.0[pivot][pivot].get(k, k);
            largest = largest.max(inverse.abs());
            matrix.0[pivot][pivot].set(k, k, inverse);
            for i in pivot..STAGES {
                for r in if i == pivot { k + 1 } else { 0 }..size {
                    let multiplier = matrix.0[i][pivot].get(r, k) * inverse;
                    matrix.0[i][pivot].set(r, k, multiplier);
                    for j in pivot..STAGES {
                        for c in if j == pivot { k + 1 } else { 0 }..size {
                            let product = multiplier * matrix.0[pivot][j].get(k, c);
                            let entry = matrix.0[i][j].get(r, c) - product;
                            matrix.0[i][j].set(r, c, entry);
                        }
                    }
                }
            }
        }
    }
    inverse_pivots_are_safe(largest)
}

/// Solves `K X = B` for a column of blocks in place of B, by the factors of K.
#[allow(
    clippy::needless_range_loop,
    reason = "by iterators a step of isospectral4 on se(3) takes a third more instructions"
)]
pub(super) fn solve<S: Scalar, M: SquareMatrix<S>, const STAGES: usize>(
    factors: &StageMatrix<M, STAGES>,
    blocks: &mut [M; STAGES],
) {
    let size = blocks[0].dimension();
    for column in 0..size {
        for i in 0..STAGES {
            for r in 0..size {
                let mut sum = blocks[i].get(r, column);
                for j in 0..i {
                    for k in 0..size {
                        sum -= factors.0[i][j].get(r, k) * blocks[j].get(k, column);
                    }
                }
                for k in 0..r {
                    sum -= factors.0[i][i].get(r, k) * blocks[i].get(k, column);
                }
                blocks[i].set(r, column, sum);
            }
        }
        for i in (0..STAGES).rev() {
            for r in (0..size).rev() {
                let mut sum = blocks[i].get(r, column);
                for k in r + 1..size {
                    sum -= factors.0[i][i].get(r, k) * blocks[i].get(k, column);
                }
                for j in i + 1..STAGES {
                    for k in 0..size {
                        sum -= factors.0[i][j].get(r, k) * blocks[j].get(k, column);
                    }
                }
                blocks[i].set(r, column, sum * factors.0[i][i].get(r, r));
            }
        }
    }
}

/// Sets each block to a number times the unit matrix.
pub(super) fn set_units<S: Scalar, M: SquareMatrix<S>, const STAGES: usize>(
    factors: [S; STAGES],
    blocks: &mut [M; STAGES],
) {
    for (block, factor) in blocks.iter_mut().zip(factors) {
        for r in 0..block.dimension() {
            for c in 0..block.dimension() {
                block.set(r, c, if r == c { factor } else { S::zero() });
            }
        }
    }
}

/// Solves `K X = A` for the ratios of a tableau, each times the unit matrix, by the factors of K; block (j, i) of the result
/// stands in row i and column j.
pub(super) fn solve_weights<S: Scalar, M: SquareMatrix<S>, const STAGES: usize>(
    tableau: &Tableau<S, STAGES>,
    factors: &StageMatrix<M, STAGES>,
    out: &mut StageMatrix<M, STAGES>,
) {
    for (j, column) in out.0.iter_mut().enumerate() {
        set_units(core::array::from_fn(|i| tableau.ratios[i][j]), column);
        solve(factors, column);
    }
}
