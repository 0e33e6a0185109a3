//! Steppers whose types are forgotten, so that what runs them is compiled once.

use super::stats::Stats;
use super::{
    FactorSink, Projection, Relay, Retraction, RungeKutta, Stage, StepFailure, StepReport, Stepper,
};
use crate::scalar::Scalar;
use crate::state::State;
use core::mem::ManuallyDrop;

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
        // it stays empty: there is nothing to be dropped behind every step
        let mut motions = ManuallyDrop::new(Motions::unasked());
        Stepper::step(self, mu, &mut *motions)
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
