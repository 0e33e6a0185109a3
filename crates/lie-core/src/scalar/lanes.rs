//! SIMD lanes over the vectors of the `wide` crate.
//!
//! Arithmetic and square roots are the vector's, which round like the scalar ones. Elementary functions that are programs are done in
//! all lanes at once, the others lane by lane, because the vector's own differ in the last bits.
//!
//! In the development profile they are calls: inlined into a crate without optimisation, an operation on eight numbers is a dozen calls.

mod exchange;
mod primitive;

use super::{Mask, Scalar, elementary};
use core::fmt;
use core::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};

macro_rules! lane_operator {
    ($name:ident, $($trait:ident $method:ident $assign_trait:ident $assign:ident),*) => {$(
        impl $trait for $name {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $method(self, other: Self) -> Self {
                Self($trait::$method(self.0, other.0))
            }
        }
        impl $assign_trait for $name {
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $assign(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}

/// Elementary functions lane by lane.
macro_rules! by_lanes {
    ($name:ident) => {
        #[cfg_attr(not(debug_assertions), inline)]
        fn $name(self) -> Self {
            self.map(<Self::Lane as Scalar>::$name)
        }
    };
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(by_lanes!($name);)+
    };
}

/// Elementary functions, the programs among them in all lanes at once.
macro_rules! at_once {
    (libm $name:ident) => {
        by_lanes!($name);
    };
    (program $name:ident) => {
        #[cfg_attr(not(debug_assertions), inline)]
        fn $name(self) -> Self {
            elementary::$name(self)
        }
    };
    (angle $name:ident) => {
        at_once!(angle $name -> Self);
    };
    (angle $name:ident -> $result:ty) => {
        #[cfg_attr(not(debug_assertions), inline)]
        fn $name(self) -> $result {
            if elementary::is_small(self).all() {
                elementary::small::$name(self)
            } else {
                elementary::$name(self)
            }
        }
    };
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(at_once!($from $name);)+
        at_once!(angle sin_cos -> (Self, Self));
    };
}

/// Defines a scalar of several lanes and its mask.
macro_rules! lanes {
    ($(#[$doc:meta])* $name:ident, $mask:ident, $vector:ty, $lane:ty, $bits:ty, $count:literal, $functions:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Default, PartialEq)]
        #[repr(transparent)]
        pub struct $name($vector);

        #[doc = concat!("One truth value per lane of [`", stringify!($name), "`].")]
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct $mask($vector);

        impl $name {
            /// The number of every lane.
            #[cfg_attr(not(debug_assertions), inline(always))]
            pub fn new(lanes: [$lane; $count]) -> Self {
                Self(<$vector>::new(lanes))
            }

            /// All lanes in order.
            #[cfg_attr(not(debug_assertions), inline(always))]
            pub fn to_array(self) -> [$lane; $count] {
                self.0.to_array()
            }

            #[inline(always)]
            fn map(self, function: impl FnMut($lane) -> $lane) -> Self {
                Self::new(self.to_array().map(function))
            }

            #[inline(always)]
            fn zip(self, other: Self, function: impl Fn($lane, $lane) -> $lane) -> Self {
                let (left, right) = (self.to_array(), other.to_array());
                Self::new(core::array::from_fn(|index| function(left[index], right[index])))
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.to_array().fmt(formatter)
            }
        }

        impl Neg for $name {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        lane_operator!($name, Add add AddAssign add_assign, Sub sub SubAssign sub_assign,
            Mul mul MulAssign mul_assign, Div div DivAssign div_assign);

        impl Scalar for $name {
            type Lane = $lane;
            type Mask = $mask;
            type Wide = super::Pack<Self>;
            const LANES: usize = $count;

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn zero() -> Self {
                Self::splat(0.0)
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn one() -> Self {
                Self::splat(1.0)
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn ratio(numerator: f64, denominator: f64) -> Self {
                Self::splat(<$lane>::ratio(numerator, denominator))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn constant(high: f64, low: f64) -> Self {
                Self::splat(<$lane>::constant(high, low))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn from_f64(value: f64) -> Self {
                Self::splat(<$lane>::from_f64(value))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn epsilon() -> Self {
                Self::splat(<$lane>::EPSILON)
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn splat(lane: $lane) -> Self {
                Self(<$vector>::splat(lane))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn lane(self, index: usize) -> $lane {
                self.to_array()[index]
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn with_lane(self, index: usize, lane: $lane) -> Self {
                let mut lanes = self.to_array();
                lanes[index] = lane;
                Self::new(lanes)
            }
            #[inline(always)]
            fn from_lanes(number: impl FnMut(usize) -> $lane) -> Self {
                Self::new(core::array::from_fn(number))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn to_f64(self) -> f64 {
                f64::from(self.lane(0))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn gather(numbers: [Self; 8]) -> Self::Wide {
                super::Pack(numbers)
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn scatter(wide: Self::Wide) -> [Self; 8] {
                wide.0
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn abs(self) -> Self {
                Self(self.0.abs())
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }
            crate::elementary_functions!($functions);
            #[cfg_attr(not(debug_assertions), inline)]
            fn atan2(self, x: Self) -> Self {
                self.zip(x, <$lane as Scalar>::atan2)
            }
            #[cfg_attr(not(debug_assertions), inline)]
            fn powf(self, exponent: Self) -> Self {
                self.zip(exponent, <$lane as Scalar>::powf)
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn max(self, other: Self) -> Self {
                let second = self.0.simd_lt(other.0) | other.0.is_nan();
                Self(second.select(other.0, self.0))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn less(self, other: Self) -> $mask {
                $mask(self.0.simd_lt(other.0))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn less_equal(self, other: Self) -> $mask {
                $mask(self.0.simd_le(other.0))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn finite(self) -> $mask {
                // inf - inf and nan - nan are not numbers, and so not equal to 0
                $mask((self.0 - self.0).simd_eq(<$vector>::splat(0.0)))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                Self(mask.0.select(yes.0, no.0))
            }
        }

        impl fmt::Debug for $mask {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                core::array::from_fn::<bool, $count, _>(|index| self.lane(index)).fmt(formatter)
            }
        }

        impl PartialEq for $mask {
            fn eq(&self, other: &Self) -> bool {
                self.bits() == other.bits()
            }
        }

        impl BitAnd for $mask {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn bitand(self, other: Self) -> Self {
                Self(self.0 & other.0)
            }
        }

        impl BitOr for $mask {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn bitor(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
        }

        impl Not for $mask {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn not(self) -> Self {
                Self(!self.0)
            }
        }

        impl Mask for $mask {
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn splat(value: bool) -> Self {
                Self::from_bits(if value { u64::MAX } else { 0 })
            }
            #[cfg_attr(not(debug_assertions), inline)]
            fn from_bits(bits: u64) -> Self {
                Self(<$vector>::new(core::array::from_fn(|index| {
                    <$lane>::from_bits(if bits >> index & 1 == 1 { <$bits>::MAX } else { 0 })
                })))
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn bits(self) -> u64 {
                u64::from(self.0.to_bitmask())
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn all(self) -> bool {
                self.0.all()
            }
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn any(self) -> bool {
                self.0.any()
            }
        }
    };
}

lanes!(
    /// Eight f64 in lanes: one AVX-512 register, two of AVX or four of SSE2.
    F64x8, Mask64x8, wide::f64x8, f64, u64, 8, at_once
);
lanes!(
    /// Four f64 in lanes: one AVX register or two of SSE2.
    F64x4, Mask64x4, wide::f64x4, f64, u64, 4, at_once
);
lanes!(
    /// Eight f32 in lanes: one AVX register or two of SSE2.
    F32x8, Mask32x8, wide::f32x8, f32, u32, 8, by_lanes
);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::Elementary;

    const SAMPLES: [f64; 8] = [
        0.3,
        -1.7,
        1e-300,
        2.5e8,
        f64::NAN,
        f64::INFINITY,
        -0.0,
        0.999_999_999,
    ];

    type Unary<T> = fn(T) -> T;
    type Binary<T> = fn(T, T) -> T;

    fn bits(values: [f64; 8]) -> [u64; 8] {
        // every not-a-number counts as the same: their payloads are not specified
        values.map(|value| {
            if value.is_nan() {
                f64::NAN.to_bits()
            } else {
                value.to_bits()
            }
        })
    }

    #[test]
    fn every_operation_has_the_bits_of_one_lane() {
        let x = F64x8::new(SAMPLES);
        let y = F64x8::new([2.0, 0.5, 1e-10, -3.0, 1.0, -1.0, 4.0, f64::NAN]);
        let binary: [(Binary<F64x8>, Binary<f64>); 7] = [
            (|a, b| a + b, |a, b| a + b),
            (|a, b| a - b, |a, b| a - b),
            (|a, b| a * b, |a, b| a * b),
            (|a, b| a / b, |a, b| a / b),
            (Scalar::max, Scalar::max),
            (Scalar::powf, Scalar::powf),
            (Scalar::atan2, Scalar::atan2),
        ];
        for (lanes, one) in binary {
            let expected = core::array::from_fn(|k| one(x.lane(k), y.lane(k)));
            assert_eq!(bits(lanes(x, y).to_array()), bits(expected));
        }
        let unary: [(Unary<F64x8>, Unary<f64>); 4] = [
            (|a| -a, |a| -a),
            (Scalar::abs, Scalar::abs),
            (Scalar::sqrt, Scalar::sqrt),
            (Scalar::magnitude, Scalar::magnitude),
        ];
        for (lanes, one) in unary {
            assert_eq!(bits(lanes(x).to_array()), bits(x.to_array().map(one)));
        }
        for function in Elementary::ALL {
            let expected = x.to_array().map(|one| function.apply(one));
            assert_eq!(bits(function.apply(x).to_array()), bits(expected));
        }
    }

    #[test]
    fn comparisons_and_masks() {
        let x = F64x8::new(SAMPLES);
        assert_eq!(x.finite().bits(), 0b1100_1111);
        assert_eq!(x.less(F64x8::splat(0.3)).bits(), 0b0100_0110);
        assert_eq!(x.less_equal(F64x8::splat(0.3)).bits(), 0b0100_0111);
        assert!((x.finite() | !x.finite()).all());
        assert!(!(x.finite() & !x.finite()).any());
        let mask = Mask64x8::from_bits(0b1010_0001);
        assert_eq!(mask.bits(), 0b1010_0001);
        let chosen = F64x8::select(mask, F64x8::one(), F64x8::zero());
        assert_eq!(chosen.to_array(), [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0]);
        assert_eq!(Mask32x8::from_bits(0b101).bits(), 0b101);
        assert_eq!(Mask64x4::splat(true).bits(), 0b1111);
        assert_eq!(x.with_lane(3, 7.0).lane(3), 7.0);
    }
}
