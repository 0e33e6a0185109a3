//! The coordinates that carry the time, of a system whose Hamiltonian depends on it.
//!
//! `H(t, mu)` moves mu as `K = H + p` does on a larger phase space, with the canonical pair (t, p) and a unit beside mu:
//! every method for systems without the time applies. But the time is no unknown. A driver sets it at each step to what it
//! is, `t0 + k h`, since a sum of steps leaves the times of the grid by more with each of them; and its size says
//! nothing of the motion, so that it counts in no norm and no test of convergence. Nor do p, on which no motion depends, and
//! the unit.

use crate::scalar::Scalar;
use crate::state::Unknown;

/// Where the time and its momentum are among the coordinates; the unit follows the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Clock {
    /// The momentum of the time, behind the momenta of the system.
    pub momentum: usize,
    /// The time.
    pub time: usize,
}

impl Clock {
    /// Whether a coordinate is one of the three.
    #[inline(always)]
    pub fn holds(self, index: usize) -> bool {
        index == self.momentum || index == self.time || index == self.time + 1
    }

    /// The largest magnitude of the other coordinates.
    #[inline]
    fn norm<S: Scalar>(self, entries: &[S]) -> S {
        let (first, rest) = entries.split_at(self.momentum.min(entries.len()));
        let count = rest.len().min(self.time - self.momentum);
        let rest = rest.get(1..count).unwrap_or_default();
        S::largest_magnitude(&[S::largest_magnitude(first), S::largest_magnitude(rest)])
    }
}

/// Whether a coordinate carries the time.
#[inline(always)]
pub fn holds(clock: Option<Clock>, index: usize) -> bool {
    clock.is_some_and(|clock| clock.holds(index))
}

/// The largest magnitude of the entries of states that do not carry the time.
#[inline(always)]
pub fn norm<S: Scalar, U: Unknown<S>>(clock: Option<Clock>, unknown: &U) -> S {
    let Some(clock) = clock else {
        return unknown.max_norm();
    };
    (0..unknown.parts()).fold(S::zero(), |norm, part| {
        S::largest_magnitude(&[norm, clock.norm(unknown.part(part))])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_has_no_size() {
        let clock = Clock {
            momentum: 2,
            time: 4,
        };
        let state = [0.5, -2.0, 1e9, 0.25, 1e5, 1.0];
        assert_eq!(norm(Some(clock), &state), 2.0);
        assert_eq!(norm(None, &state), 1e9, "the control");
        // momenta alone
        assert_eq!(norm(Some(clock), &[0.5, -2.0, 1e9]), 2.0);
        assert!(norm(Some(clock), &[0.0, 0.0, 0.0, f64::NAN, 0.0, 1.0]).is_nan());
    }
}
