//! The iteration until the map of a step has converged, and not its state alone.

use super::{BEYOND, Iterated, StageParallel};
use crate::generic::stage_work::Rule;
use crate::newton::rest::{REVIEW, Reviews, STAGNATION, dropped, is_quick};
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// Changes up to so many units of round-off are at rest where they have shrunk quickly.
const CALM: f64 = 4.0;

impl<S: Scalar, V: State<S::Wide>> StageParallel<S, V> {
    /// Until the derivative of the increments by the base has converged too.
    ///
    /// With the start frozen, that derivative starts from nothing, and iterates by the same contraction as an error of
    /// the state. So by how much the updates have shrunk since the first one, they say how much of the derivative is left. Where
    /// they reach round-off before it, the last rate is taken to go on; a start at round-off shows no rate, and takes as
    /// many iterations as the last step that showed one. Where changes do not shrink quickly, the last one is looked at: the rate of changes
    /// that turn while they shrink may have been taken for a smaller one, and then the iteration goes on until they are at rest.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn iterate_map(&mut self, mut field: impl Rule<S, V>) -> Iterated<S> {
        let unit = self.size() * S::epsilon();
        let bound = unit * S::from_f64(STAGNATION);
        let mut work = self.work.take::<S>();
        let [mut ended, mut settled, mut converged] = [S::Mask::splat(false); 3];
        let [mut quick, mut enough, mut again] = [S::Mask::splat(false); 3];
        let never = S::from_f64(f64::MAX);
        let (mut reviews, mut due) = (Reviews::new(), never);
        let (mut iterations, mut mark) = (0, S::from_f64(f64::MAX));
        let [mut first, mut before, mut change] = [S::zero(); 3];
        let [mut left, mut rate] = [S::one(); 2];
        while iterations < self.most_iterations && !ended.all() {
            let earlier = before;
            before = change;
            change = self.look(&mut work, ended, &mut field);
            iterations += 1;
            let count = S::from_f64(f64::from(iterations));
            let open = (self.quiet.less(count) | count.less_equal(S::one())) & !ended;
            left *= rate;
            let new = change.less_equal(bound) & open & !settled;
            if new.any() {
                if iterations > 1 {
                    quick = quick | (new & is_quick([first, change], iterations));
                    let last = self.seen(new, count, [change, before, earlier]);
                    rate = S::select(new, last, rate);
                    left = S::select(new, change / first, left);
                }
                settled = settled | new;
            }
            let third = again;
            again = enough;
            enough = enough | (settled & open & self.derived(left, count));
            let resumed = S::one().less_equal(left);
            let done = enough & (quick | resumed) & !ended;
            self.taken = S::select(done & !resumed, count, self.taken);
            converged = converged | done;
            ended = ended | done;
            if (enough & !ended).any() {
                let calm = change.less_equal(unit * S::from_f64(CALM))
                    & (is_quick([first, change], iterations) | change.less_equal(S::zero()));
                let still = third & dropped(first, [earlier, before, change], unit, iterations);
                let ready = enough & !ended & (calm | still | due.less_equal(count));
                self.taken = S::select(ready, count, self.taken);
                converged = converged | ready;
                ended = ended | ready;
            }
            if iterations.is_multiple_of(REVIEW) {
                let active = open & !settled;
                ended = ended | (active & !change.less(mark * S::ratio(1.0, 2.0)));
                mark = S::select(active, change, mark);
                let [resting, _] = reviews.take(enough & !ended, change, unit);
                let late = count + S::from_f64(BEYOND);
                due = S::select(resting & !due.less(never), late, due);
            }
            if iterations == 1 {
                first = change;
                if !ended.any() {
                    iterations = self.least_quiet().max(1);
                    self.blind(&mut work, iterations - 1, &mut field);
                }
            } else if settled.all() && !enough.any() {
                // nothing is to be seen before the derivative of some lane has converged
                let now = iterations;
                loop {
                    let next = S::from_f64(f64::from(iterations + 1));
                    let close = self.derived(left * rate, next).any();
                    if close || iterations + 1 >= self.most_iterations {
                        break;
                    }
                    iterations += 1;
                    left *= rate;
                }
                let resumed = S::one().less_equal(left);
                if (quick | resumed).all() && iterations + 1 < self.most_iterations {
                    iterations += 1;
                    left *= rate;
                    let count = S::from_f64(f64::from(iterations));
                    enough = self.derived(left, count);
                    self.taken = S::select(enough & !resumed, count, self.taken);
                    converged = enough;
                    ended = enough;
                }
                self.blind(&mut work, iterations - now, &mut field);
            }
        }
        self.work = work;
        self.end(iterations, change, converged)
    }

    /// The rate at which changes shrink that have just reached round-off, from the last three of them: single ones may
    /// shrink by much less than those around them. The third look of a step should be the one that sees it.
    #[cfg_attr(not(debug_assertions), inline(always))]
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
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn derived(&self, left: S, count: S) -> S::Mask {
        let by_rate = left.less_equal(S::epsilon() * S::ratio(1.0, 4.0));
        by_rate | (S::one().less_equal(left) & self.taken.less_equal(count))
    }
}
