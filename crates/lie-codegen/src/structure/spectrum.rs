//! Real eigenvalues of representations, at which the Cayley map and Gauss methods have poles.

use crate::algebra::Parametric;
use crate::algebra::ring::Ring;
use lie_symbolic::exact::{Budget, Fraction, Rational};
use lie_syntax::linear::WORK;

/// What is known of the eigenvalues of all elements of a representation.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// None is real but 0.
    Imaginary,
    /// The absolute value of each is at most the sum of these weights times the absolute coordinates.
    Bounded(Vec<f64>),
}

/// The spectrum of some matrices of one size.
///
/// Arrange the axes so that all matrices are block triangular, each block strongly connected by their nonzero
/// entries. Where all diagonal blocks are antisymmetric, the eigenvalues of every combination are imaginary.
pub fn spectrum(matrices: &[Vec<Vec<Rational>>]) -> Spectrum {
    if is_imaginary(matrices, |a, b| (a + b).is_zero()) {
        return Spectrum::Imaginary;
    }
    Spectrum::Bounded(matrices.iter().map(|matrix| norm(matrix)).collect())
}

/// Whether matrices with parameters have no real eigenvalues but 0, whatever the values of these.
pub fn is_imaginary_identically(parametric: &Parametric) -> bool {
    let budget = Budget::new(WORK);
    is_imaginary(&parametric.matrices, |a: &Fraction, b| {
        a.add(b, &budget).is_ok_and(|sum| sum.is_zero())
    })
}

/// Whether all diagonal blocks are antisymmetric, in the arrangement that makes the matrices block triangular.
fn is_imaginary<T: Ring>(matrices: &[Vec<Vec<T>>], are_opposite: impl Fn(&T, &T) -> bool) -> bool {
    let size = matrices.first().map_or(0, Vec::len);
    let reaches = reachable(matrices, size);
    let skew = |matrix: &Vec<Vec<T>>| {
        (0..size).all(|i| {
            (0..=i).all(|j| {
                let joined = i == j || (reaches[i][j] && reaches[j][i]);
                !joined || are_opposite(&matrix[i][j], &matrix[j][i])
            })
        })
    };
    matrices.iter().all(skew)
}

/// Whether there is a way along nonzero entries from one axis to another.
fn reachable<T: Ring>(matrices: &[Vec<Vec<T>>], size: usize) -> Vec<Vec<bool>> {
    let mut reaches = vec![vec![false; size]; size];
    for matrix in matrices {
        for (i, row) in matrix.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                reaches[i][j] |= !entry.is_zero();
            }
        }
    }
    for through in 0..size {
        for i in 0..size {
            for j in 0..size {
                reaches[i][j] |= reaches[i][through] && reaches[through][j];
            }
        }
    }
    reaches
}

/// A bound of the eigenvalues: the largest absolute sum of a row, rounded up.
///
/// Sums of norms bound those of sums, so that it must be the same norm for all matrices.
fn norm(matrix: &[Vec<Rational>]) -> f64 {
    let sums = matrix.iter().map(|row| {
        let sum = row.iter().fold(Rational::ZERO, |sum, entry| {
            if entry.to_f64() < 0.0 {
                &sum - entry
            } else {
                &sum + entry
            }
        });
        sum.to_f64()
    });
    sums.fold(0.0, f64::max) * (1.0 + 4.0 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrices(entries: &[&[&[i64]]]) -> Vec<Vec<Vec<Rational>>> {
        let row = |row: &&[i64]| row.iter().map(|&v| Rational::from(v)).collect();
        entries
            .iter()
            .map(|m| m.iter().map(row).collect())
            .collect()
    }

    #[test]
    fn imaginary_or_not() {
        let turn: &[&[i64]] = &[&[0, -1, 0], &[1, 0, 0], &[0, 0, 0]];
        let shift: &[&[i64]] = &[&[0, 0, 1], &[0, 0, 0], &[0, 0, 0]];
        let boost: &[&[i64]] = &[&[0, 0, 1], &[0, 0, 0], &[1, 0, 0]];
        let scale: &[&[i64]] = &[&[-3, 0, 0], &[0, 2, 0], &[0, 0, 0]];
        assert_eq!(spectrum(&matrices(&[turn, shift])), Spectrum::Imaginary);
        let Spectrum::Bounded(weights) = spectrum(&matrices(&[turn, boost, scale])) else {
            panic!("a boost has real eigenvalues");
        };
        for (weight, expected) in weights.iter().zip([1.0, 1.0, 3.0]) {
            assert!(*weight >= expected && *weight < expected * (1.0 + 1e-15));
        }
        assert_ne!(spectrum(&matrices(&[boost])), Spectrum::Imaginary);
        assert_ne!(spectrum(&matrices(&[scale])), Spectrum::Imaginary);
        // a translation that comes back through another element is a boost
        let back: &[&[i64]] = &[&[0, 0, 0], &[0, 0, 0], &[1, 0, 0]];
        assert_ne!(spectrum(&matrices(&[shift, back])), Spectrum::Imaginary);
    }
}
