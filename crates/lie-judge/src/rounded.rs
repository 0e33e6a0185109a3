//! Values with a bound of their round-off.

use crate::functions::slope;
use crate::number::Number;
use lie_core::Elementary;

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
    /// A constant, known to so many units of round-off of itself.
    pub fn new(value: f64, units: f64) -> Self {
        Self {
            value,
            error: units * value.abs(),
        }
    }

    /// The result of an operation, itself rounded.
    fn of(value: f64, inherited: f64) -> Self {
        Self {
            value,
            error: inherited + value.abs(),
        }
    }

    /// What an exact argument leaves to its function, whatever the slope, and others by the slope.
    fn inherited(&self, slope: impl FnOnce() -> f64) -> f64 {
        if self.error == 0.0 {
            0.0
        } else {
            slope().abs() * self.error
        }
    }
}

/// The operations of [`Number`].
impl Rounded {
    pub(super) fn add(&self, other: &Self) -> Self {
        Self::of(self.value + other.value, self.error + other.error)
    }
    pub(super) fn neg(&self) -> Self {
        Self {
            value: -self.value,
            ..*self
        }
    }
    pub(super) fn mul(&self, other: &Self) -> Self {
        let inherited = self.value.abs() * other.error + other.value.abs() * self.error;
        Self::of(self.value * other.value, inherited)
    }
    pub(super) fn div(&self, other: &Self) -> Self {
        let value = self.value / other.value;
        let inherited = (self.error + value.abs() * other.error) / other.value.abs();
        Self::of(value, inherited)
    }
    pub(super) fn call(&self, function: Elementary) -> Self {
        let value = function.evaluate(self.value);
        // without an error of their own these have no slopes asked for in turn
        let exact = |value| Number::Rounded(Self { value, error: 0.0 });
        let slope = || slope(function, &exact(self.value), &exact(value)).value();
        let inherited = self.inherited(slope);
        Self::of(value, inherited + value.abs())
    }
    pub(super) fn atan2(&self, other: &Self) -> Self {
        let (y, x) = (self.value, other.value);
        let inherited = (x.abs() * self.error + y.abs() * other.error) / (x * x + y * y);
        Self::of(y.atan2(x), inherited)
    }
    pub(super) fn power(&self, exponent: f64) -> Self {
        let value = power(self.value, exponent);
        let inherited = self.inherited(|| exponent * value / self.value);
        Self::of(value, inherited + value.abs())
    }
}

/// `x^p`, with the root that is rounded correctly.
pub fn power(x: f64, exponent: f64) -> f64 {
    match exponent {
        0.5 => x.sqrt(),
        _ => x.powf(exponent),
    }
}
