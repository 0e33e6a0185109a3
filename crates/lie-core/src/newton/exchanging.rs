//! Elimination with row exchanges for every lane at once: each lane exchanges its own rows, by selection.
//!
//! Nothing is allocated and nothing fails: where a matrix is singular or not finite, the solution is not finite.

use core::ops::Range;

use crate::matrix::SquareMatrix;
use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// Brings the largest entry of column k, at or below row k, to the diagonal: of the rows and columns before `end` of the matrix,
/// from column k on, and of what `exchange` exchanges besides.
fn pivot<S: Scalar, M: SquareMatrix<S>>(
    matrix: &mut M,
    end: usize,
    k: usize,
    mut exchange: impl FnMut(S::Mask, usize, usize),
) {
    for row in k + 1..end {
        let larger = matrix.get(k, k).abs().less(matrix.get(row, k).abs());
        if !larger.any() {
            continue;
        }
        for column in k..end {
            let (a, b) = (matrix.get(k, column), matrix.get(row, column));
            matrix.set(k, column, S::select(larger, b, a));
            matrix.set(row, column, S::select(larger, a, b));
        }
        exchange(larger, k, row);
    }
}

/// Solves `A x = b` in place of b; the matrix is used up. Returns the sign of the determinant, 1 or -1.
pub fn solve<S: Scalar, M: SquareMatrix<S>, U: Unknown<S>>(matrix: &mut M, vector: &mut U) -> S {
    solve_block(0..matrix.dimension(), matrix, vector)
}

/// The same with the rows and columns of a block on the diagonal of A, and its entries of b, alone; the others are not looked at and stay.
#[inline]
pub fn solve_block<S: Scalar, M: SquareMatrix<S>, U: Unknown<S>>(
    block: Range<usize>,
    matrix: &mut M,
    vector: &mut U,
) -> S {
    let end = block.end;
    let mut sign = S::one();
    for k in block.clone() {
        pivot(matrix, end, k, |lanes, first, second| {
            sign = S::select(lanes, -sign, sign);
            let (a, b) = (vector.entry(first), vector.entry(second));
            vector.set_entry(first, S::select(lanes, b, a));
            vector.set_entry(second, S::select(lanes, a, b));
        });
        let negative = matrix.get(k, k).less(S::zero());
        sign = S::select(negative, -sign, sign);
        let inverse = S::one() / matrix.get(k, k);
        for row in k + 1..end {
            let multiplier = matrix.get(row, k) * inverse;
            for column in k + 1..end {
                let reduced = matrix.get(row, column) - multiplier * matrix.get(k, column);
                matrix.set(row, column, reduced);
            }
            vector.set_entry(row, vector.entry(row) - multiplier * vector.entry(k));
        }
    }
    for row in block.rev() {
        let mut sum = vector.entry(row);
        for column in row + 1..end {
            sum -= matrix.get(row, column) * vector.entry(column);
        }
        vector.set_entry(row, sum / matrix.get(row, row));
    }
    sign
}

/// Writes the inverse of a matrix to `out`; the matrix is used up.
pub fn invert<S: Scalar, M: SquareMatrix<S>>(matrix: &mut M, out: &mut M) {
    invert_leading(matrix.dimension(), matrix, out);
}

