//! Into how many parts steps are divided.

/// Into so many parts a step is divided at most.
pub(in super::super) const MOST_PARTS: u32 = 1 << 12;

/// A step that needs a Jacobian in place of a fixed point costs about as much as so many that do not.
pub(in super::super) const JACOBIAN: u64 = 200;
/// Into so many parts steps are divided at most in order to contract.
pub(in super::super) const SLOW_PARTS: f64 = 8.0;

/// In how many parts a step is made that failed in some; none where that is enough.
pub(in super::super) fn divided(parts: u32) -> Option<u32> {
    (parts < MOST_PARTS).then_some(2 * parts)
}
