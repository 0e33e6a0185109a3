//! Where the iteration of a step starts: the unknowns of the steps before it, extrapolated.

use crate::clock::{Clock, holds};
use crate::scalar::{Mask, Scalar};
use crate::state::{Unknown, copies};

/// The polynomial goes through so many unknowns.
const VALUES: usize = 12;
/// So many predictions must have been near the solution before the first one is used.
const PROOFS: f64 = 2.0;
/// A prediction farther from the solution than this part of the state is none: the unknown is not smooth along the run, or
/// the step is large. Guesses from the start of a step alone do not err more.
const FAR: f64 = 1.0 / 128.0;
/// After so many predictions a step starts from the guess of its equation, and shows how the iteration converges.
const MOST: f64 = 64.0;
/// So many steps start from the guess of their equation where a prediction was worse than that may be.
const REST: f64 = 32.0;

/// In so many steps before the first prediction Newton's method shows how it converges.
const BEGINS: f64 = 3.0;

/// From this age on predictions are used.
const FIRST: f64 = VALUES as f64 + PROOFS;

/// Predicts the unknown of a step by the polynomial through those of the last steps, all of one size.
///
/// The polynomial is kept as backward differences: `d_0 = u`, `d_j <- d_(j-1) - d_j` with every new unknown, and the
/// next one is about their sum. Its error is about `(h d/dt)^12 u`, as long as the unknown is a smooth function
/// along the run; where that shows not to be, nothing is predicted. A prediction changes where an iteration starts, not the
/// equation that is solved.
#[derive(Clone, Debug)]
pub(crate) struct Predictor<S, U> {
    differences: [U; VALUES],
    next: U,
    /// The unknowns taken since the last one that did not follow, lane by lane.
    age: S,
}

impl<S: Scalar, U: Unknown<S>> Predictor<S, U> {
    /// For unknowns of this shape.
    pub(crate) fn new(zero: &U) -> Self {
        Self {
            differences: copies(zero),
            next: zero.clone(),
            age: S::zero(),
        }
    }

    /// Shows what is remembered.
    pub(crate) fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) {
        for unknown in self.differences.iter_mut().chain([&mut self.next]) {
            for part in 0..unknown.parts() {
                unknown.part_mut(part).iter_mut().for_each(&mut *visit);
            }
        }
        visit(&mut self.age);
    }

    /// The lanes in which there is a prediction for a step; it follows the last one in the lanes of a mask.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn ready(&mut self, follows: S::Mask) -> S::Mask {
        if !follows.all() {
            self.forget(!follows);
        }
        let ready = S::from_f64(FIRST).less_equal(self.age);
        if (ready & self.age.less(S::from_f64(FIRST + MOST))).all() {
            return ready;
        }
        self.renew(ready)
    }

    /// Passes one prediction over where there were many.
    #[cold]
    fn renew(&mut self, ready: S::Mask) -> S::Mask {
        let due = S::from_f64(FIRST + MOST).less_equal(self.age);
        self.age = S::select(due, S::from_f64(FIRST - 1.0), self.age);
        ready & !due
    }

    /// The unknown of the step before.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn last(&self) -> &U {
        let [last, ..] = &self.differences;
        last
    }

    /// The lanes in which predictions are about to begin; [`Self::last`] is of the step before this one there.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn begins(&self) -> S::Mask {
        S::from_f64(FIRST - BEGINS).less_equal(self.age)
    }

    /// The prediction, in lanes where there is one.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn next(&self) -> &U {
        &self.next
    }

    /// Forgets everything in the lanes, not among those of a mask, in which the prediction that was not used was far from
    /// the unknown of a step.
    #[cold]
    pub(crate) fn examine(&mut self, unknown: &U, scale: S, used: S::Mask, clock: Option<Clock>) {
        let due = S::from_f64(VALUES as f64).less_equal(self.age) & !used;
        if !due.any() {
            return;
        }
        let mut distance = S::zero();
        for part in 0..unknown.parts() {
            let pairs = unknown
                .part(part)
                .iter()
                .zip(self.next.part(part))
                .enumerate();
            for (_, (&unknown, &next)) in pairs.filter(|(i, _)| !holds(clock, *i)) {
                distance = S::largest_magnitude(&[distance, unknown - next]);
            }
        }
        let near = !is_far(distance, scale) & distance.finite();
        self.age = S::select(due & !near, S::zero(), self.age);
    }

    /// Takes the unknown of a step.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn record(&mut self, unknown: &U) {
        self.age += S::one();
        for part in 0..unknown.parts() {
            let values = unknown.part(part);
            let next = self.next.part_mut(part);
            let count = values.len();
            // of as many entries each, as the compiler is to know
            let mut rows = self
                .differences
                .each_mut()
                .map(|row| &mut row.part_mut(part)[..count]);
            let next = &mut next[..count];
            let mut index = 0;
            while index + 1 < count {
                let pair = [values[index], values[index + 1]];
                let [first, second] = update(&mut rows, index, pair);
                next[index] = first;
                next[index + 1] = second;
                index += 2;
            }
            if index < count {
                let [only] = update(&mut rows, index, [values[index]]);
                next[index] = only;
            }
        }
    }

    /// Starts anew in the lanes of a mask.
    #[cold]
    pub(crate) fn forget(&mut self, lanes: S::Mask) {
        self.age = S::select(lanes, S::zero(), self.age);
    }

    /// Makes no predictions for a while in the lanes of a mask.
    #[cold]
    pub(crate) fn rest(&mut self, lanes: S::Mask) {
        self.age = S::select(lanes, S::from_f64(-REST), self.age);
    }
}

