//! A step size from a tolerance.
//!
//! The step is constant, and chosen so that `e(h) |T|/h`, the sum of the errors of all steps of a span T, is the tolerance. It is
//! relative to the size of the state, in the maximum norm.
//!
//! Where the stages of a step tell its error, the run's own first step is tried until it is right (see the module
//! `by_stages`), and nothing is made twice. Of other methods a run-in from the initial state estimates the error of single
//! steps: that of a step of h against two steps of h/2, times `2^p/(2^p - 1)`, p the order; the first five steps decide, and
//! the run starts anew. Where H depends on the time, steps are tried too where the field changes most by it, and the smaller
//! step is taken: steps chosen at the start could pass a pulse without seeing it. The same is done where an input is largest and smallest in its
//! table. Where the motion becomes faster later, steps
//! become shorter during the run (see the module `watch`); where errors of single steps grow on their way, as near unstable motion,
//! the error at the end is larger, which a second run tells ([`Options::assessed`]).
//!
//! Reference: E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd edition, Springer
//! 1993, section II.4, [doi:10.1007/978-3-540-78862-1](https://doi.org/10.1007/978-3-540-78862-1).

use super::by_stages::{Begun, Staged};
use super::held::Held;
use super::kept::Kept;
use super::options::{OptionError, Options, Pace};
use super::problem::Problem;
use super::pulse::{Pulse, pulse};
use super::solve::IntegrateError;
use super::trial::{Estimates, Trial};
use super::watch::{Gauge, Guard, Watch};
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

impl Chosen {
    fn new<S: Scalar, P: Poisson<S>>(tolerance: f64, span: f64, found: &Staged<'_, S, P>) -> Self {
        Self {
            tolerance,
            step: if span == 0.0 { 1.0 } else { span / found.steps },
            error: found.error,
            at_round_off: tolerance / found.steps < least_tolerance::<S>(),
        }
    }
}

/// Times the tolerance that an error at the end may be without a warning.
const MISSED: f64 = 30.0;

/// What is known of the error at the end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assessed {
    /// The tolerance that was asked for, if one was.
    pub tolerance: Option<f64>,
    /// The error at the end relative to the state, by a second run; none where that failed or was ended, and of a method that
    /// chooses its own steps without a tolerance, or with levels that are kept.
    pub error: Option<f64>,
}

impl Assessed {
    /// Whether the error is more than 30 times the tolerance, or cannot be told.
    pub fn missed(&self) -> bool {
        let most = self
            .tolerance
            .map_or(f64::INFINITY, |tolerance| MISSED * tolerance);
        self.error
            .is_none_or(|error| error.is_nan() || error > most)
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
pub(super) struct Settled<'a, S: Scalar, P: Poisson<S>> {
    pub(super) chosen: Chosen,
    pub(super) trial: Trial<'a, S, P>,
    /// None of methods that choose their own steps.
    pub(super) watch: Option<Watch<S, P>>,
    /// The first step, where it is made.
    pub(super) begun: Option<Begun<'a, S, P>>,
}

impl<'a, S: Scalar, P: Poisson<S>> Settled<'a, S, P> {
    /// The solver of the run.
    pub(super) fn newton(&self, step: f64) -> NewtonOptions {
        self.trial.newton_of_run(step.abs())
    }

    /// What looks after the run, and its first step.
    pub(super) fn begin(self) -> Begins<'a, S, P> {
        let trial = self.trial;
        let guard = self.watch.map(|watch| Guard { watch, trial });
        (guard, self.begun)
    }
}

/// What looks after a run, and its first step.
type Begins<'a, S, P> = (Option<Guard<'a, S, P>>, Option<Begun<'a, S, P>>);

/// A step, and how it was chosen if it was.
type Paced<'a, S, P> = (f64, Option<Settled<'a, S, P>>);

