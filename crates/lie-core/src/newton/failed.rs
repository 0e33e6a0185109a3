//! The lanes in which an iteration has failed, and why.

use super::report::FailureReason;
use crate::scalar::Mask;

/// Lanes that go on no longer: their matrix is singular, or their update not finite.
#[cold]
pub(super) fn refuse<M: Mask>(
    failed: &mut Option<(FailureReason, u64)>,
    active: M,
    singular: M,
    sound: M,
) {
    record(failed, active & singular, FailureReason::Singular);
    let infinite = active & !singular & !sound;
    record(failed, infinite, FailureReason::NotFinite);
}

/// Lanes whose updates did not shrink to the tolerance, or grew.
#[cold]
pub(super) fn leave<M: Mask>(failed: &mut Option<(FailureReason, u64)>, active: M, growing: M) {
    record(failed, active & growing, FailureReason::Diverged);
    record(failed, active & !growing, FailureReason::NotConverged);
}

/// Adds lanes to the failed ones; the reason is that of the lowest lane.
fn record<M: Mask>(failed: &mut Option<(FailureReason, u64)>, lanes: M, reason: FailureReason) {
    let bits = lanes.bits();
    if bits == 0 {
        return;
    }
    let (known, before) = failed.unwrap_or((reason, 0));
    let reason = if bits.trailing_zeros() < before.trailing_zeros() {
        reason
    } else {
        known
    };
    *failed = Some((reason, before | bits));
}

#[cfg(all(test, feature = "lanes"))]
mod tests {
    use super::*;
    use crate::scalar::{F64x4, Scalar};

    type Lanes = <F64x4 as Scalar>::Mask;

    #[test]
    fn the_reason_is_that_of_the_lowest_lane() {
        let mut failed = None;
        record(&mut failed, Lanes::from_bits(0), FailureReason::Diverged);
        assert_eq!(failed, None);
        record(
            &mut failed,
            Lanes::from_bits(0b1000),
            FailureReason::Singular,
        );
        record(
            &mut failed,
            Lanes::from_bits(0b0010),
            FailureReason::NotFinite,
        );
        assert_eq!(failed, Some((FailureReason::NotFinite, 0b1010)));
        record(
            &mut failed,
            Lanes::from_bits(0b0100),
            FailureReason::Diverged,
        );
        assert_eq!(failed, Some((FailureReason::NotFinite, 0b1110)));
    }
}
