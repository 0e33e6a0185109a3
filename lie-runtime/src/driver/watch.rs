//! What looks after the error of steps during a run whose step was chosen.
//!
//! The run-in knows the start alone: a motion may begin quietly and become fast. So the run watches a number that follows the
//! error of a step and costs little, `s = |f| |Df|^p/|mu|`, p the order, and adds up the errors that it suggests. Where the
//! sum is ten times the tolerance, or the number far beyond what it was when an error was estimated last, the error of the
//! step just made is estimated again. If the sum stays too large, the step is made again in several parts, and so is every
//! later one: the method is one map again from there on. A step that fails is divided too.
//!
//! The sum decides and not the largest error: to divide all steps for the sake of a few costs more than these do.

use super::pace::Chosen;
use super::trial::Trial;
use crate::matrix::SquareMatrix;
use crate::methods::Method;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;

/// The Jacobian is looked at up to so many coordinates: beyond, it costs more than a step may.
const MOST_COORDINATES: usize = 12;
/// Steps are divided where their errors add up to so many times the tolerance, until one has at most so many times its share.
const TOO_LARGE: f64 = 10.0;
/// They are divided too where a step has more than so many times its share, or what half a division would take off.
const FAR_TOO_LARGE: f64 = 30.0;
/// By how much the watched number may grow before errors are estimated again: as much as they leave room for, within these.
const ROOM: (f64, f64) = (4.0, 64.0);
/// Steps are looked at once in so much of the time in which the motion changes.
const LOOK: f64 = 2.0;
/// Into so many parts a step is divided at most.
pub(super) const MOST_PARTS: u32 = 1 << 12;

/// A number that follows the error of steps of an order.
pub(super) struct Gauge<S: Scalar, P: Poisson<S>> {
    order: i32,
    /// The first `|Df|`, in units of which the others are.
    unit: f64,
    field: P::State,
    jacobian: Option<P::Jacobian>,
}

impl<S: Scalar, P: Poisson<S>> Gauge<S, P> {
    pub(super) fn new(system: &P, mu: &P::State, order: u32) -> Self {
        let small = system.dimension() <= MOST_COORDINATES && system.has_jacobian();
        let mut gauge = Self {
            order: order.max(1) as i32,
            unit: 1.0,
            field: system.zero_state(),
            jacobian: small.then(|| system.zero_jacobian()),
        };
        let (_, rate) = gauge.speed_and_rate(system, mu);
        if rate.is_finite() && rate > 0.0 {
            gauge.unit = rate;
        }
        gauge
    }

    /// `|f|/|mu|`, and `|Df|` in the Frobenius norm.
    fn speed_and_rate(&mut self, system: &P, mu: &P::State) -> (f64, f64) {
        let Some(jacobian) = &mut self.jacobian else {
            system.vector_field(mu, &mut self.field);
            let speed = largest(system.norm(&self.field) / system.norm(mu));
            return (speed, speed);
        };
        system.linearize(mu, &mut self.field, jacobian);
        let mut sum = S::zero();
        let count = self.field.as_slice().len();
        for row in 0..count {
            for column in 0..count {
                let entry = jacobian.get(row, column);
                sum += entry * entry;
            }
        }
        let speed = largest(system.norm(&self.field) / system.norm(mu));
        (speed, largest(sum.sqrt()))
    }

    /// The number at a state; not a number where the field is not.
    #[inline(never)]
    pub(super) fn at(&mut self, system: &P, mu: &P::State) -> f64 {
        let (speed, rate) = self.speed_and_rate(system, mu);
        speed * (rate / self.unit).powi(self.order)
    }

    /// How many steps of a size go between two looks.
    fn interval(&self, h: f64) -> u32 {
        (LOOK / (h * self.unit)).clamp(1.0, 1e6) as u32
    }
}

/// What a run knows of the errors of its steps.
pub(super) struct Watch<S: Scalar, P: Poisson<S>> {
    gauge: Gauge<S, P>,
    /// Up to this number nothing is estimated.
    ceiling: f64,
    /// The error of a step for a number of one, and the sum of errors, both as parts of what they may be.
    slope: f64,
    spent: f64,
    /// The part of the span that a step is.
    share: f64,
    interval: u32,
    left: u32,
    before: P::State,
}

/// What a run that is taken up has to know of the errors of its steps, as parts of what they may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watched {
    /// Up to this value of the watched number nothing is estimated.
    pub ceiling: f64,
    /// The error of a step for a number of one.
    pub slope: f64,
    /// The sum of errors.
    pub spent: f64,
    /// Steps until the next look.
    pub left: u32,
}

/// How much the gauge may grow from where an error was found, relative to what it may be.
fn room(part: f64) -> f64 {
    (15.0 / part).clamp(ROOM.0, ROOM.1)
}

