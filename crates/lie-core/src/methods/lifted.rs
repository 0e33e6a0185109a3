//! The stepper of collective methods whose stages are evaluated together.

use super::implicit::equal_lanes;
use super::stage_parallel::push_velocities;
use super::stepper::{FactorSink, StepFailure, StepReport, Stepper};
use crate::generic::{LinearLift, StageParallel};
use crate::newton::{FailureReason, NewtonOptions};
use crate::poisson::{LiePoisson, Poisson, Widen};
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Points this many times as large as one that is chosen over the state are chosen anew.
const GROWTH: f64 = 2.0;

/// By how much the error of a step is larger for the momentum than for its point, to which it is quadratic: measured on random systems.
const OF_MOMENTA: f64 = 10.0;

type Wide<S, P> = <P as Widen<S>>::Widened;
type WideState<S, P> = <Wide<S, P> as Poisson<<S as Scalar>::Wide>>::State;
type WidePoint<S, P, L> = <L as LinearLift<<S as Scalar>::Wide, Wide<S, P>>>::Point;
type WideLabels<S, P, L> = <L as LinearLift<<S as Scalar>::Wide, Wide<S, P>>>::Labels;

/// A lift of a system and of the same system over eight numbers at once.
pub trait StageLift<S, P>: LinearLift<S, P> + LinearLift<S::Wide, P::Widened>
where
    S: Scalar,
    P: LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
{
}

impl<S, P, L> StageLift<S, P> for L
where
    S: Scalar,
    P: LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
    L: LinearLift<S, P> + LinearLift<S::Wide, P::Widened>,
{
}

/// Lifts a state to a linear symplectic space over g*, makes a Gauss step of `H o J` with all stages in one register, and
/// takes J of its end.
///
/// The point is kept from step to step where the state is the one that the last step led to; the step depends on the state
/// alone, because moving the point over its state commutes with it.
pub struct LiftedStepper<'a, S, P, L>
where
    S: Scalar,
    P: LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
    L: StageLift<S, P>,
{
    system: &'a P,
    wide: P::Widened,
    step: S,
    stages: StageParallel<S, WidePoint<S, P, L>>,
    /// A point over the state at which the last chain of steps began.
    point: <L as LinearLift<S, P>>::Point,
    labels: <L as LinearLift<S, P>>::Labels,
    wide_labels: WideLabels<S, P, L>,
    /// How large the point was when it was chosen.
    size: S,
    momenta: WideState<S, P>,
    end: P::State,
    next: P::State,
    follows: S::Mask,
}

