//! Methods behind whose steps the state goes back onto levels.

use super::options::OptionError;
use super::problem::Problem;
use crate::methods::{
    FactorSink, Facts, Keep, Levels, Method, Preserves, Projection, StepFailure, StepReport,
    Stepper,
};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown as _};

/// A method, and the levels that are kept, if any are.
pub(super) struct Kept<S, M> {
    method: M,
    levels: Option<Levels<S>>,
}

impl<S: Scalar, M> Kept<S, M> {
    /// A method with the levels of a start.
    ///
    /// # Errors
    /// They cannot be kept.
    pub(super) fn new<P: Poisson<S>>(
        problem: &Problem<S, P>,
        method: M,
        keep: Keep,
    ) -> Result<Self, OptionError> {
        let mut levels = None;
        if keep != Keep::NOTHING {
            let mu = problem.start();
            let followed = problem.system.following(&mu);
            let system = followed.as_ref().unwrap_or(&problem.system);
            levels = Some(Levels::at(system, &mu, keep).map_err(OptionError::Keep)?);
        }
        Ok(Self { method, levels })
    }
}

impl<S, M> Kept<S, M> {
    /// Whether levels are kept.
    pub(super) fn keeps(&self) -> bool {
        self.levels.is_some()
    }
}

impl<S, M: Facts> Facts for Kept<S, M> {
    const ID: &'static str = M::ID;
    const ORDER: u32 = M::ORDER;
    const SYMMETRIC: bool = M::SYMMETRIC;
    const EXPLICIT: bool = M::EXPLICIT;
    const FIXED_POINT: bool = M::FIXED_POINT;
    const OWN_STEPS: bool = M::OWN_STEPS;
    const PRESERVES: Preserves = M::PRESERVES;
    const FORCES: bool = M::FORCES;
    const DAMPING: bool = M::DAMPING;

    fn order(&self) -> u32 {
        self.method.order()
    }
    fn fixed_point(&self) -> bool {
        self.method.fixed_point()
    }
    fn own_steps(&self) -> bool {
        self.method.own_steps()
    }
    /// A projection looks at the start of the run alone, and no step of -h undoes it.
    fn symmetric(&self) -> bool {
        self.levels.is_none() && self.method.symmetric()
    }
}

impl<S: Scalar, P: Poisson<S>, M: Method<S, P>> Method<S, P> for Kept<S, M> {
    type Stepper<'a>
        = KeptStepper<'a, S, P, M::Stepper<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        let mut stepper = self.method.stepper(system, h, newton);
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
pub(super) struct KeptStepper<'a, S: Scalar, P: Poisson<S>, T> {
    stepper: T,
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

impl<S: Scalar, P: Poisson<S>, T: Stepper<S, State = P::State>> Stepper<S>
    for KeptStepper<'_, S, P, T>
{
    type State = P::State;

    #[inline(always)]
    fn step<K: FactorSink<P::State>>(
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

    fn estimate(&mut self) -> Option<S> {
        self.stepper.estimate()
    }

    fn set_step(&mut self, h: S) -> bool {
        self.stepper.set_step(h)
    }

    fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) -> bool {
        self.stepper.carry(visit)
    }
}
