//! Points of `C^(N x (N-1))` over a unitary representation on `C^N`: factors X of the Hermitian matrix `X X^H` of a state, up to a
//! multiple of the unit matrix, which is the label of an orbit.

use super::StageSlopes;
use super::lifts::LinearLift;
use crate::methods::Unitary;
use crate::scalar::{Mask, Scalar, frozen, power_of_two};
use crate::state::State;
use crate::structure::UnitaryPoisson;

/// Sweeps over a Hermitian matrix, which converge quadratically; those of size 2 to 12 take three to eight.
const SWEEPS: usize = 40;
/// What is left beside the diagonal, in units of round-off of the largest entry.
const LEFT: f64 = 1e-3;
/// Pivots that count as zero, in units of round-off of the largest one and for each row.
const ROUND_OFF: f64 = 4.0;

/// The momentum `mu_k = (i/2) tr(X^H rho(e_k) X)` of a point, and i/2 times the shift times the trace of `rho(e_k)`.
#[inline(always)]
pub fn momentum_of_factor<S: Scalar, P: UnitaryPoisson<S>>(
    system: &P,
    shift: &P::Shift,
    point: &P::Factor,
    out: &mut P::State,
) {
    let (size, shift) = (system.degree(), shift.as_slice()[0]);
    let (real, imaginary) = halves(point.as_slice());
    let (half, quarter) = (S::ratio(1.0, 2.0), S::ratio(1.0, 4.0));
    let matrices = system.representation().matrices;
    for (out, matrix) in out.as_mut_slice().iter_mut().zip(matrices) {
        let (mut sum, mut trace) = (S::zero(), S::zero());
        for entry in *matrix {
            let ((a, b), value) = (entry.place(), entry.value::<S>());
            let (row, column) = (a % size, b % size);
            let right = if b < size { real } else { imaginary };
            let (left, value) = match a < size {
                true => (imaginary, value),
                false => (real, -value),
            };
            let pairs = left.chunks_exact(size).zip(right.chunks_exact(size));
            let products = pairs.map(|(x, y)| x[row] * y[column]);
            sum += value * products.fold(S::zero(), |sum, term| sum + term);
            if row == column && a != b {
                trace += value;
            }
        }
        *out = half * sum + quarter * (shift * trace);
    }
}

/// The canonical flow of `H o J` at a point, of which `xi` is the gradient of H at J: `X' = -rho(xi) X`.
#[inline(always)]
pub fn flow_of_factor<S: Scalar, P: UnitaryPoisson<S>>(
    system: &P,
    point: &P::Factor,
    xi: &P::State,
    out: &mut P::Factor,
) {
    let size = system.degree();
    out.fill(S::zero());
    let (real, imaginary) = halves(point.as_slice());
    let middle = real.len();
    let (out_real, out_imaginary) = out.as_mut_slice().split_at_mut(middle);
    let matrices = system.representation().matrices;
    for (&xi, matrix) in xi.as_slice().iter().zip(matrices) {
        for entry in *matrix {
            let ((a, b), value) = (entry.place(), entry.value::<S>() * xi);
            let (row, column) = (a % size, b % size);
            let from = if b < size { real } else { imaginary };
            let to = match a < size {
                true => &mut *out_real,
                false => &mut *out_imaginary,
            };
            for (out, x) in to.chunks_exact_mut(size).zip(from.chunks_exact(size)) {
                out[row] -= value * x[column];
            }
        }
    }
}

/// The canonical flow of `H o J` at a point.
#[inline(always)]
pub fn flow_over_factors<S: Scalar, P: UnitaryPoisson<S>>(
    system: &P,
    shift: &P::Shift,
    point: &P::Factor,
    out: &mut P::Factor,
) {
    let (mut momenta, mut gradient) = (system.zero_state(), system.zero_state());
    momentum_of_factor(system, shift, point, &mut momenta);
    system.gradient(&momenta, &mut gradient);
    flow_of_factor(system, point, &gradient, out);
}

