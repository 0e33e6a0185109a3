//! Eigenvalues of small matrices that are not symmetric.
//!
//! A matrix in Hessenberg form is made triangular but for blocks of two rows by steps of QR with two shifts (Francis; the procedure `hqr` of
//! R. S. Martin, G. Peters and J. H. Wilkinson 1970, doi:10.1007/BF02163032). An entry beside the diagonal counts as zero where it is
//! round-off beside the diagonal; after some steps without one, where it is round-off of the whole matrix. Eigenvalues that nearly meet
//! leave entries that stay above the first bound for ever, and the second one is all that round-off allows.

use nalgebra::DMatrix;
use num_complex::Complex64 as c64;

/// Steps for one eigenvalue; two are usual.
const MOST: usize = 60;
/// After so many the bound is that of the whole matrix.
const PATIENCE: usize = 8;

/// The eigenvalues of a matrix by rows, those with the largest real part first; pairs stand together. Empty where the iteration fails.
pub fn eigenvalues(a: &[f64], n: usize) -> Vec<c64> {
    let mut found = match n {
        0 => Vec::new(),
        _ => shifted(DMatrix::from_row_slice(n, n, a).hessenberg().unpack_h()).unwrap_or_default(),
    };
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

/// The eigenvalues of a matrix in Hessenberg form.
fn shifted(mut h: DMatrix<f64>) -> Option<Vec<c64>> {
    if !h.iter().all(|x| x.is_finite()) {
        return None;
    }
    let (mut found, mut left, mut steps) = (Vec::new(), h.nrows(), 0);
    let norm = h.norm();
    while left > 0 {
        let last = left - 1;
        let first = block(&h, last, if steps > PATIENCE { norm } else { 0.0 });
        match last - first {
            0 => found.push(c64::new(h[(last, last)], 0.0)),
            1 => found.extend(pair(&h, last)),
            _ if steps == MOST => return None,
            _ => {
                steps += 1;
                step(&mut h, first, last, steps % 10 == 0);
                continue;
            }
        }
        (left, steps) = (first, 0);
    }
    Some(found)
}

/// The first row of the block that ends at a row.
fn block(h: &DMatrix<f64>, last: usize, least: f64) -> usize {
    let splits = |k: &usize| {
        let size = h[(*k, *k)].abs() + h[(k - 1, k - 1)].abs();
        h[(*k, k - 1)].abs() <= f64::EPSILON * size.max(least)
    };
    (1..=last).rev().find(splits).unwrap_or(0)
}

/// The eigenvalues of the block of two rows that ends at a row.
fn pair(h: &DMatrix<f64>, last: usize) -> [c64; 2] {
    let (x, y) = (h[(last, last)], h[(last - 1, last - 1)]);
    let half = 0.5 * (y - x);
    let product = h[(last, last - 1)] * h[(last - 1, last)];
    let square = half * half + product;
    let root = square.abs().sqrt();
    if square < 0.0 {
        return [c64::new(x + half, root), c64::new(x + half, -root)];
    }
    let far = half + root.copysign(half);
    let near = if far == 0.0 { 0.0 } else { -product / far };
    [c64::new(x + far, 0.0), c64::new(x + near, 0.0)]
}

/// One step with two shifts on the rows of a block: the eigenvalues of its last two rows, or others where those lead nowhere.
fn step(h: &mut DMatrix<f64>, first: usize, last: usize, other: bool) {
    let (mut x, mut y) = (h[(last, last)], h[(last - 1, last - 1)]);
    let mut w = h[(last, last - 1)] * h[(last - 1, last)];
    if other {
        let size = h[(last, last - 1)].abs() + h[(last - 1, last - 2)].abs();
        (x, y, w) = (x + 0.75 * size, x + 0.75 * size, -0.4375 * size * size);
    }
    let z = h[(first, first)];
    let below = h[(first + 1, first)];
    let mut bulge = [
        ((x - z) * (y - z) - w) / below + h[(first, first + 1)],
        h[(first + 1, first + 1)] + z - x - y,
        h[(first + 2, first + 1)],
    ];
    for k in first..last {
        let rows = (last + 1 - k).min(3);
        if k > first {
            (0..3).for_each(|i| bulge[i] = if i < rows { h[(k + i, k - 1)] } else { 0.0 });
        }
        reflect(h, &bulge[..rows], k, first, last);
    }
}

/// The reflection that turns a vector into the first axis, on both sides of the block from row k on.
fn reflect(h: &mut DMatrix<f64>, vector: &[f64], k: usize, first: usize, last: usize) {
    let length = vector.iter().fold(0.0_f64, |size, x| size.hypot(*x));
    if length == 0.0 {
        return;
    }
    let mut v = vector.to_vec();
    v[0] += length.copysign(v[0]);
    let square: f64 = v.iter().map(|x| x * x).sum();
    if square == 0.0 {
        return;
    }
    for j in k.saturating_sub(1).max(first)..=last {
        let part: f64 = v.iter().enumerate().map(|(i, v)| v * h[(k + i, j)]).sum();
        let part = 2.0 * part / square;
        v.iter()
            .enumerate()
            .for_each(|(i, v)| h[(k + i, j)] -= part * v);
    }
    for i in first..=last.min(k + 3) {
        let part: f64 = v.iter().enumerate().map(|(j, v)| v * h[(i, k + j)]).sum();
        let part = 2.0 * part / square;
        v.iter()
            .enumerate()
            .for_each(|(j, v)| h[(i, k + j)] -= part * v);
    }
    if k > first {
        (1..vector.len()).for_each(|i| h[(k + i, k - 1)] = 0.0);
    }
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

    /// Pairs of pairs a distance apart that is small beside their size: those of a top that hardly spins.
    #[test]
    fn pairs_that_nearly_meet() {
        for apart in [0.0, 1e-14, 1e-9, 1e-4, 1e-2] {
            // two oscillators that are turned against each other: (s - i apart)^2 = 1, in real form
            let rows = [
                [0.0, -apart, 1.0, 0.0],
                [apart, 0.0, 0.0, 1.0],
                [1.0, 0.0, 0.0, -apart],
                [0.0, 1.0, apart, 0.0],
            ];
            let found = eigenvalues(&rows.concat(), 4);
            assert_eq!(found.len(), 4, "{apart}");
            for z in &found {
                let wanted = c64::new(1.0_f64.copysign(z.re), apart.copysign(z.im));
                assert!((z - wanted).norm() < 1e-14, "{apart}: {z}");
            }
        }
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
