//! Hermitian matrices, by rows, the real part of an entry before the imaginary one: their lowest eigenvalue and their factors.

use crate::scalar::{Mask, Scalar, frozen, power_of_two};

/// Sweeps over a Hermitian matrix, which converge quadratically; those of size 2 to 12 take three to eight.
const SWEEPS: usize = 40;
/// What is left beside the diagonal, in units of round-off of the largest entry.
const LEFT: f64 = 1e-3;
/// Pivots that count as zero, in units of round-off of the largest one and for each row.
const ROUND_OFF: f64 = 4.0;

/// The real parts of the columns, then the imaginary ones.
#[inline(always)]
pub(super) fn halves<S>(point: &[S]) -> (&[S], &[S]) {
    point.split_at(point.len() / 2)
}

/// The lowest eigenvalue of a Hermitian matrix, by the iteration of Jacobi, which leaves the eigenvalues on the diagonal.
///
/// Its derivative is that of `v^H M v` for the eigenvector v: rotations are frozen. Where the eigenvalue is a multiple one, v is
/// one of its eigenvectors; along orbits the derivative is 0 for each.
pub(super) fn lowest_eigenvalue<S: Scalar>(size: usize, matrix: &mut [S]) -> S {
    let largest = matrix.iter().fold(S::zero(), |largest, entry| {
        largest.max(frozen(*entry).abs())
    });
    let unit = power_of_two(largest);
    for entry in matrix.iter_mut() {
        *entry /= unit;
    }
    let bound = S::from_f64(LEFT) * S::epsilon();
    for _ in 0..SWEEPS {
        let mut left = S::zero();
        for p in 0..size {
            for q in p + 1..size {
                let [x, y] = entry(size, matrix, p, q).map(frozen);
                left = left.max(x.abs()).max(y.abs());
            }
        }
        let open = bound.less(left);
        if !open.any() {
            break;
        }
        for p in 0..size {
            for q in p + 1..size {
                rotate(size, matrix, (p, q), open);
            }
        }
    }
    let diagonal = |a: usize| matrix[2 * (size * a + a)];
    let lowest = (1..size).fold(diagonal(0), |lowest, a| {
        S::select(diagonal(a).less(lowest), diagonal(a), lowest)
    });
    lowest * unit
}

/// The entry in a row and a column.
fn entry<S: Scalar>(size: usize, matrix: &[S], row: usize, column: usize) -> [S; 2] {
    let place = 2 * (size * row + column);
    [matrix[place], matrix[place + 1]]
}

/// The product of complex numbers.
fn times<S: Scalar>([a, b]: [S; 2], [c, d]: [S; 2]) -> [S; 2] {
    [a * c - b * d, a * d + b * c]
}

/// Turns a Hermitian matrix so that an entry beside the diagonal is zero, in the lanes of a mask where it is not: the entry
/// `g exp(i phi)` by the angle of tangent t with `t^2 + t (b - a)/g = 1`, a and b the entries of the diagonal.
fn rotate<S: Scalar>(size: usize, matrix: &mut [S], (p, q): (usize, usize), open: S::Mask) {
    let (zero, one) = (S::zero(), S::one());
    let [x, y] = entry(size, matrix, p, q).map(frozen);
    let length = (x * x + y * y).sqrt();
    let open = open & zero.less(length);
    if !open.any() {
        return;
    }
    let length = S::select(open, length, one);
    let [[a, _], [b, _]] = [p, q].map(|k| entry(size, matrix, k, k).map(frozen));
    let ratio = (b - a) / (length + length);
    let tangent = one / (ratio.abs() + (one + ratio * ratio).sqrt());
    let tangent = S::select(ratio.less(zero), -tangent, tangent);
    let cosine = one / (one + tangent * tangent).sqrt();
    let sine = tangent * cosine / length;
    let turn = [sine * x, sine * y];
    let back = [sine * x, -(sine * y)];
    for row in 0..size {
        let (u, v) = (entry(size, matrix, row, p), entry(size, matrix, row, q));
        let (first, second) = (times(v, back), times(u, turn));
        write(
            size,
            matrix,
            (row, p),
            open,
            core::array::from_fn(|k| cosine * u[k] - first[k]),
        );
        write(
            size,
            matrix,
            (row, q),
            open,
            core::array::from_fn(|k| second[k] + cosine * v[k]),
        );
    }
    for column in 0..size {
        let (u, v) = (
            entry(size, matrix, p, column),
            entry(size, matrix, q, column),
        );
        let (first, second) = (times(v, turn), times(u, back));
        write(
            size,
            matrix,
            (p, column),
            open,
            core::array::from_fn(|k| cosine * u[k] - first[k]),
        );
        write(
            size,
            matrix,
            (q, column),
            open,
            core::array::from_fn(|k| second[k] + cosine * v[k]),
        );
    }
    for (row, column) in [(p, q), (q, p)] {
        let rest = entry(size, matrix, row, column).map(|x| x - frozen(x));
        write(size, matrix, (row, column), open, rest);
    }
}

/// Writes an entry in the lanes of a mask.
fn write<S: Scalar>(
    size: usize,
    matrix: &mut [S],
    (row, column): (usize, usize),
    mask: S::Mask,
    value: [S; 2],
) {
    let place = 2 * (size * row + column);
    for (entry, value) in matrix[place..place + 2].iter_mut().zip(value) {
        *entry = S::select(mask, value, *entry);
    }
}

