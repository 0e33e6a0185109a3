//! The same functions with their count as a value: one copy for each scalar in place of one for each scalar and count, for
//! interpreters. The operations and their order are those of the functions over arrays, so that the bits are; the loops, whose
//! lengths are not known beforehand, take 1.4 to 7 times as long over `f64`.

use super::{
    LOWEST, MOST_FUNCTIONS, NEAR, PHI_FAR, PHI_FAR_TERMS, PHI_TERMS, STUMPFF_BESIDE,
    STUMPFF_BESIDE_TERMS, STUMPFF_FAR, STUMPFF_FAR_TERMS, STUMPFF_TERMS, inverse_factorial,
};
use crate::scalar::{Mask, Scalar};

/// As many functions as there are at most; those from the count on mean nothing.
type All<S> = [S; MOST_FUNCTIONS];

/// Sums of the last functions, as many as the stride, then the recurrence `f_k = 1/k! + x f_(k + stride)` down.
#[inline(never)]
fn downwards<S: Scalar>(stride: usize, count: usize, terms: usize, x: S) -> All<S> {
    let mut out = [S::zero(); MOST_FUNCTIONS];
    let mut k = if count > LOWEST + stride {
        count - 1
    } else {
        LOWEST + stride - 1
    };
    // f_k and, for a stride of two, f_(k - 1)
    let mut this = inverse_factorial::<S>(k + stride * (terms - 1));
    let mut before = inverse_factorial::<S>(k - 1 + stride * (terms - 1));
    for n in (0..terms - 1).rev() {
        this = this * x + inverse_factorial(k + stride * n);
        if stride == 2 {
            before = before * x + inverse_factorial(k - 1 + stride * n);
        }
    }
    loop {
        if k < count {
            out[k] = this;
        }
        if k == 0 {
            return out;
        }
        this = match stride {
            1 => inverse_factorial::<S>(k - 1) + x * this,
            _ => {
                let below = before;
                if k >= 2 {
                    before = inverse_factorial::<S>(k - 2) + x * this;
                }
                below
            }
        };
        k -= 1;
    }
}

/// From the first functions up: `f_(k + stride) = (f_k - 1/k!)/x`.
fn upwards<S: Scalar>(count: usize, x: S, first: &[S]) -> All<S> {
    let mut all = [S::zero(); MOST_FUNCTIONS];
    let stride = first.len();
    all[..stride].copy_from_slice(first);
    for k in 0..count.saturating_sub(stride) {
        all[k + stride] = (all[k] - inverse_factorial(k)) / x;
    }
    all
}

fn select<S: Scalar>(mask: S::Mask, yes: All<S>, no: All<S>) -> All<S> {
    core::array::from_fn(|k| S::select(mask, yes[k], no[k]))
}

/// The Stumpff functions `S_k(w)`, k below the count, which is at most [`MOST_FUNCTIONS`].
#[inline(never)]
pub fn stumpff<S: Scalar>(count: usize, w: S) -> All<S> {
    let ranges = [
        (STUMPFF_BESIDE, STUMPFF_BESIDE_TERMS),
        (NEAR, STUMPFF_TERMS),
        (STUMPFF_FAR, STUMPFF_FAR_TERMS),
    ];
    let within = |bound| w.abs().less_equal(S::from_f64(bound));
    // the ranges that are needed, and what is left beyond them
    let last = ranges.iter().position(|(bound, _)| within(*bound).all());
    let mut values = match last {
        Some(_) => [S::zero(); MOST_FUNCTIONS],
        None => beyond(count, w),
    };
    for (bound, terms) in ranges[..=last.unwrap_or(2)].iter().rev() {
        values = select(within(*bound), downwards(2, count, *terms, -w), values);
    }
    values
}

/// Stumpff functions by elementary ones.
fn beyond<S: Scalar>(count: usize, w: S) -> All<S> {
    let negative = w.less(S::zero());
    let angle = S::select(negative, -w, w).sqrt();
    let mut first = [angle.cos(), angle.sin() / angle];
    if negative.any() {
        first = [
            S::select(negative, angle.cosh(), first[0]),
            S::select(negative, angle.sinh() / angle, first[1]),
        ];
    }
    upwards(count, -w, &first)
}

/// The functions `phi_k(z)`, k below the count, which is at most [`MOST_FUNCTIONS`].
#[inline(never)]
pub fn phi<S: Scalar>(count: usize, z: S) -> All<S> {
    let near = z.abs().less_equal(S::from_f64(NEAR));
    let values = downwards(1, count, PHI_TERMS, z);
    if near.all() {
        return values;
    }
    let summed = z.abs().less_equal(S::from_f64(PHI_FAR));
    let mut further = downwards(1, count, PHI_FAR_TERMS, z);
    if !summed.all() {
        further = select(summed, further, upwards(count, z, &[z.exp()]));
    }
    select(near, values, further)
}
