//! Gauss collocation with its stages side by side in one number, by fixed-point iteration.

use core::array::from_fn;

use super::diagonals::{diagonals, product, tree};
use super::tableau::{gauss_ahead, gauss_entry, gauss_weight};
use crate::newton::{Convergence, NewtonOptions};
use crate::scalar::{Mask, Scalar, largest};
use crate::state::{Stages, State};

/// After so many iterations each, updates must have become half as large.
const REVIEW: u32 = 8;
/// Updates up to this many units of round-off that no longer shrink are round-off themselves.
const STAGNATION: f64 = 256.0;

/// A start that is no better than the field at the state is improved by so many half iterations.
const APPROACH: u32 = 12;

/// The stages of a step of Gauss collocation for `y' = f(y)`, all in one number of type [`Scalar::Wide`].
///
/// With the slopes `F_i = f(Y_i)` the iteration is `F_i <- f(y + h sum_j a_ij F_j)`: one evaluation of the field on
/// all stages and one product with the tableau. It starts from the polynomial of the step before, continued; without
/// one, from `f(y)`. It converges linearly, by a factor proportional to h.
#[derive(Clone, Debug)]
pub struct StageParallel<S: Scalar, V, const STAGES: usize> {
    /// The diagonals of h A.
    tableau: [S::Wide; 8],
    /// Those of the matrix that continues the polynomial of a step.
    ahead: [S::Wide; 8],
    /// `h b_i` in place i.
    weights: S::Wide,
    /// 1 in the place of each stage, 0 in the others.
    inside: S::Wide,
    step: S,
    /// `1/|h|`
    rate: S,
    slopes: V,
    point: V,
    next: V,
    options: NewtonOptions,
    /// How many iterations the map of the last step took, in each lane.
    taken: S,
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug)]
pub struct Iterated<S: Scalar> {
    /// Evaluations of the field on all stages.
    pub iterations: u32,
    /// The size of the last update of `h F`.
    pub residual: f64,
    /// The lanes that have converged.
    pub converged: S::Mask,
}

impl<S: Scalar, V: State<S::Wide>, const STAGES: usize> StageParallel<S, V, STAGES> {
    /// Steps of size h; `zero` is any vector of the right size.
    pub fn new(h: S, zero: V, options: &NewtonOptions) -> Self {
        Self {
            tableau: diagonals(STAGES, STAGES, |i, j| h * gauss_entry::<S>(STAGES, i, j)),
            ahead: diagonals(STAGES, STAGES, |i, j| gauss_ahead::<S>(STAGES, i, j)),
            weights: S::gather(from_fn(|i| {
                if i < STAGES {
                    h * gauss_weight::<S>(STAGES, i)
                } else {
                    S::zero()
                }
            })),
            inside: S::gather(from_fn(|i| if i < STAGES { S::one() } else { S::zero() })),
            step: h,
            rate: S::one() / h.abs(),
            slopes: zero.clone(),
            point: zero.clone(),
            next: zero,
            options: *options,
            taken: S::zero(),
        }
    }

    /// Starts from a slope that is the same at all stages, in the lanes of a mask.
    pub fn start_with(&mut self, mask: S::Mask, slope: &[S]) {
        for (slopes, &entry) in self.slopes.as_mut_slice().iter_mut().zip(slope) {
            let old = S::scatter(*slopes);
            *slopes = S::gather(old.map(|old| S::select(mask, entry, old)));
        }
        self.taken = S::select(mask, S::zero(), self.taken);
    }

    /// Takes half of the way that the iteration would go, several times, in the lanes of a mask: where it contracts at all, that
    /// leads from a bad start to a good one.
    pub fn approach(&mut self, mask: S::Mask, base: &[S], mut field: impl FnMut(&V, &mut V)) {
        let half = S::ratio(1.0, 2.0);
        for _ in 0..APPROACH {
            self.set_points(base);
            field(&self.point, &mut self.next);
            let slopes = self.slopes.as_mut_slice().iter_mut();
            for (slope, &next) in slopes.zip(self.next.as_slice()) {
                let (old, new) = (S::scatter(*slope), S::scatter(next));
                let middle = |i: usize| half * (old[i] + new[i]);
                *slope = S::gather(from_fn(|i| S::select(mask, middle(i), old[i])));
            }
        }
    }

    /// Starts from the polynomial of the last step.
    #[inline(always)]
    pub fn go_on(&mut self) {
        for slopes in self.slopes.as_mut_slice() {
            *slopes = product::<S, STAGES>(&self.ahead, *slopes);
        }
    }

    /// Iterates from a base until what the options say has converged. Sizes are sums of magnitudes. `field` takes the slopes
    /// and the points at the stages and gives the next slopes.
    #[inline(always)]
    pub fn iterate(&mut self, base: &[S], field: impl FnMut(&V, &V, &mut V)) -> Iterated<S> {
        match self.options.convergence {
            Convergence::Map => self.iterate_map(base, field),
            Convergence::State | Convergence::Claimed => self.iterate_state(base, field),
        }
    }

