//! Where the time alone changes the field most: a pulse that steps chosen at the start would pass without seeing it.

use super::problem::{Problem, set_time};
use crate::clock::holds;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State as _;

/// Entries of the field that are looked at in all, and the bounds of the number of times.
const ENTRIES: usize = 1 << 17;
const TIMES: (usize, usize) = (1 << 8, 1 << 14);

/// A time from which on the field is looked at again, and the time between two looks.
pub(super) struct Pulse {
    /// After the start.
    pub(super) after: f64,
    pub(super) spacing: f64,
}

/// The time at which the field at the initial state begins to change most from one of many times to the next; none of a
/// system without the time, or whose field does not change.
pub(super) fn pulse<S: Scalar, P: Poisson<S>>(problem: &Problem<S, P>) -> Option<Pulse> {
    let system = &problem.system;
    let clock = system.clock()?;
    let (start, end) = problem.span;
    let mut mu = problem.start();
    let entries = mu.as_slice().len();
    let times = (ENTRIES / entries).clamp(TIMES.0, TIMES.1);
    let spacing = (end - start) / times as f64;
    let mut field = system.zero_state();
    let mut before = system.zero_state();
    let (mut most, mut found) = (0.0, None);
    for k in 0..=times {
        set_time(system, &mut mu, start + k as f64 * spacing);
        system.vector_field(&mu, &mut field);
        let pairs = field.as_slice().iter().zip(before.as_slice()).enumerate();
        let counted = pairs.filter(|(i, _)| !holds(Some(clock), *i));
        let change = counted.fold(0.0, |sum, (_, (&a, &b))| sum + largest((a - b).magnitude()));
        if k > 0 && change > most {
            most = change;
            // a pulse that lies between three times begins before the first
            found = Some(k.saturating_sub(2));
        }
        core::mem::swap(&mut field, &mut before);
    }
    found.map(|k| Pulse {
        after: k as f64 * spacing.abs(),
        spacing: spacing.abs(),
    })
}
