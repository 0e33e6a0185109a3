//! Observers of a run.

use super::events::Event;
use super::held::Held;
use super::milestone::Milestone;
use super::pace::{Assessed, Chosen};
use crate::methods::{FactorSink, Retraction, RungeKutta, Stage};
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use core::ops::ControlFlow;

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Steps done.
    pub step: u64,
    /// Steps of the whole run.
    pub steps: u64,
    /// The time reached.
    pub time: f64,
}

/// Observes a run and may end it with [`ControlFlow::Break`].
///
/// A pair of observers is an observer. [`EveryStep`] makes an observer of a closure.
pub trait Observer<S: Scalar, P: Poisson<S>> {
    /// Sees the step that was chosen, before all else, where the options give a tolerance.
    fn chosen(&mut self, chosen: &Chosen) {
        let _ = chosen;
    }
    /// Sees that steps have this size from here on, smaller than before: the error of single steps has become larger than the
    /// tolerance allows.
    fn shortened(&mut self, progress: Progress, step: f64) {
        let _ = (progress, step);
    }
    /// Sees that the errors of steps are larger than the tolerance allows from here on, and steps cannot be divided so far that
    /// they would not be, as before a singularity.
    fn lost(&mut self, progress: Progress) {
        let _ = progress;
    }
    /// Sees at the end that the steps which the tolerance allows differ by this factor along the run: ones that follow the motion, as with
    /// [`Options::reversible`](super::Options::reversible) or by [`Taylor`](crate::methods::Taylor), are faster.
    fn uneven(&mut self, factor: f64) {
        let _ = factor;
    }
    /// Sees the steps of the run that tells the error of the one before, and may end it.
    fn compared(&mut self, progress: Progress) -> ControlFlow<()> {
        let _ = progress;
        ControlFlow::Continue(())
    }
    /// Sees the error at the end, after all else, where the options ask for it.
    fn assessed(&mut self, assessed: &Assessed) {
        let _ = assessed;
    }
    /// Sets what is held from the beginning of a step on, or from where an input changes within one: inputs and the rates of noise, for a
    /// step by its number, the time and the step of the grid. Controllers see the group element that an observer beside it follows.
    fn hold(&mut self, system: &P, step: (u64, f64, f64), mu: &mut P::State, element: &[S]) {
        let _ = (system, step, mu, element);
    }
    /// The group element that it follows, in its chart; empty where it follows none.
    fn group_element(&self) -> &[S] {
        &[]
    }
    /// What it holds, whose changes end steps.
    fn held(&self) -> Option<&Held> {
        None
    }
    /// Sees the state before the first step.
    fn start(&mut self, system: &P, progress: Progress, mu: &P::State) {
        let _ = (system, progress, mu);
    }
    /// Sees the state after each step of the grid.
    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        let _ = (system, progress, mu);
        ControlFlow::Continue(())
    }
    /// Sees a place from which the run can be taken up again, before the rows that are saved there.
    fn milestone(&mut self, system: &P, milestone: &Milestone<P::State>) {
        let _ = (system, milestone);
    }
    /// Sees each saved state with its time.
    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        let _ = (system, time, mu);
        ControlFlow::Continue(())
    }
    /// Whether it wants to know of the events that the system declares; asked once, at the start. They are not looked for otherwise, and
    /// end no run.
    fn awaits_events(&self) -> bool {
        false
    }
    /// Sees an event, in order of time, once the step that it happens on is accepted. One that ends the run is seen before the
    /// last row.
    fn event(&mut self, system: &P, event: &Event<P::State>) {
        let _ = (system, event);
    }
    /// Whether it draws the run as a curve, and wants to see states between the rows where these are far apart; asked once, at
    /// the start.
    fn draws(&self) -> bool {
        false
    }
    /// Sees such a state with its time.
    fn between(&mut self, system: &P, time: f64, mu: &P::State) {
        let _ = (system, time, mu);
    }
    /// Whether it wants to see the motion on the group; asked once, before the start. Steppers skip the work otherwise.
    fn follows_motion(&self) -> bool {
        false
    }
    /// Sees how a step moves the group element, in one or several parts, if it [asks for it](Observer::follows_motion); before it sees the
    /// state.
    fn motion(&mut self, system: &P, motion: &Motion<'_, P::State>) {
        let _ = (system, motion);
    }
    /// The next motion is that of a shorter step to a saved time off the grid, …
    fn leave_grid(&mut self) {}
    /// … which is not continued from: the group element is where it was before.
    fn return_to_grid(&mut self) {}
}

