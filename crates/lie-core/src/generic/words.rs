//! Numbers in two words, of any scalar, for what has to be known better than its own rounding.
//!
//! Reference: T. J. Dekker, "A floating-point technique for extending the available precision", Numerische Mathematik
//! 18 (1971), 224–242, [doi:10.1007/BF01397083](https://doi.org/10.1007/BF01397083).

use crate::scalar::Scalar;

/// `high + low`.
#[derive(Clone, Copy, Debug)]
pub struct Words<S> {
    /// The sum, rounded.
    pub high: S,
    /// What rounding took from it.
    pub low: S,
}

impl<S: Scalar> Words<S> {
    /// The sum of two numbers.
    #[inline(always)]
    pub fn sum(x: S, y: S) -> Self {
        let high = x + y;
        let other = high - x;
        let low = (x - (high - other)) + (y - other);
        Self { high, low }
    }

    /// The product of two numbers.
    #[inline(always)]
    pub fn product(x: S, y: S) -> Self {
        let ([x1, x2], [y1, y2]) = (halves(x), halves(y));
        let high = x * y;
        let low = ((x1 * y1 - high) + x1 * y2 + x2 * y1) + x2 * y2;
        Self { high, low }
    }

    /// The product with a number.
    #[must_use]
    #[inline(always)]
    pub fn times(self, factor: S) -> Self {
        let Self { high, low } = Self::product(self.high, factor);
        Self::sum(high, low + self.low * factor)
    }

    /// The sum with another one.
    #[must_use]
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        let Self { high, low } = Self::sum(self.high, other.high);
        Self::sum(high, low + (self.low + other.low))
    }

    /// What it exceeds another one by, as one number.
    #[inline(always)]
    pub fn minus(self, other: Self) -> S {
        let Self { high, low } = Self::sum(self.high, -other.high);
        high + (low + (self.low - other.low))
    }
}

/// The upper half of the bits of a number, and the rest.
#[inline(always)]
fn halves<S: Scalar>(x: S) -> [S; 2] {
    // 2^27 + 1 for the 53 bits of f64, 2^12 + 1 for the 24 of f32
    let double = S::epsilon().to_f64() < 1e-10;
    let shifted = S::from_f64(if double { 134_217_729.0 } else { 4097.0 }) * x;
    let high = shifted - (shifted - x);
    [high, x - high]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_lost() {
        let (x, y) = (1.0 / 3.0, 1e-9 / 7.0);
        let product = Words::product(x, y);
        assert_eq!(product.low, libm::fma(x, y, -product.high));
        assert_ne!(product.low, 0.0);
        let sum = Words::sum(x, y);
        assert_eq!(sum.low, y - (sum.high - x));
        assert_eq!(sum.plus(Words::sum(-x, 0.0)).minus(Words::sum(y, 0.0)), 0.0);
        let (x, y) = (1.0_f32 / 3.0, 1e-3 / 7.0);
        let product = Words::product(x, y);
        let exact = f64::from(x) * f64::from(y);
        assert_eq!(f64::from(product.high) + f64::from(product.low), exact);
    }
}
