//! Where two roots of a polynomial meet.

/// The discriminant of a polynomial but for a positive factor: `(-1)^(d(d-1)/2) Res(q, q')/a_d`.
pub fn discriminant(q: &[f64]) -> f64 {
    let d = q.len().saturating_sub(1);
    if d < 2 {
        return 1.0;
    }
    let slope: Vec<f64> = (1..=d).map(|k| k as f64 * q[k]).collect();
    let size = 2 * d - 1;
    let mut sylvester = vec![0.0; size * size];
    for row in 0..d - 1 {
        (0..=d).for_each(|k| sylvester[row * size + row + k] = q[d - k]);
    }
    for row in 0..d {
        (0..d).for_each(|k| sylvester[(d - 1 + row) * size + row + k] = slope[d - 1 - k]);
    }
    let sign = if (d * (d - 1) / 2).is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    sign * determinant(sylvester, size) / q[d]
}

fn determinant(mut a: Vec<f64>, n: usize) -> f64 {
    let mut product = 1.0;
    for k in 0..n {
        let size = |i: usize, a: &[f64]| a[i * n + k].abs();
        let best = (k..n).max_by(|i, j| size(*i, &a).total_cmp(&size(*j, &a)));
        let best = best.unwrap_or(k);
        if a[best * n + k] == 0.0 {
            return 0.0;
        }
        if best != k {
            (0..n).for_each(|j| a.swap(k * n + j, best * n + j));
            product = -product;
        }
        product *= a[k * n + k];
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            (k..n).for_each(|j| a[i * n + j] -= factor * a[k * n + j]);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_discriminants() {
        // (s + 1)(s + 2), s^2 + 1, (s + 1)(s + 2)(s + 4) and (s + 1)(s^2 + 1)
        assert!((discriminant(&[2.0, 3.0, 1.0]) - 1.0).abs() < 1e-14);
        assert!((discriminant(&[1.0, 0.0, 1.0]) + 4.0).abs() < 1e-14);
        assert!((discriminant(&[8.0, 14.0, 7.0, 1.0]) - 36.0).abs() < 1e-10);
        assert!((discriminant(&[1.0, 1.0, 1.0, 1.0]) + 16.0).abs() < 1e-12);
        assert!(discriminant(&[1.0, 2.0, 1.0]).abs() < 1e-15);
    }
}
