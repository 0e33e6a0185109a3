//! The stepper of collective methods over a declared realization.

use super::implicit::clear;
use super::stepper::{FactorSink, RungeKutta, Stage, StepFailure, StepReport, Stepper};
use crate::equation::Equation;
use crate::generic::{Canonical, Gauss, Lifting, direction, gauss_tableau, invertible_along};
use crate::matrix::{SquareMatrix as _, StageMatrix};
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
    motion: StageMatrix<P::PointMatrix, STAGES>,
    /// No step has been made yet.
    fresh: bool,
}

impl<'a, S, P, const STAGES: usize> RealizedStepper<'a, S, P, STAGES>
where
    S: Scalar,
    P: RealizedPoisson<S>,
{
    pub(super) fn new(system: &'a P, h: S, newton: &NewtonOptions) -> Self {
        let canonical = Canonical::new(system);
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
            motion: equation.zero_matrix(),
            fresh: true,
        }
    }
}

impl<S, P, const STAGES: usize> RealizedStepper<'_, S, P, STAGES>
where
    S: Scalar,
    P: RealizedPoisson<S>,
{
    /// The lanes in which the stages exist for every part of the step, from `base`: `1 - s A B` has an inverse for s from
    /// 0 to 1, with `B_j` the matrices of the flows along which the stages move.
    fn within_chart(&mut self, base: &P::Point) -> S::Mask {
        let tableau = gauss_tableau::<S, STAGES>();
        let half = self.system.point_dimension() / 2;
        let mut xi = self.system.zero_state();
        let mut second = self.system.zero_point_matrix();
        let mut bound = [S::zero(); STAGES];
        for (j, row) in tableau.ratios.iter().enumerate() {
            self.next.copy_from(base);
            for (&ratio, increment) in row.iter().zip(&self.unknown.0) {
                self.next.axpy(ratio, increment);
            }
            self.system.momentum_map(&self.next, &mut self.end);
            direction(self.system, self.step * tableau.b[j], &self.end, &mut xi);
            self.system.curvature(&self.next, &xi, &mut second);
            let mut size = S::zero();
            for r in 0..self.system.point_dimension() {
                let mut sum = S::zero();
                for c in 0..self.system.point_dimension() {
                    // row r of the flow's matrix
                    let entry = if r < half {
                        -second.get(half + r, c)
                    } else {
                        second.get(r - half, c)
                    };
                    sum += entry.abs();
                    for (i, ratios) in tableau.ratios.iter().enumerate() {
                        self.motion.0[i][j].set(r, c, ratios[j] * entry);
                    }
                }
                size = size.max(sum);
            }
            for (bound, ratios) in bound.iter_mut().zip(&tableau.ratios) {
                *bound += ratios[j].abs() * size;
            }
        }
        let largest = bound.iter().fold(S::zero(), |most, &bound| most.max(bound));
        let near = largest.less(S::one());
        if near.all() {
            return near;
        }
        near | invertible_along(&self.motion, None)
    }

    /// Gives away `h grad H` at the stages of the step whose increments have been solved for, from `base`.
    fn give_velocities<K: FactorSink<P::State>>(
        &mut self,
        base: &P::Point,
        failed: S::Mask,
        sink: &mut K,
    ) {
        let tableau = gauss_tableau::<S, STAGES>();
        let mut xi = self.system.zero_state();
        for (index, row) in tableau.ratios.iter().enumerate() {
            self.next.copy_from(base);
            for (&ratio, increment) in row.iter().zip(&self.unknown.0) {
                self.next.axpy(ratio, increment);
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
        if self.fresh && !self.system.start_is_given() {
            self.lifting.scale(self.system, mu, &mut base);
        }
        self.fresh = false;
        let lifted = self.lifting.lift(self.system, mu, &mut base);
        let canonical = Canonical::new(self.system);
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
        let charted = self.within_chart(&base);
        equation.result(&self.unknown, &mut self.next);
        self.system.momentum_map(&self.next, &mut self.end);
        let finite = self.end.finite();
        let solved = !S::Mask::from_bits(failure.map_or(0, |failure| failure.lanes));
        for (bad, reason) in [
            (!lifted, FailureReason::NoLift),
            (lifted & solved & !finite, FailureReason::NotFinite),
            (
                lifted & solved & finite & !charted,
                FailureReason::OutsideChart,
            ),
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
        let good = lifted & solved & finite & charted;
        mu.assign_where(good, &self.end);
        self.point.assign_where(good, &self.next);
        if sink.is_active() && good.any() {
            self.give_velocities(&base, !good, sink);
        }
        failure.map_or(Ok(report), Err)
    }
}
