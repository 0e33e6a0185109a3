//! The entire functions of which closed forms of the exponential are made, with all digits for every argument.
//!
//! Where the minimal polynomial of `ad_x` is `z^a (z^2 + w)^b`, with w a quadratic form in x, functions of `ad_x` are
//! polynomials in it whose coefficients are Stumpff functions of w, for any sign of w:
//!
//! ```math
//! S_k(w) = \sum_n \frac{(-w)^n}{(2n + k)!}, \qquad S_k = \frac1{k!} - w\, S_{k+2}, \qquad
//! S_k' = \tfrac12 (k\, S_{k+2} - S_{k+1})
//! ```
//!
//! `$S_0 = \cos\sqrt w$`, `$S_1 = \sin\sqrt w/\sqrt w$`, `$S_2 = (1 - \cos\sqrt w)/w$`, and with hyperbolic functions of
//! `$\sqrt{-w}$` where w is negative. Where it is `z^a (z - l)^b`, they are
//!
//! ```math
//! \varphi_k(z) = \sum_n \frac{z^n}{(n + k)!}, \qquad \varphi_k = \frac1{k!} + z\, \varphi_{k+1}, \qquad
//! \varphi_k' = \varphi_k - k\, \varphi_{k+1}
//! ```
//!
//! Both recurrences lose digits upwards beside 0, where the functions themselves have removable singularities, and none
//! downwards: the last functions asked for are summed there, and beyond, the first ones are elementary.
//!
//! Rotations keep lengths as far as `$S_1^2 + w\, S_2^2 = 2\, S_2$`, and what moves with them as far as the derivative of this in w
//! holds. Rounding may miss both by chance, but not on average, which would add up over steps: of the two functions one
//! is computed from the other, and the factorials that are not exact are in two words.
//!
//! Reference: E. L. Stiefel, G. Scheifele, "Linear and Regular Celestial Mechanics", Springer 1971, section 11,
//! [doi:10.1007/978-3-642-65027-7](https://doi.org/10.1007/978-3-642-65027-7).
#![cfg_attr(doc, doc = include_str!("../docs/katex.html"))]

pub mod counted;

use crate::scalar::{Mask, Scalar};

/// The largest `FIRST + COUNT` of the functions here.
pub const MOST_FUNCTIONS: usize = 14;
/// Sums begin no lower: the recurrence is cheaper than more terms.
const LOWEST: usize = 4;
/// Within this distance of 0 few terms are enough, and no function is called.
const NEAR: f64 = 1.0;
/// Terms of Stumpff functions from `S_4` on for `|w| <= 1`: the first that is left out is below an eighth of a unit in the
/// last place of the sum, and of its first two derivatives.
const STUMPFF_TERMS: usize = 10;
/// Steps turn by small angles: the same for `|w|` up to this.
const STUMPFF_BESIDE: f64 = 1.0 / 16.0;
const STUMPFF_BESIDE_TERMS: usize = 6;
/// Up to here they are summed; beyond, the upward recurrence loses no more than two bits.
const STUMPFF_FAR: f64 = 16.0;
const STUMPFF_FAR_TERMS: usize = 17;
/// Between this and there the cosine is negative and far from 0.
const STUMPFF_TURNED: f64 = 4.0;
/// The same of `phi_k`.
const PHI_TERMS: usize = 19;
const PHI_FAR: f64 = 4.0;
const PHI_FAR_TERMS: usize = 32;

/// `1/n!`
const INVERSE_FACTORIALS: [f64; 52] = {
    let mut values = [1.0; 52];
    let mut factorial = 1.0;
    let mut n = 1;
    while n < values.len() {
        factorial *= n as f64;
        values[n] = 1.0 / factorial;
        n += 1;
    }
    values
};

/// What rounding took from `1/3!`, `1/4!` and `1/5!`.
const LOWER_WORDS: [f64; 3] = [
    9.25185853854297e-18,
    2.3129646346357427e-18,
    1.1564823173178714e-19,
];

#[inline(always)]
fn inverse_factorial<S: Scalar>(n: usize) -> S {
    S::from_f64(INVERSE_FACTORIALS[n])
}

