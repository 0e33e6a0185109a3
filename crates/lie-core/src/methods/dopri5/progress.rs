//! What a step of the grid has behind it, in each lane.

use crate::methods::stepper::{StepFailure, StepReport};
use crate::newton::FailureReason;
use crate::scalar::{Mask, Scalar};

/// How far a step of the grid has come.
pub(super) struct Progress<S: Scalar> {
    /// What is behind, of the length of the step.
    pub(super) covered: S,
    /// Lanes that have neither arrived nor failed.
    pub(super) active: S::Mask,
    pub(super) after_rejection: S::Mask,
    pub(super) report: StepReport,
    pub(super) failure: Option<StepFailure>,
}

impl<S: Scalar> Progress<S> {
    /// In no lane.
    pub(super) fn none() -> Self {
        Self {
            covered: S::zero(),
            active: S::Mask::splat(false),
            after_rejection: S::Mask::splat(false),
            report: StepReport::default(),
            failure: None,
        }
    }

    /// Lanes go no further.
    pub(super) fn fail(&mut self, reason: FailureReason, lanes: S::Mask) {
        if !lanes.any() {
            return;
        }
        let failed = StepFailure {
            reason,
            lanes: 0,
            report: self.report,
        };
        self.failure.get_or_insert(failed).lanes |= lanes.bits();
        self.active = self.active & !lanes;
    }

    /// The lanes that have failed.
    pub(super) fn failed(&self) -> S::Mask {
        S::Mask::from_bits(self.failure.map_or(0, |failure| failure.lanes))
    }
}
