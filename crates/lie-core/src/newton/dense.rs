//! Elimination in natural order without row exchanges, for every lane at once.

use crate::matrix::SquareMatrix;
use crate::scalar::Scalar;
use crate::state::Unknown;

/// The largest inverse pivot that elimination without row exchanges accepts.
const MAX_INVERSE_PIVOT: f64 = 1024.0;

/// The lanes in which no inverse pivot exceeds 2^10, given the largest of their absolute values, or the sum of a few.
///
/// The Jacobian of a step is the identity plus terms of the step size, hence its pivots are
/// dimensionless and near 1; an inverse that is large or not a number asks for row exchanges.
#[inline]
pub fn inverse_pivots_are_safe<S: Scalar>(largest: S) -> S::Mask {
    largest.less_equal(S::from_f64(MAX_INVERSE_PIVOT))
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
    let mut largest = S::zero();
    for k in 0..size {
        let inverse = S::one() / matrix.get(k, k);
        largest = largest.max(inverse.abs());
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
    inverse_pivots_are_safe(largest)
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
        assert!(inverse_pivots_are_safe::<f64>(1000.0));
        assert!(!inverse_pivots_are_safe::<f64>(2000.0));
        assert!(!inverse_pivots_are_safe::<f64>(f64::INFINITY));
        assert!(!inverse_pivots_are_safe::<f64>(f64::NAN));
    }
}