/// `1/n! + rest`; the lower word counts, as the rest is smaller.
#[inline(always)]
fn inverse_factorial_and<S: Scalar>(n: usize, rest: S) -> S {
    let high = inverse_factorial::<S>(n);
    match n {
        3..=5 => {
            let low = INVERSE_FACTORIALS[n] - high.to_f64() + LOWER_WORDS[n - 3];
            high + (rest + S::from_f64(low))
        }
        _ => high + rest,
    }
}

/// `S_1` and `S_2`, one of them from the other so that `S_1^2 + w S_2^2 = 2 S_2`, with `x = -w`.
#[inline(always)]
fn paired<S: Scalar>(x: S, [first, second]: [S; 2], far: bool) -> [S; 2] {
    let (one, two) = (S::one(), S::from_f64(2.0));
    let near = [(second * (two + x * second)).sqrt(), second];
    if !far {
        return near;
    }
    let turned = x.less(S::from_f64(-STUMPFF_TURNED));
    let far = [first, (one + (one + x * first * first).sqrt()) / -x];
    select(turned, far, near)
}

/// Stumpff functions with `x = -w` from the sums of the last two down: `S_k = 1/k! + x S_(k + 2)`.
#[inline(always)]
fn stumpff_downwards<S: Scalar, const FIRST: usize, const COUNT: usize, const TERMS: usize>(
    x: S,
) -> [S; COUNT] {
    const { assert!(FIRST + COUNT <= MOST_FUNCTIONS) };
    let mut out = [S::zero(); COUNT];
    let mut k = if FIRST + COUNT > LOWEST + 2 {
        FIRST + COUNT - 1
    } else {
        LOWEST + 1
    };
    // S_k and S_(k - 1)
    let mut this = inverse_factorial::<S>(k + 2 * (TERMS - 1));
    let mut before = inverse_factorial::<S>(k - 1 + 2 * (TERMS - 1));
    let mut n = TERMS - 1;
    while n > 0 {
        n -= 1;
        this = inverse_factorial_and(k + 2 * n, this * x);
        before = inverse_factorial_and(k - 1 + 2 * n, before * x);
    }
    while k > 2 {
        if k >= FIRST && k < FIRST + COUNT {
            out[k - FIRST] = this;
        }
        (this, before) = (before, inverse_factorial_and(k - 2, x * this));
        k -= 1;
    }
    let [first, second] = paired(x, [before, this], TERMS == STUMPFF_FAR_TERMS);
    let lowest = [S::one() + x * second, first, second];
    for (k, value) in lowest.into_iter().enumerate().skip(FIRST) {
        if k < FIRST + COUNT {
            out[k - FIRST] = value;
        }
    }
    out
}

/// The functions `phi_k` from the sum of the last one down: `phi_k = 1/k! + z phi_(k + 1)`.
#[inline(always)]
fn phi_downwards<S: Scalar, const FIRST: usize, const COUNT: usize, const TERMS: usize>(
    z: S,
) -> [S; COUNT] {
    const { assert!(FIRST + COUNT <= MOST_FUNCTIONS) };
    let mut out = [S::zero(); COUNT];
    let mut k = if FIRST + COUNT > LOWEST + 1 {
        FIRST + COUNT - 1
    } else {
        LOWEST
    };
    let mut this = inverse_factorial::<S>(k + TERMS - 1);
    let mut n = TERMS - 1;
    while n > 0 {
        n -= 1;
        this = this * z + inverse_factorial(k + n);
    }
    loop {
        if k < FIRST + COUNT {
            out[k - FIRST] = this;
        }
        if k == FIRST {
            return out;
        }
        k -= 1;
        this = inverse_factorial::<S>(k) + z * this;
    }
}

/// Fills functions from the first ones up: `f_(k + stride) = (f_k - 1/k!)/x`.
#[inline(always)]
fn upwards<S: Scalar, const FIRST: usize, const COUNT: usize>(x: S, first: &[S]) -> [S; COUNT] {
    let mut all = [S::zero(); MOST_FUNCTIONS];
    let stride = first.len();
    all[..stride].copy_from_slice(first);
    for k in 0..FIRST + COUNT - stride.min(FIRST + COUNT) {
        all[k + stride] = (all[k] - inverse_factorial(k)) / x;
    }
    core::array::from_fn(|index| all[FIRST + index])
}

