//! Lanes that change places.

use super::{F32x8, F64x8};

impl F64x8 {
    /// The lanes with places i and i xor D exchanged.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(in crate::scalar) fn exchange<const D: usize>(self) -> Self {
        Self(crate::scalar::registers::exchange::<D>(self.0))
    }
}

impl F32x8 {
    /// The lanes with places i and i xor D exchanged.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(in crate::scalar) fn exchange<const D: usize>(self) -> Self {
        let lanes = self.to_array();
        Self::new(core::array::from_fn(|i| lanes[i ^ D]))
    }
}
