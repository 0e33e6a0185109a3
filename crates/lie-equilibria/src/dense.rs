//! Small dense linear algebra.

use nalgebra::{ComplexField, DMatrix, DVector, SVD, SymmetricEigen};

/// Where an iteration has converged, for numbers of size 1.
pub const CONVERGED: f64 = 5.0 * f64::EPSILON;
/// Iterations for a decomposition; a few for each row are usual.
pub const MOST: usize = 10_000;

/// Solves `A x = b`, A by rows; `None` where A is singular.
pub fn solve<T: ComplexField>(a: &[T], b: Vec<T>) -> Option<Vec<T>> {
    let n = b.len();
    if n == 0 {
        return Some(b);
    }
    let x = DMatrix::from_row_slice(n, n, a)
        .lu()
        .solve(&DVector::from_vec(b))?;
    Some(x.data.into())
}

/// The singular value decomposition of a matrix by rows, values from the largest down.
pub struct Singular {
    /// The values, one for each column.
    pub values: Vec<f64>,
    /// The left vectors.
    left: Vec<Vec<f64>>,
    /// The right vectors, all of them.
    pub right: Vec<Vec<f64>>,
}

impl Singular {
    /// `None` where something is not finite.
    pub fn new(a: &[f64], rows: usize, columns: usize) -> Option<Self> {
        if !a.iter().all(|x| x.is_finite()) {
            return None;
        }
        if columns == 0 {
            return Some(Self {
                values: Vec::new(),
                left: Vec::new(),
                right: Vec::new(),
            });
        }
        // rows of zeros, so that the kernel is among the right vectors
        let entry = |i: usize, j: usize| a.get(i * columns + j).copied().unwrap_or(0.0);
        let square = DMatrix::from_fn(rows.max(columns), columns, entry);
        let found = SVD::try_new(square, true, true, CONVERGED, MOST)?;
        let left = found.u?;
        let left = left
            .column_iter()
            .map(|u| u.rows(0, rows).iter().copied().collect());
        let right = found.v_t?;
        let right = right.row_iter().map(|v| v.iter().copied().collect());
        Some(Self {
            values: found.singular_values.data.into(),
            left: left.collect(),
            right: right.collect(),
        })
    }

    /// How many values are above a part of the largest.
    pub fn rank(&self, part: f64) -> usize {
        let bound = part * self.values.first().copied().unwrap_or(0.0);
        self.values.iter().filter(|value| **value > bound).count()
    }

    /// The shortest solution of least squares, in which values beyond the rank do not take part.
    pub fn shortest(&self, b: &[f64], rank: usize) -> Vec<f64> {
        let columns = self.right.first().map_or(0, Vec::len);
        let mut x = vec![0.0; columns];
        for k in 0..rank {
            let part = dot(&self.left[k], b) / self.values[k];
            add(&mut x, part, &self.right[k]);
        }
        x
    }

    /// An orthonormal basis of the kernel.
    pub fn kernel(&self, rank: usize) -> &[Vec<f64>] {
        &self.right[rank..]
    }
}

/// The vectors along the axes.
pub fn unit_vectors(n: usize) -> Vec<Vec<f64>> {
    let unit = |i: usize| (0..n).map(|j| f64::from(u8::from(i == j))).collect();
    (0..n).map(unit).collect()
}

/// The eigenvalues of a symmetric matrix by rows, ascending, with eigenvectors of length 1; `None` where the iteration fails.
pub fn symmetric_eigen(a: &[f64], n: usize) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    if n == 0 {
        return Some((Vec::new(), Vec::new()));
    }
    let found = SymmetricEigen::try_new(DMatrix::from_row_slice(n, n, a), CONVERGED, MOST)?;
    let values = found.eigenvalues.iter().copied();
    let mut pairs: Vec<(f64, Vec<f64>)> = values
        .zip(found.eigenvectors.column_iter())
        .map(|(value, vector)| (value, vector.iter().copied().collect()))
        .collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(pairs.into_iter().unzip())
}

/// `B^T A B` for vectors that are the columns of B.
pub fn restricted(a: &[f64], n: usize, basis: &[Vec<f64>]) -> Vec<f64> {
    let images: Vec<Vec<f64>> = basis.iter().map(|v| times(a, n, v)).collect();
    let rows = basis
        .iter()
        .flat_map(|u| images.iter().map(move |image| dot(u, image)));
    rows.collect()
}

