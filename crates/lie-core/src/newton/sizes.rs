//! By what the error of each entry of an unknown is measured.

use crate::clock::{Clock, holds};
use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// The sizes of the entries of an unknown u, given that of the step before, w: `|u_i| + 8 |u_i - w_i|`.
///
/// The maximum norm knows what an update does to the largest entries alone. Where entries differ by decades, so do the
/// errors of predictions, and H may depend on the small ones by their logarithms. An entry that passes through zero has
/// the size of its change; rounding of the residual, whose terms change as much, leaves no less. An entry that shrinks by
/// a factor in every step is measured by nearly its own size as long as it can be predicted.
pub(super) struct Sizes<'a, U> {
    /// The unknown of the step before; without it, the size of an entry is its magnitude.
    pub(super) before: Option<&'a U>,
    /// The entries that carry the time, which do not count.
    pub(super) clock: Option<Clock>,
}

impl<U> Clone for Sizes<'_, U> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<U> Copy for Sizes<'_, U> {}

/// Passing zero, an entry has the size that it has so many steps later.
const STEPS: f64 = 8.0;

impl<U> Sizes<'_, U> {
    /// The size of an entry.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn of<S: Scalar>(unknown: S, before: S) -> S {
        unknown.magnitude() + S::from_f64(STEPS) * (unknown - before).magnitude()
    }

    /// The largest size.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn largest<S: Scalar>(&self, unknown: &U) -> S
    where
        U: Unknown<S>,
    {
        let start = self.before.unwrap_or(unknown);
        let mut largest = S::zero();
        for part in 0..unknown.parts() {
            let entries = unknown.part(part).iter().zip(start.part(part)).enumerate();
            for (_, (&unknown, &before)) in entries.filter(|(i, _)| !holds(self.clock, *i)) {
                largest = S::largest_magnitude(&[largest, Self::of(unknown, before)]);
            }
        }
        largest
    }

    /// The lanes in which no entry of an update exceeds its size divided by a factor; none where one is not finite.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn small_lanes<S: Scalar>(&self, update: &U, unknown: &U, factor: S) -> S::Mask
    where
        U: Unknown<S>,
    {
        let start = self.before.unwrap_or(unknown);
        let mut within = S::Mask::splat(true);
        for part in 0..unknown.parts() {
            let sizes = unknown.part(part).iter().zip(start.part(part));
            let entries = update.part(part).iter().zip(sizes).enumerate();
            let counted = entries.filter(|(i, _)| !holds(self.clock, *i));
            for (_, (&update, (&unknown, &before))) in counted {
                let rest = Self::of(unknown, before) - factor * update.magnitude();
                within = within & S::zero().less_equal(rest);
            }
        }
        within
    }

    /// The largest entry of an update relative to its size; an entry that is 0 and stays 0 does not count.
    #[inline(never)]
    pub(super) fn relative<S: Scalar>(&self, update: &U, unknown: &U) -> S
    where
        U: Unknown<S>,
    {
        let start = self.before.unwrap_or(unknown);
        let mut largest = S::zero();
        for part in 0..unknown.parts() {
            let sizes = unknown.part(part).iter().zip(start.part(part));
            let entries = update.part(part).iter().zip(sizes).enumerate();
            let counted = entries.filter(|(i, _)| !holds(self.clock, *i));
            for (_, (&update, (&unknown, &before))) in counted {
                let update = update.magnitude();
                let rests = update.less_equal(S::zero());
                let ratio = S::select(rests, S::zero(), update / Self::of(unknown, before));
                largest = S::largest_magnitude(&[largest, ratio]);
            }
        }
        largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_entries_count_as_much_as_large_ones() {
        let (before, unknown) = ([1.1, 1.1e-12], [1.0, 1e-12]);
        let sizes = Sizes {
            before: Some(&before),
            clock: None,
        };
        // nearly their own sizes, whatever the scale
        let relative = |update: [f64; 2]| sizes.relative(&update, &unknown);
        for update in [[1e-9, 0.0], [0.0, 1e-21]] {
            let relative = relative(update);
            assert!((5e-10..1e-9).contains(&relative), "{relative:e}");
            assert!(sizes.small_lanes(&update, &unknown, 1e9));
            assert!(!sizes.small_lanes(&update, &unknown, 2e9));
        }
        // the control: by the maximum norm the second is nothing
        assert!([0.0, 1e-21].max_norm() < 1e-20);
    }

    #[test]
    fn entries_that_pass_zero_have_the_size_of_their_change() {
        let (before, unknown) = ([1.0, 0.01], [1.0, 1e-9]);
        let sizes = Sizes {
            before: Some(&before),
            clock: None,
        };
        assert!(sizes.relative(&[0.0, 1e-12], &unknown) < 2e-11);
        // the control: without the step before it is nearly 0
        let alone = Sizes {
            before: None,
            clock: None,
        };
        assert!(alone.relative(&[0.0, 1e-12], &unknown) > 1e-4);
    }

    #[test]
    fn zeros_that_stay_do_not_count_and_what_is_not_finite_does() {
        let unknown = [1.0, 0.0];
        let sizes = Sizes {
            before: Some(&unknown),
            clock: None,
        };
        assert_eq!(sizes.relative(&[1e-12, 0.0], &unknown), 1e-12);
        assert!(sizes.small_lanes(&[1e-12, 0.0], &unknown, 1e11_f64));
        assert!(!sizes.small_lanes(&[1e-12, 1e-300], &unknown, 1e11));
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(!sizes.small_lanes(&[bad, 0.0], &unknown, 1.0));
            assert!(!sizes.small_lanes(&[bad, 0.0], &[bad, 0.0], 1.0));
            assert!(!sizes.relative(&[bad, 0.0], &unknown).is_finite());
        }
    }
}
