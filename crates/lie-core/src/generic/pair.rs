//! Numbers as unevaluated sums of two f64, about 104 bits, in functions that the compiler can run.
//!
//! Reference: T. J. Dekker, "A floating-point technique for extending the available precision", Numerische Mathematik
//! 18 (1971), 224–242, [doi:10.1007/BF01397083](https://doi.org/10.1007/BF01397083).

use crate::scalar::Scalar;

/// `high + low`, where high is the f64 nearest to the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub(super) high: f64,
    low: f64,
}

/// The sum of two numbers and what rounding took from it.
const fn sum(x: f64, y: f64) -> Pair {
    let high = x + y;
    let other = high - x;
    Pair {
        high,
        low: (x - (high - other)) + (y - other),
    }
}

/// The upper half of the bits of a number.
const fn upper(x: f64) -> f64 {
    let shifted = 134_217_729.0 * x;
    shifted - (shifted - x)
}

/// The product of two numbers and what rounding took from it.
const fn product(x: f64, y: f64) -> Pair {
    let high = x * y;
    let (x1, y1) = (upper(x), upper(y));
    let (x2, y2) = (x - x1, y - y1);
    Pair {
        high,
        low: ((x1 * y1 - high) + x1 * y2 + x2 * y1) + x2 * y2,
    }
}

impl Pair {
    pub(super) const ZERO: Self = Self::new(0.0);
    pub(super) const ONE: Self = Self::new(1.0);

    pub(super) const fn new(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
        }
    }

    pub(super) const fn plus(self, other: Self) -> Self {
        let high = sum(self.high, other.high);
        let low = sum(self.low, other.low);
        let first = sum(high.high, high.low + low.high);
        sum(first.high, first.low + low.low)
    }

    pub(super) const fn sub(self, other: Self) -> Self {
        self.plus(other.scaled(-1.0))
    }

    /// The product with a power of two, or its negative.
    pub(super) const fn scaled(self, factor: f64) -> Self {
        Self {
            high: self.high * factor,
            low: self.low * factor,
        }
    }

    pub(super) const fn times(self, other: Self) -> Self {
        let main = product(self.high, other.high);
        sum(
            main.high,
            main.low + (self.high * other.low + self.low * other.high),
        )
    }

    pub(super) const fn divided_by(self, other: Self) -> Self {
        let mut quotient = Self::new(self.high / other.high);
        let mut digits = 0;
        while digits < 2 {
            let rest = self.sub(quotient.times(other));
            quotient = quotient.plus(Self::new(rest.high / other.high));
            digits += 1;
        }
        quotient
    }

    /// As a scalar, correctly rounded.
    pub(super) fn number<S: Scalar>(self) -> S {
        S::constant(self.high, self.low)
    }
}
