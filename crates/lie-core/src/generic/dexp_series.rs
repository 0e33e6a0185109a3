//! The tangent of exp as a series on the algebra, for Newton's matrices.

use crate::poisson::LiePoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Terms of the series in the Jacobian beyond which no argument of use goes.
const MAX_TERMS: usize = 60;
/// The series in the Jacobian ends where its terms are below that part of the first. An error e of the
/// Jacobian leaves e times the last update, which itself is below the root of round-off: 2^-30
/// costs no iteration.
const TOLERANCE: f64 = 1.0 / 1_073_741_824.0;
/// A series whose terms rise beyond that many times the first has lost too many digits.
const MAX_RISE: f64 = 1_048_576.0;

/// Replaces the first of three states by `dexp_(-x) = sum_k (-ad_x)^k/(k + 1)!` of it; returns the lanes in which the series has
/// kept its digits. It is what the derivative of a coadjoint action is made of: along v, that of `exp(ad*_x) m` in x is `ad*_w` of it with
/// `w = dexp_(-x) v`.
pub(super) fn dexp_of_minus<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    [sum, term, next]: [&mut P::State; 3],
) -> S::Mask {
    let size = sum.max_norm();
    let end = size * S::from_f64(TOLERANCE);
    let mut active = !end.less_equal(S::zero());
    let mut peak = size;
    term.copy_from(sum);
    for index in 1..MAX_TERMS {
        if !active.any() {
            break;
        }
        system.ad(x, term, next);
        let weight = S::ratio(-1.0, (index + 1) as f64);
        let pairs = term.as_mut_slice().iter_mut().zip(next.as_slice());
        for ((term, &next), sum) in pairs.zip(sum.as_mut_slice()) {
            *term = weight * next;
            *sum = S::select(active, *sum + *term, *sum);
        }
        let norm = term.max_norm();
        peak = S::select(active, peak.max(norm), peak);
        active = active & !norm.less_equal(end);
    }
    !active & peak.less_equal(size * S::from_f64(MAX_RISE))
}
