//! Gauss collocation with its stages side by side in one number, by fixed-point iteration.

mod estimate;
mod length;
mod map;
pub(super) mod program;
mod start;
mod state;
#[cfg(test)]
mod tests;

use core::ops::Range;

#[cfg(feature = "std")]
use self::program::StageProgram;
use self::program::{AHEAD, PER_STEP, PER_UNIT, PER_WEIGHT, RATIOS, StageSlopes, TABLE, WEIGHTS};
use super::diagonals::diagonals;
use super::stage_ending::most;
use super::stage_work::{At, Rule, Work};
use super::tableau::{gauss_ahead, gauss_ratio};
use crate::clock::{Clock, holds};
use crate::newton::{Convergence, Iteration, NewtonOptions};
#[cfg(feature = "std")]
use crate::poisson::Widen;
use crate::scalar::{Mask, Scalar, largest, power_of_two};
use crate::state::State;

/// An iteration whose changes are at rest, but shrank slowly, goes on for so many iterations: in its slowest direction the
/// error is larger than the changes.
const BEYOND: f64 = 24.0;

/// For so many steps the first change counts that was seen last.
const FRESH: f64 = 16.0;

/// Where no rate is known, a change counts as what is left after it.
const UNKNOWN: (f64, f64) = (1.0, 2.0);

/// The stages of a step of Gauss collocation for `y' = f(y)`, all in one number of type [`Scalar::Wide`].
///
/// With the increments `D_i = h b_i f(Y_i)` the iteration is `D_i <- h b_i f(y + sum_j (a_ij/b_j) D_j)`: one evaluation of the
/// field on all stages and one product with the ratios of the tableau, for which rounding leaves every quadratic invariant
/// ([`gauss_ratio`]). It starts from the polynomial of the step before, continued; without
/// one, from `f(y)`. It converges linearly, by a factor proportional to h. How many iterations a step takes changes
/// little from step to step, so most of them are made without a look at the changes.
#[derive(Debug)]
pub struct StageParallel<S: Scalar, V> {
    /// How many there are.
    stages: usize,
    /// By their [places](program): `a_ij/b_j`, the matrix that continues the polynomial of a step, `h b_i` in place i and 0 in the places
    /// without a stage, `1/|h b_i|` likewise, so that places without a stage do not count, one over the unit of the momenta, and `1/|h|`.
    table: [S::Wide; TABLE],
    /// Weights and inverse weights of a step of length 1.
    unit: [S::Wide; 2],
    /// The coefficients in Legendre polynomials, once they were asked for.
    legendre: Option<[S::Wide; 8]>,
    step: S,
    /// y, the same in all places.
    base: V,
    work: Work<V>,
    /// What iterates in place of the kernels of the system.
    #[cfg(feature = "std")]
    program: Option<Box<dyn StageProgram<S::Wide>>>,
    /// Whether the last look of that program told the end of the step.
    #[cfg(feature = "std")]
    is_ended: bool,
    /// The size of the slopes of the step to come, where it is known.
    known_size: Option<S>,
    /// The entries that carry the time, where there are any.
    clock: Option<Clock>,
    /// The entries in a unit of their own, where there are any, and one over that unit.
    momenta: Option<(Range<usize>, S)>,
    options: NewtonOptions,
    /// The number of iterations after which a step has failed.
    most_iterations: u32,
    /// How many iterations of a step need no look, in each lane.
    quiet: S,
    /// The factor by which changes shrank at the end of a step.
    rate: S,
    /// How many iterations the map of the last step took, in each lane.
    taken: S,
    /// The first change of a step, and for how many steps it has not been looked at.
    first: S,
    age: S,
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug)]
pub struct Iterated<S: Scalar> {
    /// Evaluations of the field on all stages.
    pub iterations: u32,
    /// The size of the last update of `h F` that was looked at.
    pub residual: f64,
    /// The lanes that have converged.
    pub converged: S::Mask,
}

