//! Points of `C^(N x (N-1))` over a unitary representation on `C^N`: factors X of the Hermitian matrix `X X^H` of a state, up to a
//! multiple of the unit matrix, which is the label of an orbit.

use super::StageSlopes;
use super::hermitian::{factor, halves, lowest_eigenvalue};
use super::lifts::LinearLift;
use crate::methods::Unitary;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::UnitaryPoisson;

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

/// The canonical flow of `H o J` at a point; along the generator where something damps.
#[inline(always)]
pub fn flow_over_factors<S: Scalar, P: UnitaryPoisson<S>>(
    system: &P,
    shift: &P::Shift,
    point: &P::Factor,
    out: &mut P::Factor,
) {
    let (mut momenta, mut generator) = (system.zero_state(), system.zero_state());
    momentum_of_factor(system, shift, point, &mut momenta);
    system.generator(&momenta, &mut generator);
    flow_of_factor(system, point, &generator, out);
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
