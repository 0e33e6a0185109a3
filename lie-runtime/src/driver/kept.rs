//! Methods as the driver has them: of any type, with a projection behind their steps or without.

use super::options::OptionError;
use super::problem::Problem;
use crate::diagnostics::ForgottenStepper;
use crate::methods::any;
use crate::methods::{
    FactorSink, Facts, Keep, Levels, Method, Projection, StepFailure, StepReport, Stepper as _,
};
use crate::newton::{Iteration, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown as _};

/// A method whose type is forgotten: the driver is compiled once for each system, and not once more for each method on it.
trait Steps<S: Scalar, P: Poisson<S>> {
    fn order(&self) -> u32;
    fn fixed_point(&self) -> bool;
    fn own_steps(&self) -> bool;
    fn symmetric(&self) -> bool;
    fn boxed<'a>(
        &'a self,
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn any::AnyStepper<S, P::State> + 'a>;
}

impl<S: Scalar, P: Poisson<S>, M: Method<S, P>> Steps<S, P> for M {
    fn order(&self) -> u32 {
        Facts::order(self)
    }

    fn fixed_point(&self) -> bool {
        Facts::fixed_point(self)
    }

    fn own_steps(&self) -> bool {
        Facts::own_steps(self)
    }

    fn symmetric(&self) -> bool {
        Facts::symmetric(self)
    }

    fn boxed<'a>(
        &'a self,
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn any::AnyStepper<S, P::State> + 'a> {
        Method::boxed(self, system, h, newton)
    }
}

/// A method, and the levels that are kept, if any are.
pub(super) struct Kept<'m, S: Scalar, P: Poisson<S>> {
    method: &'m dyn Steps<S, P>,
    levels: Option<Levels<S>>,
}

impl<'m, S: Scalar, P: Poisson<S>> Kept<'m, S, P> {
    /// A method alone.
    pub(super) fn alone(method: &'m impl Method<S, P>) -> Self {
        Self {
            method,
            levels: None,
        }
    }

    /// The same with the levels of a start, where some are to be kept.
    ///
    /// # Errors
    /// They cannot be kept.
    pub(super) fn keeping(
        mut self,
        problem: &Problem<S, P>,
        keep: Keep,
    ) -> Result<Self, OptionError> {
        if keep != Keep::NOTHING {
            let mu = problem.start();
            let followed = problem.system.following(&mu);
            let system = followed.as_ref().unwrap_or(&problem.system);
            self.levels = Some(Levels::at(system, &mu, keep).map_err(OptionError::Keep)?);
        }
        Ok(self)
    }

    /// Whether levels are kept.
    pub(super) fn keeps(&self) -> bool {
        self.levels.is_some()
    }

    /// See [`Facts`], as for the next two.
    pub(super) fn order(&self) -> u32 {
        self.method.order()
    }

    pub(super) fn fixed_point(&self) -> bool {
        self.method.fixed_point()
    }

    pub(super) fn own_steps(&self) -> bool {
        self.method.own_steps()
    }

    /// A projection looks at the start of the run alone, and no step of -h undoes it.
    pub(super) fn symmetric(&self) -> bool {
        self.levels.is_none() && self.method.symmetric()
    }

    /// Whether steps may be divided: of one trajectory, and those that the method does not choose itself.
    pub(super) fn may_divide(&self) -> bool {
        !self.own_steps() && S::LANES == 1
    }

    /// The solver without a Jacobian where that is worth a try: shorter steps cost less than one that needs a Jacobian.
    pub(super) fn cheap(&self, newton: NewtonOptions) -> NewtonOptions {
        let iteration = match newton.iteration {
            Iteration::Automatic if self.fixed_point() => Iteration::FixedPoint,
            other => other,
        };
        NewtonOptions {
            iteration,
            ..newton
        }
    }

    /// See [`Method::stepper`].
    pub(super) fn stepper<'a>(
        &'a self,
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> KeptStepper<'a, S, P> {
        let mut stepper = ForgottenStepper::new(self.method.boxed(system, h, newton));
        let projection = self.levels.map(|levels| Projection::new(system, levels));
        let left = projection.and_then(|projection| stepper.keep(projection));
        KeptStepper {
            stepper,
            behind: left.map(|projection| Behind {
                system,
                projection,
                before: system.zero_state(),
            }),
        }
    }
}

/// The stepper of a [`Kept`] method.
pub(super) struct KeptStepper<'a, S: Scalar, P: Poisson<S>> {
    stepper: ForgottenStepper<'a, P::State, S>,
    /// What is done behind each step, where the stepper does not do it itself.
    behind: Option<Behind<'a, S, P>>,
}

/// The projection behind a step.
struct Behind<'a, S: Scalar, P: Poisson<S>> {
    system: &'a P,
    projection: Projection<S, P::State>,
    /// The state before the step.
    before: P::State,
}

impl<S: Scalar, P: Poisson<S>> KeptStepper<'_, S, P> {
    /// See [`Stepper::step`](crate::methods::Stepper::step).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let Some(behind) = &mut self.behind else {
            return self.stepper.step(mu, sink);
        };
        behind.before.copy_from(mu);
        let stepped = self.stepper.step(mu, sink);
        let refused = stepped.err().map_or(0, |failure| failure.lanes);
        let moved = !S::Mask::from_bits(refused);
        let lost = behind.projection.bring_back(behind.system, moved, mu);
        if !lost.any() {
            return stepped;
        }
        mu.assign_where(lost, &behind.before);
        Err(match stepped {
            Ok(report) => StepFailure {
                reason: behind.projection.reason(lost),
                lanes: lost.bits(),
                report,
            },
            Err(failure) => StepFailure {
                lanes: failure.lanes | lost.bits(),
                ..failure
            },
        })
    }

    pub(super) fn estimate(&mut self) -> Option<S> {
        self.stepper.estimate()
    }

    pub(super) fn set_step(&mut self, h: S) -> bool {
        self.stepper.set_step(h)
    }
}
