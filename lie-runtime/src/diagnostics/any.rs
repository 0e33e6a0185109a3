//! Methods whose types are forgotten, so that a measurement of many of them is compiled once.

use crate::driver::Stats;
use crate::methods::{
    FactorSink, Facts, Method, Preserves, Projection, Relay, Retraction, RungeKutta, Stage,
    StepFailure, StepReport, Stepper,
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

/// What a step shows of its motion on the group, as values.
#[derive(Clone, Debug)]
pub enum GroupMotion<V> {
    /// `g1 = g tau(xi)`
    Factor(Retraction, V),
    /// `h xi` at a stage of a Runge–Kutta method.
    Velocity(RungeKutta, Stage, V),
}

/// The motion of one step on the group, in order, where it is asked for.
///
/// Whether it is asked for is known when the program runs, so that the steps of a method whose type is forgotten are compiled
/// once and not twice.
#[derive(Clone, Debug)]
pub struct Motions<V> {
    shown: Vec<GroupMotion<V>>,
    is_active: bool,
}

impl<V> Default for Motions<V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<V> Motions<V> {
    /// Records the motion of the steps to which it is given.
    pub const fn new() -> Self {
        Self {
            shown: Vec::new(),
            is_active: true,
        }
    }

    /// Records nothing, and says so.
    const fn unasked() -> Self {
        Self {
            shown: Vec::new(),
            is_active: false,
        }
    }

    /// Whether nothing was shown.
    pub const fn is_empty(&self) -> bool {
        self.shown.is_empty()
    }

    /// Forgets what was shown.
    pub fn clear(&mut self) {
        self.shown.clear();
    }

    /// Shows the same to another.
    pub fn show(&self, sink: &mut impl FactorSink<V>) {
        for shown in &self.shown {
            match shown {
                GroupMotion::Factor(retraction, xi) => sink.push(*retraction, xi),
                GroupMotion::Velocity(method, stage, xi) => sink.push_velocity(*method, *stage, xi),
            }
        }
    }
}

impl<V: Clone> FactorSink<V> for Motions<V> {
    fn is_active(&self) -> bool {
        self.is_active
    }

    fn push(&mut self, retraction: Retraction, xi: &V) {
        if self.is_active {
            self.shown.push(GroupMotion::Factor(retraction, xi.clone()));
        }
    }

    fn push_velocity(&mut self, method: RungeKutta, stage: Stage, xi: &V) {
        if self.is_active {
            self.shown
                .push(GroupMotion::Velocity(method, stage, xi.clone()));
        }
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
    /// See [`Stepper::estimate`].
    fn estimate(&mut self) -> Option<S>;
    /// See [`Stepper::set_step`].
    fn set_step(&mut self, h: S) -> bool;
    /// See [`Stepper::carry`].
    fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) -> bool;
    /// See [`Stepper::keep`].
    fn keep(&mut self, projection: Projection<S, V>) -> Option<Projection<S, V>>;
    /// See [`Stepper::relay`].
    fn relay(&mut self, mu: &mut V, members: &mut dyn Relay<S, V>) -> bool;
}

impl<S: Scalar, V: State<S>, T: Stepper<S, State = V>> AnyStepper<S, V> for T {
    fn step(&mut self, mu: &mut V) -> Result<StepReport, StepFailure> {
        Stepper::step(self, mu, &mut Motions::unasked())
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
        let mut motions = Motions::unasked();
        for step in 0..steps {
            match Stepper::step(self, mu, &mut motions) {
                Ok(report) => stats.add(&report),
                Err(failure) => return Err((step, failure)),
            }
        }
        Ok(stats)
    }

    fn estimate(&mut self) -> Option<S> {
        Stepper::estimate(self)
    }

    fn set_step(&mut self, h: S) -> bool {
        Stepper::set_step(self, h)
    }

    fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) -> bool {
        Stepper::carry(self, visit)
    }

    fn keep(&mut self, projection: Projection<S, V>) -> Option<Projection<S, V>> {
        Stepper::keep(self, projection)
    }

    fn relay(&mut self, mu: &mut V, members: &mut dyn Relay<S, V>) -> bool {
        Stepper::relay(self, mu, members)
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
        ForgottenStepper {
            stepper: self.0.any_stepper(system, h, newton),
            motions: Motions::new(),
        }
    }
}

impl<S: Scalar, V: State<S>> Stepper<S> for ForgottenStepper<'_, V, S> {
    type State = V;

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
