//! What looks after the error of steps during a run whose step was chosen.
//!
//! The start alone was known when it was: a motion may begin quietly and become fast. Where the stages of a step tell its error
//! ([`Stepper::estimate`](crate::methods::Stepper::estimate)), the first six and then every fourth are asked. Of other methods
//! the run watches a number that follows the error of a step and costs little, `s = |f| |Df|^p/|mu|`, p the order, and adds up the errors that it suggests. Where the
//! sum is ten times the tolerance, or the number far beyond what it was when an error was estimated last, the error of the
//! step just made is estimated again. If the sum stays too large, the step is made again in several parts, and so is every
//! later one: the method is one map again from there on. A step that fails is divided too. Where steps cannot be divided as
//! far as the tolerance asks, as before a singularity, the run says so.
//!
//! The sum decides and not the largest error: to divide all steps for the sake of a few costs more than these do.

mod guard;
mod parts;

use super::pace::Chosen;
use super::trial::Trial;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;
pub(super) use guard::Guard;
pub(super) use parts::{JACOBIAN, MOST_PARTS, SLOW_PARTS, divided};

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

/// Of methods whose stages tell errors, the first steps are all looked at, then one of so many.
const FIRST_STEPS: u64 = 6;
const BETWEEN: u32 = 4;
/// Steps are shortened where one has more than so many times its share, of the first ones and of later ones; and where the sum
/// is so many times what it may be, and one has as much as of the first ones may have.
const ABOVE: f64 = 3.0;
const FAR_ABOVE: f64 = 30.0;
const SPENT: f64 = 3.0;
/// By how much at least.
const LEAST_SHORTER: f64 = 1.05;
/// A step with more than so many times its share is made again.
const AGAIN: f64 = 1e3;
/// More iterations than usual by more than this say that the motion is faster.
const WONDER: u32 = 2;
/// Where the steps that their errors allow differ by so much, steps that follow the motion are faster than constant ones.
const UNEVEN: f64 = 10.0;
/// Larger parts of what an error may be count as so large.
const MOST_COUNTED: f64 = 1e6;

/// What tells the errors of steps.
enum By<S: Scalar, P: Poisson<S>> {
    /// The stages of a step.
    Stages,
    /// A number that follows them.
    Field(Field<S, P>),
}

/// The number that follows errors.
struct Field<S: Scalar, P: Poisson<S>> {
    gauge: Gauge<S, P>,
    /// Up to this number nothing is estimated.
    ceiling: f64,
    /// The error of a step for a number of one, as a part of what it may be.
    slope: f64,
}

/// The sum of the errors of a run, as a part of what it may be.
struct Sum {
    spent: f64,
    /// The part of the span that a step is.
    share: f64,
    /// From one step that is looked at to the next.
    interval: u32,
}

impl Sum {
    /// Adds the error of a step, for all up to the next look.
    fn add(&mut self, part: f64) {
        self.spent += part * self.share * f64::from(self.interval);
    }
}

/// What a run knows of the errors of its steps.
pub(super) struct Watch<S: Scalar, P: Poisson<S>> {
    by: By<S, P>,
    sum: Sum,
    left: u32,
    before: P::State,
    /// The iterations of the step that was looked at last.
    usual: u32,
    /// Whether it was said that steps cannot be divided any more.
    said: bool,
    /// The smallest and the largest error of a step with its stages, relative to what it may be.
    range: (f64, f64),
}

/// What becomes of the steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    /// Each is made in so many parts.
    Parts(u32),
    /// There are so many times as many.
    Times(f64),
}

/// From where on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum From {
    /// From the start of the step that was looked at.
    Before,
    /// From its end.
    Behind,
}

/// What follows from a look at a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// It is good.
    Kept,
    /// Steps are to be shorter.
    Change(Change, From),
    /// Its error is too large in any number of parts.
    Lost,
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
    /// Steps until the next look, and from one to the next.
    pub left: u32,
    /// The same.
    pub interval: u32,
    /// The iterations of the step that was looked at last.
    pub usual: u32,
    /// Whether it was said that steps cannot be shortened any more.
    pub said: bool,
}

/// How much the gauge may grow from where an error was found, relative to what it may be.
fn room(part: f64) -> f64 {
    (15.0 / part).clamp(ROOM.0, ROOM.1)
}

impl<S: Scalar, P: Poisson<S>> Watch<S, P> {
    /// By the field, from the largest number seen while steps were chosen, and the largest error of one relative to what it may be.
    pub(super) fn by_field(
        gauge: Gauge<S, P>,
        (seen, part): (f64, f64),
        chosen: &Chosen,
        share: f64,
        zero: P::State,
    ) -> Self {
        let interval = gauge.interval(chosen.step.abs());
        let by = By::Field(Field {
            ceiling: seen * room(part),
            slope: part / seen,
            gauge,
        });
        Self::new(by, (share, interval), zero)
    }

