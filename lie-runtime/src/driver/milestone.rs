//! Places from which a run can be taken up again.
//!
//! Steppers keep what earlier steps have shown: where iterations begin, which of two is worth while, the next step of an
//! adaptive method. At a milestone a run makes its stepper anew. So all that follows depends on what a [`Milestone`] holds, and
//! a run that is taken up there has the bits of one that was never interrupted. Runs that nobody takes up have none: methods
//! that try iterations without a Jacobian would try them again after each.

use super::course::Course;
use super::density::Control;
use super::options::OptionError;
use super::stats::Stats;
use super::watch::{Guard, MOST_PARTS, Watched};
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// Steps from one milestone to the next. To make a stepper, and its first step, which has nothing to begin from, takes the time
/// of a few steps; methods that try iterations without a Jacobian take up to a tenth longer in all.
pub const MILESTONE: u64 = 1000;

/// No run counts so far: whatever comes after a milestone can be added to its counts.
const UNCOUNTED: u64 = 1 << 63;

/// A place from which a run can be taken up again, with what that takes beside its problem, method and options.
#[derive(Clone, Debug, PartialEq)]
pub struct Milestone<V> {
    /// Steps done, a multiple of [`MILESTONE`].
    pub index: u64,
    /// The time reached.
    pub time: f64,
    /// The step of the grid.
    pub step: f64,
    /// The state.
    pub mu: V,
    /// Where H has several branches, its gradient on the one that is followed.
    pub branch: Option<V>,
    /// The work so far.
    pub stats: Stats,
    /// How steps are divided.
    pub division: Division,
}

/// How a run with a tolerance divides its steps, or how they follow the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Division {
    /// In so many parts each is made.
    pub parts: u32,
    /// Where there are more of them from a point on: its number and time, and how many.
    pub shortened: Option<(u64, f64, u64)>,
    /// Jacobians that were factored, and steps since the last division for which some were.
    pub slow: (u64, u64),
    /// What is known of the errors of steps, where they are looked at.
    pub watched: Option<Watched>,
    /// What says the size of steps, where these follow the motion.
    pub control: Option<Control>,
}

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// The place where the run is.
    pub(super) fn milestone(
        &self,
        mu: &P::State,
        branch: Option<P::State>,
        guard: Option<&Guard<'_, S, P>>,
    ) -> Milestone<P::State> {
        Milestone {
            index: self.index,
            time: self.grid.time(self.index),
            step: self.step,
            mu: mu.clone(),
            branch,
            stats: self.stats,
            division: Division {
                parts: self.parts,
                shortened: self
                    .grid
                    .change()
                    .map(|(index, time)| (index, time, self.grid.steps() - index)),
                slow: self.slow,
                watched: guard.map(|guard| guard.watch.watched()),
                control: self.control,
            },
        }
    }

    /// Goes on from a place of the same run.
    ///
    /// # Errors
    /// It is one of another run.
    pub(super) fn take_up(
        &mut self,
        system: &P,
        milestone: &Milestone<P::State>,
        guard: Option<&mut Guard<'_, S, P>>,
    ) -> Result<(), OptionError> {
        let Milestone {
            index, division, ..
        } = *milestone;
        let grid = match (division.control, division.shortened) {
            (Some(control), _) => (self.grid).changed_from((index, milestone.time), control.step()),
            (None, None) => self.grid,
            (None, Some((first, time, steps))) => self.grid.going_on_with((first, time), steps),
        };
        let steered = match division.control {
            Some(control) => self.follows && control.is_of(self.step) && milestone.time.is_finite(),
            None => !self.follows,
        };
        let beyond = division.shortened.is_some_and(|(first, time, steps)| {
            !self.divides || first > index || !time.is_finite() || steps > UNCOUNTED
        });
        let fits = |vector: &P::State| vector.as_slice().len() == system.dimension();
        let why = if milestone.step.to_bits() != self.step.to_bits() {
            "its step is another one"
        } else if beyond || index > grid.steps() || !index.is_multiple_of(MILESTONE) {
            "it is not on the grid of the run"
        } else if !fits(&milestone.mu) || !milestone.branch.iter().all(fits) {
            "its state has another length"
        } else if !(1..=MOST_PARTS).contains(&division.parts)
            || (division.parts > 1 && !self.divides)
            || division.watched.is_some() != guard.is_some()
            || !steered
            || division.watched.is_some_and(|watched| watched.left == 0)
        {
            "its steps are divided otherwise"
        } else if counts(milestone)
            .into_iter()
            .any(|count| count >= UNCOUNTED)
        {
            "its counts are those of no run"
        } else {
            self.grid = grid;
            (self.index, self.milestone) = (index, index + MILESTONE);
            (self.parts, self.slow) = (division.parts, division.slow);
            self.control = division.control;
            self.stats = milestone.stats;
            if let (Some(guard), Some(watched)) = (guard, division.watched) {
                guard.watch.restore(watched);
                guard.steps_are(self.grid.step());
            }
            return Ok(());
        };
        Err(OptionError::Milestone(why))
    }
}

/// What later steps are added to.
fn counts<V>(milestone: &Milestone<V>) -> [u64; 11] {
    let Stats {
        steps,
        evaluations,
        newton,
        fixed_point,
        factorizations,
        pivoted,
        accepted,
        rejected,
        failures,
    } = milestone.stats;
    let (factored, slow) = milestone.division.slow;
    [
        steps,
        evaluations,
        newton,
        fixed_point,
        factorizations,
        pivoted,
        accepted,
        rejected,
        failures,
        factored,
        slow,
    ]
}

/// The gradient of H at a state, for the branch that is followed there.
pub(super) fn gradient<S: Scalar, P: Poisson<S>>(system: &P, mu: &P::State) -> P::State {
    let mut gradient = system.zero_state();
    system.gradient(mu, &mut gradient);
    gradient
}
