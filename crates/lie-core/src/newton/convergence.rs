//! When an iteration has converged, lane by lane.

use super::options::Iteration;
use super::rest::{REVIEW, Reviews, STAGNATION, dropped, left};
use super::sizes::Sizes;
use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// Follows the size of the updates of one solution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Convergence<S> {
    quadratic: bool,
    tolerance: S,
    first: S,
    previous: S,
    earlier: S,
    count: u32,
    reviews: Reviews<S>,
}

impl<S: Scalar> Convergence<S> {
    /// For an iteration that ends at an error of `tolerance` units of round-off.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn new(iteration: Iteration, tolerance: f64) -> Self {
        Self {
            quadratic: iteration == Iteration::Newton,
            tolerance: S::from_f64(tolerance),
            first: S::zero(),
            previous: S::from_f64(f64::MAX),
            earlier: S::from_f64(f64::MAX),
            count: 0,
            reviews: Reviews::new(),
        }
    }

    /// Takes the size of an update and of the unknown, and returns the lanes that have converged:
    /// those whose error after this update is predicted to be below the tolerance, and those whose
    /// updates have shrunk to round-off and come to rest there.
    ///
    /// With `rate` the ratio of the last two updates d, the error left is about `d rate^2` for
    /// Newton's method and `d rate/(1 - rate)` for linear convergence.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn observe(&mut self, update: S, size: S) -> S::Mask {
        let round_off = S::epsilon() * size;
        let goal = self.tolerance * round_off;
        self.count += 1;
        let converged = if self.count == 1 {
            self.first = update;
            update.less_equal(if self.quadratic { round_off } else { goal })
        } else {
            let rate = update / self.previous;
            let done = if self.quadratic {
                let shrinking = rate.less(S::ratio(1.0, 2.0));
                let at_round_off = update.less_equal(S::from_f64(STAGNATION) * round_off);
                (shrinking & (update * rate * rate).less_equal(goal))
                    | (!shrinking & at_round_off)
                    | update.less_equal(round_off)
            } else {
                let mut done = rate.less(S::one()) & left(update, rate).less_equal(goal);
                let updates = [self.earlier, self.previous, update];
                done = done | dropped(self.first, updates, round_off, self.count);
                if self.count.is_multiple_of(REVIEW) {
                    let all = S::Mask::splat(true);
                    let [resting, _] = self.reviews.take(all, update, round_off);
                    done = done | resting;
                }
                done
            };
            done | update.less_equal(S::zero())
        };
        self.earlier = self.previous;
        self.previous = update;
        converged
    }

    /// The lanes in which an update may be round-off.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn is_round_off(&self, update: S, size: S) -> S::Mask {
        is_round_off(update, size)
    }

    /// The lanes whose last update is larger than the first.
    pub(super) fn growing(&self) -> S::Mask {
        self.first.less(self.previous) & S::Mask::splat(self.count > 0)
    }
}

/// The lanes in which an iteration with the Jacobian of its start has converged, by its last two updates relative to the
/// sizes of the entries; `settled` are those whose last update may be round-off of the largest entries.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn ends<S: Scalar>(update: S, before: S, settled: S::Mask, tolerance: f64) -> S::Mask {
    let rate = update / before;
    let left = (update + update) * rate;
    let shrinking = rate.less(S::ratio(1.0, 2.0));
    shrinking & left.less_equal(S::from_f64(tolerance) * S::epsilon()) | !shrinking & settled
}

/// The lanes in which updates may be round-off, given their size and that of the unknown.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn is_round_off<S: Scalar>(update: S, size: S) -> S::Mask {
    update.less_equal(S::from_f64(STAGNATION) * S::epsilon() * size)
}

/// A bound of c in `|e_1| <= c |e_0|^2`, the errors before and after an iteration of Newton's method relative to the
/// sizes of the entries, by the first two updates of a solution: the first relative to the largest size, which bounds c
/// from above, the second relative to each.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn curvature<S: Scalar>(first: S, second: S) -> S {
    let noise = S::from_f64(CURVATURE_NOISE) * S::epsilon();
    S::from_f64(CURVATURE_SAFETY) * ((second + noise) / first / first)
}

/// The factor by which the error may exceed what a solution has shown, and the units of round-off that the second update
/// may owe to rounding.
const CURVATURE_SAFETY: f64 = 16.0;
const CURVATURE_NOISE: f64 = 16.0;

/// Iterations end where every entry has come to rest, not the largest alone: entries may have other units.
pub(super) struct Settling<S: Scalar> {
    quadratic: bool,
    ending: S::Mask,
    before: S,
}

