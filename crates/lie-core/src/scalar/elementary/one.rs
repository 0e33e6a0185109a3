//! Functions of one number, which do what the programs do where it changes something.

use super::super::Primitive;
use super::{LARGE, Reduced, is_small, small};

/// Sine or cosine; of both polynomials the one that is needed.
#[inline(always)]
fn sine_or_cosine(x: f64, is_cosine: bool, beyond: fn(f64) -> f64) -> f64 {
    let size = x.size();
    if size > LARGE || size.is_nan() {
        return beyond(x);
    }
    let reduced = Reduced::new(size);
    let is_odd = reduced.turns.to_bits() & 1 == 1;
    let value = match is_odd == is_cosine {
        true => reduced.sine(),
        false => reduced.cosine(),
    };
    value.xor(match is_cosine {
        true => reduced.sign_of_cosine(),
        false => reduced.sign_of_sine(x),
    })
}

#[inline]
pub(in super::super) fn sin(x: f64) -> f64 {
    match is_small(x) {
        true => small::sin(x),
        false => sine_or_cosine(x, false, libm::sin),
    }
}

#[inline]
pub(in super::super) fn cos(x: f64) -> f64 {
    match is_small(x) {
        true => small::cos(x),
        false => sine_or_cosine(x, true, libm::cos),
    }
}

#[inline]
pub(in super::super) fn sin_cos(x: f64) -> (f64, f64) {
    match is_small(x) {
        true => small::sin_cos(x),
        false => super::sin_cos(x),
    }
}

#[inline(always)]
pub(in super::super) fn tan(x: f64) -> f64 {
    if super::is_very_small(x) {
        super::tan_polynomial(x)
    } else {
        tan_beyond(x)
    }
}

#[cold]
#[inline(never)]
fn tan_beyond(x: f64) -> f64 {
    if super::is_small(x) {
        super::tan_quotient(x)
    } else {
        libm::tan(x)
    }
}