    /// Until the error of the increments is below the tolerance of the options, or updates have shrunk to round-off.
    #[inline(always)]
    fn iterate_state(&mut self, base: &[S], mut field: impl FnMut(&V, &V, &mut V)) -> Iterated<S> {
        let ending = Ending::new(self.size(base), &self.options);
        let [mut ended, mut converged] = [S::Mask::splat(false); 2];
        let (mut iterations, mut mark) = (0, S::from_f64(f64::MAX));
        let mut change = S::Wide::zero();
        while iterations < self.options.max_iterations && !ended.all() {
            self.set_points(base);
            field(&self.slopes, &self.point, &mut self.next);
            let before = change;
            change = self.replace(ended);
            iterations += 1;
            if ending.may_be(change) {
                let size = most::<S>(change);
                let before = (iterations > 1).then(|| most::<S>(before));
                converged = converged | (ending.reached(before, size) & !ended);
                ended = ended | converged;
            }
            if iterations % REVIEW == 0 {
                let size = most::<S>(change);
                ended = ended | !size.less(mark * S::ratio(1.0, 2.0));
                mark = size;
            }
        }
        Iterated {
            iterations,
            residual: largest(most::<S>(change) * self.step.abs()),
            converged,
        }
    }

    /// Until the derivative of the increments by the base has converged too.
    ///
    /// With the start frozen, that derivative starts from nothing, and iterates by the same contraction as an error of
    /// the state. So by how much the updates have shrunk since the first one, they say how much of the derivative is left. Where
    /// they reach round-off before it, the last rate is taken to go on; a start at round-off shows no rate, and takes as
    /// many iterations as the step before.
    #[inline(always)]
    fn iterate_map(&mut self, base: &[S], mut field: impl FnMut(&V, &V, &mut V)) -> Iterated<S> {
        let bound = self.size(base) * S::epsilon() * S::from_f64(STAGNATION);
        let wide_bound = bound.widen();
        let enough = S::epsilon() * S::ratio(1.0, 4.0);
        let [mut ended, mut settled, mut ready] = [S::Mask::splat(false); 3];
        let (mut iterations, mut mark) = (0, S::from_f64(f64::MAX));
        let [mut first, mut before, mut change] = [S::Wide::zero(); 3];
        let [mut left, mut rate] = [S::one(); 2];
        while iterations < self.options.max_iterations && !ended.all() {
            self.set_points(base);
            field(&self.slopes, &self.point, &mut self.next);
            let earlier = before;
            before = change;
            change = self.replace(ended);
            iterations += 1;
            if iterations == 1 {
                first = change;
            }
            left *= rate;
            if !settled.all() && is_below::<S>(change, wide_bound) {
                let size = most::<S>(change);
                let new = size.less_equal(bound) & !settled;
                if iterations > 1 {
                    // single updates may shrink by much less than those around them
                    let last = match iterations {
                        2 => size / most::<S>(before),
                        _ => (size / most::<S>(earlier)).sqrt(),
                    };
                    rate = S::select(new, last, rate);
                    left = S::select(new, size / most::<S>(first), left);
                }
                settled = settled | new;
            }
            let count = S::from_f64(f64::from(iterations));
            let by_rate = left.less_equal(enough);
            let by_count = S::one().less_equal(left) & self.taken.less_equal(count);
            ready = ready | (settled & !ended & (by_rate | by_count));
            self.taken = S::select(ready & !ended, count, self.taken);
            ended = ended | ready;
            if iterations % REVIEW == 0 {
                let size = most::<S>(change);
                ended = ended | (!settled & !size.less(mark * S::ratio(1.0, 2.0)));
                mark = size;
            }
        }
        Iterated {
            iterations,
            residual: largest(most::<S>(change) * self.step.abs()),
            converged: ready,
        }
    }

    /// The size of the slopes against which changes are measured: that of the base over h, or of the slopes themselves.
    #[inline(always)]
    fn size(&self, base: &[S]) -> S {
        let scale = base.iter().fold(S::zero(), |sum, y| sum + y.magnitude());
        let slopes = self.slopes.as_slice().iter();
        let slopes = slopes.fold(S::Wide::zero(), |sum, f| sum + f.magnitude());
        (scale * self.rate).max(most::<S>(slopes))
    }

    /// Sets the points `y + h A F`.
    #[inline(always)]
    fn set_points(&mut self, base: &[S]) {
        let entries = self.point.as_mut_slice().iter_mut().zip(base);
        for ((point, y), slopes) in entries.zip(self.slopes.as_slice()) {
            *point = y.widen() + product::<S, STAGES>(&self.tableau, *slopes);
        }
    }

