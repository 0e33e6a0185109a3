//! The functions of small angles.

use super::super::{Primitive, Scalar};
use super::{TINY, cosine_parts, sine_rest};

#[inline(always)]
pub fn sin<S: Scalar + Primitive>(x: S) -> S {
    let sine = x + sine_rest(x, x * x);
    S::select(x.abs().less(S::from_f64(TINY)), x, sine)
}

#[inline(always)]
pub fn cos<P: Primitive>(x: P) -> P {
    let [rest, left, r] = cosine_parts(x * x);
    rest + (left + r)
}

#[inline(always)]
pub fn sin_cos<S: Scalar + Primitive>(x: S) -> (S, S) {
    (sin(x), cos(x))
}

/// The tangent by a division only where one is needed.
#[cfg(any(feature = "lanes", test))]
#[inline(always)]
pub fn tan<S: Scalar + Primitive>(x: S) -> S {
    use super::super::Mask;
    let very = super::is_very_small(x);
    let value = super::tan_polynomial(x);
    if very.all() {
        value
    } else {
        S::select(very, value, super::tan_quotient(x))
    }
}
