//! The loop.

use super::convergence::Convergence;
use super::options::{Iteration, NewtonOptions};
use super::report::{Failure, FailureReason, NewtonReport};
use super::trial::Trial;
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
    trial: Trial<S>,
    start: U,
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
            trial: Trial::new(options, equation.jacobian_cost()),
            start: equation.zero_unknown(),
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
        let mut count = Count::default();
        let mut iteration = self.options.iteration;
        let mut lanes = S::Mask::splat(true);
        if iteration == Iteration::Automatic {
            iteration = Iteration::Newton;
            let trying = self.trial.lanes();
            if trying.any() {
                self.start.assign_where(lanes, unknown);
                let solved = self.by_fixed_point(
                    equation,
                    unknown,
                    scale,
                    trying,
                    (&mut report, &mut count),
                );
                if solved.all() {
                    report.iterations = count.most();
                    report.fixed_point = report.iterations;
                    return Ok(report);
                }
                lanes = !solved;
                self.trial.given_up(trying & lanes);
                unknown.assign_where(lanes, &self.start);
            }
        }
        report.fixed_point = count.most();
        let counts = (&mut report, &mut count);
        let failed = self.iterate(equation, unknown, scale, (iteration, lanes), counts);
        report.iterations = count.most();
        if iteration == Iteration::FixedPoint {
            report.fixed_point = report.iterations;
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

    /// Iterates without a Jacobian in the lanes of a mask, as long as that pays; returns those in which it led to the
    /// solution.
    #[inline(always)]
    fn by_fixed_point<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        lanes: S::Mask,
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> S::Mask
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut convergence = Convergence::new(Iteration::FixedPoint, self.options.tolerance);
        let mut bound = self.trial.bound();
        let mut active = lanes;
        let mut solved = S::Mask::splat(false);
        let mut residual = S::zero();
        let mut size = scale;
        while active.any() {
            let update = &mut self.workspace.update;
            equation.residual(unknown, update);
            let step = update.max_norm();
            residual = S::select(active, step, S::zero());
            unknown.subtract_where(active, update);
            if count.add(active) % REVIEW == 1 {
                size = S::largest_magnitude(&[scale, unknown.max_norm()]);
            }
            let converged = convergence.observe(step, size) & active;
            solved = solved | converged;
            active = active & !converged;
            if active.any() {
                active = active & bound.keeps(step, convergence.is_round_off(step, size));
            }
        }
        report.residual = largest(residual);
        solved
    }

    /// Iterates in the lanes of a mask, and says in which it failed.
    #[inline(always)]
    fn iterate<E>(
        &mut self,
        equation: &mut E,
        unknown: &mut U,
        scale: S,
        (iteration, lanes): (Iteration, S::Mask),
        (report, count): (&mut NewtonReport, &mut Count<S>),
    ) -> Option<(FailureReason, u64)>
    where
        E: Equation<S, Unknown = U, Matrix = M>,
    {
        let mut convergence = Convergence::new(iteration, self.options.tolerance);
        let mut active = lanes;
        let mut failed = None;
        let mut residual = S::zero();
        let mut size = scale;
        for index in 0..self.options.max_iterations {
            let outcome = update::compute(
                equation,
                unknown,
                iteration,
                index == 0,
                active,
                &mut self.workspace,
            );
            count.add(active);
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
            if index % REVIEW == 0 {
                size = S::largest_magnitude(&[scale, unknown.max_norm()]);
            }
            active = active & !convergence.observe(outcome.update, size);
            if !active.any() {
                break;
            }
        }
        report.residual = largest(residual);
        if active.any() {
            leave(&mut failed, active, convergence.growing());
        }
        failed
    }
}

/// Iterations, lane by lane where there are several.
#[derive(Default)]
struct Count<S> {
    all: u32,
    lanes: S,
}

impl<S: Scalar> Count<S> {
    /// Adds one in some lanes; returns their number in all.
    #[inline(always)]
    fn add(&mut self, active: S::Mask) -> u32 {
        self.all += 1;
        if S::LANES > 1 {
            self.lanes += S::select(active, S::one(), S::zero());
        }
        self.all
    }

    /// That of the lane that took most.
    #[inline(always)]
    fn most(&self) -> u32 {
        if S::LANES > 1 {
            largest(self.lanes) as u32
        } else {
            self.all
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

/// Lanes whose updates did not shrink to the tolerance, or grew.
#[cold]
fn leave<M: Mask>(failed: &mut Option<(FailureReason, u64)>, active: M, growing: M) {
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
