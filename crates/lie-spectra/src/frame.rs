//! The vectors with which exponents begin.

use lie_runtime::{Dual, Poisson, SquareMatrix as _};
use nalgebra::{DMatrix, DVector};

use crate::random::Random;

/// Singular values below this part of the largest are zero.
const ZERO: f64 = 1e-10;
/// A vector of which less is left beside the others is taken anew.
const DEPENDENT: f64 = 1e-6;

/// Orthonormal vectors, and half the rank of the Poisson tensor.
pub(crate) struct Frame {
    pub(crate) vectors: DMatrix<f64>,
    pub(crate) pairs: usize,
}

/// Random vectors whose flag suits the Poisson tensor `Pi` at a state: r vectors along the leaf, those off the leaf, and `Pi v` for the
/// first r in the opposite order. Where `Pi` is constant and orthogonal on its range, as the canonical one, the product of the
/// diagonal entries i and n + 1 - i of R is 1 for every Poisson map (the decomposition of Iwasawa), so that sums of pairs vanish to
/// round-off, and not only in the limit.
pub(crate) fn frame<P: Poisson<Dual<f64>>>(
    system: &P,
    mu: &P::State,
    shown: &[usize],
    seed: u64,
) -> Frame {
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut matrix);
    let n = shown.len();
    let pi = DMatrix::from_fn(n, n, |i, j| matrix.get(shown[i], shown[j]).value);
    let singular = pi.singular_values();
    let zero = ZERO * singular.max();
    let pairs = singular.iter().filter(|value| **value > zero).count() / 2;
    let mut random = Random::new(seed);
    let mut any = || DVector::from_fn(n, |_, _| random.unit());
    let mut chosen: Vec<DVector<f64>> = Vec::with_capacity(n);
    for _ in 0..pairs {
        let along = fresh(&chosen, || &pi * any());
        chosen.push(along.clone());
        let mut partner = Some(&pi * along);
        chosen.push(fresh(&chosen, || partner.take().unwrap_or_else(&mut any)));
    }
    for _ in 2 * pairs..n {
        chosen.push(fresh(&chosen, &mut any));
    }
    let firsts = (0..pairs).map(|pair| 2 * pair);
    let partners = (0..pairs).rev().map(|pair| 2 * pair + 1);
    let order: Vec<DVector<f64>> = firsts
        .chain(2 * pairs..n)
        .chain(partners)
        .map(|place| chosen[place].clone())
        .collect();
    Frame {
        vectors: DMatrix::from_columns(&order),
        pairs,
    }
}

/// The part of a candidate that is orthogonal to the others, of length 1; the first of which enough is left.
fn fresh(others: &[DVector<f64>], mut candidate: impl FnMut() -> DVector<f64>) -> DVector<f64> {
    loop {
        let given = candidate();
        let mut vector = given.clone();
        // twice, which is orthogonal to round-off
        for other in others.iter().chain(others) {
            let along = other.dot(&vector);
            vector.axpy(-along, other, 1.0);
        }
        let left = vector.norm();
        if left > DEPENDENT * given.norm() {
            return vector / left;
        }
    }
}