impl<S: Scalar, V: State<S::Wide>> StageParallel<S, V> {
    /// Steps of size h with so many stages, at most 8; `zero` is any vector of the right size.
    pub fn new(stages: usize, h: S, zero: V, options: &NewtonOptions) -> Self {
        assert!(stages <= 8, "a number has eight places");
        let mut table = [S::Wide::one(); TABLE];
        let ratios = diagonals(stages, stages, &|i, j| gauss_ratio::<S>(stages, i, j));
        let ahead = diagonals(stages, stages, &|i, j| gauss_ahead::<S>(stages, i, j));
        table[RATIOS].copy_from_slice(&ratios);
        table[AHEAD].copy_from_slice(&ahead);
        let unit = length::weights::<S>(stages, S::one());
        [table[WEIGHTS], table[PER_WEIGHT]] = length::weights::<S>(stages, h);
        table[PER_STEP] = (S::one() / h.abs()).widen();
        Self {
            stages,
            table,
            unit,
            legendre: None,
            #[cfg(feature = "std")]
            program: None,
            #[cfg(feature = "std")]
            is_ended: false,
            known_size: None,
            step: h,
            base: zero.clone(),
            work: Work {
                increments: zero.clone(),
                points: zero.clone(),
                next: zero,
            },
            clock: None,
            momenta: None,
            options: *options,
            most_iterations: match (options.iteration, options.convergence) {
                (Iteration::Automatic, Convergence::Map) => {
                    options.max_iterations.saturating_mul(3)
                }
                (Iteration::Automatic, _) => options.max_iterations.saturating_mul(2),
                _ => options.max_iterations,
            },
            quiet: S::zero(),
            rate: S::ratio(UNKNOWN.0, UNKNOWN.1),
            taken: S::zero(),
            first: S::zero(),
            age: S::from_f64(FRESH),
        }
    }

    /// How many stages there are.
    pub fn count(&self) -> usize {
        self.stages
    }

    /// With entries that carry the time.
    pub(crate) fn with_clock(mut self, clock: Option<Clock>) -> Self {
        self.clock = clock;
        self
    }

    /// With entries that have a unit of their own.
    pub(crate) fn with_momenta(mut self, momenta: Option<Range<usize>>) -> Self {
        self.momenta = momenta.map(|entries| (entries, S::one()));
        self
    }

    /// Iterates by programs of a system, where it has some of these slopes.
    #[cfg(feature = "std")]
    pub(crate) fn by_programs_of<P: Widen<S>>(
        mut self,
        system: &P,
        slopes: Option<StageSlopes>,
    ) -> Self {
        let program = |slopes| system.stage_program(slopes, self.stages);
        self.program = slopes.and_then(program);
        self
    }

    /// Iterates by the kernels of the system.
    #[cfg(not(feature = "std"))]
    pub(crate) fn by_programs_of<P>(self, _system: &P, _slopes: Option<StageSlopes>) -> Self {
        self
    }

