//! What the programs of elementary functions are made of.

use super::Scalar;
use crate::functions::Elementary;
use core::ops::{Add, Div, Mul, Sub};

/// Numbers of double precision, or what writes down what is done with them: arithmetic, and the bits of IEEE 754.
///
/// The programs of [`Elementary::program`] are written once over this, so that one number, lanes and the back ends that expand a
/// program into their own instructions do the same operations in the same order. Nothing is contracted to a fused multiply-add.
pub trait Primitive:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A constant.
    fn number(value: f64) -> Self;
    /// The number of these bits.
    fn from_word(word: u64) -> Self;
    /// The bits that both numbers have.
    #[must_use]
    fn and(self, other: Self) -> Self;
    /// The bits that one of the numbers has.
    #[must_use]
    fn or(self, other: Self) -> Self;
    /// The bits in which the numbers differ.
    #[must_use]
    fn xor(self, other: Self) -> Self;
    /// The sum of both words of bits, as integers modulo 2^64.
    #[must_use]
    fn plus(self, other: Self) -> Self;
    /// The bits so many places to the left.
    #[must_use]
    fn left(self, places: u8) -> Self;
    /// The bits so many places to the right; zeros come from the left.
    #[must_use]
    fn right(self, places: u8) -> Self;
    /// `then` where `test` is below 0, `otherwise` elsewhere. Both are there, and nothing jumps.
    fn blend(test: Self, then: Self, otherwise: Self) -> Self;
    /// `usual` where `test` is 0 or above; elsewhere, where `test` is below or not a number, the function of x by `libm`.
    fn rare(function: Elementary, x: Self, test: Self, usual: Self) -> Self;

    /// The absolute value.
    #[must_use]
    #[inline(always)]
    fn size(self) -> Self {
        self.and(Self::from_word(!SIGN))
    }
    /// The sign, with which [`Primitive::xor`] changes that of another number.
    #[must_use]
    #[inline(always)]
    fn sign(self) -> Self {
        self.and(Self::from_word(SIGN))
    }
}

const SIGN: u64 = 1 << 63;

macro_rules! of_words {
    ($($name:ident $operation:expr;)+) => {
        $(#[inline(always)]
        fn $name(self, other: Self) -> Self {
            let operation: fn(u64, u64) -> u64 = $operation;
            Self::from_bits(operation(self.to_bits(), other.to_bits()))
        })+
    };
}

impl Primitive for f64 {
    #[inline(always)]
    fn number(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn from_word(word: u64) -> Self {
        Self::from_bits(word)
    }
    of_words! {
        and |a, b| a & b;
        or |a, b| a | b;
        xor |a, b| a ^ b;
        plus u64::wrapping_add;
    }
    #[inline(always)]
    fn left(self, places: u8) -> Self {
        Self::from_bits(self.to_bits() << places)
    }
    #[inline(always)]
    fn right(self, places: u8) -> Self {
        Self::from_bits(self.to_bits() >> places)
    }
    #[inline(always)]
    fn blend(test: Self, then: Self, otherwise: Self) -> Self {
        <f64 as Scalar>::select(test < 0.0, then, otherwise)
    }
    #[inline(always)]
    fn rare(function: Elementary, x: Self, test: Self, usual: Self) -> Self {
        if test >= 0.0 {
            usual
        } else {
            beyond(function, x)
        }
    }
}

/// What few arguments ask for.
#[cold]
#[inline(never)]
pub(super) fn beyond(function: Elementary, x: f64) -> f64 {
    function.evaluate(x)
}
