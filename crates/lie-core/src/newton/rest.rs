//! Updates at round-off, told from updates that shrink slowly.

use crate::scalar::Scalar;

/// Updates up to this many units of round-off that no longer shrink are round-off themselves.
pub(crate) const STAGNATION: f64 = 256.0;

/// So many iterations are reviewed together.
pub(crate) const REVIEW: u32 = 8;

/// The ratio from which on two updates, of which one is between, do not shrink.
const STILL: (f64, f64) = (7.0, 8.0);

/// What is left after an update, by its ratio to the one before; not a number or negative where that is none of
/// convergence.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn left<S: Scalar>(update: S, rate: S) -> S {
    update * (rate / (S::one() - rate))
}

/// The lanes in which the last of three updates is at round-off after `count` iterations that began with `first`, where they
/// have shrunk by more than one half each in the mean: they do not shrink any more, or by little where they did by more than
/// a quarter.
///
/// Where the mean is larger, ratios say little: updates that turn while they shrink have any.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn dropped<S: Scalar>(first: S, updates: [S; 3], unit: S, count: u32) -> S::Mask {
    let [earlier, before, update] = updates;
    let steps = count.saturating_sub(1).min(500);
    let halves = S::from_f64(power_of_two(steps));
    let settled = update.less_equal(unit * S::from_f64(STAGNATION));
    let halved = (update * halves).less_equal(first) | first.less_equal(unit * S::ratio(4.0, 1.0));
    let quick = is_quick([first, update], count) & update.less_equal(unit);
    let still = !update.less(earlier * S::ratio(STILL.0, STILL.1));
    let slow = !(update + update).less(before);
    settled & ((halved & still) | (quick & slow))
}

/// The lanes in which updates have shrunk by more than a quarter each in the mean.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn is_quick<S: Scalar>([first, update]: [S; 2], count: u32) -> S::Mask {
    let steps = count.saturating_sub(1).min(500);
    (update * S::from_f64(power_of_two(2 * steps))).less_equal(first)
}

/// `2^bits`
fn power_of_two(bits: u32) -> f64 {
    f64::from_bits(u64::from(1023 + bits) << 52)
}

/// The sizes of updates at the last reviews: an iteration that shrinks by less than one half in two of them is at rest where
/// its updates may be round-off, and one that does so in a single one elsewhere does not converge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reviews<S> {
    last: S,
    before: S,
}

impl<S: Scalar> Reviews<S> {
    pub(crate) fn new() -> Self {
        let none = S::from_f64(f64::MAX);
        Self {
            last: none,
            before: none,
        }
    }

    /// Takes an update in the lanes of a mask, and returns those at rest and those that do not converge.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn take(&mut self, lanes: S::Mask, update: S, unit: S) -> [S::Mask; 2] {
        let half = S::ratio(1.0, 2.0);
        let settled = update.less_equal(unit * S::from_f64(STAGNATION));
        let resting = lanes & settled & !update.less(self.before * half);
        let failing = lanes & !settled & !update.less(self.last * half);
        self.before = S::select(lanes, self.last, self.before);
        self.last = S::select(lanes, update, self.last);
        [resting, failing]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Mask;

    /// The reviews of updates in units of round-off, each as whether it is at rest and whether it does not converge.
    fn reviewed(updates: &[f64]) -> Vec<[bool; 2]> {
        let all = <f64 as Scalar>::Mask::splat(true);
        let mut reviews = Reviews::new();
        let taken = updates.iter().map(|&update| reviews.take(all, update, 1.0));
        taken.map(|found| found.map(|mask| mask.any())).collect()
    }

    #[test]
    fn what_stands_still_is_at_rest_or_does_not_converge() {
        let going = [false, false];
        // updates that shrink go on, whatever their size
        assert_eq!(reviewed(&[1e6, 1e4, 1e2, 1.0, 1e-2]), [going; 5]);
        // those that stand still above round-off do not converge, at once
        assert_eq!(reviewed(&[1e6, 9e5]), [going, [false, true]]);
        // those at round-off are at rest where they have not halved in two reviews
        assert_eq!(
            reviewed(&[200.0, 150.0, 110.0]),
            [going, going, [true, false]]
        );
        assert_eq!(reviewed(&[200.0, 150.0, 90.0]), [going; 3]);
    }
}
