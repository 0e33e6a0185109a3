//! Poisson tensors of the two ends of a step.

use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// What a discrete gradient method claims with a tensor: data, as [`Facts`](crate::methods::Facts).
pub trait TensorFacts {
    /// The order of the method, with a discrete gradient for which the tensor is made.
    const ORDER: u32 = 2;
    /// Whether the tensor is the same with the ends exchanged and h of the other sign, and with it the
    /// method symmetric.
    const SYMMETRIC: bool = true;
    /// Whether `grad C` at the midpoint lies in its kernel for each Casimir C of degree at most two, so
    /// that these are kept.
    const QUADRATIC_CASIMIRS: bool;
}

/// A modified Poisson tensor: an antisymmetric matrix `Pi~(x, y, h)` of both ends of a step, with
/// `Pi~(x, x, 0) = Pi(x)`. A step `y - x = h Pi~(x, y, h) g(x, y)` with a discrete gradient g keeps the
/// energy whatever the tensor is, as long as it is antisymmetric; its order depends on it.
pub trait PoissonTensor<S: Scalar, P: Poisson<S>>: TensorFacts {
    /// The tensor, every entry.
    fn matrix(&self, system: &P, start: &P::State, end: &P::State, h: S, out: &mut P::Jacobian);
    /// Its derivative in the end against a fixed vector: `out_ij = d(Pi~(x, y, h) xi)_i/dy_j`, every
    /// entry.
    fn slope(
        &self,
        system: &P,
        start: &P::State,
        end: &P::State,
        h: S,
        xi: &P::State,
        out: &mut P::Jacobian,
    );
}

/// The Poisson matrix at the midpoint, `Pi((x + y)/2)`: symmetric, order 2, keeps Casimirs of degree at
/// most two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MidpointTensor;

/// The mean of the Poisson matrix over the ends, `(Pi(x) + Pi(y))/2`: symmetric, order 2. It is that at
/// the midpoint where the Poisson matrix is affine in the coordinates; elsewhere linear Casimirs are kept,
/// quadratic ones not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeanTensor;

fn half<S: Scalar>() -> S {
    S::ratio(1.0, 2.0)
}

fn middle<S: Scalar, P: Poisson<S>>(system: &P, start: &P::State, end: &P::State) -> P::State {
    let mut middle = system.zero_state();
    let pairs = start.as_slice().iter().zip(end.as_slice());
    for (middle, (&x, &y)) in middle.as_mut_slice().iter_mut().zip(pairs) {
        *middle = half::<S>() * (x + y).quantity();
    }
    middle
}

fn halve<S: Scalar, M: SquareMatrix<S>>(matrix: &mut M, size: usize) {
    for row in 0..size {
        for column in 0..size {
            matrix.set(row, column, half::<S>() * matrix.get(row, column));
        }
    }
}

impl TensorFacts for MidpointTensor {
    const QUADRATIC_CASIMIRS: bool = true;
}

impl<S: Scalar, P: Poisson<S>> PoissonTensor<S, P> for MidpointTensor {
    fn matrix(&self, system: &P, start: &P::State, end: &P::State, _h: S, out: &mut P::Jacobian) {
        system.poisson_matrix(&middle(system, start, end), out);
    }

    fn slope(
        &self,
        system: &P,
        start: &P::State,
        end: &P::State,
        _h: S,
        xi: &P::State,
        out: &mut P::Jacobian,
    ) {
        system.poisson_slope(&middle(system, start, end), xi, out);
        halve(out, system.dimension());
    }
}

impl TensorFacts for MeanTensor {
    const QUADRATIC_CASIMIRS: bool = false;
}

impl<S: Scalar, P: Poisson<S>> PoissonTensor<S, P> for MeanTensor {
    fn matrix(&self, system: &P, start: &P::State, end: &P::State, _h: S, out: &mut P::Jacobian) {
        let mut other = system.zero_jacobian();
        system.poisson_matrix(start, out);
        system.poisson_matrix(end, &mut other);
        for row in 0..system.dimension() {
            for column in 0..system.dimension() {
                let sum = out.get(row, column) + other.get(row, column);
                out.set(row, column, half::<S>() * sum);
            }
        }
    }

    fn slope(
        &self,
        system: &P,
        _start: &P::State,
        end: &P::State,
        _h: S,
        xi: &P::State,
        out: &mut P::Jacobian,
    ) {
        system.poisson_slope(end, xi, out);
        halve(out, system.dimension());
    }
}
