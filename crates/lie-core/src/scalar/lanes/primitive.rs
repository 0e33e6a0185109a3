//! Lanes as what programs of functions are made of.

use super::{F64x4, F64x8, Mask, Scalar};
use crate::functions::Elementary;
use crate::scalar::primitive::{Primitive, beyond};

macro_rules! primitive {
    ($name:ident, $vector:ty, $words:ty) => {
        impl $name {
            #[inline(always)]
            fn words(self) -> $words {
                <$words>::new(self.to_array().map(f64::to_bits))
            }

            #[inline(always)]
            fn from_words(words: $words) -> Self {
                Self::new(words.to_array().map(f64::from_bits))
            }
        }

        impl Primitive for $name {
            #[inline(always)]
            fn number(value: f64) -> Self {
                Self(<$vector>::splat(value))
            }
            #[inline(always)]
            fn from_word(word: u64) -> Self {
                Self::number(f64::from_bits(word))
            }
            #[inline(always)]
            fn and(self, other: Self) -> Self {
                Self(self.0 & other.0)
            }
            #[inline(always)]
            fn or(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
            #[inline(always)]
            fn xor(self, other: Self) -> Self {
                Self(self.0 ^ other.0)
            }
            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                Self::from_words(self.words() + other.words())
            }
            #[inline(always)]
            fn left(self, places: u8) -> Self {
                Self::from_words(self.words() << u32::from(places))
            }
            #[inline(always)]
            fn right(self, places: u8) -> Self {
                Self::from_words(self.words() >> u32::from(places))
            }
            #[inline(always)]
            fn blend(test: Self, then: Self, otherwise: Self) -> Self {
                Self::select(test.less(Self::zero()), then, otherwise)
            }
            #[inline(always)]
            fn rare(function: Elementary, x: Self, test: Self, usual: Self) -> Self {
                let is_usual = Self::zero().less_equal(test);
                if is_usual.all() {
                    usual
                } else {
                    let beyond = x.map(|x| beyond(function, x));
                    Self::select(is_usual, usual, beyond)
                }
            }
        }
    };
}
primitive!(F64x8, wide::f64x8, wide::u64x8);
primitive!(F64x4, wide::f64x4, wide::u64x4);