    /// By the stages of the steps.
    pub(super) fn by_stages(share: f64, zero: P::State) -> Self {
        Self::new(By::Stages, (share, 1), zero)
    }

    fn new(by: By<S, P>, (share, interval): (f64, u32), zero: P::State) -> Self {
        Self {
            by,
            sum: Sum {
                spent: 0.0,
                share,
                interval,
            },
            left: 1,
            before: zero,
            usual: u32::MAX,
            said: false,
            range: (f64::INFINITY, 0.0),
        }
    }

    /// By which factor the steps differ that the errors so far allow, where it is large.
    fn uneven(&self, order: f64) -> Option<f64> {
        let (least, most) = self.range;
        let factor = (most / least).powf(1.0 / order);
        (UNEVEN < factor && factor.is_finite()).then_some(factor)
    }

    /// What has changed since the start of the run.
    pub(super) fn watched(&self) -> Watched {
        let (ceiling, slope) = match &self.by {
            By::Field(field) => (field.ceiling, field.slope),
            By::Stages => (0.0, 0.0),
        };
        Watched {
            ceiling,
            slope,
            spent: self.sum.spent,
            left: self.left,
            interval: self.sum.interval,
            usual: self.usual,
            said: self.said,
        }
    }

    /// Goes on where another run was.
    pub(super) fn restore(&mut self, watched: Watched) {
        if let By::Field(field) = &mut self.by {
            (field.ceiling, field.slope) = (watched.ceiling, watched.slope);
        }
        (self.sum.spent, self.left) = (watched.spent, watched.left);
        (self.sum.interval, self.usual) = (watched.interval, watched.usual);
        self.said = watched.said;
    }

    /// Says that steps cannot be divided any more; whether that was not said before.
    pub(super) fn says(&mut self) -> bool {
        !core::mem::replace(&mut self.said, true)
    }

    /// What becomes of a step whose error is so much of what it may be.
    fn by_part(&mut self, part: f64, order: f64, index: u64) -> Verdict {
        let counted = part.min(MOST_COUNTED);
        let counted = if part.is_nan() { MOST_COUNTED } else { counted };
        self.sum.add(counted);
        if part > 0.0 {
            self.range = (self.range.0.min(part), self.range.1.max(part));
        }
        let most = if index < FIRST_STEPS {
            ABOVE
        } else {
            FAR_ABOVE
        };
        if counted <= ABOVE || (counted <= most && self.sum.spent <= SPENT) {
            return Verdict::Kept;
        }
        self.sum.spent = 0.0;
        let times = Change::Times(counted.powf(1.0 / order).clamp(LEAST_SHORTER, 8.0));
        let from = if counted > AGAIN {
            From::Before
        } else {
            From::Behind
        };
        Verdict::Change(times, from)
    }
}

impl<S: Scalar, P: Poisson<S>> Field<S, P> {
    /// Adds the errors that a number suggests; whether one has to be estimated. A number that is none says nothing.
    #[inline(always)]
    fn exceeded(&self, number: f64, sum: &mut Sum) -> bool {
        let suggested = self.slope * number;
        sum.add(if suggested.is_finite() {
            suggested
        } else {
            0.0
        });
        number > self.ceiling || sum.spent > TOO_LARGE
    }

    /// Corrects the sum of errors after one was estimated that has a part of what it may be; whether they are too large.
    fn corrected(&self, number: f64, part: f64, order: f64, sum: &mut Sum) -> bool {
        let suggested = self.slope * number;
        if part < suggested {
            sum.spent *= part / suggested;
        } else {
            sum.add((part - suggested).max(0.0));
        }
        let far = f64::max(FAR_TOO_LARGE, (0.5 * order).exp2());
        let much = sum.spent.min(part) > TOO_LARGE || part > far;
        if sum.spent > TOO_LARGE {
            sum.spent = 0.0;
        }
        much || part.is_nan()
    }

    /// What becomes of the step of h after a state; `number` is that of the gauge at its end.
    #[cold]
    #[inline(never)]
    fn needed(
        &mut self,
        sum: &mut Sum,
        trial: &Trial<'_, S, P>,
        (system, before): (&P, &P::State),
        (h, parts): (f64, u32),
        number: f64,
    ) -> Verdict {
        let order = f64::from(trial.method.order().max(1));
        let (mut now, mut first) = (parts, true);
        let number = number.max(self.gauge.at(system, before));
        loop {
            let size = h / f64::from(now);
            let factor = match trial.estimate(system, before, size) {
                Ok(found) => {
                    let part = found.error / trial.target(size.abs());
                    let large = if first {
                        self.corrected(number, part, order, sum)
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
                if now == parts {
                    return Verdict::Lost;
                }
                break;
            }
            (now, first) = (next, false);
        }
        if now > parts {
            Verdict::Change(Change::Parts(now), From::Before)
        } else {
            Verdict::Kept
        }
    }
}
