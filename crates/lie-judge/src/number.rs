//! Numbers that an interpretation computes with: values with a bound of their round-off, and derivatives of those.

use crate::functions::slope;
use lie_core::Elementary;
use lie_symbolic::exact::Rational;

/// What an expression can be evaluated over.
pub trait Number: Clone {
    /// A constant of double precision, known to so many units of round-off of itself.
    fn rounded(value: f64, units: f64) -> Self;
    /// The value without derivatives.
    fn value(&self) -> f64;
    /// `a + b`
    fn add(&self, other: &Self) -> Self;
    /// `a b`
    fn mul(&self, other: &Self) -> Self;
    /// `a/b`
    fn div(&self, other: &Self) -> Self;
    /// An elementary function of one argument.
    fn call(&self, function: Elementary) -> Self;
    /// `atan2(a, b)`
    fn atan2(&self, other: &Self) -> Self;
    /// `a^p` for a constant p.
    fn power(&self, exponent: f64) -> Self;

    /// An integer.
    fn integer(value: i32) -> Self {
        Self::rounded(f64::from(value), 0.0)
    }
    /// An exact constant.
    fn constant(value: &Rational) -> Self {
        let exact = value.is_integer() && value.to_f64().abs() < 2_f64.powi(53);
        Self::rounded(value.to_f64(), if exact { 0.0 } else { 1.0 })
    }
    /// `-a`
    fn neg(&self) -> Self {
        self.mul(&Self::integer(-1))
    }
    /// `a - b`
    fn sub(&self, other: &Self) -> Self {
        self.add(&other.neg())
    }
    /// Its sum over an iterator.
    fn sum(terms: impl IntoIterator<Item = Self>) -> Self {
        terms
            .into_iter()
            .fold(Self::integer(0), |sum, term| sum.add(&term))
    }
}

/// A value, and what round-off can have made of it: a bound to first order, in units of epsilon.
///
/// Inputs that are known to one unit carry the condition of a formula along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded {
    /// The value.
    pub value: f64,
    /// The bound.
    pub error: f64,
}

impl Rounded {
    /// A number that is known to one unit in its last place.
    pub fn input(value: f64) -> Self {
        Self::rounded(value, 1.0)
    }

    /// The result of an operation, itself rounded.
    fn of(value: f64, inherited: f64) -> Self {
        Self {
            value,
            error: inherited + value.abs(),
        }
    }
}

impl Number for Rounded {
    fn rounded(value: f64, units: f64) -> Self {
        Self {
            value,
            error: units * value.abs(),
        }
    }
    fn value(&self) -> f64 {
        self.value
    }
    fn add(&self, other: &Self) -> Self {
        Self::of(self.value + other.value, self.error + other.error)
    }
    fn mul(&self, other: &Self) -> Self {
        let inherited = self.value.abs() * other.error + other.value.abs() * self.error;
        Self::of(self.value * other.value, inherited)
    }
    fn div(&self, other: &Self) -> Self {
        let value = self.value / other.value;
        let inherited = (self.error + value.abs() * other.error) / other.value.abs();
        Self::of(value, inherited)
    }
    fn neg(&self) -> Self {
        Self {
            value: -self.value,
            ..*self
        }
    }
    fn call(&self, function: Elementary) -> Self {
        let value = function.evaluate(self.value);
        let slope = slope(function, &self.value, &value);
        Self::of(value, slope.abs() * self.error + value.abs())
    }
    fn atan2(&self, other: &Self) -> Self {
        let (y, x) = (self.value, other.value);
        let inherited = (x.abs() * self.error + y.abs() * other.error) / (x * x + y * y);
        Self::of(y.atan2(x), inherited)
    }
    fn power(&self, exponent: f64) -> Self {
        let value = self.value.power(exponent);
        let slope = exponent * value / self.value;
        let inherited = if self.error == 0.0 {
            0.0
        } else {
            slope.abs() * self.error
        };
        Self::of(value, inherited + value.abs())
    }
}

/// A number with its derivative along one direction: `v + d e`, `e^2 = 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Jet<T> {
    /// The number.
    pub at: T,
    /// The derivative.
    pub slope: T,
}

impl<T: Number> Jet<T> {
    /// A variable: its derivative is 1, or 0 where another one is varied.
    pub fn variable(at: T, varied: bool) -> Self {
        Self {
            at,
            slope: T::integer(i32::from(varied)),
        }
    }

    /// `f(a)` from f and f' there.
    fn chain(&self, at: T, slope: &T) -> Self {
        Self {
            at,
            slope: slope.mul(&self.slope),
        }
    }
}

impl<T: Number> Number for Jet<T> {
    fn rounded(value: f64, units: f64) -> Self {
        Self {
            at: T::rounded(value, units),
            slope: T::integer(0),
        }
    }
    fn value(&self) -> f64 {
        self.at.value()
    }
    fn add(&self, other: &Self) -> Self {
        Self {
            at: self.at.add(&other.at),
            slope: self.slope.add(&other.slope),
        }
    }
    fn mul(&self, other: &Self) -> Self {
        let first = self.slope.mul(&other.at);
        Self {
            at: self.at.mul(&other.at),
            slope: first.add(&self.at.mul(&other.slope)),
        }
    }
    fn div(&self, other: &Self) -> Self {
        let at = self.at.div(&other.at);
        let rise = self.slope.sub(&at.mul(&other.slope));
        Self {
            slope: rise.div(&other.at),
            at,
        }
    }
    fn call(&self, function: Elementary) -> Self {
        let at = self.at.call(function);
        let slope = slope(function, &self.at, &at);
        self.chain(at, &slope)
    }
    fn atan2(&self, other: &Self) -> Self {
        let (y, x) = (&self.at, &other.at);
        let square = x.mul(x).add(&y.mul(y));
        let rise = x.mul(&self.slope).sub(&y.mul(&other.slope));
        Self {
            at: y.atan2(x),
            slope: rise.div(&square),
        }
    }
    fn power(&self, exponent: f64) -> Self {
        let slope = self.at.power(exponent - 1.0);
        let slope = slope.mul(&T::rounded(exponent, 0.0));
        self.chain(self.at.power(exponent), &slope)
    }
}
