//! Who looks on while a run goes.

use super::solution::Solution;
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

/// Looks on during a run and may end it with [`ControlFlow::Break`].
///
/// Two observers make one as a pair. A closure becomes one by [`EveryStep`].
pub trait Observer<S: Scalar, P: Poisson<S>> {
    /// Sees the state before the first step.
    fn start(&mut self, system: &P, progress: Progress, mu: &P::State) {
        let _ = (system, progress, mu);
    }
    /// Sees the state after each step of the grid.
    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        let _ = (system, progress, mu);
        ControlFlow::Continue(())
    }
    /// Sees each saved state with its time.
    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        let _ = (system, time, mu);
        ControlFlow::Continue(())
    }
}

/// Nobody looks on.
impl<S: Scalar, P: Poisson<S>> Observer<S, P> for () {}

impl<S: Scalar, P: Poisson<S>, O: Observer<S, P>> Observer<S, P> for &mut O {
    fn start(&mut self, system: &P, progress: Progress, mu: &P::State) {
        (**self).start(system, progress, mu);
    }
    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        (**self).step(system, progress, mu)
    }
    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        (**self).row(system, time, mu)
    }
}

/// Both look on; either may end the run.
impl<S: Scalar, P: Poisson<S>, A: Observer<S, P>, B: Observer<S, P>> Observer<S, P> for (A, B) {
    fn start(&mut self, system: &P, progress: Progress, mu: &P::State) {
        self.0.start(system, progress, mu);
        self.1.start(system, progress, mu);
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

/// Records the saved states with energy and Casimirs.
#[derive(Clone, Debug)]
pub struct Recorder<S, V> {
    /// What was recorded.
    pub solution: Solution<S, V>,
}

impl<S: Scalar, V> Recorder<S, V> {
    /// An empty record for a system.
    pub fn new<P: Poisson<S, State = V>>() -> Self {
        Self {
            solution: Solution::empty(P::COORDINATES, P::CASIMIR_NAMES),
        }
    }
}

impl<S: Scalar, P: Poisson<S>> Observer<S, P> for Recorder<S, P::State> {
    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        let mut casimirs = vec![S::zero(); P::CASIMIRS];
        system.casimirs(mu, &mut casimirs);
        self.solution.t.push(time);
        self.solution.energy.push(system.energy(mu));
        self.solution.casimirs.push(casimirs);
        self.solution.mu.push(mu.clone());
        ControlFlow::Continue(())
    }
}