/// The lanes in which a start was far from a solution, by its first update.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn is_far<S: Scalar>(update: S, scale: S) -> S::Mask {
    (scale * S::from_f64(FAR)).less(update)
}

/// Takes entries from an index on, and returns the sums of their differences.
#[cfg_attr(not(debug_assertions), inline(always))]
fn update<S: Scalar, const N: usize>(
    rows: &mut [&mut [S]; VALUES],
    index: usize,
    values: [S; N],
) -> [S; N] {
    let mut difference = values;
    let mut sum = values;
    for (order, row) in rows.iter_mut().enumerate() {
        for i in 0..N {
            let before = row[index + i];
            row[index + i] = difference[i];
            if order > 0 {
                sum[i] += difference[i];
            }
            difference[i] -= before;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first step with a prediction, of a sequence of unknowns near 1, and the errors of the predictions.
    fn predictions(count: usize, unknown: impl Fn(usize) -> f64) -> (Option<usize>, f64) {
        let mut predictor = Predictor::new(&[0.0]);
        let (mut first, mut worst) = (None, 0.0);
        for k in 0..count {
            let value = [unknown(k)];
            let ready = predictor.ready(k > 0);
            if ready {
                first.get_or_insert(k);
                worst = f64::max(worst, (predictor.next()[0] - value[0]).abs());
            } else {
                predictor.examine(&value, 1.0, ready, None);
            }
            predictor.record(&value);
        }
        (first, worst)
    }

    #[test]
    fn polynomials_are_continued() {
        let polynomial = |k: usize| {
            let t = k as f64 / 32.0;
            1.0 + t * (0.5 - t * (0.3 + t * t * t))
        };
        let (first, worst) = predictions(60, polynomial);
        assert_eq!(first, Some(FIRST as usize));
        assert!(worst < 1e-11, "{worst:e}");
        // the control: a frequency that ten values a period do not follow
        let (_, worst) = predictions(60, |k| (0.6 * k as f64).sin());
        assert!(worst > 1e-4, "{worst:e}");
    }

    #[test]
    fn unknowns_of_two_kinds_are_not_predicted() {
        let alternating = |k: usize| if k.is_multiple_of(2) { 1.0 } else { 0.2 };
        assert_eq!(predictions(200, alternating), (None, 0.0));
    }

    #[test]
    fn steps_that_do_not_follow_start_anew() {
        let mut predictor = Predictor::new(&[0.0]);
        let mut ready = |follows: bool| {
            let ready = predictor.ready(follows);
            predictor.examine(&[1.0], 1.0, ready, None);
            predictor.record(&[1.0]);
            ready
        };
        assert!(ready(true) || (0..40).any(|_| ready(true)));
        assert!(!ready(false));
        let wait = (0..40).position(|_| ready(true));
        assert_eq!(wait, Some(FIRST as usize - 1));
        // now and then one is passed over
        let passed = (0..200).filter(|_| !ready(true)).count();
        assert!((2..=4).contains(&passed), "{passed}");
    }
}