    /// Takes over the next slopes but in the lanes that have ended; the sum of all changes at each stage.
    #[inline(always)]
    fn replace(&mut self, ended: S::Mask) -> S::Wide {
        let mut change = S::Wide::zero();
        let slopes = self.slopes.as_mut_slice().iter_mut();
        for (slope, &next) in slopes.zip(self.next.as_slice()) {
            change += (next - *slope).magnitude();
            *slope = if S::LANES == 1 {
                next
            } else {
                let (old, new) = (S::scatter(*slope), S::scatter(next));
                S::gather(from_fn(|i| S::select(ended, old[i], new[i])))
            };
        }
        // places without a stage do not count
        if STAGES < 8 {
            change * self.inside
        } else {
            change
        }
    }

    /// Adds the increment of the step to the base.
    #[inline(always)]
    pub fn advance(&self, base: &mut [S]) {
        for (y, slopes) in base.iter_mut().zip(self.slopes.as_slice()) {
            let [a, b, c, d, e, f, g, h] = S::scatter(self.weights * *slopes);
            *y += tree(&[a, b, c, d]) + tree(&[e, f, g, h]);
        }
    }

    /// The slopes at the stages, to be changed where the base is.
    pub fn slopes_mut(&mut self) -> &mut V {
        &mut self.slopes
    }

    /// The slopes and the points of the stages, of a step from the base.
    pub fn stages(&mut self, base: &[S]) -> (&V, &V) {
        self.set_points(base);
        (&self.slopes, &self.point)
    }

    /// The increments `h F_i` of the stages.
    pub fn increments<U: State<S>>(&self, out: &mut Stages<U, STAGES>) {
        for (k, &slopes) in self.slopes.as_slice().iter().enumerate() {
            let entries = S::scatter(slopes);
            for (out, &entry) in out.0.iter_mut().zip(&entries) {
                out.as_mut_slice()[k] = self.step * entry;
            }
        }
    }

    /// Replaces the slopes by given increments `h F_i` divided by h, in the lanes of a mask.
    pub fn set_increments_where(&mut self, mask: S::Mask, increment: impl Fn(usize, usize) -> S) {
        for (k, slopes) in self.slopes.as_mut_slice().iter_mut().enumerate() {
            let mut entries = S::scatter(*slopes);
            for (i, entry) in entries.iter_mut().enumerate().take(STAGES) {
                *entry = S::select(mask, increment(i, k) / self.step, *entry);
            }
            *slopes = S::gather(entries);
        }
    }
}

/// When an iteration has ended, in changes of the slopes.
struct Ending<S: Scalar> {
    /// What may be left.
    goal: S,
    /// Changes up to this are round-off if they no longer shrink.
    round_off: S,
    /// Changes above this are not looked at.
    bound: S,
    wide_bound: S::Wide,
}

impl<S: Scalar> Ending<S> {
    /// For slopes of which a part of round-off is `epsilon` times the size.
    #[inline(always)]
    fn new(size: S, options: &NewtonOptions) -> Self {
        let unit = S::epsilon() * size;
        let bound = unit * S::from_f64(STAGNATION.max(16.0 * options.tolerance));
        Self {
            goal: unit * S::from_f64(options.tolerance),
            round_off: unit * S::from_f64(STAGNATION),
            bound,
            wide_bound: bound.widen(),
        }
    }

    /// Whether a change is so small that the iteration may have ended in some lane.
    #[inline(always)]
    fn may_be(&self, change: S::Wide) -> bool {
        is_below::<S>(change, self.wide_bound)
    }

    /// The lanes in which it has: with the ratio r of the last two changes as the rate, the last one times `r/(1 - r)` is
    /// left. One change alone says no rate.
    #[inline(always)]
    fn reached(&self, before: Option<S>, change: S) -> S::Mask {
        let Some(before) = before else {
            return change.less_equal(self.goal);
        };
        let shrinks = (change + change).less(before);
        let left = change * change;
        let small = left.less_equal(self.goal * (before - change));
        let settled = change.less_equal(self.round_off);
        change.less_equal(self.bound) & ((shrinks & small) | (!shrinks & settled))
    }
}

/// Whether eight numbers are below others, in some lane; of a number without lanes, all eight.
#[inline(always)]
fn is_below<S: Scalar>(numbers: S::Wide, bound: S::Wide) -> bool {
    let below = numbers.less_equal(bound);
    if S::LANES == 1 {
        below.all()
    } else {
        below.any()
    }
}

/// The largest of eight numbers.
#[inline(always)]
fn most<S: Scalar>(wide: S::Wide) -> S {
    let [a, b, c, d, e, f, g, h] = S::scatter(wide);
    S::max(S::max(a.max(b), c.max(d)), S::max(e.max(f), g.max(h)))
}