/// `A x`, A by rows of length n.
pub fn times(a: &[f64], n: usize, x: &[f64]) -> Vec<f64> {
    a.chunks(n).map(|row| dot(row, x)).collect()
}

/// A product of square matrices by rows.
pub fn product(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let mut c = vec![0.0; n * n];
    for i in 0..n {
        for k in 0..n {
            let factor = a[i * n + k];
            (0..n).for_each(|j| c[i * n + j] += factor * b[k * n + j]);
        }
    }
    c
}

/// The sign of the Pfaffian of an antisymmetric matrix by rows: -1, 0 or 1. Elimination in pairs of rows.
pub fn pfaffian_sign(mut a: Vec<f64>, n: usize) -> f64 {
    let mut sign = 1.0;
    if n % 2 == 1 {
        return 0.0;
    }
    for k in (0..n).step_by(2) {
        let largest = |i: &usize, j: &usize| a[k * n + i].abs().total_cmp(&a[k * n + j].abs());
        let place = (k + 1..n).max_by(largest).unwrap_or(k + 1);
        if place != k + 1 {
            (0..n).for_each(|j| a.swap(place * n + j, (k + 1) * n + j));
            (0..n).for_each(|i| a.swap(i * n + place, i * n + k + 1));
            sign = -sign;
        }
        let pivot = a[k * n + k + 1];
        if pivot == 0.0 {
            return 0.0;
        }
        sign *= pivot.signum();
        for i in k + 2..n {
            for j in k + 2..n {
                let minor = a[i * n + k + 1] * a[k * n + j] - a[i * n + k] * a[(k + 1) * n + j];
                a[i * n + j] -= minor / pivot;
            }
        }
    }
    sign
}

/// The scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The Euclidean norm.
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// `a += factor b`.
pub fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(x, y)| *x += factor * y);
}

/// `a - b`.
pub fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(x, y)| x - y).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn decompositions_of_small_matrices() {
        let mut random = Random::new(5);
        for (rows, columns) in [(5, 5), (4, 5), (2, 6), (6, 3)] {
            // of rank 2 at most
            let part = |random: &mut Random, n: usize| -> Vec<f64> {
                (0..n).map(|_| random.unit()).collect()
            };
            let (u, v) = (part(&mut random, 2 * rows), part(&mut random, 2 * columns));
            let entry = |i: usize, j: usize| u[2 * i] * v[2 * j] + u[2 * i + 1] * v[2 * j + 1];
            let a: Vec<f64> = (0..rows * columns)
                .map(|k| entry(k / columns, k % columns))
                .collect();
            let found = Singular::new(&a, rows, columns).expect("finite");
            assert_eq!((found.rank(1e-10), found.right.len()), (2, columns));
            for kernel in found.kernel(2) {
                assert!(norm(&times(&a, columns, kernel)) < 1e-14);
            }
            let b = times(&a, columns, &part(&mut random, columns));
            let x = found.shortest(&b, 2);
            assert!(norm(&difference(&times(&a, columns, &x), &b)) < 1e-13);
        }
        // Pf of 4 x 4 is a12 a34 - a13 a24 + a14 a23
        for _ in 0..20 {
            let [p, q, r, s, t, u]: [f64; 6] = std::array::from_fn(|_| random.unit());
            let rows = [
                [0.0, p, q, r],
                [-p, 0.0, s, t],
                [-q, -s, 0.0, u],
                [-r, -t, -u, 0.0],
            ];
            let expected = (p * u - q * t + r * s).signum();
            assert_eq!(pfaffian_sign(rows.concat(), 4), expected);
        }
        let a = [2.0, 1.0, 0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0];
        let (values, vectors) = symmetric_eigen(&a, 3).expect("it converges");
        let root = 2.0_f64.sqrt();
        assert!(norm(&difference(&values, &[2.0 - root, 2.0, 2.0 + root])) < 1e-14);
        let image = times(&a, 3, &vectors[0]);
        let expected: Vec<f64> = vectors[0].iter().map(|x| values[0] * x).collect();
        assert!(norm(&difference(&image, &expected)) < 1e-14);
    }
}