/// A part of the motion on the group.
#[derive(Clone, Copy, Debug)]
pub enum Motion<'a, V> {
    /// `g1 = g tau(xi)`
    Factor(Retraction, &'a V),
    /// `h xi` at a stage of a Runge–Kutta method on `g' = g xi(t)`; g moves after the last stage.
    Velocity(RungeKutta, Stage, &'a V),
}

/// Shows the motion of a stepper to an observer.
pub(super) struct MotionSink<'a, S: Scalar, P: Poisson<S>> {
    pub(super) system: &'a P,
    pub(super) observer: &'a mut dyn Observer<S, P>,
    /// Whether the observer wants to see it.
    pub(super) active: bool,
}

impl<S: Scalar, P: Poisson<S>> FactorSink<P::State> for MotionSink<'_, S, P> {
    fn is_active(&self) -> bool {
        self.active
    }

    fn push(&mut self, retraction: Retraction, xi: &P::State) {
        let motion = Motion::Factor(retraction, xi);
        self.observer.motion(self.system, &motion);
    }

    fn push_velocity(&mut self, method: RungeKutta, stage: Stage, xi: &P::State) {
        let motion = Motion::Velocity(method, stage, xi);
        self.observer.motion(self.system, &motion);
    }
}

/// No observer.
impl<S: Scalar, P: Poisson<S>> Observer<S, P> for () {}

impl<S: Scalar, P: Poisson<S>, O: Observer<S, P> + ?Sized> Observer<S, P> for &mut O {
    fn follows_motion(&self) -> bool {
        (**self).follows_motion()
    }
    fn motion(&mut self, system: &P, motion: &Motion<'_, P::State>) {
        (**self).motion(system, motion);
    }
    fn leave_grid(&mut self) {
        (**self).leave_grid();
    }
    fn return_to_grid(&mut self) {
        (**self).return_to_grid();
    }
    fn chosen(&mut self, chosen: &Chosen) {
        (**self).chosen(chosen);
    }
    fn shortened(&mut self, progress: Progress, step: f64) {
        (**self).shortened(progress, step);
    }
    fn lost(&mut self, progress: Progress) {
        (**self).lost(progress);
    }
    fn uneven(&mut self, factor: f64) {
        (**self).uneven(factor);
    }
    fn compared(&mut self, progress: Progress) -> ControlFlow<()> {
        (**self).compared(progress)
    }
    fn assessed(&mut self, assessed: &Assessed) {
        (**self).assessed(assessed);
    }
    fn hold(&mut self, system: &P, step: (u64, f64, f64), mu: &mut P::State, element: &[S]) {
        (**self).hold(system, step, mu, element);
    }
    fn group_element(&self) -> &[S] {
        (**self).group_element()
    }
    fn held(&self) -> Option<&Held> {
        (**self).held()
    }
    fn start(&mut self, system: &P, progress: Progress, mu: &P::State) {
        (**self).start(system, progress, mu);
    }
    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        (**self).step(system, progress, mu)
    }
    fn milestone(&mut self, system: &P, milestone: &Milestone<P::State>) {
        (**self).milestone(system, milestone);
    }
    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        (**self).row(system, time, mu)
    }
    fn awaits_events(&self) -> bool {
        (**self).awaits_events()
    }
    fn event(&mut self, system: &P, event: &Event<P::State>) {
        (**self).event(system, event);
    }
    fn draws(&self) -> bool {
        (**self).draws()
    }
    fn between(&mut self, system: &P, time: f64, mu: &P::State) {
        (**self).between(system, time, mu);
    }
}

