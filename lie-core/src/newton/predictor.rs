//! Where the iteration of a step starts: the unknowns of the steps before it, extrapolated.

use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// The polynomial goes through so many unknowns.
const VALUES: usize = 10;
/// After so many predictions a step starts from the guess of its equation, and shows how the iteration converges.
const MOST: f64 = 64.0;
/// So many steps start from the guess of their equation where a prediction was worse than that may be.
const REST: f64 = 32.0;

/// Predicts the unknown of a step by the polynomial through those of the last steps, all of one size.
///
/// The polynomial is kept as backward differences: `d_0 = u`, `d_j <- d_(j-1) - d_j` with every new unknown, and the
/// next one is about their sum. Its error is about `(h d/dt)^8 u`, as long as the unknown is a smooth function
/// along the run. A prediction changes where an iteration starts, not the equation that is solved.
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
            differences: core::array::from_fn(|_| zero.clone()),
            next: zero.clone(),
            age: S::zero(),
        }
    }

    /// The lanes in which there is a prediction for a step; it follows the last one in the lanes of a mask.
    #[inline(always)]
    pub(crate) fn ready(&mut self, follows: S::Mask) -> S::Mask {
        if !follows.all() {
            self.forget(!follows);
        }
        let ready = S::from_f64(VALUES as f64).less_equal(self.age);
        if (ready & self.age.less(S::from_f64(VALUES as f64 + MOST))).all() {
            return ready;
        }
        self.renew(ready)
    }

    /// Passes one prediction over where there were many.
    #[cold]
    fn renew(&mut self, ready: S::Mask) -> S::Mask {
        let first = S::from_f64(VALUES as f64);
        let due = (first + S::from_f64(MOST)).less_equal(self.age);
        self.age = S::select(due, first - S::one(), self.age);
        ready & !due
    }

    /// The prediction, in lanes where there is one.
    #[inline(always)]
    pub(crate) fn next(&self) -> &U {
        &self.next
    }

    /// Takes the unknown of a step.
    #[inline(always)]
    pub(crate) fn take(&mut self, unknown: &U) {
        self.age += S::one();
        for part in 0..unknown.parts() {
            let values = unknown.part(part);
            let next = self.next.part_mut(part);
            let count = values.len();
            let mut rows = self.differences.each_mut().map(|row| row.part_mut(part));
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

/// Takes entries from an index on, and returns the sums of their differences.
#[inline(always)]
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