impl<'a, S, P, L> LiftedStepper<'a, S, P, L>
where
    S: Scalar,
    P: LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
    L: StageLift<S, P>,
{
    pub(super) fn new(stages: usize, system: &'a P, h: S, newton: &NewtonOptions) -> Self {
        let wide = system.widen();
        let newton = newton.for_a_poisson_map();
        let point = <L as LinearLift<S, P>>::zero_point(system);
        Self {
            stages: StageParallel::new(stages, h, L::zero_point(&wide), &newton)
                .with_clock(<L as LinearLift<S, P>>::clock(system))
                .with_momenta(<L as LinearLift<S, P>>::momenta(system))
                .by_programs_of(system, <L as LinearLift<S, P>>::SLOPES),
            point,
            labels: <L as LinearLift<S, P>>::zero_labels(system),
            wide_labels: L::zero_labels(&wide),
            size: S::zero(),
            momenta: wide.zero_state(),
            end: system.zero_state(),
            next: system.zero_state(),
            follows: S::Mask::splat(false),
            wide,
            step: h,
            system,
        }
    }

    /// A point over the state, in the lanes of a mask, and its slope for stages that start alike.
    #[inline(never)]
    fn start(&mut self, mu: &P::State, fresh: S::Mask) {
        let system = self.system;
        let mut point = <L as LinearLift<S, P>>::zero_point(system);
        let mut labels = <L as LinearLift<S, P>>::zero_labels(system);
        <L as LinearLift<S, P>>::lift(system, mu, &mut labels, &mut point);
        self.point.assign_where(fresh, &point);
        self.labels.assign_where(fresh, &labels);
        let entries = self.wide_labels.as_mut_slice().iter_mut();
        for (wide, label) in entries.zip(self.labels.as_slice()) {
            *wide = label.widen();
        }
        self.stages.set_labels(self.wide_labels.as_slice());
        self.stages.set_unit(fresh, point.as_slice());
        if <L as LinearLift<S, P>>::GROWS {
            let size = self.stages.norm(point.as_slice());
            self.size = S::select(fresh, size, self.size);
        }
        <L as LinearLift<S, P>>::flow(system, &self.labels, &self.point, &mut point);
        self.stages
            .start(fresh, self.point.as_slice(), point.as_slice());
        let (wide, labels) = (&self.wide, &self.wide_labels);
        self.stages.approach(fresh, |at, slopes| {
            L::flow(wide, labels, at.points, slopes);
        });
    }

    /// Moves the point over the state at which a step has ended.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn settle(&mut self) {
        let (point, increments) = self.stages.base_and_increments();
        <L as LinearLift<S::Wide, P::Widened>>::settle(&self.wide, point, increments);
    }

    /// The lanes whose point has become large.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn grown(&mut self) -> S::Mask {
        if <L as LinearLift<S, P>>::GROWS {
            self.stages.base_into(self.point.as_mut_slice());
            let size = self.stages.norm(self.point.as_slice());
            !size.less_equal(self.size * S::from_f64(GROWTH))
        } else {
            S::Mask::splat(false)
        }
    }

    /// Gives away h times the generator at the stages of the last step, which began at `self.point`.
    fn give_velocities<K: FactorSink<P::State>>(&mut self, failed: S::Mask, sink: &mut K) {
        let mut end = self.point.clone();
        self.stages.base_into(end.as_mut_slice());
        let at = self.stages.stages(self.point.as_slice());
        let mut generator: WideState<S, P> = self.wide.zero_state();
        L::project(&self.wide, &self.wide_labels, at.points, &mut self.momenta);
        self.wide.generator(&self.momenta, &mut generator);
        self.stages.set_base(S::Mask::splat(true), end.as_slice());
        let xi = self.system.zero_state();
        let count = self.stages.count();
        push_velocities(count, self.step, &generator, xi, failed, sink);
    }
}

impl<S, P, L> Stepper<S> for LiftedStepper<'_, S, P, L>
where
    S: Scalar,
    P: LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
    L: StageLift<S, P>,
{
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let clock = self.system.clock();
        let follows = self.follows & equal_lanes(clock, &self.end, mu);
        if let Some(clock) = clock {
            self.stages.set_time(mu.as_slice()[clock.time]);
        }
        if follows.any() {
            self.stages.go_on();
        }
        if !follows.all() {
            self.start(mu, !follows);
        }
        let (wide, labels) = (&self.wide, &self.wide_labels);
        let solved = self.stages.iterate(|at, slopes| {
            L::flow(wide, labels, at.points, slopes);
        });
        if sink.is_active() {
            self.stages.base_into(self.point.as_mut_slice());
        }
        self.stages.advance();
        let (point, _) = self.stages.base_and_increments();
        L::project(wide, labels, point, &mut self.momenta);
        let entries = self.next.as_mut_slice().iter_mut();
        for (next, wide) in entries.zip(self.momenta.as_slice()) {
            let [entry, ..] = S::scatter(*wide);
            *next = entry;
        }
        let report = StepReport {
            evaluations: solved.iterations + u32::from(!follows.all()),
            iterations: solved.iterations,
            residual: solved.residual,
            substeps: 1,
            ..StepReport::default()
        };
        let finite = self.next.finite();
        let good = solved.converged & finite;
        if sink.is_active() && good.any() {
            self.give_velocities(!good, sink);
        }
        self.settle();
        mu.assign_where(good, &self.next);
        self.end.copy_from(mu);
        self.follows = good & !self.grown();
        if good.all() {
            return Ok(report);
        }
        let first = 1 << (!good).bits().trailing_zeros();
        let reason = if (!solved.converged).bits() & first == 0 {
            FailureReason::NotFinite
        } else {
            FailureReason::NotConverged
        };
        let lanes = (!good).bits();
        Err(StepFailure {
            reason,
            lanes,
            report,
        })
    }

    fn estimate(&mut self) -> Option<S> {
        Some(self.stages.estimate() * S::from_f64(OF_MOMENTA))
    }

    fn set_step(&mut self, h: S) -> bool {
        self.step = h;
        self.stages.set_step(h);
        true
    }
}
