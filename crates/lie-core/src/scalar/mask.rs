//! Truth values, one per lane.

use core::fmt::Debug;
use core::ops::{BitAnd, BitOr, Not};

/// One truth value per lane: `bool` where there is one lane.
pub trait Mask:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + Not<Output = Self>
{
    /// The same truth value in every lane.
    fn splat(value: bool) -> Self;
    /// Bit k of `bits` in lane k.
    fn from_bits(bits: u64) -> Self;
    /// Lane k in bit k; the bits beyond the lanes are 0.
    fn bits(self) -> u64;
    /// True in every lane.
    fn all(self) -> bool;
    /// True in some lane.
    fn any(self) -> bool;
    /// True in every lane, as far as that is known: where `false` does no harm but takes longer.
    fn surely_all(self) -> bool {
        self.all()
    }
    /// True in one lane.
    fn lane(self, index: usize) -> bool {
        self.bits() >> index & 1 == 1
    }
    /// The lanes in which it is true, in their order.
    #[inline(always)]
    fn lanes(self) -> impl Iterator<Item = usize> {
        let mut bits = self.bits();
        core::iter::from_fn(move || {
            let lane = bits.trailing_zeros();
            bits &= bits.wrapping_sub(1);
            (lane < u64::BITS).then_some(lane as usize)
        })
    }
}

impl Mask for bool {
    #[inline]
    fn splat(value: bool) -> Self {
        value
    }
    #[inline]
    fn from_bits(bits: u64) -> Self {
        bits & 1 == 1
    }
    #[inline]
    fn bits(self) -> u64 {
        u64::from(self)
    }
    #[inline]
    fn all(self) -> bool {
        self
    }
    #[inline]
    fn any(self) -> bool {
        self
    }
    #[inline]
    fn lane(self, _index: usize) -> bool {
        self
    }
}
