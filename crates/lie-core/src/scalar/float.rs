//! `f64` and `f32` as scalars.

use super::{Scalar, elementary};

/// The elementary functions in double precision.
macro_rules! double {
    (libm $name:ident) => { libm::$name };
    (program $name:ident) => { elementary::$name };
    (angle $name:ident) => { elementary::one::$name };
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(#[cfg_attr(not(debug_assertions), inline)]
        fn $name(self) -> Self {
            double!($from $name)(self)
        })+
        #[cfg_attr(not(debug_assertions), inline)]
        fn sin_cos(self) -> (Self, Self) {
            elementary::one::sin_cos(self)
        }
    };
}

/// The elementary functions in single precision.
macro_rules! single {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(#[cfg_attr(not(debug_assertions), inline)]
        fn $name(self) -> Self {
            libm::$single(self)
        })+
    };
}

/// Implements [`Scalar`] for a machine float; functions are the given ones.
macro_rules! float_scalar {
    ($float:ty, $wide:ident, $round:expr, $ratio:expr, $abs:path, $sqrt:path, $pow:path, $atan2:path, $functions:ident) => {
        impl Scalar for $float {
            type Lane = Self;
            type Mask = bool;
            #[cfg(feature = "lanes")]
            type Wide = super::$wide;
            #[cfg(not(feature = "lanes"))]
            type Wide = super::Pack<Self>;
            const LANES: usize = 1;

            #[inline(always)]
            fn zero() -> Self {
                0.0
            }
            #[inline(always)]
            fn one() -> Self {
                1.0
            }
            #[inline(always)]
            fn ratio(numerator: f64, denominator: f64) -> Self {
                $ratio(numerator, denominator)
            }
            #[inline(always)]
            fn constant(high: f64, low: f64) -> Self {
                $round(high, low)
            }
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            fn epsilon() -> Self {
                <$float>::EPSILON
            }
            #[inline(always)]
            fn splat(lane: Self) -> Self {
                lane
            }
            #[inline(always)]
            fn lane(self, _index: usize) -> Self {
                self
            }
            #[inline(always)]
            fn with_lane(self, _index: usize, lane: Self) -> Self {
                lane
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[cfg(feature = "lanes")]
            #[inline(always)]
            fn gather(numbers: [Self; 8]) -> Self::Wide {
                super::$wide::new(numbers)
            }
            #[cfg(not(feature = "lanes"))]
            fn gather(numbers: [Self; 8]) -> Self::Wide {
                super::Pack(numbers)
            }
            #[cfg(feature = "lanes")]
            #[inline(always)]
            fn scatter(wide: Self::Wide) -> [Self; 8] {
                wide.to_array()
            }
            #[cfg(feature = "lanes")]
            #[inline(always)]
            fn exchange<const D: usize>(wide: Self::Wide) -> Self::Wide {
                wide.exchange::<D>()
            }
            #[cfg(not(feature = "lanes"))]
            fn scatter(wide: Self::Wide) -> [Self; 8] {
                wide.0
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $abs(self)
            }
            /// Without the sign, bits are ordered like the numbers, and what is not a number comes last.
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn largest_magnitude(numbers: &[Self]) -> Self {
                let largest = numbers.iter().fold(0, |largest, number| {
                    Ord::max(largest, number.to_bits() << 1)
                });
                Self::from_bits(largest >> 1)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            crate::elementary_functions!($functions);
            #[cfg_attr(not(debug_assertions), inline)]
            fn atan2(self, x: Self) -> Self {
                $atan2(self, x)
            }
            #[cfg_attr(not(debug_assertions), inline)]
            fn powf(self, exponent: Self) -> Self {
                $pow(self, exponent)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self < other || other.is_nan() {
                    other
                } else {
                    self
                }
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn less_equal(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn finite(self) -> bool {
                self.is_finite()
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
        }
    };
}

/// Square roots are rounded to nearest by either library, so that the bits are the same; those of the standard library are known to
/// the compiler, which makes several at once.
macro_rules! root {
    ($name:ident, $float:ty, $alone:path) => {
        #[inline(always)]
        fn $name(x: $float) -> $float {
            #[cfg(feature = "std")]
            return x.sqrt();
            #[cfg(not(feature = "std"))]
            return $alone(x);
        }
    };
}
root!(root, f64, libm::sqrt);
root!(root_f32, f32, libm::sqrtf);

float_scalar!(
    f64,
    F64x8,
    |high: f64, _low: f64| high,
    |numerator: f64, denominator: f64| numerator / denominator,
    libm::fabs,
    root,
    libm::pow,
    libm::atan2,
    double
);

float_scalar!(
    f32,
    F32x8,
    nearest_f32,
    ratio_f32,
    libm::fabsf,
    root_f32,
    libm::powf,
    libm::atan2f,
    single
);

/// The f32 nearest to `high + low`. Rounding `high` alone would decide a tie between two f32
/// numbers without seeing `low`.
#[inline]
fn nearest_f32(high: f64, low: f64) -> f32 {
    const BELOW_F32: u64 = (1 << 29) - 1;
    const HALF: u64 = 1 << 28;
    let bits = high.to_bits();
    if bits & BELOW_F32 != HALF || low == 0.0 {
        return high as f32;
    }
    let away_from_zero = (low > 0.0) == (high > 0.0);
    f64::from_bits(if away_from_zero { bits + 1 } else { bits - 1 }) as f32
}

/// The f32 nearest to a quotient: the remainder of the rounded f64 quotient decides ties.
#[inline]
fn ratio_f32(numerator: f64, denominator: f64) -> f32 {
    let quotient = numerator / denominator;
    let remainder = libm::fma(-quotient, denominator, numerator);
    nearest_f32(quotient, remainder / denominator)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_rounded_once() {
        assert_eq!(f64::ratio(1.0, 3.0), 1.0 / 3.0);
        // 1 + 2^-24 + 2^-60: a tie for f32 until the low part is seen.
        let high = 1.0 + 2.0_f64.powi(-24);
        assert_eq!(f32::constant(high, 0.0), 1.0);
        assert_eq!(f32::constant(high, 2.0_f64.powi(-60)), 1.0 + f32::EPSILON);
        assert_eq!(f32::constant(high, -2.0_f64.powi(-60)), 1.0);
        assert_eq!(
            f32::constant(-high, -2.0_f64.powi(-60)),
            -1.0 - f32::EPSILON
        );
    }

    #[test]
    fn quotients_are_rounded_once() {
        // 1 + 2^-24 + 2^-68 and a bit: f64 sees a tie between two f32.
        let denominator = 2.0_f64.powi(44) - 1.0;
        let numerator = denominator + 2.0_f64.powi(20);
        let once = f32::ratio(numerator, denominator);
        let quotient = numerator / denominator;
        assert_eq!(
            quotient,
            1.0 + 2.0_f64.powi(-24),
            "the example must be a tie in f64"
        );
        assert_eq!(quotient as f32, 1.0, "the control rounds twice");
        assert_eq!(once, 1.0 + f32::EPSILON);
    }

    #[test]
    fn the_largest_magnitude_is_that_of_the_numbers() {
        assert_eq!(f64::largest_magnitude(&[]), 0.0);
        assert_eq!(f64::largest_magnitude(&[-0.0, 1e-310, -3.0, 2.0]), 3.0);
        assert_eq!(
            f32::largest_magnitude(&[1.0, f32::NEG_INFINITY]),
            f32::INFINITY
        );
        for place in 0..3 {
            for nan in [f64::NAN, -f64::NAN] {
                let mut numbers = [1.0, f64::INFINITY, -2.0];
                numbers[place] = nan;
                assert!(f64::largest_magnitude(&numbers).is_nan());
            }
        }
    }

    #[test]
    fn max_keeps_what_is_not_a_number() {
        assert!(Scalar::max(f64::NAN, 1.0).is_nan());
        assert!(Scalar::max(1.0, f64::NAN).is_nan());
        assert_eq!(Scalar::max(1.0, 2.0), 2.0);
    }
}
