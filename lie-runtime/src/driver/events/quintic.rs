//! A piece of a step as a quintic, and where functions change their signs on it.

use super::zero::zero;
use super::{Knot, sign};
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// Samples of a piece of a step.
const SAMPLES: usize = 8;
/// Where the function may dip between an end of a step and the sample next to it: the place that tells.
const NEAR: f64 = 1.0 / 64.0;
/// How often a dip is narrowed down, by the golden section.
const NARROWER: u32 = 24;
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// A place where a function changes its sign on the quintics: the time, and the sign behind it.
pub(super) struct Guess {
    pub(super) time: f64,
    pub(super) sign: f64,
}

/// The quintic through two knots.
pub(super) struct Quintic<'a, S: Scalar, P: Poisson<S>> {
    system: &'a P,
    ends: [&'a Knot<P::State>; 2],
    state: P::State,
    values: Vec<S>,
}

impl<'a, S: Scalar, P: Poisson<S>> Quintic<'a, S, P> {
    pub(super) fn new(system: &'a P, ends: [&'a Knot<P::State>; 2]) -> Self {
        Self {
            system,
            ends,
            state: system.zero_state(),
            values: vec![S::zero(); system.event_count()],
        }
    }

    /// The time at a part of the way.
    fn time(&self, part: f64) -> f64 {
        let [from, to] = self.ends;
        from.time + part * (to.time - from.time)
    }

    /// The functions at a part of the way.
    fn all(&mut self, part: f64) -> &[S] {
        let [from, to] = self.ends;
        let span = to.time - from.time;
        let [square, cube] = [part * part, part * part * part];
        self.state.fill(S::zero());
        for (weight, vector) in [
            (1.0 + cube * (-10.0 + part * (15.0 - 6.0 * part)), &from.mu),
            (
                span * (part + cube * (-6.0 + part * (8.0 - 3.0 * part))),
                &from.field,
            ),
            (
                span * span * 0.5 * (square + cube * (-3.0 + part * (3.0 - part))),
                &from.bend,
            ),
            (
                span * span * 0.5 * cube * (1.0 + part * (part - 2.0)),
                &to.bend,
            ),
            (span * cube * (-4.0 + part * (7.0 - 3.0 * part)), &to.field),
            (cube * (10.0 + part * (6.0 * part - 15.0)), &to.mu),
        ] {
            self.state.axpy(S::from_f64(weight), vector);
        }
        self.system.events(&self.state, &mut self.values);
        &self.values
    }

    /// One of them.
    fn value(&mut self, index: usize, part: f64) -> f64 {
        self.all(part)[index].to_f64()
    }

    /// Where each of the functions changes its sign, in order.
    pub(super) fn guesses(&mut self, rules: usize) -> Vec<Vec<Guess>> {
        let mut samples = vec![[0.0; SAMPLES + 1]; rules];
        for place in 1..SAMPLES {
            let values = self.all(place as f64 / SAMPLES as f64);
            for (samples, value) in samples.iter_mut().zip(values) {
                samples[place] = value.to_f64();
            }
        }
        for (index, samples) in samples.iter_mut().enumerate() {
            let [from, to] = self.ends.map(|knot| knot.values[index]);
            (samples[0], samples[SAMPLES]) = (from, to);
        }
        let of = |(index, samples): (usize, &[f64; SAMPLES + 1])| self.of_one(index, samples);
        samples.iter().enumerate().map(of).collect()
    }

    fn of_one(&mut self, index: usize, samples: &[f64; SAMPLES + 1]) -> Vec<Guess> {
        let part = |place: usize| place as f64 / SAMPLES as f64;
        let mut known: Vec<(f64, f64)> = Vec::with_capacity(SAMPLES + 3);
        for (place, &value) in samples.iter().enumerate() {
            if let Some(dip) = self.dip(index, samples, place) {
                known.push(dip);
            }
            known.push((part(place), value));
        }
        // a dip is on either side of its lowest sample
        known.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut guesses = Vec::new();
        let mut before: Option<(f64, f64)> = None;
        for (part, value) in known {
            if value.is_nan() {
                before = None;
                continue;
            }
            let Some((last, side)) = before else {
                before = (value != 0.0).then_some((part, value));
                continue;
            };
            if sign(value) == -sign(side) {
                let found = self.between(index, (last, side), (part, value));
                guesses.push(Guess {
                    time: self.time(found),
                    sign: sign(value),
                });
            }
            // a zero at a sample belongs to the change around it
            if value != 0.0 {
                before = Some((part, value));
            }
        }
        guesses
    }

    /// A place with another sign in a dip towards zero before a sample, if there is one.
    fn dip(
        &mut self,
        index: usize,
        samples: &[f64; SAMPLES + 1],
        place: usize,
    ) -> Option<(f64, f64)> {
        let part = |place: usize| place as f64 / SAMPLES as f64;
        let side = sign(samples[place]);
        let at = |place: usize| side * samples[place];
        // three samples, the middle one of which is the lowest, the last of them before the end of the step
        let within = place >= 2 && at(place - 1) < at(place) && at(place - 1) <= at(place - 2);
        let same = |places: std::ops::RangeInclusive<usize>| {
            side != 0.0 && places.into_iter().all(|place| sign(samples[place]) == side)
        };
        let (low, high) = if within && same(place - 2..=place) {
            (part(place - 2), part(place))
        } else if place == 1 && same(0..=1) && at(0) <= at(1) {
            (side * self.value(index, NEAR / SAMPLES as f64) < at(0)).then_some((0.0, part(1)))?
        } else if place == SAMPLES && same(place - 1..=place) && at(place) <= at(place - 1) {
            let near = 1.0 - NEAR / SAMPLES as f64;
            (side * self.value(index, near) < at(place)).then_some((part(place - 1), 1.0))?
        } else {
            return None;
        };
        self.lowest(index, side, (low, high))
    }

    /// Follows a dip by the golden section until the sign changes.
    fn lowest(
        &mut self,
        index: usize,
        side: f64,
        (mut low, mut high): (f64, f64),
    ) -> Option<(f64, f64)> {
        let mut of = |part: f64| side * self.value(index, part);
        let places =
            |low: f64, high: f64| [low + GOLDEN * (high - low), high - GOLDEN * (high - low)];
        let mut inner = places(low, high);
        let mut values = inner.map(&mut of);
        for _ in 0..NARROWER {
            for (part, value) in inner.into_iter().zip(values) {
                if value < 0.0 {
                    return Some((part, side * value));
                }
            }
            if values[0] < values[1] {
                high = inner[1];
                inner = [places(low, high)[0], inner[0]];
                values = [of(inner[0]), values[0]];
            } else {
                low = inner[0];
                inner = [inner[1], places(low, high)[1]];
                values = [values[1], of(inner[1])];
            }
        }
        None
    }

    /// The zero on the quintic between two places with different signs, as far as that is worth it.
    fn between(&mut self, index: usize, from: (f64, f64), to: (f64, f64)) -> f64 {
        let of = |part: f64| Some(self.value(index, part));
        zero(from, to, 1e-9, of).map_or(from.0, |found| found.0)
    }
}