/// The step of a run.
pub(super) fn settle<'a, S: Scalar, P: Poisson<S>>(
    problem: &'a Problem<S, P>,
    method: &'a Kept<'a, S, P>,
    options: &Options,
    held: Option<Held>,
) -> Result<Paced<'a, S, P>, IntegrateError> {
    match options.pace {
        Pace::Step(step) => Ok((step, None)),
        Pace::Tolerance(tolerance) => {
            let settled = chosen_by(problem, method, (tolerance, &options.newton), held)?;
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
    let method = Kept::alone(method);
    Ok(chosen_by(problem, &method, (tolerance, newton), None)?.chosen)
}

fn chosen_by<'a, S: Scalar, P: Poisson<S>>(
    problem: &'a Problem<S, P>,
    method: &'a Kept<'a, S, P>,
    (tolerance, newton): (f64, &NewtonOptions),
    held: Option<Held>,
) -> Result<Settled<'a, S, P>, IntegrateError> {
    let (start, end) = problem.span;
    let span = end - start;
    if !(least_tolerance::<S>()..1.0).contains(&tolerance) {
        return Err(OptionError::Tolerance(tolerance).into());
    }
    if !span.is_finite() {
        return Err(OptionError::Span(start, end).into());
    }
    let trial = Trial::new(problem, method, (*newton, tolerance), held);
    let pulse = pulse(&problem.system, trial.start.clone(), problem.span);
    let mut pulses = trial.pushes();
    pulses.extend(pulse);
    let zero = || problem.system.zero_state();
    if method.fixed_point()
        && S::LANES == 1
        && span != 0.0
        && let Some(found) = by_stages(&trial, span, &pulses)?
    {
        let watch = Watch::by_stages(1.0 / found.steps, zero());
        return Ok(Settled {
            chosen: Chosen::new(tolerance, span, &found),
            trial,
            watch: Some(watch),
            begun: found.begun,
        });
    }
    let (size, error, seen) = if method.own_steps() {
        let most = pulses.iter().filter_map(Pulse::step).reduce(f64::min);
        let size = trial.own_steps(span)?;
        (most.map_or(size, |most| size.min(most)), tolerance, None)
    } else {
        let (size, estimates, gauge) = by_run_in(&trial, span, &pulses)?;
        let seen = (gauge, estimates.seen, estimates.part);
        let size = SAFETY * trial.below_round_off(size);
        (size, estimates.worst, Some(seen))
    };
    let steps = count(span, (span.abs() / size).ceil().max(1.0));
    let found = Staged {
        steps,
        error,
        begun: None,
    };
    let chosen = Chosen::new(tolerance, span, &found);
    let watch = seen.map(|(gauge, seen, part)| {
        Watch::by_field(gauge, (seen, part), &chosen, 1.0 / steps, zero())
    });
    Ok(Settled {
        chosen,
        trial,
        watch,
        begun: found.begun,
    })
}

/// The number of steps that keeps the tolerance at the start and at a pulse; none where the stages tell no errors.
fn by_stages<'a, S: Scalar, P: Poisson<S>>(
    trial: &Trial<'a, S, P>,
    span: f64,
    pulses: &[Pulse],
) -> Result<Option<Staged<'a, S, P>>, IntegrateError> {
    let Some(mut found) = trial.by_stages(span, None)? else {
        return Ok(None);
    };
    for pulse in pulses {
        let Ok(Some(later)) = trial.by_stages(span, Some(pulse)) else {
            continue;
        };
        let steps = count(span, (later.steps * trial.over_a_part(pulse)).ceil());
        if steps > found.steps {
            found = Staged {
                steps,
                error: later.error,
                begun: None,
            };
        }
    }
    Ok(Some(found))
}

/// The step that the estimates of a run-in allow, at the start and at a pulse.
fn by_run_in<S: Scalar, P: Poisson<S>>(
    trial: &Trial<'_, S, P>,
    span: f64,
    pulses: &[Pulse],
) -> Result<(f64, Estimates, Gauge<S, P>), IntegrateError> {
    let mut found = trial.run_in(span, None)?;
    for pulse in pulses {
        let Ok(mut later) = trial.run_in(span, Some(pulse)) else {
            continue;
        };
        later.0 /= trial.over_a_part(pulse);
        if later.0 < found.0 {
            found = later;
        }
    }
    let (size, estimates, _) = &found;
    let short = estimates.longest > MOST_SHORTENED * size;
    if short && span.abs() / size > MOST_STEPS {
        return Err(trial.no_step(trial.time(span, estimates.reached)));
    }
    Ok(found)
}

/// The least number of steps, from one on, whose last time is the end of the span to the last digit, if it is near.
pub(super) fn count(span: f64, least: f64) -> f64 {
    let near = (0..16).map(|k| least + f64::from(k));
    let mut exact = near.filter(|steps| span / steps * steps == span);
    exact.next().unwrap_or(least)
}
