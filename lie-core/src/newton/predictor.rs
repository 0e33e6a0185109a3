//! Where the iteration of a step starts: the unknowns of the steps before it, extrapolated.

use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// The polynomial goes through so many unknowns.
const VALUES: usize = 6;
/// So many steps start from the guess of their equation where a prediction was worse than that may be.
const REST: f64 = 32.0;

/// Predicts the unknown of a step by the polynomial through those of the last steps, all of one size.
///
/// The polynomial is kept as backward differences: `d_0 = u`, `d_j <- d_(j-1) - d_j` with every new unknown, and the
/// next one is about their sum. Its error is about `(h d/dt)^VALUES u`, as long as the unknown is a smooth function
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
        S::from_f64(VALUES as f64).less_equal(self.age)
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
            for (index, (&value, next)) in values.iter().zip(next).enumerate() {
                let mut difference = value;
                let mut sum = S::zero();
                for row in &mut self.differences {
                    let row = &mut row.part_mut(part)[index];
                    let before = *row;
                    *row = difference;
                    sum += difference;
                    difference -= before;
                }
                *next = sum;
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
