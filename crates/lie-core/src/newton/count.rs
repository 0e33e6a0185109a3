//! Iterations of all lanes.

use crate::scalar::{Counted, Scalar};

/// Iterations, lane by lane where there are several.
#[derive(Default)]
pub(super) struct Count<S> {
    all: u32,
    lanes: S,
}

impl<S: Scalar> Count<S> {
    /// Adds one in some lanes; returns their number in all.
    #[inline(always)]
    pub(super) fn add(&mut self, active: S::Mask) -> u32 {
        self.all += 1;
        if S::LANES > 1 {
            self.lanes += S::select(active, S::one(), S::zero());
        }
        self.all
    }

    /// That of the lane that took most.
    #[inline(always)]
    pub(super) fn most(&self, what: Counted) -> u32 {
        self.lanes.counted(self.all, what)
    }
}
