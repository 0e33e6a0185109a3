//! When an iteration over stages side by side has ended.

use crate::newton::NewtonOptions;
use crate::scalar::{Mask, Scalar};

/// Updates up to this many units of round-off that no longer shrink are round-off themselves.
pub(super) const STAGNATION: f64 = 256.0;

/// A rate that was seen in another step is not trusted below this.
const TRUSTED: f64 = 1.0 / 16.0;

/// When an iteration has ended, in changes of the slopes.
pub(super) struct Ending<S: Scalar> {
    /// What may be left.
    goal: S,
    /// A first change up to this leaves that little, by the rate of the step before.
    pub(super) at_once: S,
    /// Changes up to this are round-off if they no longer shrink.
    round_off: S,
    /// Changes above this are not looked at.
    pub(super) bound: S,
}

impl<S: Scalar> Ending<S> {
    /// For slopes of which a part of round-off is `epsilon` times the size.
    #[inline(always)]
    pub(super) fn new(size: S, rate: S, options: &NewtonOptions) -> Self {
        let unit = S::epsilon() * size;
        let goal = unit * S::from_f64(options.tolerance);
        let rate = rate.max(S::from_f64(TRUSTED));
        Self {
            goal,
            at_once: goal * ((S::one() - rate) / rate),
            round_off: unit * S::from_f64(STAGNATION),
            bound: unit * S::from_f64(STAGNATION.max(16.0 * options.tolerance)),
        }
    }

    /// The lanes in which changes shrink, and those in which it has ended: with the ratio r of the last two changes as the
    /// rate, the last one times `r/(1 - r)` is left.
    #[inline(always)]
    pub(super) fn reached(&self, before: S, change: S) -> (S::Mask, S::Mask) {
        let shrinks = (change + change).less(before);
        let left = change * change;
        let small = left.less_equal(self.goal * (before - change));
        let settled = change.less_equal(self.round_off);
        (shrinks, (shrinks & small) | (!shrinks & settled))
    }
}

/// The lanes in which eight numbers are all below a bound.
#[inline(always)]
pub(super) fn are_below<S: Scalar>(numbers: S::Wide, bound: S) -> S::Mask {
    if S::LANES == 1 {
        return S::Mask::splat(numbers.less_equal(bound.widen()).all());
    }
    let all = S::Mask::splat(true);
    let numbers = S::scatter(numbers).into_iter();
    numbers.fold(all, |below, number| below & number.less_equal(bound))
}

/// The largest of eight numbers.
#[inline(always)]
pub(super) fn most<S: Scalar>(wide: S::Wide) -> S {
    if S::LANES == 1 {
        let pairs = wide.max(S::exchange::<1>(wide));
        let fours = pairs.max(S::exchange::<2>(pairs));
        let [most, ..] = S::scatter(fours.max(S::exchange::<4>(fours)));
        return most;
    }
    let [a, b, c, d, e, f, g, h] = S::scatter(wide);
    S::max(S::max(a.max(b), c.max(d)), S::max(e.max(f), g.max(h)))
}
