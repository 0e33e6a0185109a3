//! Eight numbers side by side, of any scalar.

use super::{Mask, Scalar};
use core::array::from_fn;
use core::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};

/// Eight numbers at once, number by number: [`Scalar::Wide`] of a scalar that has no register for them.
///
/// Its lanes are those of the first number, then those of the second, and so on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pack<S>(pub [S; 8]);

/// The truth values of a [`Pack`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PackMask<S: Scalar>([S::Mask; 8]);

macro_rules! operators {
    ($($trait:ident $method:ident $assign_trait:ident $assign:ident),*) => {$(
        impl<S: Scalar> $trait for Pack<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|k| $trait::$method(self.0[k], other.0[k])))
            }
        }
        impl<S: Scalar> $assign_trait for Pack<S> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}
operators!(Add add AddAssign add_assign, Sub sub SubAssign sub_assign, Mul mul MulAssign mul_assign,
    Div div DivAssign div_assign);

macro_rules! functions {
    ($($name:ident),*) => {$(
        #[inline]
        fn $name(self) -> Self {
            Self(self.0.map(S::$name))
        }
    )*};
}

macro_rules! elementary {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        functions!($($name),+);
    };
}

impl<S: Scalar> Neg for Pack<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(Neg::neg))
    }
}

impl<S: Scalar> Scalar for Pack<S> {
    type Lane = S::Lane;
    type Mask = PackMask<S>;
    type Wide = Pack<Self>;
    const LANES: usize = 8 * S::LANES;
    const DERIVATIVES: u32 = S::DERIVATIVES;
    const LOOPS: bool = S::LOOPS;

    fn zero() -> Self {
        Self([S::zero(); 8])
    }
    fn one() -> Self {
        Self([S::one(); 8])
    }
    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self([S::ratio(numerator, denominator); 8])
    }
    fn constant(high: f64, low: f64) -> Self {
        Self([S::constant(high, low); 8])
    }
    fn from_f64(value: f64) -> Self {
        Self([S::from_f64(value); 8])
    }
    fn epsilon() -> Self {
        Self([S::epsilon(); 8])
    }
    fn splat(lane: Self::Lane) -> Self {
        Self([S::splat(lane); 8])
    }
    fn lane(self, index: usize) -> Self::Lane {
        self.0[index / S::LANES].lane(index % S::LANES)
    }
    fn with_lane(mut self, index: usize, lane: Self::Lane) -> Self {
        let number = &mut self.0[index / S::LANES];
        *number = number.with_lane(index % S::LANES, lane);
        self
    }
    fn to_f64(self) -> f64 {
        self.0[0].to_f64()
    }
    #[inline(always)]
    fn gather(numbers: [Self; 8]) -> Self::Wide {
        Pack(numbers)
    }
    #[inline(always)]
    fn scatter(wide: Self::Wide) -> [Self; 8] {
        wide.0
    }

    functions!(abs, magnitude, sqrt);
    crate::elementary_functions!(elementary);
    fn atan2(self, x: Self) -> Self {
        Self(from_fn(|k| self.0[k].atan2(x.0[k])))
    }
    fn powf(self, exponent: Self) -> Self {
        Self(from_fn(|k| self.0[k].powf(exponent.0[k])))
    }
    fn max(self, other: Self) -> Self {
        Self(from_fn(|k| S::max(self.0[k], other.0[k])))
    }
    fn less(self, other: Self) -> PackMask<S> {
        PackMask(from_fn(|k| self.0[k].less(other.0[k])))
    }
    fn less_equal(self, other: Self) -> PackMask<S> {
        PackMask(from_fn(|k| self.0[k].less_equal(other.0[k])))
    }
    fn finite(self) -> PackMask<S> {
        PackMask(self.0.map(S::finite))
    }
    fn select(mask: PackMask<S>, yes: Self, no: Self) -> Self {
        Self(from_fn(|k| S::select(mask.0[k], yes.0[k], no.0[k])))
    }
}

impl<S: Scalar> BitAnd for PackMask<S> {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|k| self.0[k] & other.0[k]))
    }
}

impl<S: Scalar> BitOr for PackMask<S> {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|k| self.0[k] | other.0[k]))
    }
}

impl<S: Scalar> Not for PackMask<S> {
    type Output = Self;
    fn not(self) -> Self {
        Self(self.0.map(Not::not))
    }
}

impl<S: Scalar> Mask for PackMask<S> {
    fn splat(value: bool) -> Self {
        Self([S::Mask::splat(value); 8])
    }
    fn from_bits(bits: u64) -> Self {
        Self(from_fn(|k| S::Mask::from_bits(bits >> (k * S::LANES))))
    }
    fn bits(self) -> u64 {
        let shifted = |(k, mask): (usize, &S::Mask)| mask.bits() << (k * S::LANES);
        self.0.iter().enumerate().map(shifted).sum()
    }
    fn all(self) -> bool {
        self.0.iter().all(|mask| mask.all())
    }
    fn any(self) -> bool {
        self.0.iter().any(|mask| mask.any())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_keeps_its_place() {
        let numbers: [f64; 8] = from_fn(|k| k as f64);
        let pack = Pack(numbers);
        assert_eq!(f64::scatter(f64::gather(numbers)), numbers);
        assert_eq!((pack * pack + pack).0, numbers.map(|x| x * x + x));
        assert_eq!(pack.less(Pack::from_f64(3.0)).bits(), 0b111);
        let mask = PackMask::<f64>::from_bits(0b1010_0000);
        assert_eq!(mask.bits(), 0b1010_0000);
        let chosen = Pack::select(mask, pack, Pack::zero());
        assert_eq!(chosen.0, [0.0, 0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 7.0]);
        assert_eq!((pack.lane(6), pack.with_lane(6, 1.0).lane(6)), (6.0, 1.0));
    }
}
