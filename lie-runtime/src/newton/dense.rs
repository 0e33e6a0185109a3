//! Elimination in natural order without row exchanges, for every lane at once.

use crate::matrix::SquareMatrix;
use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// A pivot is safe if no multiplier of its column exceeds 1/PIVOT_THRESHOLD.
const PIVOT_THRESHOLD: f64 = 1.0 / 1024.0;

/// The lanes in which a pivot may be divided by: it is not 0, finite, and at least 2^-10 of the
/// largest entry below it in its column, so that elimination without row exchanges loses at most
/// about three digits.
#[inline]
pub fn pivot_is_safe<S: Scalar>(pivot: S, largest_below: S) -> S::Mask {
    let size = pivot.abs();
    let threshold = S::from_f64(PIVOT_THRESHOLD) * largest_below.abs();
    S::zero().less(size) & threshold.less_equal(size) & size.finite()
}

/// The lanes in which no inverse pivot exceeds 2^10, given the largest of their absolute values.
///
/// The Jacobian of a step is the identity plus terms of the step size, hence its pivots are
/// dimensionless and near 1; one that is not finite or large asks for row exchanges.
#[inline]
pub fn inverse_pivots_are_safe<S: Scalar>(largest: S) -> S::Mask {
    largest.less_equal(S::from_f64(1.0 / PIVOT_THRESHOLD))
}

/// Replaces a matrix A by `1 - factor A`.
pub fn identity_minus<S: Scalar, M: SquareMatrix<S>>(factor: S, matrix: &mut M) {
    for row in 0..matrix.dimension() {
        for column in 0..matrix.dimension() {
            let identity = if row == column { S::one() } else { S::zero() };
            matrix.set(row, column, identity - factor * matrix.get(row, column));
        }
    }
}

/// Replaces a matrix by its triangular factors, the inverse pivots on the diagonal. Returns the
/// lanes in which every pivot was safe.
pub fn factor<S: Scalar, M: SquareMatrix<S>>(matrix: &mut M) -> S::Mask {
    let size = matrix.dimension();
    let mut safe = S::Mask::splat(true);
    for k in 0..size {
        let mut largest = S::zero();
        for row in k + 1..size {
            largest = largest.max(matrix.get(row, k).abs());
        }
        let pivot = matrix.get(k, k);
        safe = safe & pivot_is_safe(pivot, largest);
        let inverse = S::one() / pivot;
        matrix.set(k, k, inverse);
        for row in k + 1..size {
            let multiplier = matrix.get(row, k) * inverse;
            matrix.set(row, k, multiplier);
            for column in k + 1..size {
                let reduced = matrix.get(row, column) - multiplier * matrix.get(k, column);
                matrix.set(row, column, reduced);
            }
        }
    }
    safe
}

/// Solves `A x = b` in place of b by the factors of [`factor`].
pub fn solve<S: Scalar, M: SquareMatrix<S>, U: Unknown<S>>(factors: &M, vector: &mut U) {
    let size = factors.dimension();
    for row in 1..size {
        let mut sum = vector.entry(row);
        for column in 0..row {
            sum -= factors.get(row, column) * vector.entry(column);
        }
        vector.set_entry(row, sum);
    }
    for row in (0..size).rev() {
        let mut sum = vector.entry(row);
        for column in row + 1..size {
            sum -= factors.get(row, column) * vector.entry(column);
        }
        vector.set_entry(row, sum * factors.get(row, row));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn factors_solve_the_system() {
        let matrix = Matrix3::new(4.0, 1.0, -2.0, 1.0, 3.0, 0.5, -1.0, 0.25, 5.0);
        let expected = Vector3::new(1.0, -2.0, 3.0);
        let mut vector = matrix * expected;
        let mut factors = matrix;
        assert!(factor::<f64, _>(&mut factors));
        solve(&factors, &mut vector);
        assert!((vector - expected).amax() < 1e-15);
    }

    #[test]
    fn small_pivots_are_refused() {
        let mut matrix = Matrix3::new(1e-4, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        assert!(!factor::<f64, _>(&mut matrix));
        assert!(pivot_is_safe::<f64>(1e-3, 1.0));
        assert!(!pivot_is_safe::<f64>(1e-4, 1.0));
        assert!(!pivot_is_safe::<f64>(0.0, 0.0));
        assert!(!pivot_is_safe::<f64>(f64::NAN, 0.0));
        assert!(!pivot_is_safe::<f64>(1.0, f64::NAN));
    }
}
