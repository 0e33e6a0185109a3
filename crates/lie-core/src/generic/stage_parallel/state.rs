//! The iteration until the state has converged.

use super::{BEYOND, FRESH, Iterated, StageParallel};
use crate::generic::stage_ending::Ending;
use crate::generic::stage_work::Rule;
use crate::newton::rest::{REVIEW, Reviews};
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// Where changes shrink by less than this, what is left is taken to a part: entries may be so much smaller than the state.
const SLOW: (f64, f64) = (1.0, 4.0);
const PART: (f64, f64) = (1.0, 32.0);

impl<S: Scalar, V: State<S::Wide>> StageParallel<S, V> {
    /// Until the error of the increments is below the tolerance of the options, or changes have come to rest at round-off.
    ///
    /// The first change, which is looked at now and then, tells changes that dropped to round-off from those that shrink slowly
    /// and may have any ratio. The latter end by their reviews. Where changes shrink slowly, some iterations more are made for the
    /// entries that are smaller than the state.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn iterate_state(&mut self, mut field: impl Rule<S, V>) -> Iterated<S> {
        let ending = Ending::new(self.size(), self.rate, &self.options);
        let (quiet, stale) = (self.least_quiet(), !self.age.less(S::from_f64(FRESH)));
        let done = u32::from(quiet > 0 && stale.any());
        if done > 0 {
            self.begin(stale, &mut field);
        }
        self.age += S::one();
        // by value, so that it can stay in registers
        let mut work = self.work.take::<S>();
        let [mut ended, mut converged] = [S::Mask::splat(false); 2];
        let never = S::from_f64(f64::MAX);
        let (mut reviews, mut due) = (Reviews::new(), never);
        let mut closing = S::Mask::splat(false);
        self.blind(&mut work, quiet - done, &mut field);
        let mut iterations = quiet;
        let [mut before, mut change] = [S::zero(); 2];
        while iterations < self.most_iterations && !ended.all() {
            let earlier = before;
            before = change;
            change = self.look(&mut work, ended, &mut field);
            iterations += 1;
            if iterations == 1 {
                let seen = stale | self.quiet.less(S::one());
                self.begun(seen, change);
            }
            let count = S::from_f64(f64::from(iterations));
            let closed = closing & due.less_equal(count);
            ended = ended | closed;
            let open = self.quiet.less(count) & !ended & !closing;
            let looks = count - self.quiet;
            let first = looks.less_equal(S::one());
            let mut early = first;
            let bound = S::select(first, ending.at_once, ending.bound);
            let mut reached = change.less_equal(bound) & open;
            let doubtful = reached & !first;
            if doubtful.any() {
                let earlier = S::select(looks.less(S::ratio(3.0, 1.0)), never, earlier);
                let changes = [earlier, before, change];
                let [small, dropped] = ending.reached(self.first, changes, iterations);
                let rate = change / before;
                self.rate = S::select(doubtful & small & rate.finite(), rate, self.rate);
                reached = reached & (first | small | dropped);
                early = early | (!small & looks.less_equal(S::ratio(3.0, 1.0)));
            }
            let late = due.less_equal(count) & open & !reached;
            if late.any() {
                // three reviews are to be seen, the last where this one was at rest
                let seen = S::from_f64(BEYOND + f64::from(3 * REVIEW + 1));
                let quiet = (count - seen).max(S::zero());
                self.quiet = S::select(late, quiet, self.quiet);
                converged = converged | late;
                ended = ended | late;
            }
            if reached.any() {
                self.expect(reached, early, count);
                converged = converged | reached;
                let slow = reached & S::ratio(SLOW.0, SLOW.1).less(self.rate);
                if slow.any() {
                    due = S::select(slow, count + self.more(), due);
                    closing = closing | slow;
                }
                ended = ended | (reached & !slow);
            }
            if iterations.is_multiple_of(REVIEW) {
                let [resting, failing] = reviews.take(open & !ended, change, ending.unit);
                due = S::select(resting & !due.less(never), count + S::from_f64(BEYOND), due);
                ended = ended | failing;
            }
        }
        self.work = work;
        self.end(iterations, change, converged)
    }

    /// So many iterations more take what is left to a part.
    #[cold]
    #[inline(never)]
    fn more(&self) -> S {
        let (mut left, mut more) = (self.rate, S::one());
        for _ in 1..BEYOND as u32 {
            let goes_on = S::ratio(PART.0, PART.1).less(left);
            more += S::select(goes_on, S::one(), S::zero());
            left *= self.rate;
        }
        more
    }

    /// Iterates once, to see the first change of a step in some lanes.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, lanes: S::Mask, field: &mut impl Rule<S, V>) {
        let mut work = self.work.take::<S>();
        let change = self.look(&mut work, S::Mask::splat(false), field);
        self.work = work;
        self.begun(lanes, change);
    }

    /// Takes the first change of a step in some lanes.
    fn begun(&mut self, lanes: S::Mask, change: S) {
        self.first = S::select(lanes, change, self.first);
        self.age = S::select(lanes, S::zero(), self.age);
    }

    /// All iterations of the next step but the last two need no look. Where the first look was enough, or the next two saw
    /// nothing but round-off, it comes earlier.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn expect(&mut self, reached: S::Mask, early: S::Mask, count: S) {
        let [one, two] = [1.0, 2.0].map(|k| S::ratio(k, 1.0));
        let quiet = S::select(early, self.quiet - one, count - two);
        self.quiet = S::select(reached, quiet.max(S::zero()), self.quiet);
    }
}
