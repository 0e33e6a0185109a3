//! The same functions with their count as a value: one copy for each scalar in place of one for each scalar and count, for
//! interpreters. The operations and their order are those of the functions over arrays, so that the bits are; the loops, whose
//! lengths are not known beforehand, take 1.4 to 7 times as long over `f64`.

use super::{
    LOWEST, MOST_FUNCTIONS, NEAR, PHI_FAR, PHI_FAR_TERMS, PHI_TERMS, STUMPFF_BESIDE,
    STUMPFF_BESIDE_TERMS, STUMPFF_FAR, STUMPFF_FAR_TERMS, STUMPFF_TERMS, inverse_factorial,
    inverse_factorial_and, paired,
};
use crate::scalar::{Mask, Scalar};

/// As many functions as there are at most; those from the count on mean nothing.
type All<S> = [S; MOST_FUNCTIONS];

/// Sums of the last two Stumpff functions with `x = -w`, then the recurrence `S_k = 1/k! + x S_(k + 2)` down.
#[inline(never)]
fn stumpff_downwards<S: Scalar>(count: usize, terms: usize, x: S) -> All<S> {
    let mut out = [S::zero(); MOST_FUNCTIONS];
    let mut k = count.max(LOWEST + 2) - 1;
    let [mut this, mut before] = [k, k - 1].map(|k| inverse_factorial::<S>(k + 2 * (terms - 1)));
    for n in (0..terms - 1).rev() {
        this = inverse_factorial_and(k + 2 * n, this * x);
        before = inverse_factorial_and(k - 1 + 2 * n, before * x);
    }
    while k > 2 {
        out[k] = this;
        (this, before) = (before, inverse_factorial_and(k - 2, x * this));
        k -= 1;
    }
    let [first, second] = paired(x, [before, this], terms == STUMPFF_FAR_TERMS);
    out[..3].copy_from_slice(&[S::one() + x * second, first, second]);
    out
}

/// The sum of the last function, then the recurrence `phi_k = 1/k! + z phi_(k + 1)` down.
#[inline(never)]
fn phi_downwards<S: Scalar>(count: usize, terms: usize, z: S) -> All<S> {
    let mut out = [S::zero(); MOST_FUNCTIONS];
    let mut k = count.max(LOWEST + 1) - 1;
    let mut this = inverse_factorial::<S>(k + terms - 1);
    for n in (0..terms - 1).rev() {
        this = this * z + inverse_factorial(k + n);
    }
    loop {
        out[k] = this;
        if k == 0 {
            return out;
        }
        k -= 1;
        this = inverse_factorial::<S>(k) + z * this;
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

/// Replaces the values below the count in the lanes of a mask.
#[inline(never)]
fn replace<S: Scalar>(count: usize, mask: S::Mask, values: &mut All<S>, by: &All<S>) {
    for (value, &by) in values[..count].iter_mut().zip(by) {
        *value = S::select(mask, by, *value);
    }
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
        let sums = stumpff_downwards(count, *terms, -w);
        replace(count, within(*bound), &mut values, &sums);
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
    let sums = phi_downwards(count, PHI_TERMS, z);
    if near.all() {
        return sums;
    }
    let summed = z.abs().less_equal(S::from_f64(PHI_FAR));
    let mut values = phi_downwards(count, PHI_FAR_TERMS, z);
    if !summed.all() {
        let further = core::mem::replace(&mut values, upwards(count, z, &[z.exp()]));
        replace(count, summed, &mut values, &further);
    }
    replace(count, near, &mut values, &sums);
    values
}