    /// Tells the programs what is constant on the space of a lift.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn set_labels(&mut self, _labels: &[S::Wide]) {
        #[cfg(feature = "std")]
        if let Some(program) = &mut self.program {
            program.set_labels(_labels);
        }
    }

    /// Sets the unit of these entries, in the lanes of a mask: the power of two at or below the largest of them at a point.
    pub(crate) fn set_unit(&mut self, mask: S::Mask, point: &[S]) {
        if let Some((entries, per_unit)) = &mut self.momenta {
            let unit = power_of_two(S::largest_magnitude(&point[entries.clone()]));
            *per_unit = S::select(mask, S::one() / unit, *per_unit);
            self.table[PER_UNIT] = per_unit.widen();
        }
    }

    /// The largest magnitude at a point, in units.
    pub(crate) fn norm(&self, point: &[S]) -> S {
        let entries = point.iter().enumerate();
        let counted = entries.filter(|(i, _)| !holds(self.clock, *i));
        counted.fold(S::zero(), |norm, (i, y)| {
            norm.max(y.magnitude() * self.per_unit(i))
        })
    }

    /// One over the unit of an entry.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn per_unit(&self, entry: usize) -> S {
        match &self.momenta {
            Some((entries, per_unit)) if entries.contains(&entry) => *per_unit,
            _ => S::one(),
        }
    }

    /// Sets the time of the base.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn set_time(&mut self, time: S) {
        if let Some(clock) = self.clock {
            self.base.as_mut_slice()[clock.time] = time.widen();
        }
    }

    /// Starts from the polynomial of the last step.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn go_on(&mut self) {
        #[cfg(feature = "std")]
        if let Some(program) = &mut self.program {
            let base = self.base.as_slice();
            let [size, ..] = S::scatter(program.go_on(&self.table, base, self.work.both()));
            self.known_size = Some(size);
            return self.work.exchange();
        }
        program::go_on::<S>(
            self.stages,
            self.work.increments.as_mut_slice(),
            &self.table,
        );
    }

    /// Iterates until what the options say has converged. Sizes are sums of magnitudes. `field` gives the next slopes.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn iterate(&mut self, field: impl FnMut(At<'_, V>, &mut V)) -> Iterated<S> {
        self.iterate_by(field)
    }

    /// The same by a rule for the increments.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn iterate_by(&mut self, field: impl Rule<S, V>) -> Iterated<S> {
        match self.options.convergence {
            Convergence::Map => self.iterate_map(field),
            Convergence::State | Convergence::Claimed | Convergence::Tolerance => {
                self.iterate_state(field)
            }
        }
    }

    /// How many iterations need no look in any lane.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn least_quiet(&self) -> u32 {
        let quiet = (1..S::LANES).fold(self.quiet.lane(0).to_f64(), |least, lane| {
            least.min(self.quiet.lane(lane).to_f64())
        });
        (quiet as u32).min(self.most_iterations)
    }

    /// Iterates once; the largest change of the slopes at a stage. The lanes that have ended keep their increments.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn look(&mut self, work: &mut Work<V>, ended: S::Mask, field: &mut impl Rule<S, V>) -> S {
        #[cfg(feature = "std")]
        if let Some(program) = &mut self.program {
            let change = program.look(&self.table, self.base.as_slice(), work.both());
            work.exchange();
            self.is_ended = true;
            let [change, ..] = S::scatter(change);
            return change;
        }
        work.evaluate::<S>(self.stages, &self.table, &self.base, field);
        if let Some(clock) = self.clock {
            work.replace_entries::<S>(&[clock.momentum, clock.time], ended);
        }
        let momenta = self.momenta.as_ref();
        let momenta = momenta.map(|(entries, per_unit)| (entries.clone(), per_unit.widen()));
        most::<S>(work.replace::<S>(ended, momenta) * self.table[PER_WEIGHT])
    }

    /// Iterates so many times without a look at the changes.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn blind(&mut self, work: &mut Work<V>, count: u32, field: &mut impl Rule<S, V>) {
        #[cfg(feature = "std")]
        if let Some(program) = &mut self.program {
            if count > 0 {
                program.iterate(count, &self.table, self.base.as_slice(), work.both());
                self.is_ended = false;
            }
            if count % 2 == 1 {
                work.exchange();
            }
            return;
        }
        for _ in 0..count {
            work.evaluate::<S>(self.stages, &self.table, &self.base, field);
            work.increments.take_over(&mut work.next);
        }
    }

    /// What is reported of an iteration; the next one expects nothing in the lanes that have not converged.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn end(&mut self, iterations: u32, change: S, converged: S::Mask) -> Iterated<S> {
        if !converged.all() {
            self.forget(!converged);
        }
        Iterated {
            iterations,
            residual: largest(change * self.step.abs()),
            converged,
        }
    }

    /// Expects nothing of the next step in some lanes.
    fn forget(&mut self, lanes: S::Mask) {
        self.quiet = S::select(lanes, S::zero(), self.quiet);
        self.rate = S::select(lanes, S::ratio(UNKNOWN.0, UNKNOWN.1), self.rate);
        self.taken = S::select(lanes, S::zero(), self.taken);
        self.age = S::select(lanes, S::from_f64(FRESH), self.age);
    }

    /// The size of the slopes against which changes are measured.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn size(&mut self) -> S {
        if let Some(known) = self.known_size.take() {
            return known;
        }
        let momenta = self.momenta.as_ref().map(|(entries, _)| entries);
        let entries = [self.base.as_slice(), self.work.increments.as_slice()];
        let [size, ..] = S::scatter(program::size::<S>(
            (self.clock, momenta),
            entries,
            &self.table,
        ));
        size
    }

    /// Moves the base to the end of the step.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn advance(&mut self) {
        #[cfg(feature = "std")]
        if let Some(program) = self.program.as_ref().filter(|_| self.is_ended) {
            return self.base.as_mut_slice().copy_from_slice(program.end());
        }
        let increments = self.work.increments.as_slice();
        program::advance::<S>(self.base.as_mut_slice(), increments);
    }

    /// Writes the base, in one place of its numbers.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn base_into(&self, out: &mut [S]) {
        for (out, wide) in out.iter_mut().zip(self.base.as_slice()) {
            let [y, ..] = S::scatter(*wide);
            *out = y;
        }
    }

    /// The base and the increments of the last step, to be changed together.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn base_and_increments(&mut self) -> (&mut V, &mut V) {
        (&mut self.base, &mut self.work.increments)
    }

    /// The stages of a step with the increments of the last one from a base, which is set.
    pub fn stages(&mut self, base: &[S]) -> At<'_, V> {
        self.set_base(S::Mask::splat(true), base);
        self.work
            .set_points::<S>(self.stages, &self.table[RATIOS], &self.base);
        At {
            base: &self.base,
            increments: &self.work.increments,
            points: &self.work.points,
        }
    }

    /// The increments `D_i` of the stages.
    pub fn increments<U: State<S>>(&self, out: &mut [U]) {
        for (k, &increments) in self.work.increments.as_slice().iter().enumerate() {
            let entries = S::scatter(increments);
            for (out, &entry) in out.iter_mut().zip(&entries) {
                out.as_mut_slice()[k] = entry;
            }
        }
    }
}