#[inline(always)]
fn select<S: Scalar, const COUNT: usize>(
    mask: S::Mask,
    yes: [S; COUNT],
    no: [S; COUNT],
) -> [S; COUNT] {
    core::array::from_fn(|k| S::select(mask, yes[k], no[k]))
}

/// The Stumpff functions `S_k(w)`, k from `FIRST` on.
///
/// ```
/// use lie_core::closed::stumpff;
/// let [sine, versine] = stumpff::<f64, 1, 2>(0.25);
/// assert!((sine - 0.5_f64.sin() / 0.5).abs() < 1e-15);
/// assert!((versine - (1.0 - 0.5_f64.cos()) / 0.25).abs() < 1e-15);
/// ```
#[inline]
pub fn stumpff<S: Scalar, const FIRST: usize, const COUNT: usize>(w: S) -> [S; COUNT] {
    let beside = w.abs().less_equal(S::from_f64(STUMPFF_BESIDE));
    let values = stumpff_downwards::<S, FIRST, COUNT, STUMPFF_BESIDE_TERMS>(-w);
    if beside.all() {
        return values;
    }
    select(beside, values, near_stumpff::<S, FIRST, COUNT>(w))
}

#[inline(never)]
fn near_stumpff<S: Scalar, const FIRST: usize, const COUNT: usize>(w: S) -> [S; COUNT] {
    let near = w.abs().less_equal(S::from_f64(NEAR));
    let values = stumpff_downwards::<S, FIRST, COUNT, STUMPFF_TERMS>(-w);
    if near.all() {
        return values;
    }
    select(near, values, far_stumpff::<S, FIRST, COUNT>(w))
}

#[cold]
#[inline(never)]
fn far_stumpff<S: Scalar, const FIRST: usize, const COUNT: usize>(w: S) -> [S; COUNT] {
    let summed = w.abs().less_equal(S::from_f64(STUMPFF_FAR));
    let values = stumpff_downwards::<S, FIRST, COUNT, STUMPFF_FAR_TERMS>(-w);
    if summed.all() {
        return values;
    }
    let negative = w.less(S::zero());
    let angle = S::select(negative, -w, w).sqrt();
    let mut first = [angle.cos(), angle.sin() / angle];
    if negative.any() {
        first = select(negative, [angle.cosh(), angle.sinh() / angle], first);
    }
    select(summed, values, upwards::<S, FIRST, COUNT>(-w, &first))
}

/// The functions `phi_k(z)`, k from `FIRST` on: `phi_0 = e^z`, `phi_1 = (e^z - 1)/z`.
///
/// ```
/// use lie_core::closed::phi;
/// let [first] = phi::<f64, 1, 1>(1e-9);
/// assert!((first - (1.0 + 0.5e-9)).abs() < 1e-15);
/// ```
#[inline]
pub fn phi<S: Scalar, const FIRST: usize, const COUNT: usize>(z: S) -> [S; COUNT] {
    let near = z.abs().less_equal(S::from_f64(NEAR));
    let values = phi_downwards::<S, FIRST, COUNT, PHI_TERMS>(z);
    if near.all() {
        return values;
    }
    select(near, values, far_phi::<S, FIRST, COUNT>(z))
}

#[cold]
#[inline(never)]
fn far_phi<S: Scalar, const FIRST: usize, const COUNT: usize>(z: S) -> [S; COUNT] {
    let summed = z.abs().less_equal(S::from_f64(PHI_FAR));
    let values = phi_downwards::<S, FIRST, COUNT, PHI_FAR_TERMS>(z);
    if summed.all() {
        return values;
    }
    select(summed, values, upwards::<S, FIRST, COUNT>(z, &[z.exp()]))
}

/// One Stumpff function in double precision; `k` must be below [`MOST_FUNCTIONS`].
pub fn stumpff_of(k: usize, w: f64) -> f64 {
    stumpff::<f64, 0, MOST_FUNCTIONS>(w)[k]
}

/// One function `phi_k` in double precision; `k` must be below [`MOST_FUNCTIONS`].
pub fn phi_of(k: usize, z: f64) -> f64 {
    phi::<f64, 0, MOST_FUNCTIONS>(z)[k]
}

#[cfg(test)]
mod tests;
