//! A step size from a tolerance.
//!
//! A run-in from the initial state estimates the error of single steps and the constant step that follows from it; the run
//! itself then starts anew with that step, so that it is one map from its beginning to its end.
//!
//! The error e of a step of h is that against two steps of h/2, times `2^p/(2^p - 1)`, p the order: h is chosen so that
//! `e(h) |T|/h`, the sum over all steps of a span T, is the tolerance. It is relative to the size of the state, in the
//! maximum norm. Where errors of single steps grow on their way, as near unstable motion, the error at the end is larger.
//!
//! Reference: E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd edition, Springer
//! 1993, section II.4, [doi:10.1007/978-3-540-78862-1](https://doi.org/10.1007/978-3-540-78862-1).

use super::error::StepError;
use super::options::{OptionError, Options, Pace};
use super::problem::Problem;
use super::solve::IntegrateError;
use super::stats::Stats;
use crate::methods::{Method, StepFailure, Stepper};
use crate::newton::NewtonOptions;
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
    /// The solver of an implicit step.
    pub newton: NewtonOptions,
}

/// Steps whose estimates decide.
const ESTIMATES: u32 = 8;
/// Attempts at a step, in all.
const ATTEMPTS: u32 = 200;
/// Errors of steps below this are round-off.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;
/// The part of the error of a step that its solver may have.
const SOLVER: f64 = 0.05;
/// How much of the step that the estimates allow is taken.
const SAFETY: f64 = 0.95;

/// The step of a run and the solver of its steps.
pub(super) fn settle<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    problem: &Problem<S, P>,
    method: &M,
    options: &Options,
) -> Result<(f64, NewtonOptions, Option<Chosen>), IntegrateError> {
    match options.pace {
        Pace::Step(step) => Ok((step, options.newton, None)),
        Pace::Tolerance(tolerance) => {
            let chosen = choose(problem, method, tolerance, &options.newton)?;
            Ok((chosen.step, chosen.newton, Some(chosen)))
        }
    }
}

/// The constant step with which a method keeps a tolerance.
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
    let (start, end) = problem.span;
    let span = end - start;
    if !(ROUND_OFF..1.0).contains(&tolerance) {
        return Err(OptionError::Tolerance(tolerance).into());
    }
    if !span.is_finite() {
        return Err(OptionError::Span(start, end).into());
    }
    let followed = problem.system.following(&problem.mu0);
    let system = followed.as_ref().unwrap_or(&problem.system);
    let trial = Trial {
        system,
        method,
        newton: *newton,
        span: span.abs(),
        tolerance,
    };
    let (size, error) = trial.run_in(&problem.mu0, span)?;
    let steps = count(span, (span.abs() / (SAFETY * size)).ceil().max(1.0));
    let step = if span == 0.0 { 1.0 } else { span / steps };
    Ok(Chosen {
        tolerance,
        step,
        error,
        at_round_off: tolerance / steps < ROUND_OFF,
        newton: trial.newton_of(step.abs()),
    })
}

/// The least number of steps, from one on, whose last time is the end of the span to the last digit, if it is near.
fn count(span: f64, least: f64) -> f64 {
    let near = (0..16).map(|k| least + f64::from(k));
    let mut exact = near.filter(|steps| span / steps * steps == span);
    exact.next().unwrap_or(least)
}

/// Steps that are tried.
struct Trial<'a, P, M> {
    system: &'a P,
    method: &'a M,
    newton: NewtonOptions,
    span: f64,
    tolerance: f64,
}

