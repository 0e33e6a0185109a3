//! Methods whose types are forgotten, so that a measurement of many of them is compiled once.

use crate::driver::Stats;
use crate::methods::{
    FactorSink, Facts, Method, Preserves, Retraction, StepFailure, StepReport, Stepper,
};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The constants of a method ([`Facts`]) as a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claims {
    /// The order of convergence.
    pub order: u32,
    /// Whether a step of -h undoes a step of h.
    pub symmetric: bool,
    /// Whether a step needs no solver.
    pub explicit: bool,
    /// What is kept.
    pub preserves: Preserves,
}

impl Claims {
    /// What a method says of itself.
    pub const fn of<M: Facts>() -> Self {
        Self {
            order: M::ORDER,
            symmetric: M::SYMMETRIC,
            explicit: M::EXPLICIT,
            preserves: M::PRESERVES,
        }
    }
}

/// The group factors of one step, in order: `mu1 = Ad*_(tau_k(xi_k)) … Ad*_(tau_1(xi_1)) mu`.
pub type Factors<V> = Vec<(Retraction, V)>;

impl<V: Clone> FactorSink<V> for Factors<V> {
    fn push(&mut self, retraction: Retraction, xi: &V) {
        Vec::push(self, (retraction, xi.clone()));
    }
}

/// Some stepper.
pub trait AnyStepper<S, V> {
    /// One step, see [`Stepper::step`].
    ///
    /// # Errors
    /// The failure of the step.
    fn step(&mut self, mu: &mut V) -> Result<StepReport, StepFailure>;
    /// One step with its group factors, appended to `factors`.
    ///
    /// # Errors
    /// The failure of the step.
    fn step_with_factors(
        &mut self,
        mu: &mut V,
        factors: &mut Factors<V>,
    ) -> Result<StepReport, StepFailure>;
    /// Many steps in one loop, with nothing in between: what is timed.
    ///
    /// # Errors
    /// The number of steps done, and the failure of the next.
    fn advance(&mut self, mu: &mut V, steps: u64) -> Result<Stats, (u64, StepFailure)>;
}

impl<S: Scalar, V: State<S>, T: Stepper<S, State = V>> AnyStepper<S, V> for T {
    fn step(&mut self, mu: &mut V) -> Result<StepReport, StepFailure> {
        Stepper::step(self, mu, &mut ())
    }

    fn step_with_factors(
        &mut self,
        mu: &mut V,
        factors: &mut Factors<V>,
    ) -> Result<StepReport, StepFailure> {
        Stepper::step(self, mu, factors)
    }

    fn advance(&mut self, mu: &mut V, steps: u64) -> Result<Stats, (u64, StepFailure)> {
        let mut stats = Stats::default();
        for step in 0..steps {
            match Stepper::step(self, mu, &mut ()) {
                Ok(report) => stats.add(&report),
                Err(failure) => return Err((step, failure)),
            }
        }
        Ok(stats)
    }
}

/// Some method for a system. Implemented for every [`Method`].
pub trait AnyMethod<S: Scalar, P: Poisson<S>> {
    /// What it says of itself.
    fn claims(&self) -> Claims;
    /// A stepper of step size h.
    fn any_stepper<'a>(
        &self,
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<S, P::State> + 'a>;
}

impl<S: Scalar, P: Poisson<S>, M: Method<S, P> + 'static> AnyMethod<S, P> for M {
    fn claims(&self) -> Claims {
        Claims::of::<M>()
    }

    fn any_stepper<'a>(
        &self,
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<S, P::State> + 'a> {
        Box::new(self.stepper(system, h, newton))
    }
}
