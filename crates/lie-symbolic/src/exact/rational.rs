//! Rational numbers with a machine-word fast path.
//!
//! Nearly every constant of a Lie–Poisson system fits two machine words; arithmetic on them is
//! checked and falls over to big integers only when a word overflows.

mod rounding;

use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::ops::{Add, Div, Mul, Neg, Sub};

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

use rounding::nearest;

/// An exact rational number, always in lowest terms with a positive denominator.
///
/// A value that fits is always stored in words, so equal numbers have one representation.
#[derive(Clone)]
pub struct Rational(Repr);

#[derive(Clone)]
enum Repr {
    Word(i64, i64),
    Big(Box<BigRational>),
}

impl Rational {
    /// Zero.
    pub const ZERO: Self = Self(Repr::Word(0, 1));
    /// One.
    pub const ONE: Self = Self(Repr::Word(1, 1));
    /// Minus one.
    pub const MINUS_ONE: Self = Self(Repr::Word(-1, 1));

    /// `numerator / denominator`, reduced; `None` where the denominator is zero.
    pub fn new(numerator: i64, denominator: i64) -> Option<Self> {
        (denominator != 0).then(|| Self::from_wide(numerator.into(), denominator.into()))
    }

    /// `numerator / denominator` of big integers, reduced; `None` where the denominator is zero.
    pub fn from_big(numerator: BigInt, denominator: BigInt) -> Option<Self> {
        (!denominator.is_zero()).then(|| Self::shrink(BigRational::new(numerator, denominator)))
    }

    /// The exact value of a finite float; `None` for infinities and NaN.
    pub fn from_f64(value: f64) -> Option<Self> {
        BigRational::from_float(value).map(Self::shrink)
    }

    /// The nearest `f64` (ties to even), infinite beyond the range.
    pub fn to_f64(&self) -> f64 {
        match &self.0 {
            Repr::Word(n, d) if n.unsigned_abs() <= 1 << 53 && *d <= 1 << 53 => {
                *n as f64 / *d as f64
            }
            _ => nearest(&self.to_big()),
        }
    }

    /// As a ratio of big integers.
    pub fn to_big(&self) -> BigRational {
        match &self.0 {
            Repr::Word(n, d) => BigRational::new_raw((*n).into(), (*d).into()),
            Repr::Big(value) => (**value).clone(),
        }
    }

    /// Numerator and denominator where both fit a word.
    pub fn to_words(&self) -> Option<(i64, i64)> {
        match &self.0 {
            Repr::Word(n, d) => Some((*n, *d)),
            Repr::Big(_) => None,
        }
    }

    /// The value as an integer that fits a word.
    pub fn to_integer(&self) -> Option<i64> {
        match self.0 {
            Repr::Word(n, 1) => Some(n),
            _ => None,
        }
    }

    /// Whether the value is an integer.
    pub fn is_integer(&self) -> bool {
        match &self.0 {
            Repr::Word(_, d) => *d == 1,
            Repr::Big(value) => value.is_integer(),
        }
    }

    /// Whether the value is zero.
    pub fn is_zero(&self) -> bool {
        matches!(self.0, Repr::Word(0, _))
    }

    /// Whether the value is one.
    pub fn is_one(&self) -> bool {
        matches!(self.0, Repr::Word(1, 1))
    }

    /// Whether the value is below zero.
    pub fn is_negative(&self) -> bool {
        match &self.0 {
            Repr::Word(n, _) => *n < 0,
            Repr::Big(value) => value.is_negative(),
        }
    }

    /// The absolute value.
    pub fn abs(&self) -> Self {
        if self.is_negative() {
            -self
        } else {
            self.clone()
        }
    }

    /// `1 / self`; `None` for zero.
    pub fn recip(&self) -> Option<Self> {
        (!self.is_zero()).then(|| &Self::ONE / self)
    }

    /// `self^exponent`; `None` for a negative power of zero.
    pub fn pow(&self, exponent: i32) -> Option<Self> {
        if exponent < 0 && self.is_zero() {
            return None;
        }
        Some(Self::shrink(self.to_big().pow(exponent)))
    }

    /// The square root where it is rational.
    pub fn square_root(&self) -> Option<Self> {
        if self.is_negative() {
            return None;
        }
        let value = self.to_big();
        let root = |n: &BigInt| {
            let root = n.sqrt();
            (&root * &root == *n).then_some(root)
        };
        Self::from_big(root(value.numer())?, root(value.denom())?)
    }

