//! The number of steps of a run whose method shows the error of a step by its stages.
//!
//! A step is tried from the start: it is solved as the run will solve it, and its stages tell its error
//! ([`Stepper::estimate`](crate::methods::Stepper::estimate)). Where the sum of such errors over the span is more than the tolerance allows, more steps are tried, else
//! fewer, until neighbours on a ladder of numbers of steps are one too few and the other enough. The accepted step is the
//! first one of the run. Neighbours differ by a tenth. A tighter tolerance is found to take no fewer steps; later ones may be
//! shortened where those of a looser one are not, so that the sum may differ by some tenths.
//!
//! A step also has to contract well: the number of evaluations in all hardly depends on the step where the fixed point contracts by
//! a factor of three to eight an iteration, and where it contracts more slowly, later steps may not contract at all.

use super::error::StepError;
use super::joints::Joints;
use super::kept::KeptStepper;
use super::pace::count;
use super::problem::set_time;
use super::pulse::Pulse;
use super::solve::IntegrateError;
use super::stats::Stats;
use super::trial::Trial;
use super::watch::JACOBIAN;
use crate::methods::{StepFailure, StepReport};
use crate::newton::{Convergence, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};

/// Times the tolerance that the sum of estimates may be: they are ten to thirty times too large.
pub(super) const AIM: f64 = 20.0;
/// The part of the error of a step that its solver may have.
const SOLVER: f64 = 0.3;
/// From one number of steps to the next.
const RUNG: f64 = 1.1;
/// The first step that is tried, in units of `|mu|/|f|`.
const FIRST: f64 = 1.2;
/// Steps that are tried.
const ATTEMPTS: u32 = 100;
/// The slowest rate of a fixed point that a step may have.
const SLOWEST: f64 = 0.2;
/// Iterations that a step takes more which has nothing to begin from.
const COLD: f64 = 4.0;
/// By how much numbers of steps change at once: down and up.
const CHANGE: (f64, f64) = (0.3, 3.0);
/// The same where a step failed, and where its stages tell no error.
const FAILED: f64 = 1.6;
const UNTOLD: f64 = 1.35;
/// A piece between joints tells the error of a step that is up to so many times as long.
const LONGER: f64 = 4.0;
/// More steps than this, and so many times as many as were tried first, are those of a singularity.
const MOST_STEPS: f64 = 4e6;
const MOST_SHORTENED: f64 = 1024.0;

/// A first step.
pub(super) struct Begun<'s, S: Scalar, P: Poisson<S>> {
    /// What made it, and goes on.
    pub(super) stepper: KeptStepper<'s, S, P>,
    /// The state at its end.
    pub(super) end: P::State,
    pub(super) report: StepReport,
}

/// A number of steps with which a tolerance is kept.
pub(super) struct Staged<'s, S: Scalar, P: Poisson<S>> {
    pub(super) steps: f64,
    /// The error of the first one, relative to the state.
    pub(super) error: f64,
    /// The first one; none where another will be made.
    pub(super) begun: Option<Begun<'s, S, P>>,
}

/// What a step that was tried has come to.
enum Tried<'s, S: Scalar, P: Poisson<S>> {
    /// Of the number of steps, so many would do.
    Enough(Staged<'s, S, P>, f64),
    /// So many would do.
    TooFew(f64, Option<StepFailure>),
    /// The stages of this method tell nothing.
    Untold,
}

/// Where steps are tried.
struct Place<'s, 'm, S: Scalar, P: Poisson<S>> {
    system: &'s P,
    mu: &'m P::State,
    time: f64,
}

/// How many steps a rung of the ladder stands for.
fn rung(span: f64, k: i32) -> f64 {
    count(span, RUNG.powi(k).ceil())
}

/// The lowest rung with so many steps.
fn rung_of(steps: f64) -> i32 {
    (steps.max(1.0).ln() / RUNG.ln() - 1e-9).ceil() as i32
}

