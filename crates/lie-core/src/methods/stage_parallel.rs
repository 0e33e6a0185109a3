//! The stepper of Gauss methods whose stages are evaluated together.

mod slopes;

use super::implicit::{ImplicitStepper, clear, equal_lanes};
use super::stepper::{FactorSink, RungeKutta, Stage, StepFailure, StepReport, Stepper};
use crate::equation::Equation;
use crate::generic::StageParallel;
use crate::matrix::SquareMatrix;
use crate::newton::{FailureReason, Iteration, NewtonOptions};
use crate::poisson::{Poisson, Widen};
use crate::scalar::{Mask, Scalar};
use crate::state::{Stages, State, Unknown};
use slopes::Ruled;
pub use slopes::{Field, Slopes, WideState};

/// Newton's iteration of a method whose stages are evaluated together takes a full matrix of so many rows at most, 0.5 MB in
/// double precision.
pub const MOST_UNKNOWNS: usize = 256;

/// A step of a method by Newton's iteration: of a size, from a state, which becomes its end. The increments of the stages are shown.
pub(super) type ByNewton<S, P> = fn(
    &P,
    S,
    &NewtonOptions,
    &mut <P as Poisson<S>>::State,
    &mut dyn FnMut(&[<P as Poisson<S>>::State]),
) -> Result<StepReport, StepFailure>;

/// An equation for the increments of so many stages.
type OfStages<'e, S, V, M, const STAGES: usize> =
    &'e mut dyn Equation<S, State = V, Unknown = Stages<V, STAGES>, Matrix = M>;

/// A step by Newton's iteration with the equation of a method; `zero` is any state of the right size.
pub(super) fn solve<S, V, M, const STAGES: usize>(
    (equation, zero): (OfStages<'_, S, V, M, STAGES>, V),
    options: &NewtonOptions,
    mu: &mut V,
    show: &mut dyn FnMut(&[V]),
) -> Result<StepReport, StepFailure>
where
    S: Scalar,
    V: State<S>,
    M: SquareMatrix<S>,
{
    let mut stepper = ImplicitStepper::new(equation, zero, options);
    let outcome = stepper.step(mu, &mut ());
    show(&stepper.unknown().0);
    outcome
}

/// A collocation method by fixed-point iteration with all stages in one register; a step on which that does not contract
/// is solved by Newton's iteration, and refused where that has more than 256 unknowns.
///
/// The iteration starts from the polynomial of the last step where the state is the one that step led to.
pub struct StageParallelStepper<'a, S: Scalar, P: Widen<S>, F> {
    system: &'a P,
    wide: P::Widened,
    rule: F,
    step: S,
    stages: StageParallel<S, WideState<S, P>>,
    newton: NewtonOptions,
    by_newton: ByNewton<S, P>,
    /// The state at which the last step ended, in the lanes where one did.
    end: P::State,
    follows: S::Mask,
    next: P::State,
    wide_scratch: WideState<S, P>,
}

