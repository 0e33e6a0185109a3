//! Where the time alone changes the field most: a pulse that steps chosen at the start would pass without seeing it.

use super::problem::set_time;
use crate::clock::holds;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State as _;

/// Entries of the field that are looked at in all, and the bounds of the number of times.
const ENTRIES: usize = 1 << 17;
const TIMES: (usize, usize) = (1 << 8, 1 << 14);

/// A field that comes from its smallest to its largest value in fewer looks than this is a pulse.
const SHARP: f64 = 32.0;

/// A time from which on the field is looked at again.
pub(super) struct Pulse {
    /// After the start.
    pub(super) after: f64,
    /// The time between two looks.
    pub(super) spacing: f64,
    /// The part of all looks in which the field changes as much.
    pub(super) part: f64,
    /// Whether it is gone so soon that a series beside it does not know it.
    sharp: bool,
}

impl Pulse {
    /// An input that jumps: steps end there.
    pub(super) fn push(after: f64) -> Self {
        Self {
            after,
            spacing: f64::INFINITY,
            part: 1.0,
            sharp: false,
        }
    }

    /// A step that cannot pass it.
    pub(super) fn step(&self) -> Option<f64> {
        self.sharp.then_some(0.25 * SHARP * self.spacing)
    }
}

/// The time at which the field at the initial state begins to change most from one of many times to the next; none of a
/// system without the time, or whose field does not change.
pub(super) fn pulse<S: Scalar, P: Poisson<S>>(
    system: &P,
    mut mu: P::State,
    (start, end): (f64, f64),
) -> Option<Pulse> {
    let clock = system.clock()?;
    let times = (ENTRIES / mu.as_slice().len()).clamp(TIMES.0, TIMES.1);
    let spacing = (end - start) / times as f64;
    let distance = |a: &P::State, b: &P::State| {
        let pairs = a.as_slice().iter().zip(b.as_slice()).enumerate();
        let counted = pairs.filter(|(i, _)| !holds(Some(clock), *i));
        counted.fold(0.0, |sum, (_, (&a, &b))| sum + largest((a - b).magnitude()))
    };
    let [mut first, mut before, mut field] = core::array::from_fn(|_| system.zero_state());
    system.vector_field(&mu, &mut first);
    before.copy_from(&first);
    let (mut most, mut sum, mut range, mut at) = (0.0, 0.0, 0.0_f64, 0);
    for k in 1..=times {
        set_time(system, &mut mu, start + k as f64 * spacing);
        system.vector_field(&mu, &mut field);
        let change = distance(&field, &before);
        if change > most {
            (most, at) = (change, k);
        }
        sum += change;
        range = range.max(distance(&field, &first));
        core::mem::swap(&mut field, &mut before);
    }
    (most > 0.0 && sum.is_finite()).then(|| Pulse {
        // one that lies between three times begins before the first
        after: at.saturating_sub(2) as f64 * spacing.abs(),
        spacing: spacing.abs(),
        part: (sum / most / times as f64).min(1.0),
        sharp: SHARP * most > range,
    })
}
