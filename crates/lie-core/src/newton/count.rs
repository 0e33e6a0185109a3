//! Iterations of all lanes.

use crate::scalar::{Counted, Scalar, largest};

/// Iterations, lane by lane where there are several.
#[derive(Default)]
pub(super) struct Count<S> {
    all: u32,
    lanes: S,
    /// The largest entry of the residual when it was last evaluated, lane by lane.
    residual: S,
}

impl<S: Scalar> Count<S> {
    /// Adds one in some lanes; returns their number in all.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn add(&mut self, active: S::Mask) -> u32 {
        self.all += 1;
        if S::LANES > 1 {
            self.lanes += S::select(active, S::one(), S::zero());
        }
        self.all
    }

    /// Takes the residual of some lanes.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn saw(&mut self, active: S::Mask, residual: S) {
        self.residual = S::select(active, residual, self.residual);
    }

    /// The largest residual of all lanes.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn residual(&self) -> f64 {
        largest(self.residual)
    }

    /// That of the lane that took most.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn most(&self, what: Counted) -> u32 {
        self.lanes.counted(self.all, what)
    }
}