    /// Size in bits of numerator and denominator together, the measure for size limits.
    pub fn bits(&self) -> u64 {
        match &self.0 {
            Repr::Word(n, d) => {
                u64::from(128 - n.unsigned_abs().leading_zeros() - d.leading_zeros())
            }
            Repr::Big(value) => value.numer().bits() + value.denom().bits(),
        }
    }

    fn from_wide(numerator: i128, denominator: i128) -> Self {
        let divisor = numerator.gcd(&denominator);
        let (mut n, mut d) = (numerator / divisor, denominator / divisor);
        if d < 0 {
            (n, d) = (-n, -d);
        }
        match (i64::try_from(n), i64::try_from(d)) {
            (Ok(n), Ok(d)) => Self(Repr::Word(n, d)),
            _ => Self(Repr::Big(Box::new(BigRational::new_raw(
                n.into(),
                d.into(),
            )))),
        }
    }

    fn shrink(value: BigRational) -> Self {
        match (value.numer().to_i64(), value.denom().to_i64()) {
            (Some(n), Some(d)) => Self(Repr::Word(n, d)),
            _ => Self(Repr::Big(Box::new(value))),
        }
    }
}

impl From<i64> for Rational {
    fn from(value: i64) -> Self {
        Self(Repr::Word(value, 1))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, |$a:ident, $b:ident, $c:ident, $d:ident| $n:expr, $m:expr) => {
        impl $trait for &Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                if let (Repr::Word(a, b), Repr::Word(c, d)) = (&self.0, &other.0) {
                    let ($a, $b, $c, $d) = (
                        i128::from(*a),
                        i128::from(*b),
                        i128::from(*c),
                        i128::from(*d),
                    );
                    // Products of two words fit i128; a sum of two such products may not.
                    if let (Some(n), Some(m)) = ($n, $m) {
                        return Rational::from_wide(n, m);
                    }
                }
                Rational::shrink(self.to_big().$method(other.to_big()))
            }
        }
        impl $trait for Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                (&self).$method(&other)
            }
        }
    };
}
operator!(
    Add,
    add,
    |a, b, c, d| (a * d).checked_add(c * b),
    Some(b * d)
);
operator!(
    Sub,
    sub,
    |a, b, c, d| (a * d).checked_sub(c * b),
    Some(b * d)
);
operator!(Mul, mul, |a, b, c, d| Some(a * c), Some(b * d));

impl Div for &Rational {
    type Output = Rational;
    /// # Panics
    /// On division by zero; callers divide only by what they have tested.
    fn div(self, other: &Rational) -> Rational {
        assert!(!other.is_zero(), "division by an exact zero");
        if let (Repr::Word(a, b), Repr::Word(c, d)) = (&self.0, &other.0) {
            return Rational::from_wide(
                i128::from(*a) * i128::from(*d),
                i128::from(*b) * i128::from(*c),
            );
        }
        Rational::shrink(self.to_big() / other.to_big())
    }
}
impl Div for Rational {
    type Output = Rational;
    fn div(self, other: Rational) -> Rational {
        &self / &other
    }
}
impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        &Rational::ZERO - self
    }
}
impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        -&self
    }
}

impl PartialEq for Rational {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Repr::Word(a, b), Repr::Word(c, d)) => (a, b) == (c, d),
            (Repr::Big(a), Repr::Big(b)) => a == b,
            _ => false,
        }
    }
}
impl Eq for Rational {}
impl Hash for Rational {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match &self.0 {
            Repr::Word(n, d) => (n, d).hash(state),
            Repr::Big(value) => value.hash(state),
        }
    }
}
impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        match (&self.0, &other.0) {
            (Repr::Word(a, b), Repr::Word(c, d)) => {
                (i128::from(*a) * i128::from(*d)).cmp(&(i128::from(*c) * i128::from(*b)))
            }
            _ => self.to_big().cmp(&other.to_big()),
        }
    }
}
impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_big();
        if value.denom().is_one() {
            write!(f, "{}", value.numer())
        } else {
            write!(f, "{}/{}", value.numer(), value.denom())
        }
    }
}
impl fmt::Debug for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_big_integers_agree() {
        let big = Rational::from(i64::MAX);
        let sum = &(&big * &big) + &Rational::ONE;
        assert_eq!(sum.to_words(), None);
        assert_eq!(&(&sum - &Rational::ONE) / &big, big);
        assert_eq!(Rational::new(6, -4).unwrap().to_string(), "-3/2");
        assert_eq!(
            Rational::new(i64::MIN, -1).unwrap().to_string(),
            "9223372036854775808"
        );
    }
}
