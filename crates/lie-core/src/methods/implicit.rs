//! The stepper of every method whose step is one nonlinear equation.

use super::stepper::{FactorSink, RungeKutta, Stage, StepFailure, StepReport, Stepper};
use crate::clock::{Clock, holds};
use crate::equation::Equation;
use crate::newton::{
    Failure, FailureReason, Newton, NewtonOptions, NewtonReport, Predictor, Start,
};
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Solves the equation of a step and takes over its result.
pub struct ImplicitStepper<S: Scalar, E: Equation<S>> {
    equation: E,
    newton: Newton<S, E::Unknown, E::Matrix>,
    unknown: E::Unknown,
    next: E::State,
    predictor: Predictor<S, E::Unknown>,
    /// The state at the end of the last step.
    last: E::State,
}

impl<S: Scalar, E: Equation<S>> ImplicitStepper<S, E> {
    /// A stepper for an equation; `zero` is any state of the right size.
    pub fn new(equation: E, zero: E::State, options: &NewtonOptions) -> Self {
        let newton = Newton::new(&equation, options);
        let unknown = equation.zero_unknown();
        Self {
            equation,
            predictor: Predictor::new(&unknown),
            newton,
            unknown,
            last: zero.clone(),
            next: zero,
        }
    }

    /// The solution of the last step's equation.
    pub fn unknown(&self) -> &E::Unknown {
        &self.unknown
    }

    /// Looks at the equation with the solution of the last step.
    pub(super) fn with_solution<'s, T>(
        &'s mut self,
        look: impl FnOnce(&'s mut E, &'s E::Unknown) -> T,
    ) -> T {
        look(&mut self.equation, &self.unknown)
    }

    /// Advances one step without a sink. `step` is compiled once for each kind of sink: in optimised programs each of them contains this;
    /// in the development profile it is called, for it would be a fifth of what is compiled there.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn advance(&mut self, mu: &mut E::State) -> Result<StepReport, StepFailure> {
        self.equation.set_base(mu);
        let attempts = self.newton.attempts();
        let follows = equal_lanes(self.equation.clock(), mu, &self.last);
        let predicted = self.predictor.ready(follows) & attempts.predictable();
        if predicted.all() {
            self.unknown.assign_where(predicted, self.predictor.next());
        } else {
            self.equation.initial_guess(&mut self.unknown);
            if predicted.any() {
                self.unknown.assign_where(predicted, self.predictor.next());
            }
        }
        self.equation.leave_out(&mut self.unknown);
        let scale = self.equation.scale(mu);
        let solved = self.newton.solve_trying(
            &mut self.equation,
            &mut self.unknown,
            scale,
            attempts,
            &Start {
                predicted,
                shows: self.predictor.begins(),
                before: Some(self.predictor.last()),
            },
        );
        self.equation.result(&self.unknown, &mut self.next);
        let finite = self.next.finite();
        let charted = self.equation.within_chart(&self.unknown);
        let resolved = self.equation.resolved(&self.unknown, &self.next);
        if let Ok(report) = &solved
            && (finite & charted & resolved).all()
        {
            mu.copy_from(&self.next);
            self.remember(scale, predicted, attempts.predictable());
            return Ok(StepReport::implicit(report));
        }
        let outcome = refuse(mu, &self.next, solved, [finite, charted, resolved]);
        self.remember(scale, predicted, attempts.predictable());
        if let Err(failure) = &outcome {
            self.predictor.forget(S::Mask::from_bits(failure.lanes));
        }
        outcome
    }

    /// Takes the solution for the next prediction.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn remember(&mut self, scale: S, predicted: S::Mask, predictable: S::Mask) {
        if !predictable.any() {
            // the next one that is follows none that was taken
            self.predictor.forget(S::Mask::splat(true));
            return;
        }
        self.last.copy_from(&self.next);
        if !predicted.all() {
            let clock = self.equation.clock();
            self.predictor
                .examine(&self.unknown, scale, predicted, clock);
        }
        self.predictor.record(&self.unknown);
        if !predictable.all() {
            self.predictor.forget(!predictable);
        }
        let far = self.newton.started_far();
        if far.any() {
            self.predictor.rest(far);
        }
    }
}