impl<'a, S: Scalar, P: Poisson<S>> Trial<'a, S, P> {
    /// How many steps keep the tolerance, from the start or from the initial state at the time of a pulse; none where the stages of
    /// the method tell no errors.
    pub(super) fn by_stages(
        &self,
        span: f64,
        pulse: Option<&Pulse>,
    ) -> Result<Option<Staged<'a, S, P>>, IntegrateError> {
        let system = &self.problem.system;
        let time = self.time(span, pulse.map_or(0.0, |pulse| pulse.after));
        let mu = self.at(time);
        let longest = pulse.map_or(f64::INFINITY, |pulse| pulse.spacing);
        let Some(followed) = system.following(&mu) else {
            let place = Place {
                system,
                mu: &mu,
                time,
            };
            return self.search(span, &place, longest);
        };
        let place = Place {
            system: &followed,
            mu: &mu,
            time,
        };
        let found = self.search(span, &place, longest)?;
        Ok(found.map(|found| Staged {
            steps: found.steps,
            error: found.error,
            begun: None,
        }))
    }

    /// Tries steps at a place, the first of at most a length.
    fn search<'s>(
        &self,
        span: f64,
        place: &Place<'s, '_, S, P>,
        longest: f64,
    ) -> Result<Option<Staged<'s, S, P>>, IntegrateError>
    where
        'a: 's,
    {
        let mut field = place.system.zero_state();
        place.system.vector_field(place.mu, &mut field);
        let rate = largest(place.system.norm(&field) / place.system.norm(place.mu));
        let first = (span.abs() * f64::max(rate / FIRST, 1.0 / longest)).ceil();
        let first = if first.is_finite() { first } else { 1.0 };
        let mut k = rung_of(first);
        let (mut too_few, mut found, mut failure) = (-1, None, None);
        let mut lowest = i32::MAX;
        for _ in 0..ATTEMPTS {
            let steps = rung(span, k);
            if steps > MOST_STEPS && steps > MOST_SHORTENED * first {
                break;
            }
            match self.tried(span, steps, place) {
                Tried::Untold => return Ok(None),
                Tried::Enough(staged, needed) => {
                    found = Some(staged);
                    lowest = k;
                    while lowest > too_few + 1 && rung(span, lowest - 1) == steps {
                        lowest -= 1;
                    }
                    k = rung_of(needed).max(too_few + 1);
                    if k >= lowest {
                        break;
                    }
                }
                Tried::TooFew(needed, why) => {
                    failure = why.or(failure);
                    too_few = k;
                    while rung(span, too_few + 1) == steps {
                        too_few += 1;
                    }
                    if too_few + 1 >= lowest {
                        break;
                    }
                    k = rung_of(needed).clamp(too_few + 1, lowest - 1);
                }
            }
        }
        if found.is_some() {
            return Ok(found);
        }
        Err(match failure {
            Some(failure) => IntegrateError::Step(Box::new(StepError {
                step: 1,
                time: place.time,
                failure,
                stats: Stats::default(),
                works: None,
            })),
            None => self.no_step(place.time),
        })
    }

    /// Tries the first of so many steps.
    fn tried<'s>(&self, span: f64, steps: f64, place: &Place<'s, '_, S, P>) -> Tried<'s, S, P>
    where
        'a: 's,
    {
        let h = span / steps;
        let (time, size) = self.between_joints(place, h);
        let mut mu = place.mu.clone();
        set_time(place.system, &mut mu, time);
        let newton = self.newton_of_stages(steps);
        let mut stepper = self
            .method
            .stepper(place.system, S::from_f64(size), &newton);
        let mut end = mu;
        let report = match stepper.step(&mut end, &mut ()) {
            Ok(report) => report,
            Err(failure) => return Tried::TooFew(FAILED * steps, Some(failure)),
        };
        let Some(error) = stepper.estimate() else {
            return Tried::Untold;
        };
        set_time(place.system, &mut end, time + size);
        let order = f64::from(self.method.order().max(1));
        let error = largest(error);
        // what a short piece says of a whole step is nothing: those of the run tell more
        let longer = h / size;
        let longer = if longer > LONGER { 1.0 } else { longer };
        let part = self.part(error, size) * longer.powf(order);
        let slow = self.rate(&report, &newton) * longer / SLOWEST;
        let enough = part <= 1.0 && slow <= 1.0 && report.factorizations == 0;
        if !enough {
            let by_error = if part.is_finite() {
                part.powf(1.0 / order)
            } else {
                UNTOLD
            };
            let factor = by_error.max(slow).clamp(RUNG, CHANGE.1);
            return Tried::TooFew(factor * steps, None);
        }
        let factor = part.powf(1.0 / order).max(slow).max(CHANGE.0);
        let begun = Begun {
            stepper,
            end,
            report,
        };
        let staged = Staged {
            steps,
            error,
            begun: (size == h).then_some(begun),
        };
        Tried::Enough(staged, factor * steps)
    }

    /// The error of a step over what it may have; its sign does not matter.
    pub(super) fn part(&self, error: f64, h: f64) -> f64 {
        error / (AIM * self.tolerance * (h.abs() / self.span))
    }

    /// The rate at which the fixed point contracts, by how many iterations a step took that had nothing to begin from.
    fn rate(&self, report: &StepReport, newton: &NewtonOptions) -> f64 {
        let digits = -(newton.tolerance * largest(S::epsilon())).ln();
        let iterations = f64::from(report.iterations) - COLD;
        if iterations > 0.0 {
            (-digits / iterations).exp()
        } else {
            0.0
        }
    }

    /// The solver of the first of so many steps.
    fn newton_of_stages(&self, steps: f64) -> NewtonOptions {
        let newton = self.newton_of_run(self.span / steps);
        match steps < JACOBIAN as f64 {
            true => self.method.cheap(newton),
            false => newton,
        }
    }

    /// The solver of a run with steps of a size whose stages tell their errors.
    pub(super) fn by_tolerance(&self, h: f64) -> NewtonOptions {
        let share = self.tolerance * (h / self.span).min(1.0);
        let enough = SOLVER * share / largest(S::epsilon());
        NewtonOptions {
            tolerance: self.newton.tolerance.max(enough),
            convergence: Convergence::State,
            ..self.newton
        }
    }

    /// A step within the run, or the longest piece of it between joints that are known beforehand: where it begins, and its size.
    fn between_joints(&self, place: &Place<'_, '_, S, P>, h: f64) -> (f64, f64) {
        // a system may end where the run does, as a table of the time: no step goes beyond that
        let (from, to) = self.problem.span;
        let last = to - h;
        let start = match (place.time - last) * h > 0.0 {
            // not by round-off either
            true if (last - from) * h < 0.0 => from,
            true => last,
            false => place.time,
        };
        let end = match (start + h - to) * h > 0.0 {
            true => to,
            false => start + h,
        };
        let size = if end == to { to - start } else { h };
        let whole = (start, size);
        let Some(mut joints) = Joints::of(place.system) else {
            return whole;
        };
        let pieces = joints.pieces(place.system, (start, end));
        let sizes = pieces.iter().map(|&(start, end)| (start, end - start));
        let longest = sizes.max_by(|a, b| f64::total_cmp(&a.1.abs(), &b.1.abs()));
        longest.filter(|piece| piece.1 != 0.0).unwrap_or(whole)
    }
}
