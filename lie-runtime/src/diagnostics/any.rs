//! Methods whose types are forgotten, so that a measurement of many of them is compiled once.

use crate::driver::Stats;
use crate::methods::{
    FactorSink, Facts, Method, Preserves, Retraction, RungeKutta, Stage, StepFailure, StepReport,
    Stepper,
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
            fixed_point: M::FIXED_POINT,
            preserves: M::PRESERVES,
        }
    }
}

/// What a step shows of its motion on the group, as values.
#[derive(Clone, Debug)]
pub enum Shown<V> {
    /// `g1 = g tau(xi)`
    Factor(Retraction, V),
    /// `h xi` at a stage of a Runge–Kutta method.
    Velocity(RungeKutta, Stage, V),
}

/// The motion of one step on the group, in order.
#[derive(Clone, Debug)]
pub struct Motions<V>(pub Vec<Shown<V>>);

impl<V> Motions<V> {
    /// Shows the same to another.
    pub fn show(&self, sink: &mut impl FactorSink<V>) {
        for shown in &self.0 {
            match shown {
                Shown::Factor(retraction, xi) => sink.push(*retraction, xi),
                Shown::Velocity(method, stage, xi) => sink.push_velocity(*method, *stage, xi),
            }
        }
    }
}

impl<V: Clone> FactorSink<V> for Motions<V> {
    fn push(&mut self, retraction: Retraction, xi: &V) {
        self.0.push(Shown::Factor(retraction, xi.clone()));
    }

    fn push_velocity(&mut self, method: RungeKutta, stage: Stage, xi: &V) {
        self.0.push(Shown::Velocity(method, stage, xi.clone()));
    }
}

/// Some stepper.
pub trait AnyStepper<S, V> {
    /// One step, see [`Stepper::step`].
    ///
    /// # Errors
    /// The failure of the step.
    fn step(&mut self, mu: &mut V) -> Result<StepReport, StepFailure>;
    /// One step with its motion on the group, appended to `motions`.
    ///
    /// # Errors
    /// The failure of the step.
    fn step_with_motions(
        &mut self,
        mu: &mut V,
        motions: &mut Motions<V>,
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

    fn step_with_motions(
        &mut self,
        mu: &mut V,
        motions: &mut Motions<V>,
    ) -> Result<StepReport, StepFailure> {
        Stepper::step(self, mu, motions)
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

/// A method whose type is forgotten, as a method again: the driver runs it. Its constants say nothing.
pub struct Forgotten<'m, P: Poisson<f64>>(pub &'m dyn AnyMethod<f64, P>);

/// The stepper of a [`Forgotten`] method.
pub struct ForgottenStepper<'a, V> {
    stepper: Box<dyn AnyStepper<f64, V> + 'a>,
    motions: Motions<V>,
}

impl<P: Poisson<f64>> Facts for Forgotten<'_, P> {
    const ID: &'static str = "";
    const ORDER: u32 = 0;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::NOTHING;
}

impl<P: Poisson<f64>> Method<f64, P> for Forgotten<'_, P> {
    type Stepper<'a>
        = ForgottenStepper<'a, P::State>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: f64, newton: &NewtonOptions) -> Self::Stepper<'a> {
        ForgottenStepper {
            stepper: self.0.any_stepper(system, h, newton),
            motions: Motions(Vec::new()),
        }
    }
}

impl<V: State<f64>> Stepper<f64> for ForgottenStepper<'_, V> {
    type State = V;

    fn step<K: FactorSink<V>>(
        &mut self,
        mu: &mut V,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        if !K::ACTIVE {
            return self.stepper.step(mu);
        }
        self.motions.0.clear();
        let report = self.stepper.step_with_motions(mu, &mut self.motions);
        self.motions.show(sink);
        report
    }
}
