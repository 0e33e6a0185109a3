//! Steps that are tried, and what the first ones of a run say of the step for all of it.

use super::error::StepError;
use super::held::Held;
use super::kept::Kept;
use super::observer::Observer as _;
use super::options::OptionError;
use super::pace::least_tolerance;
use super::problem::{Problem, set_time};
use super::pulse::Pulse;
use super::solve::IntegrateError;
use super::stats::Stats;
use super::watch::Gauge;
use crate::methods::StepFailure;
use crate::newton::{Convergence, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;

/// Steps whose estimates decide.
const ESTIMATES: u32 = 5;
/// Attempts at a step, in all.
const ATTEMPTS: u32 = 200;
/// An error of so many units of round-off is round-off alone: it says nothing of longer steps.
const UNSEEN: f64 = 3.0;
/// Smaller parts of round-off than this are not worth shorter steps.
const SMALLEST: f64 = 1.0 / 64.0;

/// Steps that are tried.
pub(super) struct Trial<'a, S: Scalar, P: Poisson<S>> {
    pub(super) problem: &'a Problem<S, P>,
    pub(super) method: &'a Kept<'a, S, P>,
    pub(super) newton: NewtonOptions,
    pub(super) span: f64,
    pub(super) tolerance: f64,
    /// The initial state with its inputs, and the tables of these.
    pub(super) start: P::State,
    tables: Option<Held>,
}

/// What a trial has found.
pub(super) struct TrialStep<V> {
    /// The error of a step, relative to the state.
    pub(super) error: f64,
    /// The state after two steps of half the size.
    end: V,
}

/// What the estimates of a run-in have come to.
pub(super) struct Estimates {
    /// Steps that were counted.
    count: u32,
    /// The largest step that all of them allow.
    allowed: f64,
    /// The largest error of a step.
    pub(super) worst: f64,
    /// The largest error relative to what it may be.
    pub(super) part: f64,
    /// The largest number of the gauge.
    pub(super) seen: f64,
    /// How far the steps came, and the longest of them.
    pub(super) reached: f64,
    pub(super) longest: f64,
}

impl Estimates {
    const NONE: Self = Self {
        count: 0,
        allowed: f64::INFINITY,
        worst: 0.0,
        part: 0.0,
        seen: 0.0,
        reached: 0.0,
        longest: 0.0,
    };
}

impl<'a, S: Scalar, P: Poisson<S>> Trial<'a, S, P> {
    /// Of the steps of a problem by a method.
    pub(super) fn new(
        problem: &'a Problem<S, P>,
        method: &'a Kept<'a, S, P>,
        (newton, tolerance): (NewtonOptions, f64),
        mut held: Option<Held>,
    ) -> Self {
        let span = problem.span.1 - problem.span.0;
        let mut start = problem.start();
        held.hold(&problem.system, (0, problem.span.0, span), &mut start, &[]);
        Self {
            problem,
            method,
            newton,
            span: span.abs(),
            tolerance,
            start,
            tables: held.map(Held::tables),
        }
    }

    /// The initial state at a time, with the inputs of their tables there.
    pub(super) fn at(&self, time: f64) -> P::State {
        let mut mu = self.start.clone();
        let span = self.problem.span.1 - self.problem.span.0;
        set_time(&self.problem.system, &mut mu, time);
        self.tables
            .clone()
            .hold(&self.problem.system, (0, time, span), &mut mu, &[]);
        mu
    }

    /// Times at which inputs are largest and smallest.
    pub(super) fn pushes(&self) -> Vec<Pulse> {
        let (start, end) = self.problem.span;
        let times = self
            .tables
            .as_ref()
            .map_or_else(Vec::new, |held| held.extremes((start, end)));
        times
            .into_iter()
            .map(|time| Pulse::push((time - start).abs()))
            .collect()
    }

    /// The error that a step of a size may have.
    pub(super) fn target(&self, h: f64) -> f64 {
        let part = if self.span > 0.0 {
            (h / self.span).min(1.0)
        } else {
            1.0
        };
        (self.tolerance * part).max(least_tolerance::<S>())
    }

    /// A step whose error is too small to be seen, from one whose error is round-off, by the order of the method.
    pub(super) fn below_round_off(&self, h: f64) -> f64 {
        let asked = self.tolerance * h / self.span.max(h);
        let part = (asked / least_tolerance::<S>()).clamp(SMALLEST, 1.0);
        h * part.powf(1.0 / f64::from(self.method.order().max(1)))
    }

    /// The solver of a run with steps of a size: where each digit costs an iteration, as exact as was asked for.
    pub(super) fn newton_of_run(&self, h: f64) -> NewtonOptions {
        match self.newton.convergence {
            Convergence::Tolerance if self.method.fixed_point() => self.by_tolerance(h),
            _ => self.newton,
        }
    }