impl<'a, S, P, F> StageParallelStepper<'a, S, P, F>
where
    S: Scalar,
    P: Widen<S>,
    F: Slopes<'a, S, P>,
{
    /// With so many stages, and their steps by Newton's iteration.
    pub(super) fn new(
        (stages, by_newton): (usize, ByNewton<S, P>),
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> Self {
        let wide = system.widen();
        let zero = wide.zero_state();
        let stages = StageParallel::new(stages, h, zero.clone(), newton).with_clock(system.clock());
        let rule = F::new(system, &wide, h);
        Self {
            system,
            wide,
            step: h,
            stages: stages.by_programs_of(system, rule.known()),
            rule,
            newton: *newton,
            by_newton,
            end: system.zero_state(),
            follows: S::Mask::splat(false),
            next: system.zero_state(),
            wide_scratch: zero,
        }
    }

    /// Whether the fixed point is tried: not where the options ask for Newton's iteration, or a simplified one.
    fn by_fixed_point(&self) -> bool {
        let asked = matches!(
            self.newton.iteration,
            Iteration::Automatic | Iteration::FixedPoint
        );
        asked || !self.has_newton()
    }

    /// Whether a step can be solved by Newton's iteration.
    fn has_newton(&self) -> bool {
        self.stages.count() * self.system.dimension() <= MOST_UNKNOWNS && self.system.has_jacobian()
    }

    /// The step by Newton's iteration, in the lanes that are left.
    #[cold]
    #[inline(never)]
    fn by_newton(
        &mut self,
        mu: &P::State,
        left: S::Mask,
        report: &mut StepReport,
    ) -> Option<StepFailure> {
        let options = NewtonOptions {
            iteration: match self.newton.iteration {
                Iteration::Automatic => Iteration::Newton,
                chosen => chosen,
            },
            ..self.newton
        };
        let mut end = mu.clone();
        let stages = &mut self.stages;
        let outcome =
            (self.by_newton)(self.system, self.step, &options, &mut end, &mut |unknown| {
                stages.set_increments_where(left, |stage, k| unknown[stage].as_slice()[k]);
            });
        let (solved, failure) = match outcome {
            Ok(solved) => (solved, None),
            Err(failure) => (failure.report, Some(failure)),
        };
        report.evaluations += solved.evaluations;
        report.iterations += solved.iterations;
        report.factorizations += solved.factorizations;
        report.residual = solved.residual;
        report.pivoted = solved.pivoted & left.bits();
        self.next.assign_where(left, &end);
        self.stages.set_base(left, end.as_slice());
        failure
            .map(|failure| StepFailure {
                lanes: failure.lanes & left.bits(),
                ..failure
            })
            .filter(|failure| failure.lanes != 0)
    }

    /// Gives away h times the directions at the stages of the step from `base` to the next state.
    fn give_velocities<K: FactorSink<P::State>>(
        &mut self,
        base: &P::State,
        failed: S::Mask,
        sink: &mut K,
    ) {
        let at = self.stages.stages(base.as_slice());
        self.rule.directions(&self.wide, at, &mut self.wide_scratch);
        self.stages
            .set_base(S::Mask::splat(true), self.next.as_slice());
        let xi = self.system.zero_state();
        let count = self.stages.count();
        push_velocities(count, self.step, &self.wide_scratch, xi, failed, sink);
    }
}

impl<'a, S, P, F> Stepper<S> for StageParallelStepper<'a, S, P, F>
where
    S: Scalar,
    P: Widen<S>,
    F: Slopes<'a, S, P>,
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
            self.system.vector_field(mu, &mut self.next);
            self.stages
                .start(!follows, mu.as_slice(), self.next.as_slice());
        }
        let mut report = StepReport {
            evaluations: u32::from(!follows.all()),
            substeps: 1,
            ..StepReport::default()
        };
        let mut left = S::Mask::splat(true);
        if self.by_fixed_point() {
            let (wide, rule) = (&self.wide, &mut self.rule);
            let solved = self.stages.iterate_by(Ruled::<S, P, F> { wide, rule });
            self.stages.advance();
            self.stages.base_into(self.next.as_mut_slice());
            report.evaluations += solved.iterations;
            report.iterations = solved.iterations;
            report.fixed_point = solved.iterations;
            report.residual = solved.residual;
            left = !solved.converged;
        }
        let mut failure = None;
        if left.any() {
            failure = if self.newton.iteration == Iteration::FixedPoint || !self.has_newton() {
                Some(StepFailure {
                    reason: FailureReason::NotConverged,
                    lanes: left.bits(),
                    report,
                })
            } else {
                self.by_newton(mu, left, &mut report)
            };
        }
        let solved = !S::Mask::from_bits(failure.map_or(0, |failure| failure.lanes));
        let finite = self.next.finite();
        let stages = &self.stages;
        let increments = |out: &mut [P::State]| stages.increments(out);
        let resolved = self.rule.resolved(mu, &self.next, increments);
        for (bad, reason) in [
            (solved & !finite, FailureReason::NotFinite),
            (solved & finite & !resolved, FailureReason::Unresolved),
        ] {
            if bad.any() {
                let first = StepFailure {
                    reason,
                    lanes: 0,
                    report,
                };
                failure.get_or_insert(first).lanes |= bad.bits();
            }
        }
        let good = solved & finite & resolved;
        if sink.is_active() && good.any() {
            self.give_velocities(mu, !good, sink);
        }
        mu.assign_where(good, &self.next);
        self.end.copy_from(mu);
        self.follows = good;
        failure.map_or(Ok(report), |failure| Err(StepFailure { report, ..failure }))
    }

    fn estimate(&mut self) -> Option<S> {
        Some(self.stages.estimate())
    }

    fn set_step(&mut self, h: S) -> bool {
        if !self.rule.set_step(h) {
            return false;
        }
        self.step = h;
        self.stages.set_step(h);
        true
    }
}

/// Gives away h times the directions at so many stages, one stage after the other; `xi` is any state of the right size.
pub(super) fn push_velocities<S, V, W, K>(
    count: usize,
    step: S,
    gradients: &W,
    mut xi: V,
    failed: S::Mask,
    sink: &mut K,
) where
    S: Scalar,
    V: State<S>,
    W: State<S::Wide>,
    K: FactorSink<V>,
{
    for index in 0..count {
        let entries = xi.as_mut_slice().iter_mut();
        for (entry, &gradients) in entries.zip(gradients.as_slice()) {
            *entry = step * S::scatter(gradients)[index];
        }
        clear(&mut xi, failed);
        sink.push_velocity(RungeKutta::Gauss, Stage { index, count }, &xi);
    }
}