impl<P, M> Trial<'_, P, M> {
    /// The error that a step of a size may have.
    fn target<S: Scalar>(&self, h: f64) -> f64
    where
        M: Method<S, P>,
        P: Poisson<S>,
    {
        let part = if self.span > 0.0 {
            (h / self.span).min(1.0)
        } else {
            1.0
        };
        (self.tolerance * part).max(ROUND_OFF)
    }

    /// The solver for a step of a size: as exact as was asked for, but where each digit costs an iteration no more exact
    /// than the step needs.
    fn newton_of<S: Scalar>(&self, h: f64) -> NewtonOptions
    where
        M: Method<S, P>,
        P: Poisson<S>,
    {
        let enough = SOLVER * self.target(h) / f64::EPSILON;
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

    /// The size of step that the estimates of a run-in allow, and the largest error in it.
    fn run_in<S: Scalar>(&self, start: &P::State, span: f64) -> Result<(f64, f64), IntegrateError>
    where
        M: Method<S, P>,
        P: Poisson<S>,
    {
        let mut mu = start.clone();
        let (mut h, mut reached) = (self.first(&mu), 0.0);
        let (mut allowed, mut worst, mut counted) = (f64::INFINITY, 0.0_f64, 0);
        let (mut shrunk, mut failure) = (false, None);
        for _ in 0..ATTEMPTS {
            if counted >= ESTIMATES || reached >= self.span {
                return Ok((allowed.min(self.span.max(f64::MIN_POSITIVE)), worst));
            }
            h = h.min(self.span);
            let estimated = self.estimate(&mu, h * span.signum());
            let (error, end) = match estimated {
                Ok(found) => found,
                Err(failed) => {
                    failure = Some(failed);
                    (h, shrunk) = (0.5 * h, true);
                    continue;
                }
            };
            let target = self.target(h);
            let ratio = (target / error).powf(1.0 / f64::from(M::ORDER + 1));
            let kept = error <= 3.0 * target;
            if !kept {
                h *= (0.9 * ratio).clamp(0.1, 0.9);
                (shrunk, counted, allowed, worst) = (true, 0, f64::INFINITY, 0.0);
                continue;
            }
            // grow first, and count where the step is about that which stays
            if ratio > 1.2 && !shrunk && counted < 2 && h < self.span {
                h *= ratio.min(2.0);
                (counted, allowed, worst) = (0, f64::INFINITY, 0.0);
                continue;
            }
            mu = end;
            reached += h;
            counted += 1;
            allowed = allowed.min(h * ratio.min(2.0));
            worst = worst.max(error);
        }
        Err(match failure {
            Some(failure) => IntegrateError::Step(Box::new(StepError {
                step: 1,
                time: 0.0,
                failure,
                stats: Stats::default(),
                works: None,
            })),
            None => OptionError::NoStep(self.tolerance).into(),
        })
    }

    /// A size of step to begin with, from those of state and field.
    fn first<S: Scalar>(&self, mu: &P::State) -> f64
    where
        P: Poisson<S>,
    {
        let mut field = self.system.zero_state();
        self.system.vector_field(mu, &mut field);
        let size = 0.3 * largest(mu.max_norm()) / largest(field.max_norm());
        if size.is_finite() && size > 0.0 {
            size.min(self.span)
        } else {
            self.span
        }
    }

    /// The error of a step of h, relative to the state, and the state after two steps of h/2.
    fn estimate<S: Scalar>(&self, mu: &P::State, h: f64) -> Result<(f64, P::State), StepFailure>
    where
        M: Method<S, P>,
        P: Poisson<S>,
    {
        let newton = self.newton_of(h.abs());
        let steps = |h: f64, count: u32| {
            let mut stepper = self.method.stepper(self.system, S::from_f64(h), &newton);
            let mut end = mu.clone();
            for _ in 0..count {
                stepper.step(&mut end, &mut ())?;
            }
            Ok(end)
        };
        let (mut whole, halves) = (steps(h, 1)?, steps(0.5 * h, 2)?);
        whole.axpy(S::from_f64(-1.0), &halves);
        let size = mu.max_norm().max(halves.max_norm());
        let error = S::select(
            size.less_equal(S::zero()),
            S::zero(),
            whole.max_norm() / size,
        );
        let part = 1.0 - 0.5_f64.powi(M::ORDER as i32);
        Ok((largest(error).max(f64::EPSILON) / part, halves))
    }
}