/// Columns X with `X X^H` the matrix, which has no negative eigenvalue: of what is left of it, that column whose entry on the
/// diagonal is largest, over its root. Columns beyond the rank are 0.
pub(super) fn factor<S: Scalar>(size: usize, matrix: &mut [S], point: &mut [S]) {
    let (zero, one) = (S::zero(), S::one());
    let middle = point.len() / 2;
    let (real, imaginary) = point.split_at_mut(middle);
    let mut bound = None;
    let columns = real.chunks_exact_mut(size);
    for (x, y) in columns.zip(imaginary.chunks_exact_mut(size)) {
        let mut pivot = matrix[0];
        for a in 0..size {
            [x[a], y[a]] = entry(size, matrix, a, 0);
        }
        for p in 1..size {
            let [diagonal, _] = entry(size, matrix, p, p);
            let larger = pivot.less(diagonal);
            pivot = S::select(larger, diagonal, pivot);
            for a in 0..size {
                let [re, im] = entry(size, matrix, a, p);
                x[a] = S::select(larger, re, x[a]);
                y[a] = S::select(larger, im, y[a]);
            }
        }
        let round_off = S::from_f64(ROUND_OFF * size as f64) * S::epsilon();
        let bound = *bound.get_or_insert(round_off * frozen(pivot));
        let resting = pivot.less_equal(bound);
        let root = S::select(resting, one, pivot).sqrt();
        for entry in x.iter_mut().chain(y.iter_mut()) {
            *entry = S::select(resting, zero, *entry / root);
        }
        for a in 0..size {
            for b in 0..size {
                let [re, im] = times([x[a], y[a]], [x[b], -y[b]]);
                matrix[2 * (size * a + b)] -= re;
                matrix[2 * (size * a + b) + 1] -= im;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Dual;

    /// A Hermitian matrix without symmetry and one that varies it, of numbers between -1 and 1.
    fn matrix(size: usize, seed: f64) -> Vec<f64> {
        let number = |k: usize| (seed + 2.3 * k as f64).sin();
        let mut matrix = vec![0.0; 2 * size * size];
        for a in 0..size {
            for b in 0..=a {
                let (x, y) = (number(a * size + b), number(70 + a * size + b));
                let [one, other] = [(a, b), (b, a)].map(|(a, b)| 2 * (size * a + b));
                (matrix[one], matrix[other]) = (x, x);
                if a != b {
                    (matrix[one + 1], matrix[other + 1]) = (y, -y);
                }
            }
        }
        matrix
    }

    fn shifted(size: usize, matrix: &[f64], shift: f64) -> Vec<f64> {
        let mut matrix = matrix.to_vec();
        for a in 0..size {
            matrix[2 * (size * a + a)] -= shift;
        }
        matrix
    }

    /// The largest entry of `X X^H - M`.
    fn defect(size: usize, matrix: &[f64], point: &[f64]) -> f64 {
        let (real, imaginary) = halves(point);
        let mut worst = 0.0_f64;
        for a in 0..size {
            for b in 0..size {
                let columns = real.chunks(size).zip(imaginary.chunks(size));
                let sum = columns.fold([0.0; 2], |[x, y], (re, im)| {
                    let [u, v] = times([re[a], im[a]], [re[b], -im[b]]);
                    [x + u, y + v]
                });
                let [x, y] = entry(size, matrix, a, b);
                worst = worst.max((sum[0] - x).abs()).max((sum[1] - y).abs());
            }
        }
        worst
    }

    /// A factor of N - 1 columns says that the shift is an eigenvalue and that no other one is lower.
    #[test]
    fn factors_lead_back_to_their_matrix() {
        for size in 2..=12 {
            for (seed, scale) in [(0.3, 1.0), (1.7, 1e-200), (2.9, 1e200)] {
                let mut given = matrix(size, seed);
                given.iter_mut().for_each(|x| *x *= scale);
                let lowest = lowest_eigenvalue(size, &mut given.clone());
                let rest = shifted(size, &given, lowest);
                let mut point = vec![0.0; 2 * size * (size - 1)];
                factor(size, &mut rest.clone(), &mut point);
                let off = defect(size, &rest, &point) / scale;
                println!("{size} {seed} {scale:e}: {off:e}");
                assert!(off < 3e-14 * size as f64);
            }
        }
    }

    /// The derivative of the lowest eigenvalue and of `X X^H`, against differences.
    #[test]
    fn derivatives_are_those_of_the_matrix() {
        for size in 2..=6 {
            let (given, along) = (matrix(size, 0.3), matrix(size, 1.1));
            let at = |h: f64| -> f64 {
                let mut moved: Vec<f64> =
                    given.iter().zip(&along).map(|(x, v)| x + h * v).collect();
                lowest_eigenvalue(size, &mut moved)
            };
            let mut dual: Vec<Dual<f64>> = given
                .iter()
                .zip(&along)
                .map(|(x, v)| Dual::new(*x, *v))
                .collect();
            let copy = dual.clone();
            let lowest = lowest_eigenvalue(size, &mut dual);
            let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
            assert_eq!(lowest.value.to_bits(), at(0.0).to_bits());
            assert!((lowest.derivative - slope).abs() < 1e-8, "{size}: {slope}");
            let mut rest = copy;
            for a in 0..size {
                rest[2 * (size * a + a)] -= lowest;
            }
            let mut point = vec![Dual::constant_of(0.0); 2 * size * (size - 1)];
            factor(size, &mut rest.clone(), &mut point);
            let (real, imaginary) = halves(&point);
            for a in 0..size {
                for b in 0..size {
                    let columns = real.chunks(size).zip(imaginary.chunks(size));
                    let product = columns.fold(Dual::constant_of(0.0), |sum, (re, im)| {
                        sum + times([re[a], im[a]], [re[b], -im[b]])[0]
                    });
                    let [expected, _] = entry(size, &rest, a, b);
                    let off = (product.derivative - expected.derivative).abs();
                    assert!(off < 1e-12, "{size}: {off:e}");
                }
            }
        }
    }
}
