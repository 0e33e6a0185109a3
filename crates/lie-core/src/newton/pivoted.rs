//! Elimination with row exchanges, for one lane.

use crate::matrix::SquareMatrix;
use crate::scalar::Scalar;
use crate::state::Unknown;

/// Solves `A x = b` in one lane, in place of b, by Gaussian elimination with partial pivoting;
/// the matrix is used up in that lane, all other lanes of both are left alone. False, with an
/// unusable b, if the matrix is singular to the last bit or not finite.
pub fn solve_lane<S: Scalar, M: SquareMatrix<S>, U: Unknown<S>>(
    matrix: &mut M,
    vector: &mut U,
    lane: usize,
) -> bool {
    let size = matrix.dimension();
    let zero = S::Lane::zero();
    for k in 0..size {
        let mut largest = zero;
        let mut pivot_row = k;
        for row in k..size {
            let candidate = matrix.get(row, k).lane(lane).abs();
            if !candidate.finite() {
                return false;
            }
            if largest.less(candidate) {
                largest = candidate;
                pivot_row = row;
            }
        }
        if !zero.less(largest) {
            return false;
        }
        if pivot_row != k {
            exchange_rows(matrix, vector, lane, k, pivot_row);
        }
        let pivot = matrix.get(k, k).lane(lane);
        for row in k + 1..size {
            let multiplier = matrix.get(row, k).lane(lane) / pivot;
            for column in k + 1..size {
                let entry = matrix.get(row, column);
                let reduced = entry.lane(lane) - multiplier * matrix.get(k, column).lane(lane);
                matrix.set(row, column, entry.with_lane(lane, reduced));
            }
            let entry = vector.entry(row);
            let reduced = entry.lane(lane) - multiplier * vector.entry(k).lane(lane);
            vector.set_entry(row, entry.with_lane(lane, reduced));
        }
    }
    for row in (0..size).rev() {
        let entry = vector.entry(row);
        let mut sum = entry.lane(lane);
        for column in row + 1..size {
            sum -= matrix.get(row, column).lane(lane) * vector.entry(column).lane(lane);
        }
        let solution = sum / matrix.get(row, row).lane(lane);
        vector.set_entry(row, entry.with_lane(lane, solution));
    }
    true
}

/// Exchanges two rows of the matrix and of the right-hand side in one lane.
fn exchange_rows<S: Scalar, M: SquareMatrix<S>, U: Unknown<S>>(
    matrix: &mut M,
    vector: &mut U,
    lane: usize,
    first: usize,
    second: usize,
) {
    for column in 0..matrix.dimension() {
        let (a, b) = (matrix.get(first, column), matrix.get(second, column));
        matrix.set(first, column, a.with_lane(lane, b.lane(lane)));
        matrix.set(second, column, b.with_lane(lane, a.lane(lane)));
    }
    let (a, b) = (vector.entry(first), vector.entry(second));
    vector.set_entry(first, a.with_lane(lane, b.lane(lane)));
    vector.set_entry(second, b.with_lane(lane, a.lane(lane)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SMatrix, SVector};

    /// Numbers in [-1, 1) that look random.
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / 2.0_f64.powi(52) - 1.0
    }

    #[test]
    fn agrees_with_nalgebra() {
        let mut seed = 2018;
        for trial in 0..200 {
            let mut matrix = SMatrix::<f64, 7, 7>::from_fn(|_, _| noise(&mut seed));
            if trial % 2 == 0 {
                matrix[(0, 0)] = 0.0;
            }
            let vector = SVector::<f64, 7>::from_fn(|_, _| noise(&mut seed));
            let expected = matrix
                .lu()
                .solve(&vector)
                .expect("a random matrix has an inverse");
            let mut solution = vector;
            assert!(solve_lane(&mut matrix.clone(), &mut solution, 0));
            let scale = expected.amax();
            assert!(
                (solution - expected).amax() < 1e-10 * scale,
                "trial {trial}"
            );
            assert!(
                (matrix * solution - vector).amax() < 1e-13 * (1.0 + scale),
                "trial {trial}"
            );
        }
    }

    #[test]
    fn singular_matrices_are_refused() {
        let mut matrix = SMatrix::<f64, 2, 2>::new(1.0, 2.0, 2.0, 4.0);
        assert!(!solve_lane(&mut matrix, &mut SVector::from([1.0, 1.0]), 0));
        let mut matrix = SMatrix::<f64, 2, 2>::new(1.0, f64::NAN, 2.0, 4.0);
        assert!(!solve_lane(&mut matrix, &mut SVector::from([1.0, 1.0]), 0));
    }

    #[cfg(feature = "lanes")]
    #[test]
    fn other_lanes_are_left_alone() {
        use crate::scalar::F64x4;
        let entry = |x: f64| F64x4::splat(x).with_lane(2, x * 2.0);
        let mut matrix =
            SMatrix::<F64x4, 2, 2>::new(entry(0.0), entry(1.0), entry(3.0), entry(1.0));
        let mut vector = SVector::<F64x4, 2>::new(entry(1.0), entry(4.0));
        let before = vector;
        assert!(solve_lane(&mut matrix, &mut vector, 2));
        assert_eq!((vector[0].lane(2), vector[1].lane(2)), (1.0, 1.0));
        for lane in [0, 1, 3] {
            assert_eq!(vector[0].lane(lane), before[0].lane(lane));
            assert_eq!(matrix[(0, 0)].lane(lane), 0.0);
        }
    }
}