/// A point over a state: the columns of the Cholesky factor with pivots of `M - shift`, where M is the Hermitian matrix of the
/// state and the shift its lowest eigenvalue.
///
/// Any factor does, since those of one matrix differ by a unitary matrix from the right, with which Gauss methods commute. This
/// one needs no eigenvectors, and what it drops is of the size of round-off also where eigenvalues coincide.
pub fn factor_of<S: Scalar, P: UnitaryPoisson<S>>(
    system: &P,
    mu: &P::State,
    shift: &mut P::Shift,
    point: &mut P::Factor,
) {
    let size = system.degree();
    let mut work = system.zero_hermitian();
    let (matrix, copy) = work.as_mut_slice().split_at_mut(2 * size * size);
    hermitian_of(system, mu, matrix);
    copy.copy_from_slice(matrix);
    let lowest = lowest_eigenvalue(size, copy);
    shift.as_mut_slice()[0] = lowest;
    for a in 0..size {
        matrix[2 * (size * a + a)] -= lowest;
    }
    factor(size, matrix, point.as_mut_slice());
}

/// The real parts of the columns, then the imaginary ones.
#[inline(always)]
fn halves<S>(point: &[S]) -> (&[S], &[S]) {
    point.split_at(point.len() / 2)
}

/// The matrix M with `mu_k = (i/2) tr(M rho(e_k))`, `M = -4 i sum mu_k D^k` with the dual matrices; by rows, the real part of an
/// entry before the imaginary one.
fn hermitian_of<S: Scalar, P: UnitaryPoisson<S>>(system: &P, mu: &P::State, matrix: &mut [S]) {
    let size = system.degree();
    let four = S::ratio(4.0, 1.0);
    matrix.fill(S::zero());
    for (&mu, dual) in mu.as_slice().iter().zip(system.representation().dual) {
        for entry in *dual {
            let ((a, b), value) = (entry.place(), four * entry.value::<S>() * mu);
            // of the two equal blocks of rows one
            if b < size && a >= size {
                matrix[2 * (size * (a - size) + b)] += value;
            } else if b < size {
                matrix[2 * (size * a + b) + 1] -= value;
            }
        }
    }
}

/// The lowest eigenvalue of a Hermitian matrix, by the iteration of Jacobi, which leaves the eigenvalues on the diagonal.
///
/// Its derivative is that of `v^H M v` for the eigenvector v: rotations are frozen. Where the eigenvalue is a multiple one, v is
/// one of its eigenvectors; along orbits the derivative is 0 for each.
fn lowest_eigenvalue<S: Scalar>(size: usize, matrix: &mut [S]) -> S {
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
fn factor<S: Scalar>(size: usize, matrix: &mut [S], point: &mut [S]) {
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

/// The fibre is turned by unitary matrices from the right, which leaves the norm of points as it is.
impl<S: Scalar, P: UnitaryPoisson<S>> LinearLift<S, P> for Unitary {
    type Point = P::Factor;
    type Labels = P::Shift;
    const GROWS: bool = false;
    const SLOPES: Option<StageSlopes> = Some(StageSlopes::Unitary);

    fn zero_point(system: &P) -> P::Factor {
        system.zero_factor()
    }

    fn zero_labels(system: &P) -> P::Shift {
        system.zero_shift()
    }

    #[inline]
    fn lift(system: &P, mu: &P::State, shift: &mut P::Shift, point: &mut P::Factor) {
        factor_of(system, mu, shift, point);
    }

    #[inline(always)]
    fn project(system: &P, shift: &P::Shift, point: &P::Factor, mu: &mut P::State) {
        momentum_of_factor(system, shift, point, mu);
    }

    #[inline(always)]
    fn flow(system: &P, shift: &P::Shift, point: &P::Factor, out: &mut P::Factor) {
        system.unitary_flow(shift, point, out);
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
