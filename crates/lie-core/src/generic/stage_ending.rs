//! When an iteration over stages side by side has ended.

use crate::newton::NewtonOptions;
use crate::newton::rest::{STAGNATION, dropped, left};
use crate::scalar::Scalar;

/// A rate that was seen in another step is not trusted below this.
const TRUSTED: f64 = 1.0 / 16.0;

/// When an iteration has ended, in changes of the slopes.
pub(super) struct Ending<S: Scalar> {
    /// One unit of round-off.
    pub(super) unit: S,
    /// What may be left.
    goal: S,
    /// A first change up to this leaves that little, by the rate of the step before.
    pub(super) at_once: S,
    /// Changes above this are not looked at.
    pub(super) bound: S,
}

impl<S: Scalar> Ending<S> {
    /// For slopes of which a part of round-off is `epsilon` times the size.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn new(size: S, rate: S, options: &NewtonOptions) -> Self {
        let unit = S::epsilon() * size;
        let goal = unit * S::from_f64(options.tolerance);
        let rate = rate.max(S::from_f64(TRUSTED));
        Self {
            unit,
            goal,
            at_once: goal * ((S::one() - rate) / rate),
            bound: unit * S::from_f64(STAGNATION.max(16.0 * options.tolerance)),
        }
    }

    /// The lanes in which so little is left, by the ratio of the last two of three changes, and those in which changes have dropped to
    /// round-off, after `count` iterations of which the first one changed `first`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn reached(&self, first: S, changes: [S; 3], count: u32) -> [S::Mask; 2] {
        let [_, before, change] = changes;
        let rate = change / before;
        let small = rate.less(S::one()) & left(change, rate).less_equal(self.goal);
        let small = small | change.less_equal(S::zero());
        [small, dropped(first, changes, self.unit, count)]
    }
}

/// The largest of eight numbers.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn most<S: Scalar>(wide: S::Wide) -> S {
    let [most, ..] = S::scatter(most_everywhere::<S>(wide));
    most
}

/// The same in all places.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn most_everywhere<S: Scalar>(wide: S::Wide) -> S::Wide {
    if S::LANES == 1 {
        let pairs = wide.max(S::exchange::<1>(wide));
        let fours = pairs.max(S::exchange::<2>(pairs));
        return fours.max(S::exchange::<4>(fours));
    }
    let [a, b, c, d, e, f, g, h] = S::scatter(wide);
    S::max(S::max(a.max(b), c.max(d)), S::max(e.max(f), g.max(h))).widen()
}