/// Both observe the run; either may end it.
impl<S: Scalar, P: Poisson<S>, A: Observer<S, P>, B: Observer<S, P>> Observer<S, P> for (A, B) {
    fn follows_motion(&self) -> bool {
        self.0.follows_motion() || self.1.follows_motion()
    }
    fn motion(&mut self, system: &P, motion: &Motion<'_, P::State>) {
        self.0.motion(system, motion);
        self.1.motion(system, motion);
    }
    fn leave_grid(&mut self) {
        self.0.leave_grid();
        self.1.leave_grid();
    }
    fn return_to_grid(&mut self) {
        self.0.return_to_grid();
        self.1.return_to_grid();
    }
    fn chosen(&mut self, chosen: &Chosen) {
        self.0.chosen(chosen);
        self.1.chosen(chosen);
    }
    fn shortened(&mut self, progress: Progress, step: f64) {
        self.0.shortened(progress, step);
        self.1.shortened(progress, step);
    }
    fn lost(&mut self, progress: Progress) {
        self.0.lost(progress);
        self.1.lost(progress);
    }
    fn uneven(&mut self, factor: f64) {
        self.0.uneven(factor);
        self.1.uneven(factor);
    }
    fn compared(&mut self, progress: Progress) -> ControlFlow<()> {
        let first = self.0.compared(progress);
        let second = self.1.compared(progress);
        if first.is_break() { first } else { second }
    }
    fn assessed(&mut self, assessed: &Assessed) {
        self.0.assessed(assessed);
        self.1.assessed(assessed);
    }
    fn hold(&mut self, system: &P, step: (u64, f64, f64), mu: &mut P::State, element: &[S]) {
        self.0
            .hold(system, step, mu, followed(self.1.group_element(), element));
        self.1
            .hold(system, step, mu, followed(self.0.group_element(), element));
    }
    fn group_element(&self) -> &[S] {
        followed(self.0.group_element(), self.1.group_element())
    }
    fn held(&self) -> Option<&Held> {
        self.0.held().or(self.1.held())
    }
    fn start(&mut self, system: &P, progress: Progress, mu: &P::State) {
        self.0.start(system, progress, mu);
        self.1.start(system, progress, mu);
    }
    fn milestone(&mut self, system: &P, milestone: &Milestone<P::State>) {
        self.0.milestone(system, milestone);
        self.1.milestone(system, milestone);
    }
    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        let first = self.0.step(system, progress, mu);
        let second = self.1.step(system, progress, mu);
        if first.is_break() { first } else { second }
    }
    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        let first = self.0.row(system, time, mu);
        let second = self.1.row(system, time, mu);
        if first.is_break() { first } else { second }
    }
    fn awaits_events(&self) -> bool {
        self.0.awaits_events() || self.1.awaits_events()
    }
    fn event(&mut self, system: &P, event: &Event<P::State>) {
        self.0.event(system, event);
        self.1.event(system, event);
    }
    fn draws(&self) -> bool {
        self.0.draws() || self.1.draws()
    }
    fn between(&mut self, system: &P, time: f64, mu: &P::State) {
        self.0.between(system, time, mu);
        self.1.between(system, time, mu);
    }
}

/// The group element of one observer, else that of the other.
fn followed<'e, S>(one: &'e [S], other: &'e [S]) -> &'e [S] {
    if one.is_empty() { other } else { one }
}

/// What is held sets itself.
impl<S: Scalar, P: Poisson<S>> Observer<S, P> for Held {
    fn hold(&mut self, system: &P, step: (u64, f64, f64), mu: &mut P::State, element: &[S]) {
        self.set(system, step, mu, element);
    }
    fn held(&self) -> Option<&Held> {
        Some(self)
    }
}

/// What is held, where something is.
impl<S: Scalar, P: Poisson<S>> Observer<S, P> for Option<Held> {
    fn hold(&mut self, system: &P, step: (u64, f64, f64), mu: &mut P::State, element: &[S]) {
        if let Some(held) = self {
            held.set(system, step, mu, element);
        }
    }
    fn held(&self) -> Option<&Held> {
        self.as_ref()
    }
}

/// Calls a closure after every step of the grid with the progress and the state.
#[derive(Clone, Copy, Debug)]
pub struct EveryStep<F>(pub F);

impl<S: Scalar, P: Poisson<S>, F> Observer<S, P> for EveryStep<F>
where
    F: FnMut(Progress, &P::State) -> ControlFlow<()>,
{
    fn step(&mut self, _system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        (self.0)(progress, mu)
    }
}