    /// The size of step that the estimates of a run-in allow, and what they are: from the start, or from the initial state at
    /// the time of a pulse.
    pub(super) fn run_in(
        &self,
        span: f64,
        pulse: Option<&Pulse>,
    ) -> Result<(f64, Estimates, Gauge<S, P>), IntegrateError> {
        let mut reached = pulse.map_or(0.0, |pulse| pulse.after);
        let mut mu = self.at(self.time(span, reached));
        let mut followed = self.problem.system.following(&mu);
        let system = followed.as_ref().unwrap_or(&self.problem.system);
        let mut gauge = Gauge::new(system, &mu, self.method.order());
        let start = gauge.at(system, &mu);
        let spacing = pulse.map_or(f64::INFINITY, |pulse| pulse.spacing);
        let mut h = self.first(&mu).min(spacing);
        let mut estimates = Estimates::NONE;
        let (mut ceiling, mut shrunk, mut failure) = (f64::INFINITY, false, None);
        let mut longest = 0.0_f64;
        for _ in 0..ATTEMPTS {
            // a step that the end cuts short says nothing of longer ones
            let cut = estimates.count > 0 && h > self.span - reached;
            if estimates.count >= ESTIMATES || reached >= self.span || cut {
                let allowed = estimates.allowed.min(ceiling).min(self.span);
                estimates.seen = estimates.seen.max(start);
                (estimates.reached, estimates.longest) = (reached, longest);
                return Ok((allowed.max(f64::MIN_POSITIVE), estimates, gauge));
            }
            let system = followed.as_ref().unwrap_or(&self.problem.system);
            h = h.min(self.span - reached);
            let TrialStep { error, end } = match self.estimate(system, &mu, h * span.signum()) {
                Ok(found) => found,
                Err(failed) => {
                    failure = Some(failed);
                    h *= 0.5;
                    (ceiling, shrunk, estimates) = (h, true, Estimates::NONE);
                    continue;
                }
            };
            let target = self.target(h);
            let ratio = (target / error).powf(1.0 / f64::from(self.method.order().max(1)));
            let kept = error <= 3.0 * target;
            if !kept {
                h *= (0.9 * ratio).clamp(0.1, 0.9);
                (shrunk, estimates) = (true, Estimates::NONE);
                continue;
            }
            // grow first, at the start: a step that its error allowed has to be allowed there too
            let unseen = error <= UNSEEN * largest(S::epsilon());
            let grows = !shrunk && estimates.count == 0 && reached + h < self.span;
            if (ratio > 1.2 || unseen) && grows {
                h *= ratio.clamp(if unseen { 1.5 } else { 1.0 }, 2.0);
                estimates = Estimates::NONE;
                continue;
            }
            longest = longest.max(h);
            mu = end;
            reached += h;
            estimates.count += 1;
            estimates.allowed = estimates.allowed.min(h * ratio.min(2.0));
            estimates.worst = estimates.worst.max(error);
            estimates.part = estimates.part.max(error / target);
            estimates.seen = estimates.seen.max(gauge.at(system, &mu));
            set_time(system, &mut mu, self.time(span, reached));
            if let Some(next) = system.following(&mu) {
                followed = Some(next);
            }
        }
        let time = self.time(span, reached);
        Err(match failure {
            Some(failure) => IntegrateError::Step(Box::new(StepError {
                step: 1,
                time,
                failure,
                stats: Stats::default(),
                works: None,
            })),
            None => self.no_step(time),
        })
    }

    /// By how many more steps errors may be larger that add up over a pulse alone.
    pub(super) fn over_a_part(&self, pulse: &Pulse) -> f64 {
        pulse.part.powf(1.0 / f64::from(self.method.order().max(1)))
    }

    /// The time so far from the start.
    pub(super) fn time(&self, span: f64, reached: f64) -> f64 {
        self.problem.span.0 + reached * span.signum()
    }

    /// The error where steps beyond a time keep the tolerance only if they are far too short.
    pub(super) fn no_step(&self, time: f64) -> IntegrateError {
        let tolerance = self.tolerance;
        OptionError::NoStep { tolerance, time }.into()
    }

    /// The mean of the steps that a method chooses itself, from the start on.
    pub(super) fn own_steps(&self, span: f64) -> Result<f64, IntegrateError> {
        let system = &self.problem.system;
        let mut size = self.first(&self.start);
        loop {
            let mut mu = self.start.clone();
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
        let time =
            largest(self.problem.system.norm(mu)) / largest(self.problem.system.norm(&field));
        let order = f64::from(self.method.order().max(1));
        let part = f64::max(0.15 * order, 2.0) * self.target(0.3 * time).powf(1.0 / order);
        let size = part.min(1.0) * time;
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
    ) -> Result<TrialStep<P::State>, StepFailure> {
        let steps = |h: f64, count: u32| {
            let mut stepper = self.method.stepper(system, S::from_f64(h), &self.newton);
            let mut end = mu.clone();
            for _ in 0..count {
                stepper.step(&mut end, &mut ())?;
            }
            Ok(end)
        };
        let (mut whole, halves) = (steps(h, 1)?, steps(0.5 * h, 2)?);
        whole.axpy(S::from_f64(-1.0), &halves);
        let size = system.norm(mu).max(system.norm(&halves));
        let resting = size.less_equal(S::zero());
        let error = S::select(resting, S::zero(), system.norm(&whole) / size);
        let part = 1.0 - 0.5_f64.powi(self.method.order() as i32);
        Ok(TrialStep {
            error: largest(error.max(S::epsilon())) / part,
            end: halves,
        })
    }
}
