//! Which registers machine code for lanes uses.

/// The registers that numbers side by side are in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Registers {
    /// AVX-512: 32 registers of eight numbers, by the assembler of this crate.
    Avx512,
    /// AVX2: 16 registers of four numbers, by the assembler of this crate.
    Avx2,
    /// Pairs of numbers by Cranelift, on other processors than x86-64, or other systems than Unix.
    Pairs,
}

impl Registers {
    /// All of them, the widest first.
    pub const ALL: [Self; 3] = [Self::Avx512, Self::Avx2, Self::Pairs];

    /// Whether this processor has them.
    pub fn are_here(self) -> bool {
        match self {
            #[cfg(all(unix, target_arch = "x86_64"))]
            Self::Avx512 => is_x86_feature_detected!("avx512f") && Self::Avx2.are_here(),
            #[cfg(all(unix, target_arch = "x86_64"))]
            Self::Avx2 => is_x86_feature_detected!("avx2"),
            #[cfg(not(all(unix, target_arch = "x86_64")))]
            Self::Avx512 | Self::Avx2 => false,
            Self::Pairs => cfg!(not(all(unix, target_arch = "x86_64"))),
        }
    }

    /// The widest that this processor has, if it has any.
    pub fn widest() -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|registers| registers.are_here())
    }
}
