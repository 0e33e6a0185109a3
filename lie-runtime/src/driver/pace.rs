//! A step size from a tolerance.
//!
//! A run-in from the initial state estimates the error of single steps and the constant step that follows from it; the run
//! itself then starts anew with that step, so that it is one map from its beginning to its end.
//!
//! The error e of a step of h is that against two steps of h/2, times `2^p/(2^p - 1)`, p the order: h is chosen so that
//! `e(h) |T|/h`, the sum over all steps of a span T, is the tolerance. It is relative to the size of the state, in the
//! maximum norm. The first five steps decide. Where the motion becomes faster later, a step is
//! divided during the run (see the module `watch`); where errors of single steps grow on their way, as near unstable motion, the
//! error at the end is larger, which a second run tells ([`Options::assessed`]).
//!
//! Reference: E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd edition, Springer
//! 1993, section II.4, [doi:10.1007/978-3-540-78862-1](https://doi.org/10.1007/978-3-540-78862-1).

use super::error::StepError;
use super::options::{OptionError, Options, Pace};
use super::problem::Problem;
use super::solve::IntegrateError;
use super::stats::Stats;
use super::watch::{Gauge, Guard, Watch};
use crate::methods::{Method, StepFailure, Stepper};
use crate::newton::{Convergence, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::{State, Unknown};

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

/// Steps whose estimates decide.
const ESTIMATES: u32 = 5;
/// Attempts at a step, in all.
const ATTEMPTS: u32 = 200;
/// Errors of steps below so many units of round-off are round-off.
const ROUND_OFF: f64 = 8.0;
/// The part of the error of a step that its solver may have in the run-in.
const SOLVER: f64 = 0.05;
/// By how much steps are shortened at most so that the iteration contracts.
const SLOWER: f64 = 16.0;
/// How much of the step that the estimates allow is taken.
const SAFETY: f64 = 0.95;

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
    let trial = Trial {
        problem,
        method,
        newton: *newton,
        span: span.abs(),
        tolerance,
    };
    let (size, error, seen) = if M::OWN_STEPS {
        (trial.own_steps(span)?, tolerance, None)
    } else {
        let (size, estimates, gauge) = trial.run_in(span)?;
        let seen = (gauge, estimates.seen, estimates.part);
        (SAFETY * size, estimates.worst, Some(seen))
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
    let watch = seen.map(|(gauge, seen, part)| Watch::new(gauge, seen, part, &chosen, zero()));
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

/// Steps that are tried.
pub(super) struct Trial<'a, S: Scalar, P: Poisson<S>, M> {
    problem: &'a Problem<S, P>,
    method: &'a M,
    newton: NewtonOptions,
    span: f64,
    tolerance: f64,
}

/// What a trial has found.
pub(super) struct Found<V> {
    /// The error of a step, relative to the state.
    pub(super) error: f64,
    /// The state after two steps of half the size.
    end: V,
    /// Whether the iteration without a Jacobian did not contract.
    slow: bool,
}

/// What the estimates of a run-in have come to.
struct Estimates {
    /// Steps that were counted.
    count: u32,
    /// The largest step that all of them allow.
    allowed: f64,
    /// The largest error of a step.
    worst: f64,
    /// The largest error relative to what it may be.
    part: f64,
    /// The largest number of the gauge.
    seen: f64,
}

impl Estimates {
    const NONE: Self = Self {
        count: 0,
        allowed: f64::INFINITY,
        worst: 0.0,
        part: 0.0,
        seen: 0.0,
    };
}

impl<S: Scalar, P: Poisson<S>, M: Method<S, P>> Trial<'_, S, P, M> {
    /// The error that a step of a size may have.
    pub(super) fn target(&self, h: f64) -> f64 {
        let part = if self.span > 0.0 {
            (h / self.span).min(1.0)
        } else {
            1.0
        };
        (self.tolerance * part).max(least_tolerance::<S>())
    }

    /// The solver for a trial of a size: where each digit costs an iteration, no more exact than the estimate needs.
    fn newton_of(&self, h: f64) -> NewtonOptions {
        let enough = SOLVER * self.target(h) / largest(S::epsilon());
        let tolerance = if M::FIXED_POINT {
            self.newton.tolerance.max(enough)
        } else {
            self.newton.tolerance
        };
        NewtonOptions {
            tolerance,
            ..self.newton
        }
    }

    /// The solver of a run with steps of a size.
    fn newton_of_run(&self, h: f64) -> NewtonOptions {
        match self.newton.convergence {
            Convergence::Tolerance => self.newton_of(h),
            _ => self.newton,
        }
    }

    /// The size of step that the estimates of a run-in allow, and what they are.
    fn run_in(&self, span: f64) -> Result<(f64, Estimates, Gauge<S, P>), IntegrateError> {
        let mut mu = self.problem.mu0.clone();
        let mut followed = self.problem.system.following(&mu);
        let system = followed.as_ref().unwrap_or(&self.problem.system);
        let mut gauge = Gauge::new(system, &mu, M::ORDER);
        let start = gauge.at(system, &mu);
        let mut h = self.first(&mu);
        let (mut reached, mut estimates) = (0.0, Estimates::NONE);
        let (mut ceiling, mut shrunk, mut failure) = (f64::INFINITY, false, None);
        let mut contracting = 0.0_f64;
        for _ in 0..ATTEMPTS {
            // a step that the end cuts short says nothing of longer ones
            let cut = estimates.count > 0 && h > self.span - reached;
            if estimates.count >= ESTIMATES || reached >= self.span || cut {
                let allowed = estimates.allowed.min(ceiling).min(self.span);
                estimates.seen = estimates.seen.max(start);
                return Ok((allowed.max(f64::MIN_POSITIVE), estimates, gauge));
            }
            let system = followed.as_ref().unwrap_or(&self.problem.system);
            h = h.min(self.span - reached);
            let Found { error, end, .. } = match self.estimate(system, &mu, h * span.signum()) {
                // where it does not contract, several shorter steps cost less
                Ok(found) if found.slow && h > contracting => {
                    contracting = f64::max(contracting, h / SLOWER);
                    h *= 0.7;
                    (ceiling, shrunk, estimates) = (h, true, Estimates::NONE);
                    continue;
                }
                Ok(found) => found,
                Err(failed) => {
                    failure = Some(failed);
                    h *= 0.5;
                    (ceiling, shrunk, estimates) = (h, true, Estimates::NONE);
                    continue;
                }
            };
            let target = self.target(h);
            let ratio = (target / error).powf(1.0 / f64::from(M::ORDER.max(1)));
            let kept = error <= 3.0 * target;
            if !kept {
                h *= (0.9 * ratio).clamp(0.1, 0.9);
                (shrunk, estimates) = (true, Estimates::NONE);
                continue;
            }
            // grow first, at the start: a step that its error allowed has to be allowed there too
            if ratio > 1.2 && !shrunk && estimates.count == 0 && reached + h < self.span {
                h *= ratio.min(2.0);
                estimates = Estimates::NONE;
                continue;
            }
            mu = end;
            reached += h;
            estimates.count += 1;
            estimates.allowed = estimates.allowed.min(h * ratio.min(2.0));
            estimates.worst = estimates.worst.max(error);
            estimates.part = estimates.part.max(error / target);
            estimates.seen = estimates.seen.max(gauge.at(system, &mu));
            if let Some(next) = system.following(&mu) {
                followed = Some(next);
            }
        }
        Err(match failure {
            Some(failure) => IntegrateError::Step(Box::new(StepError {
                step: 1,
                time: self.problem.span.0,
                failure,
                stats: Stats::default(),
                works: None,
            })),
            None => OptionError::NoStep(self.tolerance).into(),
        })
    }

    /// The mean of the steps that a method chooses itself, from the start on.
    fn own_steps(&self, span: f64) -> Result<f64, IntegrateError> {
        let system = &self.problem.system;
        let mut size = self.first(&self.problem.mu0);
        loop {
            let mut mu = self.problem.mu0.clone();
            let h = S::from_f64(size * span.signum());
            let mut stepper = self.method.stepper(system, h, &self.newton);
            match stepper.step(&mut mu, &mut ()) {
                Ok(report) if report.substeps >= ESTIMATES || size >= self.span => {
                    return Ok(size / f64::from(report.substeps.max(1)));
                }
                Ok(_) => size = (4.0 * size).min(self.span),
                // the run itself says where it ends
                Err(_) => return Ok(size),
            }
        }
    }

    /// A size of step to begin with, from those of state and field.
    fn first(&self, mu: &P::State) -> f64 {
        let mut field = self.problem.system.zero_state();
        self.problem.system.vector_field(mu, &mut field);
        let size = 0.3 * largest(mu.max_norm()) / largest(field.max_norm());
        if size.is_finite() && size > 0.0 {
            size.min(self.span)
        } else {
            self.span
        }
    }

    /// The error of a step of h, relative to the state, and the state after two steps of h/2.
    pub(super) fn estimate(
        &self,
        system: &P,
        mu: &P::State,
        h: f64,
    ) -> Result<Found<P::State>, StepFailure> {
        let newton = self.newton_of(h.abs());
        let mut slow = false;
        let mut steps = |h: f64, count: u32| {
            let mut stepper = self.method.stepper(system, S::from_f64(h), &newton);
            let mut end = mu.clone();
            for _ in 0..count {
                let report = stepper.step(&mut end, &mut ())?;
                slow |= M::FIXED_POINT && report.factorizations > 0;
            }
            Ok(end)
        };
        let (mut whole, halves) = (steps(h, 1)?, steps(0.5 * h, 2)?);
        whole.axpy(S::from_f64(-1.0), &halves);
        let size = mu.max_norm().max(halves.max_norm());
        let resting = size.less_equal(S::zero());
        let error = S::select(resting, S::zero(), whole.max_norm() / size);
        let part = 1.0 - 0.5_f64.powi(M::ORDER as i32);
        Ok(Found {
            error: largest(error.max(S::epsilon())) / part,
            end: halves,
            slow,
        })
    }
}