impl<S: Scalar> Settling<S> {
    pub(super) fn new(iteration: Iteration) -> Self {
        Self {
            quadratic: iteration == Iteration::Newton,
            ending: S::Mask::splat(false),
            before: S::zero(),
        }
    }

    /// Takes the lanes that have converged by their largest entries, and returns those that have by all.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn observe<U: Unknown<S>>(
        &mut self,
        converged: S::Mask,
        sizes: Sizes<'_, U>,
        (update, unknown): (&U, &U),
    ) -> S::Mask {
        self.ending = self.ending | converged;
        if !self.quadratic && !self.ending.any() {
            return self.ending;
        }
        let step = sizes.relative(update, unknown);
        let rate = step / self.before;
        let small = step.less_equal(S::from_f64(AT_REST) * S::epsilon());
        // Newton's method foresees its next update
        let foreseen = S::Mask::splat(self.quadratic)
            & (step * rate * rate).less_equal(S::from_f64(AT_REST) * S::epsilon());
        let at_rest = !rate.less(S::ratio(1.0, 2.0)) | foreseen;
        let at_rest = at_rest & S::zero().less(self.before);
        let follows = self.ending | S::Mask::splat(self.quadratic);
        self.before = S::select(follows, step, self.before);
        self.ending & (small | at_rest)
    }

    /// The lanes that have converged by their largest entries.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn ending(&self) -> S::Mask {
        self.ending
    }
}

/// Updates of entries up to this many units of their round-off are at rest.
const AT_REST: f64 = 16.0;

#[cfg(test)]
mod tests {
    use super::super::options::NewtonOptions;
    use super::*;

    fn iterations(options: &NewtonOptions, updates: &[f64]) -> Option<usize> {
        let mut convergence = Convergence::<f64>::new(options.iteration, options.tolerance);
        updates
            .iter()
            .position(|&update| convergence.observe(update, 1.0))
            .map(|k| k + 1)
    }

    #[test]
    fn quadratic_convergence_is_foreseen() {
        let options = NewtonOptions::newton();
        assert_eq!(iterations(&options, &[1e-3, 1e-6, 1e-12, 1e-24]), Some(3));
        assert_eq!(iterations(&options, &[1e-4, 1e-9, 1e-18]), Some(2));
        assert_eq!(iterations(&options, &[1e-17]), Some(1));
        assert_eq!(iterations(&options, &[0.0]), Some(1));
    }

    #[test]
    fn linear_convergence_is_not_taken_for_quadratic() {
        let updates: [f64; 40] = core::array::from_fn(|k| 0.1_f64.powi(k as i32));
        let iterations = iterations(&NewtonOptions::fixed_point(), &updates).unwrap();
        assert!((18..=21).contains(&iterations), "{iterations}");
    }

    #[test]
    fn stagnation_counts_only_at_round_off() {
        let options = NewtonOptions::fixed_point();
        assert_eq!(
            iterations(&options, &[1e-12, 2e-14, 1.9e-14, 1.9e-14]),
            Some(4)
        );
        assert_eq!(iterations(&options, &[1e-3, 1e-10, 1e-10, 1e-10]), None);
        assert_eq!(iterations(&options, &[1.0, 2.0, f64::NAN, 4.0]), None);
    }

    /// Updates that shrink slowly, and turn meanwhile, are not at rest at 256 units of round-off, but below one; the control is
    /// what they would leave there.
    #[test]
    fn slow_convergence_is_not_taken_for_rest() {
        for rate in [0.55_f64, 0.7, 0.9] {
            let update = |k: usize| {
                let turn = 1.0 + 0.4 * (1.1 * k as f64).cos();
                1e-3 * turn * rate.powi(k as i32) + 1e-17 * (2.3 * k as f64).cos().abs()
            };
            let updates: [f64; 500] = core::array::from_fn(update);
            let count = iterations(&NewtonOptions::fixed_point(), &updates).expect("it ends");
            let left = |k: usize| rate.powi(k as i32) * 1e-3 / (1.0 - rate);
            let early = updates
                .iter()
                .position(|&update| update < 256.0 * f64::EPSILON);
            let early = left(early.expect("it gets there"));
            println!(
                "{rate}: {count} iterations leave {:e}, early {early:e}",
                left(count)
            );
            assert!(left(count) < 3e-16 && early > 3e-14);
            assert!(count < 120 || rate > 0.8);
        }
    }

    #[test]
    fn growth_is_seen() {
        let mut convergence = Convergence::<f64>::new(Iteration::Newton, 0.0);
        convergence.observe(1.0, 1.0);
        convergence.observe(0.5, 1.0);
        assert!(!convergence.growing());
        convergence.observe(2.0, 1.0);
        assert!(convergence.growing());
    }
}
