//! The stepper of collective methods over a declared realization.

use super::implicit::clear;
use super::stepper::{FactorSink, RungeKutta, Stage, StepFailure, StepReport, Stepper};
use crate::equation::Equation;
use crate::generic::{Canonical, Gauss, Lifting, direction, gauss_tableau};
use crate::matrix::StageMatrix;
use crate::newton::{FailureReason, Newton, NewtonOptions};
use crate::scalar::{Mask, Scalar};
use crate::state::{Stages, State, Unknown};
use crate::structure::RealizedPoisson;

/// Lifts a state, makes a Gauss step of the canonical system of `H o J`, and takes J of its end.
///
/// The point is kept from step to step: where the state is the one that the last step led to, lifting moves it
/// by round-off alone.
pub struct RealizedStepper<'a, S, P, const STAGES: usize>
where
    S: Scalar,
    P: RealizedPoisson<S>,
{
    system: &'a P,
    step: S,
    point: P::Point,
    next: P::Point,
    unknown: Stages<P::Point, STAGES>,
    solver: Newton<S, Stages<P::Point, STAGES>, StageMatrix<P::PointMatrix, STAGES>>,
    lifting: Lifting<P::State, P::Jacobian, P::Point>,
    end: P::State,
    /// No step has been made yet.
    fresh: bool,
}

impl<'a, S, P, const STAGES: usize> RealizedStepper<'a, S, P, STAGES>
where
    S: Scalar,
    P: RealizedPoisson<S>,
{
    pub(super) fn new(system: &'a P, h: S, newton: &NewtonOptions) -> Self {
        let canonical = Canonical::over(system);
        let equation = Gauss::<S, _, STAGES>::new(&canonical, h);
        let mut point = system.zero_point();
        system.start(&mut point);
        Self {
            system,
            step: h,
            next: point.clone(),
            point,
            unknown: equation.zero_unknown(),
            solver: Newton::new(&equation, newton),
            lifting: Lifting::new(system),
            end: system.zero_state(),
            fresh: true,
        }
    }
}

impl<S, P, const STAGES: usize> RealizedStepper<'_, S, P, STAGES>
where
    S: Scalar,
    P: RealizedPoisson<S>,
{
    /// Gives away `h grad H` at the stages of the step whose increments have been solved for, from `base`.
    fn give_velocities<K: FactorSink<P::State>>(
        &mut self,
        base: &P::Point,
        failed: S::Mask,
        sink: &mut K,
    ) {
        let tableau = gauss_tableau::<S, STAGES>();
        let mut xi = self.system.zero_state();
        for (index, row) in tableau.a.iter().enumerate() {
            self.next.copy_from(base);
            for (&weight, increment) in row.iter().zip(&self.unknown.0) {
                self.next.axpy(weight, increment);
            }
            self.system.momentum_map(&self.next, &mut self.end);
            direction(self.system, self.step, &self.end, &mut xi);
            clear(&mut xi, failed);
            let stage = Stage {
                index,
                count: STAGES,
            };
            sink.push_velocity(RungeKutta::Gauss, stage, &xi);
        }
    }
}

impl<S, P, const STAGES: usize> Stepper<S> for RealizedStepper<'_, S, P, STAGES>
where
    S: Scalar,
    P: RealizedPoisson<S>,
{
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let mut base = self.point.clone();
        if self.fresh && !P::START_GIVEN {
            self.lifting.scale(self.system, mu, &mut base);
        }
        self.fresh = false;
        let lifted = self.lifting.lift(self.system, mu, &mut base);
        let canonical = Canonical::over(self.system);
        let mut equation = Gauss::<S, _, STAGES>::new(&canonical, self.step);
        equation.set_base(&base);
        equation.initial_guess(&mut self.unknown);
        let scale = base.max_norm();
        let solved = self.solver.solve(&mut equation, &mut self.unknown, scale);
        let (report, mut failure) = match solved {
            Ok(report) => (StepReport::implicit(&report), None),
            Err(failure) => {
                let failure = StepFailure::of_solver(&failure);
                (failure.report, Some(failure))
            }
        };
        equation.result(&self.unknown, &mut self.next);
        self.system.momentum_map(&self.next, &mut self.end);
        let finite = self.end.finite();
        let solved = !S::Mask::from_bits(failure.map_or(0, |failure| failure.lanes));
        for (bad, reason) in [
            (!lifted, FailureReason::NoLift),
            (lifted & solved & !finite, FailureReason::NotFinite),
        ] {
            if bad.any() {
                let first = StepFailure {
                    reason,
                    lanes: 0,
                    report,
                };
                let known = failure.get_or_insert(first);
                if reason == FailureReason::NoLift {
                    known.reason = reason;
                }
                known.lanes |= bad.bits();
            }
        }
        let good = lifted & solved & finite;
        mu.assign_where(good, &self.end);
        self.point.assign_where(good, &self.next);
        if K::ACTIVE && good.any() {
            self.give_velocities(&base, !good, sink);
        }
        failure.map_or(Ok(report), Err)
    }
}