/// The same of the block of the leading `size` rows and columns; the other entries are not looked at and stay.
#[inline]
pub fn invert_leading<S: Scalar, M: SquareMatrix<S>>(size: usize, matrix: &mut M, out: &mut M) {
    for row in 0..size {
        for column in 0..size {
            out.set(
                row,
                column,
                if row == column { S::one() } else { S::zero() },
            );
        }
    }
    for k in 0..size {
        pivot(matrix, size, k, |lanes, first, second| {
            for column in 0..size {
                let (a, b) = (out.get(first, column), out.get(second, column));
                out.set(first, column, S::select(lanes, b, a));
                out.set(second, column, S::select(lanes, a, b));
            }
        });
        let inverse = S::one() / matrix.get(k, k);
        for column in 0..size {
            matrix.set(k, column, matrix.get(k, column) * inverse);
            out.set(k, column, out.get(k, column) * inverse);
        }
        for row in (0..size).filter(|&row| row != k) {
            let multiplier = matrix.get(row, k);
            for column in k..size {
                let reduced = matrix.get(row, column) - multiplier * matrix.get(k, column);
                matrix.set(row, column, reduced);
            }
            for column in 0..size {
                let reduced = out.get(row, column) - multiplier * out.get(k, column);
                out.set(row, column, reduced);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SMatrix, SVector};

    fn example() -> SMatrix<f64, 4, 4> {
        SMatrix::from_row_slice(&[
            0.0, 2.0, -1.0, 0.5, 1e-9, 1.0, 3.0, -2.0, 4.0, 0.25, 0.0, 1.0, 2.0, -1.0, 0.5, 0.0,
        ])
    }

    #[test]
    fn solution_and_inverse() {
        let (matrix, right) = (example(), SVector::from([1.0, -2.0, 0.5, 3.0]));
        let mut solution = right;
        solve(&mut matrix.clone(), &mut solution);
        assert!((matrix * solution - right).amax() < 1e-14);
        let mut inverse = SMatrix::<f64, 4, 4>::zeros();
        invert(&mut matrix.clone(), &mut inverse);
        assert!((matrix * inverse - SMatrix::identity()).amax() < 1e-14);
        assert!((inverse * right - solution).amax() < 1e-14);
    }

    /// A block has the bits of a matrix of its own, whatever stands around it, which stays.
    #[test]
    fn a_block_stands_alone() {
        let (whole, right) = (example(), SVector::from([1.0, -2.0, 0.5, 3.0]));
        for first in [0, 1] {
            let block = whole.fixed_view::<3, 3>(first, first).into_owned();
            let mut expected = right.fixed_rows::<3>(first).into_owned();
            let sign = solve(&mut block.clone(), &mut expected);
            let mut expected_inverse = block;
            invert(&mut block.clone(), &mut expected_inverse);
            for around in [0.0, -7.0, f64::NAN] {
                let mut matrix = SMatrix::<f64, 4, 4>::repeat(around);
                matrix
                    .fixed_view_mut::<3, 3>(first, first)
                    .copy_from(&block);
                let (mut factors, mut solution) = (matrix, right);
                let own_sign = solve_block(first..first + 3, &mut factors, &mut solution);
                assert_eq!(own_sign, sign);
                assert_eq!(solution.fixed_rows::<3>(first), expected);
                let other = 3 - 3 * first;
                assert_eq!(solution[other], right[other]);
                if first == 0 {
                    let mut inverse = whole;
                    invert_leading(3, &mut matrix, &mut inverse);
                    assert_eq!(inverse.fixed_view::<3, 3>(0, 0), expected_inverse);
                    assert_eq!(inverse.row(3), whole.row(3));
                    assert_eq!(inverse.column(3), whole.column(3));
                }
            }
            let mut solution = right;
            solve(&mut whole.clone(), &mut solution);
            assert_ne!(solution.fixed_rows::<3>(first), expected);
        }
    }

    #[test]
    fn the_sign_of_the_determinant() {
        let unit = |k: usize| SVector::<f64, 3>::from_fn(|row, _| f64::from(u8::from(row == k)));
        for [a, b, c] in [
            [0, 1, 2],
            [1, 2, 0],
            [2, 0, 1],
            [1, 0, 2],
            [0, 2, 1],
            [2, 1, 0],
        ] {
            for signs in 0..8 {
                let column =
                    |k: usize, at: usize| unit(k) * if signs >> at & 1 == 1 { -2.0 } else { 3.0 };
                let columns = [column(a, 0), column(b, 1), column(c, 2)];
                let mut matrix = SMatrix::<f64, 3, 3>::from_columns(&columns);
                let expected = matrix.determinant().signum();
                let sign = solve(&mut matrix, &mut SVector::from([1.0, 2.0, 3.0]));
                assert_eq!(sign, expected, "{columns:?}");
            }
        }
        let expected = example().determinant().signum();
        let mut right = SVector::from([1.0, 2.0, 3.0, 4.0]);
        assert_eq!(solve(&mut example(), &mut right), expected);
    }

    #[test]
    fn a_singular_matrix_gives_no_numbers() {
        let matrix = SMatrix::<f64, 2, 2>::new(1.0, 2.0, 2.0, 4.0);
        let mut vector = SVector::from([1.0, 0.0]);
        solve(&mut matrix.clone(), &mut vector);
        assert!(!vector.iter().all(|x| x.is_finite()));
        let mut inverse = matrix;
        invert(&mut matrix.clone(), &mut inverse);
        assert!(!inverse.iter().all(|x| x.is_finite()));
    }

    #[cfg(feature = "lanes")]
    #[test]
    fn a_lane_has_the_bits_of_a_run_of_its_own() {
        use crate::scalar::F64x4;
        let scaled = |lane: usize| {
            let mut matrix = example();
            matrix[(0, 0)] = 3.0 * lane as f64;
            matrix[(2, 0)] = 4.0 - lane as f64;
            matrix
        };
        let mut lanes = SMatrix::<F64x4, 4, 4>::repeat(F64x4::zero());
        for (index, entry) in lanes.iter_mut().enumerate() {
            for lane in 0..4 {
                *entry = entry.with_lane(lane, scaled(lane)[index]);
            }
        }
        let mut right = SVector::<F64x4, 4>::from([1.0, -2.0, 0.5, 3.0].map(F64x4::splat));
        let mut inverse = lanes;
        invert(&mut lanes.clone(), &mut inverse);
        solve(&mut lanes, &mut right);
        for lane in 0..4 {
            let mut alone = SVector::from([1.0, -2.0, 0.5, 3.0]);
            solve(&mut scaled(lane), &mut alone);
            let mut alone_inverse = scaled(lane);
            invert(&mut scaled(lane), &mut alone_inverse);
            for row in 0..4 {
                assert_eq!(right[row].lane(lane), alone[row]);
                for column in 0..4 {
                    assert_eq!(
                        inverse[(row, column)].lane(lane),
                        alone_inverse[(row, column)]
                    );
                }
            }
        }
    }
}
