//! The iteration until the map of a step has converged, and not its state alone.

use super::{Iterated, REVIEW, StageParallel};
use crate::generic::stage_ending::{STAGNATION, are_below, most};
use crate::generic::stage_work::At;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

impl<S: Scalar, V: State<S::Wide>, const STAGES: usize> StageParallel<S, V, STAGES> {
    /// Until the derivative of the increments by the base has converged too.
    ///
    /// With the start frozen, that derivative starts from nothing, and iterates by the same contraction as an error of
    /// the state. So by how much the updates have shrunk since the first one, they say how much of the derivative is left. Where
    /// they reach round-off before it, the last rate is taken to go on; a start at round-off shows no rate, and takes as
    /// many iterations as the step before.
    #[inline(always)]
    pub(super) fn iterate_map(&mut self, mut field: impl FnMut(At<'_, V>, &mut V)) -> Iterated<S> {
        let bound = self.size() * S::epsilon() * S::from_f64(STAGNATION);
        let mut work = self.work.take::<S>();
        let [mut ended, mut settled, mut ready] = [S::Mask::splat(false); 3];
        let (mut iterations, mut mark) = (0, S::from_f64(f64::MAX));
        let [mut first, mut before, mut change] = [S::Wide::zero(); 3];
        let [mut left, mut rate] = [S::one(); 2];
        while iterations < self.options.max_iterations && !ended.all() {
            let earlier = before;
            before = change;
            change = self.look(&mut work, ended, &mut field);
            iterations += 1;
            let count = S::from_f64(f64::from(iterations));
            let open = (self.quiet.less(count) | count.less_equal(S::one())) & !ended;
            left *= rate;
            let new = are_below::<S>(change, bound) & open & !settled;
            if new.any() {
                if iterations > 1 {
                    let [size, before, earlier] = [change, before, earlier].map(most::<S>);
                    let last = self.seen(new, count, [size, before, earlier]);
                    rate = S::select(new, last, rate);
                    left = S::select(new, size / most::<S>(first), left);
                }
                settled = settled | new;
            }
            ready = ready | (settled & open & self.derived(left, count));
            self.taken = S::select(ready & !ended, count, self.taken);
            ended = ended | ready;
            if iterations.is_multiple_of(REVIEW) {
                let size = most::<S>(change);
                let active = open & !settled;
                ended = ended | (active & !size.less(mark * S::ratio(1.0, 2.0)));
                mark = S::select(active, size, mark);
            }
            if iterations == 1 {
                first = change;
                if !ended.any() {
                    iterations = self.least_quiet().max(1);
                    self.blind(&mut work, iterations - 1, &mut field);
                }
            } else if settled.all() && !ended.any() {
                // nothing is to be seen before some lane is ready
                let now = iterations;
                while iterations < self.options.max_iterations && !ready.any() {
                    iterations += 1;
                    left *= rate;
                    let count = S::from_f64(f64::from(iterations));
                    ready = self.derived(left, count);
                    self.taken = S::select(ready, count, self.taken);
                }
                ended = ready;
                self.blind(&mut work, iterations - now, &mut field);
            }
        }
        self.work = work;
        self.end(iterations, change, ready)
    }

    /// The rate at which changes shrink that have just reached round-off, from the last three of them: single ones may
    /// shrink by much less than those around them. The third look of a step should be the one that sees it.
    #[inline(always)]
    fn seen(&mut self, new: S::Mask, count: S, [size, before, earlier]: [S; 3]) -> S {
        let looks = count - self.quiet;
        let [one, two, three] = [1.0, 2.0, 3.0].map(|k| S::ratio(k, 1.0));
        let rate = S::select(looks.less(three), size / before, (size / earlier).sqrt());
        let rate = S::select(looks.less(two), self.rate, rate);
        let quiet = S::select(looks.less(three), self.quiet - one, count - three);
        self.quiet = S::select(new, quiet.max(S::zero()), self.quiet);
        self.rate = S::select(new, rate, self.rate);
        rate
    }

    /// The lanes in which nothing is left of the derivative, after so many iterations.
    #[inline(always)]
    fn derived(&self, left: S, count: S) -> S::Mask {
        let by_rate = left.less_equal(S::epsilon() * S::ratio(1.0, 4.0));
        by_rate | (S::one().less_equal(left) & self.taken.less_equal(count))
    }
}
