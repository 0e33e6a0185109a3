//! Eigenvalues of small matrices that are not symmetric.

use nalgebra::{DMatrix, Schur};
use num_complex::Complex64 as c64;

use crate::dense::{CONVERGED, MOST};

/// The eigenvalues of a matrix by rows, those with the largest real part first; pairs stand together. Empty where the iteration fails.
pub fn eigenvalues(a: &[f64], n: usize) -> Vec<c64> {
    let matrix = DMatrix::from_row_slice(n, n, a);
    let found = (n > 0).then(|| Schur::try_new(matrix, CONVERGED, MOST));
    let Some(found) = found.flatten() else {
        return Vec::new();
    };
    let mut found: Vec<c64> = found.complex_eigenvalues().data.into();
    let scale = found.iter().map(|z| z.norm()).fold(0.0, f64::max);
    // parts that differ by round-off alone are in no order
    let coarse = |x: f64| (x / (1e-7 * scale.max(f64::MIN_POSITIVE))).round();
    found.sort_by(|a, b| {
        let re = coarse(b.re).total_cmp(&coarse(a.re));
        let im = coarse(b.im.abs()).total_cmp(&coarse(a.im.abs()));
        re.then(im).then(b.im.total_cmp(&a.im))
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn eigenvalues_of_known_matrices() {
        // a rotation, a companion matrix of (s - 1)(s - 2)(s^2 + 4), and one that is triangular but for a similarity
        let close = |found: &[c64], expected: &[(f64, f64)]| {
            found.len() == expected.len()
                && found
                    .iter()
                    .zip(expected)
                    .all(|(z, w)| (z - c64::new(w.0, w.1)).norm() < 1e-12)
        };
        let found = eigenvalues(&[0.0, -3.0, 3.0, 0.0], 2);
        assert!(close(&found, &[(0.0, 3.0), (0.0, -3.0)]), "{found:?}");
        let companion = [
            0.0, 0.0, 0.0, -8.0, 1.0, 0.0, 0.0, 12.0, 0.0, 1.0, 0.0, -6.0, 0.0, 0.0, 1.0, 3.0,
        ];
        let found = eigenvalues(&companion, 4);
        assert!(
            close(&found, &[(2.0, 0.0), (1.0, 0.0), (0.0, 2.0), (0.0, -2.0)]),
            "{found:?}"
        );
        assert!(eigenvalues(&[], 0).is_empty());
        assert!(close(&eigenvalues(&[0.0; 9], 3), &[(0.0, 0.0); 3]));
    }

    /// The sums of powers of eigenvalues are the traces of powers.
    #[test]
    fn traces_of_random_matrices() {
        let mut random = Random::new(11);
        for n in 1..12 {
            let a: Vec<f64> = (0..n * n).map(|_| random.unit()).collect();
            let square = crate::dense::product(&a, &a, n);
            let trace = |a: &[f64]| (0..n).map(|i| a[i * n + i]).sum::<f64>();
            let found = eigenvalues(&a, n);
            assert_eq!(found.len(), n);
            let sum: c64 = found.iter().sum();
            let squares: c64 = found.iter().map(|z| z * z).sum();
            assert!((sum - trace(&a)).norm() < 1e-12, "{n}: {sum}");
            assert!((squares - trace(&square)).norm() < 1e-11, "{n}: {squares}");
        }
    }
}
