//! The loop.

use super::convergence::Convergence;
use super::options::NewtonOptions;
use super::report::{Failure, FailureReason, NewtonReport};
use super::update::{self, Workspace};
use crate::equation::Equation;
use crate::scalar::{Mask, Scalar, largest};
use crate::state::Unknown;

/// Newton's iteration `u <- u - (dr/du)^-1 r(u)`, or a cheaper variant, for all lanes together.
///
/// A lane that has converged is frozen, so that it keeps the digits of a run of its own; the loop
/// ends when every lane has converged or failed. Pivots are taken in the order fixed by the
/// equation; a lane in which one is too small is solved alone with row exchanges. Steps allocate
/// nothing (a heap matrix is allocated where row exchanges are needed).
#[derive(Clone, Debug)]
pub struct Newton<S: Scalar, U, M> {
    options: NewtonOptions,
    workspace: Workspace<S, U, M>,
}

impl<S: Scalar, U: Unknown<S>, M: Clone> Newton<S, U, M> {
    /// A solver for equations of the shape of this one.
    pub fn new<E>(equation: &E, options: &NewtonOptions) -> Self
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let workspace = Workspace::new(equation.zero_unknown(), equation.zero_matrix());
        Self {
            options: *options,
            workspace,
        }
    }

    /// Solves `r(u) = 0` from the unknown given.
    ///
    /// `scale` is the size of the state; errors are measured relative to it and to the unknown.
    ///
    /// # Errors
    /// A [`Failure`] if some lane did not converge; the unknown then is the solution in the others.
    #[inline(always)]
    pub fn solve<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
    ) -> Result<NewtonReport, Failure>
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut report = NewtonReport::default();
        let mut convergence = Convergence::new(&self.options);
        let mut active = S::Mask::splat(true);
        let mut failed = None;
        let mut residual = S::zero();
        let mut size = scale;
        while report.iterations < self.options.max_iterations {
            let outcome = update::compute(
                equation,
                unknown,
                self.options.iteration,
                report.iterations == 0,
                active,
                &mut self.workspace,
            );
            report.iterations += 1;
            report.factorizations += outcome.factorizations;
            report.pivoted |= outcome.pivoted.bits();
            residual = S::select(active, outcome.residual, S::zero());

            let sound = outcome.update.finite() & !outcome.singular;
            if !(sound | !active).all() {
                refuse(&mut failed, active, outcome.singular, sound);
                active = active & sound;
                if !active.any() {
                    break;
                }
            }
            unknown.subtract_where(active, &self.workspace.update);
            if report.iterations % REVIEW == 1 {
                size = S::largest_magnitude(&[scale, unknown.max_norm()]);
            }
            active = active & !convergence.observe(outcome.update, size);
            if !active.any() {
                break;
            }
        }
        report.residual = largest(residual);
        if active.any() {
            let growing = convergence.growing();
            record(&mut failed, active & growing, FailureReason::Diverged);
            record(&mut failed, active & !growing, FailureReason::NotConverged);
        }
        match failed {
            None => Ok(report),
            Some((reason, lanes)) => Err(Failure {
                reason,
                lanes,
                report,
            }),
        }
    }
}

/// The unknown is measured with the first iteration, and again after so many.
const REVIEW: u32 = 4;

/// Lanes that go on no longer: their matrix is singular, or their update not finite.
#[cold]
fn refuse<M: Mask>(failed: &mut Option<(FailureReason, u64)>, active: M, singular: M, sound: M) {
    record(failed, active & singular, FailureReason::Singular);
    let infinite = active & !singular & !sound;
    record(failed, infinite, FailureReason::NotFinite);
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
    use crate::scalar::F64x4;

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
