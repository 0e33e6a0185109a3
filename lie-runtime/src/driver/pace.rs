//! A step size from a tolerance.
//!
//! A run-in from the initial state estimates the error of single steps and the constant step that follows from it; the run
//! itself then starts anew with that step, so that it is one map from its beginning to its end.
//!
//! The error e of a step of h is that against two steps of h/2, times `2^p/(2^p - 1)`, p the order: h is chosen so that
//! `e(h) |T|/h`, the sum over all steps of a span T, is the tolerance. It is relative to the size of the state, in the
//! maximum norm. The first five steps decide. Of methods that iterate without a Jacobian, steps that do not contract by a
//! factor of three are shortened: several that contract cost less. Where H depends on the time, a second run-in starts where
//! the field changes most by it, and the smaller step is taken: steps chosen at the start could pass a pulse without seeing
//! it. Where the motion becomes faster later, a step is divided during the run (see the module `watch`); where errors of single
//! steps grow on their way, as near unstable motion, the error at the end is larger, which a second run tells
//! ([`Options::assessed`]).
//!
//! Reference: E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd edition, Springer
//! 1993, section II.4, [doi:10.1007/978-3-540-78862-1](https://doi.org/10.1007/978-3-540-78862-1).

use super::options::{OptionError, Options, Pace};
use super::problem::Problem;
use super::pulse::pulse;
use super::solve::IntegrateError;
use super::trial::Trial;
use super::watch::{Guard, Watch};
use crate::methods::Method;
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};

/// The step of a run, chosen from a tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// The tolerance that was asked for: relative error at the end of the span.
    pub tolerance: f64,
    /// The step, of which the span is a multiple.
    pub step: f64,
    /// The largest error of a step that was estimated, relative to the state.
    pub error: f64,
    /// Whether round-off forbids a smaller error: the tolerance may then be missed.
    pub at_round_off: bool,
}

/// Times the tolerance that an error at the end may be without a warning.
const MISSED: f64 = 30.0;

/// What is known of the error at the end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assessed {
    /// The tolerance that was asked for.
    pub tolerance: f64,
    /// The error at the end relative to the state, by a second run; none where that failed or would take too many steps.
    pub error: Option<f64>,
}

impl Assessed {
    /// Whether the error is more than 30 times the tolerance, or cannot be told.
    pub fn missed(&self) -> bool {
        self.error
            .is_none_or(|error| error.is_nan() || error > MISSED * self.tolerance)
    }
}

/// Errors of steps below so many units of round-off are round-off.
const ROUND_OFF: f64 = 8.0;
/// How much of the step that the estimates allow is taken.
const SAFETY: f64 = 0.95;

/// A step that is so many times shorter than one made before, and of which so many would be made, is that of a singularity.
const MOST_SHORTENED: f64 = 1024.0;
const MOST_STEPS: f64 = 4e6;

/// How a step was chosen, what tries others, and what looks after it.
pub(super) struct Settled<'a, S: Scalar, P: Poisson<S>, M> {
    pub(super) chosen: Chosen,
    pub(super) trial: Trial<'a, S, P, M>,
    /// None of methods that choose their own steps.
    pub(super) watch: Option<Watch<S, P>>,
}

impl<'a, S: Scalar, P: Poisson<S>, M: Method<S, P>> Settled<'a, S, P, M> {
    /// The solver of the run.
    pub(super) fn newton(&self, step: f64) -> NewtonOptions {
        self.trial.newton_of_run(step.abs())
    }

    /// What looks after the run.
    pub(super) fn guard(self) -> Option<Guard<'a, S, P, M>> {
        let trial = self.trial;
        self.watch.map(|watch| Guard { watch, trial })
    }
}

/// A step, and how it was chosen if it was.
type Paced<'a, S, P, M> = (f64, Option<Settled<'a, S, P, M>>);

/// The step of a run.
pub(super) fn settle<'a, S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &'a Problem<S, P>,
    method: &'a M,
    options: &Options,
) -> Result<Paced<'a, S, P, M>, IntegrateError> {
    match options.pace {
        Pace::Step(step) => Ok((step, None)),
        Pace::Tolerance(tolerance) => {
            let settled = chosen_by(problem, method, tolerance, &options.newton)?;
            Ok((settled.chosen.step, Some(settled)))
        }
    }
}

/// The least tolerance that can be asked for: a few units of round-off.
pub fn least_tolerance<S: Scalar>() -> f64 {
    ROUND_OFF * largest(S::epsilon())
}

/// The constant step with which a method keeps a tolerance; of a method that chooses its own steps, with a tolerance of
/// its own, the mean of these at the start of the span.
///
/// # Errors
/// [`OptionError`] for a tolerance that is no number between round-off and 1, a span that is not finite, or a method whose
/// error does not depend on its step; a step error where no step succeeds.
pub fn choose<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &Problem<S, P>,
    method: &M,
    tolerance: f64,
    newton: &NewtonOptions,
) -> Result<Chosen, IntegrateError> {
    Ok(chosen_by(problem, method, tolerance, newton)?.chosen)
}

fn chosen_by<'a, S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &'a Problem<S, P>,
    method: &'a M,
    tolerance: f64,
    newton: &NewtonOptions,
) -> Result<Settled<'a, S, P, M>, IntegrateError> {
    let (start, end) = problem.span;
    let span = end - start;
    if !(least_tolerance::<S>()..1.0).contains(&tolerance) {
        return Err(OptionError::Tolerance(tolerance).into());
    }
    if !span.is_finite() {
        return Err(OptionError::Span(start, end).into());
    }
    let trial = Trial::new(problem, method, *newton, tolerance);
    let pulse = pulse(problem);
    let (size, error, seen) = if method.own_steps() {
        let most = pulse.and_then(|pulse| pulse.step());
        let size = trial.own_steps(span)?;
        (most.map_or(size, |most| size.min(most)), tolerance, None)
    } else {
        let mut found = trial.run_in(span, None)?;
        if let Some(pulse) = pulse
            && let Ok(mut later) = trial.run_in(span, Some(&pulse))
        {
            // its errors add up over a part of the span
            later.0 *= pulse.part.powf(-1.0 / f64::from(method.order().max(1)));
            if later.0 < found.0 {
                found = later;
            }
        }
        let (size, estimates, gauge) = found;
        let short = estimates.longest > MOST_SHORTENED * size;
        if short && span.abs() / size > MOST_STEPS {
            return Err(trial.no_step(trial.time(span, estimates.reached)));
        }
        let seen = (gauge, estimates.seen, estimates.part);
        (
            SAFETY * trial.below_round_off(size),
            estimates.worst,
            Some(seen),
        )
    };
    let steps = count(span, (span.abs() / size).ceil().max(1.0));
    let step = if span == 0.0 { 1.0 } else { span / steps };
    let chosen = Chosen {
        tolerance,
        step,
        error,
        at_round_off: tolerance / steps < least_tolerance::<S>(),
    };
    let zero = || problem.system.zero_state();
    let watch = seen
        .map(|(gauge, seen, part)| Watch::new(gauge, (seen, part), &chosen, 1.0 / steps, zero()));
    Ok(Settled {
        chosen,
        trial,
        watch,
    })
}

/// The least number of steps, from one on, whose last time is the end of the span to the last digit, if it is near.
pub(super) fn count(span: f64, least: f64) -> f64 {
    let near = (0..16).map(|k| least + f64::from(k));
    let mut exact = near.filter(|steps| span / steps * steps == span);
    exact.next().unwrap_or(least)
}
