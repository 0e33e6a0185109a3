//! Where an iteration starts.

use core::array::from_fn;

use super::program::WEIGHTS;
use super::{At, StageParallel};
use crate::scalar::Scalar;
use crate::state::State;

/// A start that is no better than the field at the state is improved by so many half iterations.
const APPROACH: u32 = 12;

impl<S: Scalar, V: State<S::Wide>> StageParallel<S, V> {
    /// Starts from a base, with a slope that is the same at all stages, in the lanes of a mask.
    pub fn start(&mut self, mask: S::Mask, base: &[S], slope: &[S]) {
        self.set_base(mask, base);
        let weights = S::scatter(self.table[WEIGHTS]);
        let increments = self.work.increments.as_mut_slice().iter_mut();
        for (increments, &slope) in increments.zip(slope) {
            let old = S::scatter(*increments);
            let entry = |i: usize| S::select(mask, weights[i] * slope, old[i]);
            *increments = S::gather(from_fn(entry));
        }
        self.known_size = None;
        self.forget(mask);
    }

    /// Sets the base of the next step in the lanes of a mask.
    pub fn set_base(&mut self, mask: S::Mask, base: &[S]) {
        for (wide, &entry) in self.base.as_mut_slice().iter_mut().zip(base) {
            let [old, ..] = S::scatter(*wide);
            *wide = S::select(mask, entry, old).widen();
        }
    }

    /// Takes half of the way that the iteration would go, several times, in the lanes of a mask: where it contracts at all, that
    /// leads from a bad start to a good one.
    pub fn approach(&mut self, mask: S::Mask, mut field: impl FnMut(At<'_, V>, &mut V)) {
        let half = S::ratio(1.0, 2.0);
        for _ in 0..APPROACH {
            self.work
                .evaluate::<S>(self.stages, &self.table, &self.base, &mut field);
            let increments = self.work.increments.as_mut_slice().iter_mut();
            for (increment, &next) in increments.zip(self.work.next.as_slice()) {
                let (old, new) = (S::scatter(*increment), S::scatter(next));
                let middle = |i: usize| half * (old[i] + new[i]);
                *increment = S::gather(from_fn(|i| S::select(mask, middle(i), old[i])));
            }
        }
    }

    /// Replaces the increments by given ones, in the lanes of a mask.
    pub fn set_increments_where(&mut self, mask: S::Mask, increment: impl Fn(usize, usize) -> S) {
        for (k, increments) in self.work.increments.as_mut_slice().iter_mut().enumerate() {
            let mut entries = S::scatter(*increments);
            for (i, entry) in entries.iter_mut().enumerate().take(self.stages) {
                *entry = S::select(mask, increment(i, k), *entry);
            }
            *increments = S::gather(entries);
        }
    }
}
