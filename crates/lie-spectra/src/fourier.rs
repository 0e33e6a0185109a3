//! The discrete Fourier transform of so many numbers as a power of two, J. W. Cooley, J. W. Tukey (1965),
//! doi:10.1090/S0025-5718-1965-0178586-1. Only the place of the largest coefficient is taken from it.

use std::f64::consts::TAU;

use lie_runtime::Scalar;

/// The squares of the magnitudes of `sum_j x_j exp(-2 pi i j k/n)` for k up to n/2, n the next power of two of so many numbers, with
/// zeros behind those that are given.
pub(crate) fn powers(values: impl Iterator<Item = f64>, length: usize) -> Vec<f64> {
    let n = length.next_power_of_two();
    let mut all = vec![[0.0; 2]; n];
    let bits = n.trailing_zeros();
    for (j, value) in values.enumerate() {
        let reversed = j.reverse_bits().unbounded_shr(usize::BITS - bits);
        all[reversed][0] = value;
    }
    let turns: Vec<[f64; 2]> = (0..n / 2)
        .map(|k| {
            let (sine, cosine) = Scalar::sin_cos(-TAU * k as f64 / n as f64);
            [cosine, sine]
        })
        .collect();
    let mut half = 1;
    while half < n {
        for block in all.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            let turns = turns.iter().step_by(n / (2 * half));
            for ((a, b), turn) in low.iter_mut().zip(high).zip(turns) {
                let turned = [
                    b[0] * turn[0] - b[1] * turn[1],
                    b[0] * turn[1] + b[1] * turn[0],
                ];
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        half *= 2;
    }
    all.truncate(n / 2 + 1);
    all.into_iter().map(|[x, y]| x * x + y * y).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_are_those_of_the_sum() {
        let mut random = crate::random::Random::new(1);
        for given in [1_usize, 2, 23, 32] {
            let values: Vec<f64> = (0..given).map(|_| random.unit()).collect();
            let found = powers(values.iter().copied(), given);
            let n = given.next_power_of_two();
            for (k, found) in found.iter().enumerate() {
                let sum = |part: fn(f64) -> f64| {
                    let term = |j: usize| part(TAU * (j * k) as f64 / n as f64);
                    values
                        .iter()
                        .enumerate()
                        .map(|(j, v)| v * term(j))
                        .sum::<f64>()
                };
                let power = sum(f64::cos).powi(2) + sum(f64::sin).powi(2);
                assert!((found - power).abs() < 1e-12, "{given} {k}");
            }
        }
    }
}
