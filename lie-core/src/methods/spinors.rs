//! The stepper of collective methods over the Hopf map whose stages are evaluated together.

use super::stage_parallel::{give, same};
use super::stepper::{FactorSink, StepFailure, StepReport, Stepper};
use crate::generic::{StageParallel, flow_of_spinors, spinors_of, spins_of};
use crate::newton::{FailureReason, NewtonOptions};
use crate::poisson::{Poisson, Widen};
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};
use crate::structure::SpinPoisson;

type Wide<S, P> = <P as Widen<S>>::Widened;
type WideState<S, P> = <Wide<S, P> as Poisson<<S as Scalar>::Wide>>::State;
type WideSpinors<S, P> = <Wide<S, P> as SpinPoisson<<S as Scalar>::Wide>>::Spinors;

/// Lifts a state to `T*R^2` for each spin, makes a Gauss step of `H o J` with all stages in one register, and takes J of its
/// end.
///
/// The point is kept from step to step where the state is the one that the last step led to; the step depends on the state
/// alone, because turning the point about its fibre commutes with it.
pub struct SpinorStepper<'a, S, P, const STAGES: usize>
where
    S: Scalar,
    P: SpinPoisson<S> + Widen<S>,
    P::Widened: SpinPoisson<S::Wide>,
{
    system: &'a P,
    wide: P::Widened,
    step: S,
    stages: StageParallel<S, WideSpinors<S, P>, STAGES>,
    point: P::Spinors,
    base: P::Spinors,
    end: P::State,
    next: P::State,
    follows: S::Mask,
    momenta: WideState<S, P>,
    gradient: WideState<S, P>,
}

impl<'a, S, P, const STAGES: usize> SpinorStepper<'a, S, P, STAGES>
where
    S: Scalar,
    P: SpinPoisson<S> + Widen<S>,
    P::Widened: SpinPoisson<S::Wide>,
{
    pub(super) fn new(system: &'a P, h: S, newton: &NewtonOptions) -> Self {
        let wide = system.widen();
        let momenta = wide.zero_state();
        Self {
            stages: StageParallel::new(h, wide.zero_spinors(), newton),
            point: system.zero_spinors(),
            base: system.zero_spinors(),
            end: system.zero_state(),
            next: system.zero_state(),
            follows: S::Mask::splat(false),
            gradient: momenta.clone(),
            momenta,
            wide,
            step: h,
            system,
        }
    }

    /// The slope at the point over a state, for stages that start alike.
    fn start(&mut self, mu: &P::State, fresh: S::Mask) {
        let mut lifted = self.system.zero_spinors();
        spinors_of(self.system, mu, &mut lifted);
        self.point.assign_where(fresh, &lifted);
        let mut slope = self.system.zero_spinors();
        self.system.gradient(mu, &mut self.next);
        flow_of_spinors(self.system, &self.point, &self.next, &mut slope);
        self.stages.start_with(fresh, slope.as_slice());
    }

    /// Gives away `h grad H` at the stages of the last step.
    fn give_velocities<K: FactorSink<P::State>>(&mut self, failed: S::Mask, sink: &mut K) {
        let (_, points) = self.stages.stages(self.base.as_slice());
        spins_of(&self.wide, points, &mut self.momenta);
        self.wide.gradient(&self.momenta, &mut self.gradient);
        let xi = self.system.zero_state();
        give::<S, _, _, _, STAGES>(self.step, &self.gradient, xi, failed, sink);
    }
}

impl<S, P, const STAGES: usize> Stepper<S> for SpinorStepper<'_, S, P, STAGES>
where
    S: Scalar,
    P: SpinPoisson<S> + Widen<S>,
    P::Widened: SpinPoisson<S::Wide>,
{
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let follows = self.follows & same(&self.end, mu);
        if follows.any() {
            self.stages.go_on();
        }
        if !follows.all() {
            self.start(mu, !follows);
        }
        let (wide, momenta, gradient) = (&self.wide, &mut self.momenta, &mut self.gradient);
        let solved = self
            .stages
            .iterate(self.point.as_slice(), |_, points, slopes| {
                spins_of(wide, points, momenta);
                wide.gradient(momenta, gradient);
                flow_of_spinors(wide, points, gradient, slopes);
            });
        self.base.copy_from(&self.point);
        self.stages.advance(self.point.as_mut_slice());
        spins_of(self.system, &self.point, &mut self.next);
        let report = StepReport {
            evaluations: solved.iterations + u32::from(!follows.all()),
            iterations: solved.iterations,
            fixed_point: solved.iterations,
            residual: solved.residual,
            substeps: 1,
            ..StepReport::default()
        };
        let finite = self.next.finite();
        let good = solved.converged & finite;
        if K::ACTIVE && good.any() {
            self.give_velocities(!good, sink);
        }
        mu.assign_where(good, &self.next);
        self.end.copy_from(mu);
        self.follows = good;
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
}
