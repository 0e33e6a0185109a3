//! Moves within a register that the vector type has no function for.
//!
//! This is the one module with unsafe code: the compiler knows these moves as intrinsics alone, and from the portable form it
//! makes gathers of single numbers where vectors lie in memory (measured on a six-dimensional field: 85 ns an iteration against
//! 40). They are compiled where the whole program is compiled for registers of 512 bits; a test holds them to the portable form.
#![allow(unsafe_code)]

use wide::f64x8;

/// The numbers with places i and i xor D exchanged.
#[inline(always)]
pub(super) fn exchange<const D: usize>(numbers: f64x8) -> f64x8 {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx512f"))]
    {
        use core::arch::x86_64::{_mm512_permute_pd, _mm512_shuffle_f64x2};
        let register = numbers.into();
        // SAFETY: the instructions belong to AVX-512F, for which this program is compiled; they touch no memory.
        let moved = unsafe {
            let quarters = match D & 6 {
                2 => _mm512_shuffle_f64x2::<0b10_11_00_01>(register, register),
                4 => _mm512_shuffle_f64x2::<0b01_00_11_10>(register, register),
                6 => _mm512_shuffle_f64x2::<0b00_01_10_11>(register, register),
                _ => register,
            };
            match D & 1 {
                1 => _mm512_permute_pd::<0b0101_0101>(quarters),
                _ => quarters,
            }
        };
        moved.into()
    }
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx512f")))]
    portable::<D>(numbers)
}

#[cfg(any(test, not(all(target_arch = "x86_64", target_feature = "avx512f"))))]
#[inline(always)]
fn portable<const D: usize>(numbers: f64x8) -> f64x8 {
    let numbers = numbers.to_array();
    f64x8::new(core::array::from_fn(|i| numbers[i ^ D]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<const D: usize>() {
        let numbers = f64x8::new(core::array::from_fn(|k| k as f64));
        assert_eq!(exchange::<D>(numbers), portable::<D>(numbers), "{D}");
        assert_eq!(exchange::<D>(exchange::<D>(numbers)), numbers, "{D}");
        let places: [f64; 8] = core::array::from_fn(|k| (k ^ D) as f64);
        assert_eq!(exchange::<D>(numbers).to_array(), places, "{D}");
    }

    #[test]
    fn moves_are_the_portable_ones() {
        check::<0>();
        check::<1>();
        check::<2>();
        check::<3>();
        check::<4>();
        check::<5>();
        check::<6>();
        check::<7>();
    }
}
