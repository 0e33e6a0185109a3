//! Whether cheaper iterations are tried before Newton's method, lane by lane.

use super::options::{Iteration, NewtonOptions};
use crate::scalar::{Mask, Scalar};

/// Newton's method takes so many iterations; the fixed point may cost as much.
const NEWTON: f64 = 2.2;
/// From a prediction a step takes one iteration with a Jacobian and so many evaluations more.
const MORE: f64 = 2.5;
/// The fixed point is not tried where it would have to end after fewer iterations: from the guess of the equation, and from
/// a prediction.
const FEWEST: [f64; 2] = [6.0, 6.5];
/// So many bits of the first update are to be gained.
const BITS: f64 = 50.0;
/// More iterations are never tried.
const MOST: u32 = 128;
/// The steps for which a lane is left to Newton's method when the fixed point did not pay: at first, and at most.
const REST: [f64; 2] = [16.0, 1024.0];

/// What is remembered from step to step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial<S: Scalar> {
    /// Whether anything is tried at all.
    tried: bool,
    /// Whether it is where a step starts from a prediction.
    predicted: bool,
    /// The factor by which updates without a Jacobian must shrink.
    rate: S,
    /// The lanes that are left to Newton's method.
    resting: S::Mask,
    /// For how many steps more, and how many the last time.
    left: S,
    rest: S,
}

impl<S: Scalar> Trial<S> {
    /// Of iterations without a Jacobian, for an equation with this [`jacobian_cost`](crate::Equation::jacobian_cost).
    pub(super) fn of_fixed_point(options: &NewtonOptions, cost: f64) -> Self {
        let most = NEWTON * cost;
        let [fewest, fewest_predicted] = FEWEST;
        let one_jacobian = Self::of_one_jacobian(options);
        let tried = one_jacobian.tried && most >= fewest;
        Self {
            tried,
            predicted: tried && cost + MORE >= fewest_predicted,
            rate: S::from_f64(libm::exp2(-BITS / most)),
            ..one_jacobian
        }
    }

    /// Of iterations with the Jacobian of the start.
    pub(super) fn of_one_jacobian(options: &NewtonOptions) -> Self {
        let tried = options.iteration == Iteration::Automatic && options.max_iterations > 1;
        Self {
            tried,
            predicted: tried,
            rate: S::zero(),
            resting: S::Mask::splat(false),
            left: S::zero(),
            rest: S::from_f64(0.5 * REST[0]),
        }
    }

    /// Shows what is remembered.
    pub(super) fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) {
        if !self.tried {
            return;
        }
        let mut resting = S::select(self.resting, S::one(), S::zero());
        visit(&mut resting);
        self.resting = S::zero().less(resting);
        visit(&mut self.left);
        visit(&mut self.rest);
    }

    /// The lanes that try in this step.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn lanes(&mut self) -> S::Mask {
        if !self.tried {
            return S::Mask::splat(false);
        }
        if self.resting.any() {
            self.count_down();
        }
        !self.resting
    }

    /// Whether anything is tried from predictions.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn predictable(&self) -> bool {
        self.predicted
    }

    #[cold]
    fn count_down(&mut self) {
        self.left = S::select(self.resting, self.left - S::one(), self.left);
        self.resting = self.resting & S::zero().less(self.left);
    }

    /// Takes the lanes whose updates did not shrink fast enough.
    #[cold]
    pub(super) fn given_up(&mut self, lanes: S::Mask) {
        if !lanes.any() {
            return;
        }
        let [_, most] = REST.map(S::from_f64);
        let doubled = self.rest + self.rest;
        let doubled = S::select(doubled.less(most), doubled, most);
        self.rest = S::select(lanes, doubled, self.rest);
        self.left = S::select(lanes, self.rest, self.left);
        self.resting = self.resting | lanes;
    }

    /// The bound of the first update.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn bound(&self) -> Bound<S> {
        Bound {
            rate: self.rate,
            size: S::zero(),
            count: 0,
        }
    }
}

/// By how much the updates of one step must have shrunk.
pub(super) struct Bound<S> {
    rate: S,
    size: S,
    count: u32,
}

impl<S: Scalar> Bound<S> {
    /// Takes the size of an update, and returns the lanes that may go on: those that keep the rate, from the third
    /// update on, and those whose update is so small that it may be round-off.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn keeps(&mut self, update: S, settled: S::Mask) -> S::Mask {
        self.size = if self.count == 0 {
            update
        } else {
            self.size * self.rate
        };
        self.count += 1;
        if self.count <= 2 {
            return update.finite();
        }
        (update.less_equal(self.size) | settled) & S::Mask::splat(self.count < MOST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cheap_jacobians_are_not_avoided() {
        let options = NewtonOptions::default();
        let trial = |cost: f64| Trial::<f64>::of_fixed_point(&options, cost);
        assert!(!trial(2.0).lanes());
        assert!(trial(3.3).lanes());
        assert!(!Trial::<f64>::of_fixed_point(&NewtonOptions::newton(), 3.3).lanes());
        // a prediction and one Jacobian are cheaper than two
        assert!(!trial(3.3).predictable());
        assert!(trial(5.0).predictable());
    }

    #[test]
    fn rests_grow() {
        let mut trial = Trial::<f64>::of_fixed_point(&NewtonOptions::default(), 10.0);
        let mut rest = || {
            assert!(trial.lanes());
            trial.given_up(true);
            (0..).find(|_| trial.lanes()).unwrap_or(0)
        };
        assert_eq!([rest(), rest(), rest()], [15, 31, 63]);
        let longest = (0..9).map(|_| rest()).last();
        assert_eq!(longest, Some(1023));
    }

    #[test]
    fn updates_must_shrink_by_the_rate() {
        let trial = Trial::<f64>::of_fixed_point(&NewtonOptions::default(), 20.0 / NEWTON);
        let keeps = |rate: f64| {
            let mut bound = trial.bound();
            (0..8).all(|k| bound.keeps(1e-3 * rate.powi(k), false))
        };
        // 50 bits in 20 iterations
        assert!(keeps(0.17));
        assert!(!keeps(0.18));
        assert!(!keeps(f64::NAN));
    }
}