/// Takes over the step in the lanes where nothing is against it, and says what is in the others. It does not depend on the equation.
#[cold]
#[inline(never)]
fn refuse<S: Scalar, V: State<S>>(
    mu: &mut V,
    next: &V,
    solved: Result<NewtonReport, Failure>,
    [finite, charted, resolved]: [S::Mask; 3],
) -> Result<StepReport, StepFailure> {
    let (report, mut failure) = match solved {
        Ok(report) => (StepReport::implicit(&report), None),
        Err(failure) => {
            let failure = StepFailure::of_solver(&failure);
            (failure.report, Some(failure))
        }
    };
    let good = !S::Mask::from_bits(failure.map_or(0, |failure| failure.lanes));
    mu.assign_where(good & finite & charted & resolved, next);
    for (bad, reason) in [
        (good & !finite, FailureReason::NotFinite),
        (good & finite & !charted, FailureReason::OutsideChart),
        (
            good & finite & charted & !resolved,
            FailureReason::Unresolved,
        ),
    ] {
        if bad.any() {
            let lanes = bad.bits();
            let first = StepFailure {
                reason,
                lanes: 0,
                report,
            };
            failure.get_or_insert(first).lanes |= lanes;
        }
    }
    failure.map_or(Ok(report), Err)
}

impl<S: Scalar, E: Equation<S>> Stepper<S> for ImplicitStepper<S, E> {
    type State = E::State;

    fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) -> bool {
        self.last.as_mut_slice().iter_mut().for_each(&mut *visit);
        self.predictor.carry(visit);
        self.newton.carry(visit);
        true
    }

    fn step<K: FactorSink<E::State>>(
        &mut self,
        mu: &mut E::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let outcome = self.advance(mu);
        if sink.is_active() {
            let failed = S::Mask::from_bits(outcome.map_or_else(|failure| failure.lanes, |_| 0));
            // the state at the end has been taken over: its place is free
            let factor = &mut self.next;
            if failed.all() {
                return outcome;
            }
            if let Some(retraction) = self.equation.earlier_factor(&self.unknown, factor) {
                clear(factor, failed);
                sink.push(retraction, factor);
            }
            if let Some(retraction) = self.equation.group_factor(&self.unknown, factor) {
                clear(factor, failed);
                sink.push(retraction, factor);
                return outcome;
            }
            let mut index = 0;
            loop {
                let count = self.equation.velocity(&self.unknown, index, factor);
                if index >= count {
                    break;
                }
                clear(factor, failed);
                sink.push_velocity(RungeKutta::Gauss, Stage { index, count }, factor);
                index += 1;
                if index == count {
                    break;
                }
            }
        }
        outcome
    }
}

/// The lanes in which two states are equal but for the time, which a driver sets after each step.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn equal_lanes<S: Scalar, V: State<S>>(
    clock: Option<Clock>,
    one: &V,
    other: &V,
) -> S::Mask {
    let (one, other) = (one.as_slice(), other.as_slice());
    if S::LANES == 1 && clock.is_none() {
        return S::Mask::splat(one == other);
    }
    let mut equal = S::Mask::splat(true);
    for (i, (&one, &other)) in one.iter().zip(other).enumerate() {
        if !holds(clock, i) {
            equal = equal & one.less_equal(other) & other.less_equal(one);
            if S::DERIVATIVES > 0 {
                // a tangent that was made another one is another state
                equal = equal & (one - other).magnitude().less_equal(S::zero());
            }
        }
    }
    equal
}

/// Sets the lanes of a mask to 0.
pub(super) fn clear<S: Scalar, V: State<S>>(xi: &mut V, failed: S::Mask) {
    for entry in xi.as_mut_slice() {
        *entry = S::select(failed, S::zero(), *entry);
    }
}
