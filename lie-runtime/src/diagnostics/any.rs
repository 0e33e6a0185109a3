//! Methods whose types are forgotten, so that a measurement of many of them is compiled once.

use crate::methods::any::{AnyStepper, Motions};
use crate::methods::{
    FactorSink, Facts, Method, Preserves, Projection, Relay, StepFailure, StepReport, Stepper,
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
    /// Whether a step is solved by fixed-point iteration, which has no order.
    pub fixed_point: bool,
    /// Whether a step is made of steps that the method chooses itself.
    pub own_steps: bool,
    /// What is kept.
    pub preserves: Preserves,
}

impl Claims {
    /// Of a method of order 1 that solves nothing and keeps nothing: name what differs, as in
    /// `Claims { order: 2, ..Claims::NONE }`.
    pub const NONE: Self = Self {
        order: 1,
        symmetric: false,
        explicit: true,
        fixed_point: false,
        own_steps: false,
        preserves: Preserves::NOTHING,
    };

    /// The order in the mean square on noise in the sense of Stratonovich whose rate is held over each step (E. Wong, M. Zakai, 1965,
    /// doi:10.1214/aoms/1177699916): 1 where the noises commute, 1/2 where the areas between them count. A method of order 1 takes
    /// squares of increments wrong, and claims none.
    pub fn strong_order(&self, commuting: bool) -> Option<f64> {
        (self.order >= 2).then_some(if commuting { 1.0 } else { 0.5 })
    }

    /// The order of means of functions of the state on such noise.
    pub fn weak_order(&self) -> Option<f64> {
        (self.order >= 2).then_some(1.0)
    }

    /// What a method says of itself.
    pub const fn from_facts<M: Facts>() -> Self {
        Self {
            order: M::ORDER,
            symmetric: M::SYMMETRIC,
            explicit: M::EXPLICIT,
            fixed_point: M::FIXED_POINT,
            own_steps: M::OWN_STEPS,
            preserves: M::PRESERVES,
        }
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
        Claims::from_facts::<M>()
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

/// A method whose type is forgotten, as a method again: the driver runs it. Its constants say
/// nothing; what the driver asks is asked of the method.
pub struct Forgotten<'m, P: Poisson<S>, S: Scalar = f64>(pub &'m dyn AnyMethod<S, P>);

/// The stepper of a [`Forgotten`] method.
pub struct ForgottenStepper<'a, V, S = f64> {
    stepper: Box<dyn AnyStepper<S, V> + 'a>,
    motions: Motions<V>,
}

impl<'a, S, V> ForgottenStepper<'a, V, S> {
    /// Some stepper as a stepper again.
    pub(crate) const fn new(stepper: Box<dyn AnyStepper<S, V> + 'a>) -> Self {
        Self {
            stepper,
            motions: Motions::new(),
        }
    }
}

impl<S: Scalar, P: Poisson<S>> Facts for Forgotten<'_, P, S> {
    const ID: &'static str = "";
    const ORDER: u32 = 0;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::NOTHING;

    fn order(&self) -> u32 {
        self.0.claims().order
    }
    fn fixed_point(&self) -> bool {
        self.0.claims().fixed_point
    }
    fn own_steps(&self) -> bool {
        self.0.claims().own_steps
    }
    fn symmetric(&self) -> bool {
        self.0.claims().symmetric
    }
}

impl<S: Scalar, P: Poisson<S>> Method<S, P> for Forgotten<'_, P, S> {
    type Stepper<'a>
        = ForgottenStepper<'a, P::State, S>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        ForgottenStepper::new(self.0.any_stepper(system, h, newton))
    }

    fn boxed<'a>(
        &'a self,
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<S, P::State> + 'a> {
        self.0.any_stepper(system, h, newton)
    }
}

impl<S: Scalar, V: State<S>> Stepper<S> for ForgottenStepper<'_, V, S> {
    type State = V;

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn step<K: FactorSink<V>>(
        &mut self,
        mu: &mut V,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        if !sink.is_active() {
            return self.stepper.step(mu);
        }
        self.motions.clear();
        let report = self.stepper.step_with_motions(mu, &mut self.motions);
        self.motions.show(sink);
        report
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

    fn keep(&mut self, projection: Projection<S, V>) -> Option<Projection<S, V>> {
        self.stepper.keep(projection)
    }

    fn relay(&mut self, mu: &mut V, members: &mut dyn Relay<S, V>) -> bool {
        self.stepper.relay(mu, members)
    }
}
