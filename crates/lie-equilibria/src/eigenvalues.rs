//! Eigenvalues of small matrices that are not symmetric: Hessenberg form by reflections, then the QR iteration over the complex numbers with
//! the shifts of Wilkinson (G. H. Golub and C. F. Van Loan 2013, *Matrix Computations*, 4th ed., sections 7.4 and 7.5).

use num_complex::Complex64 as c64;

/// Iterations for one eigenvalue; four are usual.
const MOST: usize = 60;
/// After so many the shift is another one.
const STUCK: usize = 12;

/// The eigenvalues of a matrix by rows, those with the largest real part first; pairs stand together. Empty where the iteration fails.
pub fn eigenvalues(a: &[f64], n: usize) -> Vec<c64> {
    let Some(mut found) = iterated(hessenberg(a, n)) else {
        return Vec::new();
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

/// A similar matrix with nothing below the first subdiagonal.
fn hessenberg(a: &[f64], n: usize) -> Vec<Vec<c64>> {
    let mut h: Vec<Vec<f64>> = a.chunks(n.max(1)).map(<[f64]>::to_vec).collect();
    for k in 0..n.saturating_sub(2) {
        let mut v: Vec<f64> = (k + 1..n).map(|i| h[i][k]).collect();
        let length = super::dense::norm(&v);
        if length == 0.0 {
            continue;
        }
        v[0] += if v[0] < 0.0 { -length } else { length };
        let square = super::dense::dot(&v, &v);
        let part = |j: usize| (k + 1..n).map(|i| v[i - k - 1] * h[i][j]).sum();
        let parts: Vec<f64> = (0..n).map(part).collect();
        for (row, weight) in h[k + 1..].iter_mut().zip(&v) {
            super::dense::add(row, -2.0 * weight / square, &parts);
        }
        for row in &mut h {
            let part = super::dense::dot(&row[k + 1..], &v);
            super::dense::add(&mut row[k + 1..], -2.0 * part / square, &v);
        }
    }
    let complex = |row: Vec<f64>| row.into_iter().map(|x| c64::new(x, 0.0)).collect();
    h.into_iter().map(complex).collect()
}

/// The QR iteration; `None` where it does not end.
fn iterated(mut h: Vec<Vec<c64>>) -> Option<Vec<c64>> {
    let (mut end, mut rounds) = (h.len(), 0);
    let mut found = Vec::new();
    while end > 0 {
        let last = end - 1;
        let negligible = |k: usize| {
            let around = h[k - 1][k - 1].norm() + h[k][k].norm();
            h[k][k - 1].norm() <= f64::EPSILON * around
        };
        let first = (1..end).rev().find(|k| negligible(*k)).unwrap_or(0);
        if first == last {
            found.push(h[last][last]);
            (end, rounds) = (last, 0);
            continue;
        }
        if rounds == MOST {
            return None;
        }
        let shift = match rounds % STUCK {
            11 => h[last][last] + h[last][last - 1].norm(),
            _ => wilkinson(&h, last),
        };
        step(&mut h, first..end, shift);
        rounds += 1;
    }
    Some(found)
}

/// The eigenvalue of the last block of two that is nearer to its last entry.
fn wilkinson(h: &[Vec<c64>], k: usize) -> c64 {
    let (a, b, c, d) = (h[k - 1][k - 1], h[k - 1][k], h[k][k - 1], h[k][k]);
    let half = (a - d) * 0.5;
    let root = (half * half + b * c).sqrt();
    let sum = match (half.conj() * root).re >= 0.0 {
        true => half + root,
        false => half - root,
    };
    match sum.norm_sqr() > 0.0 {
        true => d - b * c / sum,
        false => d,
    }
}

/// `H - s = Q R` becomes `R Q + s` on a block.
fn step(h: &mut [Vec<c64>], block: std::ops::Range<usize>, shift: c64) {
    block.clone().for_each(|k| h[k][k] -= shift);
    let mut rotations = Vec::new();
    for k in block.start..block.end - 1 {
        let (x, y) = (h[k][k], h[k + 1][k]);
        let length = x.norm().hypot(y.norm());
        let (c, s) = match length > 0.0 {
            true => (x / length, y / length),
            false => (c64::new(1.0, 0.0), c64::new(0.0, 0.0)),
        };
        let (upper, lower) = h.split_at_mut(k + 1);
        let rows = upper[k][k..block.end].iter_mut();
        for (p, q) in rows.zip(&mut lower[0][k..block.end]) {
            (*p, *q) = (c.conj() * *p + s.conj() * *q, c * *q - s * *p);
        }
        rotations.push((c, s));
    }
    for (k, (c, s)) in (block.start..).zip(rotations) {
        for row in &mut h[block.start..block.end.min(k + 2)] {
            let (p, q) = (row[k], row[k + 1]);
            (row[k], row[k + 1]) = (p * c + q * s, q * c.conj() - p * s.conj());
        }
    }
    block.for_each(|k| h[k][k] += shift);
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
