//! Where a function of a part of the way, from 0 to 1, changes its sign, as samples of it show.
//!
//! Nothing here knows the system that the function is of: it is compiled once, not for each.

use super::sign;
use super::zero::zero;

/// Samples of the way, beside the one at its beginning.
pub(super) const SAMPLES: usize = 8;
/// Where the function may dip between an end of the way and the sample next to it: the place that tells.
const NEAR: f64 = 1.0 / 64.0;
/// How often a dip is narrowed down, by the golden section.
const NARROWER: u32 = 24;
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// A function of a part of the way.
type Function<'f> = &'f mut dyn FnMut(f64) -> f64;

/// A place where the function changes its sign: the part of the way, and the sign behind it.
pub(super) struct SignChange {
    pub(super) part: f64,
    pub(super) sign: f64,
}

/// The part of the way at a sample.
pub(super) fn part(place: usize) -> f64 {
    place as f64 / SAMPLES as f64
}

/// Where the function with these samples changes its sign, in order.
pub(super) fn sign_changes(samples: &[f64; SAMPLES + 1], value: Function<'_>) -> Vec<SignChange> {
    let mut known: Vec<(f64, f64)> = Vec::with_capacity(SAMPLES + 3);
    for (place, &sample) in samples.iter().enumerate() {
        if let Some(dip) = dip(samples, place, value) {
            known.push(dip);
        }
        known.push((part(place), sample));
    }
    // a dip is on either side of its lowest sample
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut changes = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    for (part, sample) in known {
        if sample.is_nan() {
            before = None;
            continue;
        }
        let Some((last, side)) = before else {
            before = (sample != 0.0).then_some((part, sample));
            continue;
        };
        if sign(sample) == -sign(side) {
            changes.push(SignChange {
                part: between((last, side), (part, sample), value),
                sign: sign(sample),
            });
        }
        // a zero at a sample belongs to the change around it
        if sample != 0.0 {
            before = Some((part, sample));
        }
    }
    changes
}

/// A place with another sign in a dip towards zero before a sample, if there is one.
fn dip(samples: &[f64; SAMPLES + 1], place: usize, value: Function<'_>) -> Option<(f64, f64)> {
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
        (side * value(NEAR / SAMPLES as f64) < at(0)).then_some((0.0, part(1)))?
    } else if place == SAMPLES && same(place - 1..=place) && at(place) <= at(place - 1) {
        let near = 1.0 - NEAR / SAMPLES as f64;
        (side * value(near) < at(place)).then_some((part(place - 1), 1.0))?
    } else {
        return None;
    };
    lowest(side, (low, high), value)
}

/// Follows a dip by the golden section until the sign changes.
fn lowest(side: f64, (mut low, mut high): (f64, f64), value: Function<'_>) -> Option<(f64, f64)> {
    let mut of = |part: f64| side * value(part);
    let places = |low: f64, high: f64| [low + GOLDEN * (high - low), high - GOLDEN * (high - low)];
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

/// The zero between two places with different signs, as far as that is worth it.
fn between(from: (f64, f64), to: (f64, f64), value: Function<'_>) -> f64 {
    zero(from, to, 1e-9, &mut |part| Some(value(part))).map_or(from.0, |found| found.0)
}