impl<S: Scalar, P: Poisson<S>> Watch<S, P> {
    /// From the largest number seen while steps were chosen, and the largest error of one relative to what it may be.
    pub(super) fn new(
        gauge: Gauge<S, P>,
        (seen, part): (f64, f64),
        chosen: &Chosen,
        share: f64,
        zero: P::State,
    ) -> Self {
        let interval = gauge.interval(chosen.step.abs());
        Self {
            ceiling: seen * room(part),
            slope: part / seen,
            spent: 0.0,
            share,
            gauge,
            interval,
            left: 1,
            before: zero,
        }
    }

    /// What has changed since the start of the run.
    pub(super) fn watched(&self) -> Watched {
        Watched {
            ceiling: self.ceiling,
            slope: self.slope,
            spent: self.spent,
            left: self.left,
        }
    }

    /// Goes on where another run was.
    pub(super) fn restore(&mut self, watched: Watched) {
        (self.ceiling, self.slope) = (watched.ceiling, watched.slope);
        (self.spent, self.left) = (watched.spent, watched.left);
    }

    /// Adds the errors that a number suggests; whether one has to be estimated. A number that is none says nothing.
    #[inline(always)]
    fn exceeded(&mut self, number: f64) -> bool {
        let sum = self.slope * number * self.share * f64::from(self.interval);
        self.spent += if sum.is_finite() { sum } else { 0.0 };
        number > self.ceiling || self.spent > TOO_LARGE
    }

    /// Corrects the sum of errors after one was estimated that has a part of what it may be; whether they are too large.
    fn corrected(&mut self, number: f64, part: f64, order: f64) -> bool {
        let suggested = self.slope * number;
        if part < suggested {
            self.spent *= part / suggested;
        } else {
            self.spent += (part - suggested).max(0.0) * self.share * f64::from(self.interval);
        }
        let far = f64::max(FAR_TOO_LARGE, (0.5 * order).exp2());
        let much = self.spent.min(part) > TOO_LARGE || part > far;
        if self.spent > TOO_LARGE {
            self.spent = 0.0;
        }
        much || part.is_nan()
    }

    /// In how many parts the step of h after the state that was kept is to be made; `number` is that of the gauge at its end.
    #[cold]
    #[inline(never)]
    fn needed<M: Method<S, P>>(
        &mut self,
        trial: &Trial<'_, S, P, M>,
        system: &P,
        (h, parts): (f64, u32),
        number: f64,
    ) -> u32 {
        let order = f64::from(trial.method().order().max(1));
        let (mut now, mut first) = (parts, true);
        let number = number.max(self.gauge.at(system, &self.before));
        loop {
            let size = h / f64::from(now);
            let factor = match trial.estimate(system, &self.before, size, now < SLOW_PARTS) {
                Ok(found) => {
                    let part = found.error / trial.target(size.abs());
                    let large = if first {
                        self.corrected(number, part, order)
                    } else {
                        part.is_nan() || part > TOO_LARGE
                    };
                    if !large {
                        self.ceiling = number * room(part);
                        self.slope = part / number;
                        break;
                    }
                    (part / TOO_LARGE).powf(1.0 / order).clamp(1.1, 8.0)
                }
                Err(_) => 2.0,
            };
            let next = (factor * f64::from(now)).ceil() as u32;
            if next > MOST_PARTS {
                self.ceiling = f64::INFINITY;
                self.slope = 0.0;
                break;
            }
            (now, first) = (next, false);
        }
        now
    }
}

/// A watch with what tries steps.
pub(super) struct Guard<'a, S: Scalar, P: Poisson<S>, M> {
    pub(super) watch: Watch<S, P>,
    pub(super) trial: Trial<'a, S, P, M>,
}

impl<S: Scalar, P: Poisson<S>, M: Method<S, P>> Guard<'_, S, P, M> {
    /// Whether the step to come is looked at; keeps the state before it if so.
    #[inline(always)]
    pub(super) fn begins(&mut self, mu: &P::State) -> bool {
        let watch = &mut self.watch;
        watch.left -= 1;
        let due = watch.left == 0;
        if due {
            watch.left = watch.interval;
            watch.before.copy_from(mu);
        }
        due
    }

    /// The state before the step.
    pub(super) fn before(&self) -> &P::State {
        &self.watch.before
    }

    /// In how many parts a step of h is to be made that was made in some and has ended at a state.
    #[inline(always)]
    pub(super) fn parts(&mut self, system: &P, (h, parts): (f64, u32), end: &P::State) -> u32 {
        let number = self.watch.gauge.at(system, end);
        if !self.watch.exceeded(number) {
            return parts;
        }
        self.watch.needed(&self.trial, system, (h, parts), number)
    }
}

/// A step that needs a Jacobian in place of a fixed point costs about as much as so many that do not.
pub(super) const JACOBIAN: u64 = 200;
/// Into so many parts steps are divided at most in order to contract.
pub(super) const SLOW_PARTS: u32 = 8;

/// In how many parts a step is made that failed in some; none where that is enough.
pub(super) fn divided(parts: u32) -> Option<u32> {
    (parts < MOST_PARTS).then_some(2 * parts)
}
