//! Step size, what is saved, and the solver.

use super::density::Density;
use crate::methods::{Keep, Unkept};
use crate::newton::NewtonOptions;
use thiserror::Error;

/// Which states of a run are saved.
#[derive(Clone, Debug, PartialEq)]
pub enum Save {
    /// The start, every k-th step, and the end.
    Every(u64),
    /// The given times, in order of the run; each row carries the time as given.
    At(Vec<f64>),
    /// The start, multiples of an interval of time after it, and the end.
    Interval(f64),
    /// The start and the end.
    Ends,
}

/// How large steps are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// A step size; negative for a run backwards in time.
    Step(f64),
    /// A relative error at the end of the span, from which a constant step is chosen (see [`choose`](super::pace::choose)).
    Tolerance(f64),
}

/// Options of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// How large steps are.
    pub pace: Pace,
    /// Which states are saved; every step by default.
    pub save: Save,
    /// The solver of implicit methods.
    pub newton: NewtonOptions,
    /// What a projection behind each step keeps: nothing by default.
    pub keep: Keep,
    /// Whether steps follow the motion: not by default.
    pub density: Density,
    /// A second run tells the error at the end of one with at most so many steps: none by default.
    pub assess: u64,
}

impl Options {
    /// Options with a step size, every step saved.
    pub fn new(step: f64) -> Self {
        Self::paced(Pace::Step(step))
    }

    /// Options with a tolerance, from which the step is chosen, every step saved.
    pub fn tolerance(tolerance: f64) -> Self {
        Self::paced(Pace::Tolerance(tolerance))
    }

    fn paced(pace: Pace) -> Self {
        Self {
            pace,
            save: Save::Every(1),
            newton: NewtonOptions::default(),
            keep: Keep::NOTHING,
            density: Density::Constant,
            assess: 0,
        }
    }

    /// The same with another run behind it that nobody sees, which tells the error at the end: with steps of four fifths, or for
    /// a method that chooses its own steps from a start that is changed by a tenth of the tolerance. It takes 1.25 times as
    /// long.
    #[must_use]
    pub fn assessed(self) -> Self {
        Self {
            assess: u64::MAX,
            ..self
        }
    }

    /// The same with a [`Projection`](crate::methods::Projection) behind each step, those of adaptive methods included, and before
    /// each saved state. Meant for explicit methods: one that is a Poisson map or symmetric is neither any more.
    #[must_use]
    pub fn keep(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// The same with steps whose size follows the motion, by an integrating step density: the given or chosen step is the first one, and
    /// those where the field is larger are shorter, in proportion to `|f|^(-3/4)`. A symmetric method stays reversible so, and has no
    /// drift in the energy of reversible motion, but is no Poisson map any more. Each step takes a Jacobian. See
    /// E. Hairer, G. Söderlind, [doi:10.1137/040606995](https://doi.org/10.1137/040606995). Methods that are not symmetric are refused, as are
    /// adaptive ones, projections, lanes, systems without a Jacobian and those with joints that are known beforehand.
    #[must_use]
    pub fn reversible(self) -> Self {
        Self {
            density: Density::Reversible,
            ..self
        }
    }

    /// The same with another choice of saved states.
    #[must_use]
    pub fn save(self, save: Save) -> Self {
        Self { save, ..self }
    }

    /// The same with another solver.
    #[must_use]
    pub fn newton(self, newton: NewtonOptions) -> Self {
        Self { newton, ..self }
    }
}

/// Invalid options; nothing was computed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum OptionError {
    /// The step size is zero, infinite or not a number.
    #[error("the step must be a finite number other than zero, not {0}")]
    Step(f64),
    /// The tolerance is below round-off, 1 or more, or not a number.
    #[error("the tolerance must lie between eight units of round-off and 1, not {0}")]
    Tolerance(f64),
    /// No step was found with which the method keeps the tolerance.
    #[error(
        "no step was found that keeps the tolerance {tolerance} beyond t = {time}: the motion becomes singular there, \
         or the error of a step does not decrease with its size"
    )]
    NoStep {
        /// The tolerance.
        tolerance: f64,
        /// How far the first steps came.
        time: f64,
    },
    /// The initial state has not one number for each coordinate.
    #[error("the initial state has length {found}, the system {expected} coordinates")]
    StateLength {
        /// The number of coordinates.
        expected: usize,
        /// The length of the state.
        found: usize,
    },
    /// Start or end is infinite or not a number.
    #[error("start and end must be finite, not {0} and {1}")]
    Span(f64, f64),
    /// The step leads away from the end.
    #[error("the step {step} leads from {start} away from {end}")]
    Direction {
        /// The step size.
        step: f64,
        /// The start.
        start: f64,
        /// The end, or a saved time.
        end: f64,
    },
    /// More steps than can be counted.
    #[error("{0:e} steps are more than can be counted (2^53)")]
    TooManySteps(f64),
    /// A saved time beyond the span or not a number.
    #[error("the time {time} to be saved is not between {start} and {end}")]
    SavedTime {
        /// The time to be saved.
        time: f64,
        /// The start.
        start: f64,
        /// The end.
        end: f64,
    },
    /// What is to be kept cannot be.
    #[error("this cannot be kept: {0}")]
    Keep(Unkept),
    /// Steps cannot follow the motion.
    #[error("steps of a reversible density are not possible: {0}")]
    Density(&'static str),
    /// Noise and a tolerance.
    #[error(
        "a system with noise takes steps of one size: no tolerance says how far a random path is right"
    )]
    Noise,
    /// A controller that sees the group element, asked within steps, and events.
    #[error(
        "events are looked for before a step shows the group element, which a controller is asked with: take steps that end at its samplings"
    )]
    SampledWithin,
    /// A milestone of another run.
    #[error("the milestone is not one of this run: {0}")]
    Milestone(&'static str),
    /// A group element that is none of the chart.
    #[error("the group element at the start has another number of entries than its chart")]
    Element,
    /// `Save::Every(0)`, or an interval that is not a finite number other than zero of the step's
    /// sign.
    #[error("states can be saved every 1, 2, 3, … steps or at a positive interval of time")]
    Interval,
}
