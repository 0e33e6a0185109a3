//! Limits that several stages know.

/// Kernels are straight-line code; above this dimension no compiler gets through them.
pub const MAX_DIMENSION: usize = 256;
