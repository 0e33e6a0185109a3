//! The unit of time of a series: a power of two near its radius of convergence.
//!
//! In this unit no coefficient overflows or vanishes because of its order, whatever the rates of the system are. Powers of two
//! are exact: the unit changes no digit of the solution.

use super::development::{Pace, Terms};
use super::radius::Radius;
use super::rough_log::{binary_log, power_of_two, rounded};
use crate::clock::{Clock, norm};
use crate::scalar::{Mask, Scalar, largest};
use crate::state::State;

/// No scalar has more lanes.
pub(super) const MOST_LANES: usize = 8;
/// How far the unit may be from the radius, as a power of two: order 40 then has a factor of 2^160 at most.
const FARTHEST: i64 = 4;
/// Units that are tried for one series.
const TRIALS: u32 = 8;

/// The unit in each lane, and how far the series is used there.
#[derive(Clone, Debug)]
pub(super) struct TimeUnit<S: Scalar> {
    exponents: [i32; MOST_LANES],
    /// The lanes in which there was a series before.
    known: u64,
    /// Orders that were finite in the last trial.
    finite: [usize; MOST_LANES],
    trials: u32,
    /// One unit.
    pub(super) length: S,
    /// What a time is multiplied by to be in units.
    pub(super) inverse: S,
    /// How far the series is used, as a time; not a number where a coefficient is not finite.
    pub(super) reach: S,
}

impl<S: Scalar> TimeUnit<S> {
    pub(super) fn new() -> Self {
        const { assert!(S::LANES <= MOST_LANES) };
        Self {
            exponents: [0; MOST_LANES],
            known: 0,
            finite: [0; MOST_LANES],
            trials: 0,
            length: S::one(),
            inverse: S::one(),
            reach: S::zero(),
        }
    }

    /// Knows nothing of the series before in some lanes.
    pub(super) fn forget(&mut self, lanes: S::Mask) {
        self.known &= !lanes.bits();
    }

    fn set(&mut self, lane: usize, exponent: i32) {
        let most = match largest(S::epsilon()) > 1e-10 {
            true => 100,
            false => 1000,
        };
        let exponent = exponent.clamp(-most, most);
        self.exponents[lane] = exponent;
        self.known |= 1 << lane;
        let power = |exponent| S::Lane::from_f64(power_of_two(exponent));
        self.length = self.length.with_lane(lane, power(exponent));
        self.inverse = self.inverse.with_lane(lane, power(-exponent));
    }

    /// Before a series from a state, for a step of the grid: the unit of the series before, or else a guess by the norm of the field, which
    /// is asked for then.
    pub(super) fn begin<V: State<S>>(
        &mut self,
        pace: &Pace,
        clock: Option<Clock>,
        (mu, slope): (&V, impl FnOnce() -> S),
        step: S,
        lanes: S::Mask,
    ) {
        self.trials = 0;
        self.finite = [0; MOST_LANES];
        let guessed = lanes.bits() & !self.known;
        if guessed == 0 {
            return;
        }
        let (step, state, slope) = (each(step), each(norm(clock, mu)), each(slope()));
        for lane in S::Mask::from_bits(guessed).lanes() {
            let of_lane = |sizes: &[f64; MOST_LANES]| binary_log(sizes[lane].abs());
            // what is too large for the unit is found more surely than what is too small
            let step = of_lane(&step).unwrap_or(0);
            let (state, slope) = (of_lane(&state), of_lane(&slope));
            let guess = match (state, slope) {
                (Some(state), Some(slope)) if pace.is_adaptive() => rounded(state - slope),
                _ => rounded(step),
            };
            let least = rounded(step) - i64::from(pace.is_adaptive()) * 10;
            self.set(lane, guess.max(least) as i32);
        }
    }

    /// After a series in some lanes: those in which it is wanted once more, in another unit.
    pub(super) fn settle<V: State<S>>(
        &mut self,
        pace: &Pace,
        series: &[Terms<'_, S, V>],
        clock: Option<Clock>,
        step: S,
        lanes: S::Mask,
    ) -> S::Mask {
        if let [terms] = series
            && let Some(reach) = terms.reach().filter(|_| pace.is_usual())
        {
            // nothing is special in any lane
            let near = reach.shift.abs().less_equal(S::from_f64(FARTHEST as f64));
            if (reach.lanes & near | !lanes).all() {
                self.reach = S::select(lanes, reach.length * self.length, self.reach);
                return S::Mask::splat(false);
            }
        }
        self.trials += 1;
        let mut again = 0;
        let steps = each(step * self.inverse);
        let mut radii = [Radius::Infinite; MOST_LANES];
        for terms in series {
            let usual = pace.usual(terms, clock);
            for lane in lanes.lanes() {
                let step = steps[lane].abs();
                let radius = usual.radius(lane);
                let radius = radius.unwrap_or_else(|| pace.radius(terms, lane, step, clock));
                radii[lane] = radii[lane].smaller(radius);
            }
        }
        let (mut reaches, mut shifts) = ([0.0; MOST_LANES], [0; MOST_LANES]);
        for lane in lanes.lanes() {
            let unit = self.exponents[lane];
            let radius = radii[lane];
            let (shift, wanted) = match radius {
                Radius::Infinite => (0, false),
                Radius::Log(log) => (rounded(log), rounded(log).abs() > FARTHEST),
                Radius::Broken { finite, log } => {
                    let more = finite > self.finite[lane];
                    self.finite[lane] = finite;
                    (rounded(log).min(-FARTHEST), more)
                }
            };
            reaches[lane] = pace.used(radius);
            if wanted && self.trials < TRIALS {
                again |= 1 << lane;
                shifts[lane] = unit + shift as i32;
            }
        }
        let reach = S::from_lanes(|lane| S::Lane::from_f64(reaches[lane])) * self.length;
        self.reach = S::select(lanes, reach, self.reach);
        let again = S::Mask::from_bits(again);
        again.lanes().for_each(|lane| self.set(lane, shifts[lane]));
        again
    }
}

/// The number of each lane, and 0 beyond them.
#[inline(always)]
pub(super) fn each<S: Scalar>(x: S) -> [f64; MOST_LANES] {
    core::array::from_fn(|lane| match lane < S::LANES {
        true => x.lane(lane).to_f64(),
        false => 0.0,
    })
}
