//! States of a system and unknowns of an implicit step, as slices of scalars.

use crate::scalar::{Mask, Scalar};
#[cfg(any(feature = "nalgebra", test))]
use nalgebra::SVector;

/// A vector of scalars in one or several parts: what Newton's iteration solves for.
pub trait Unknown<S: Scalar>: Clone {
    /// The number of parts (one for a state, one per stage for stages).
    fn parts(&self) -> usize;
    /// One part.
    fn part(&self, index: usize) -> &[S];
    /// One part, to be written.
    fn part_mut(&mut self, index: usize) -> &mut [S];

    /// The number of entries; all parts have the same length.
    fn len(&self) -> usize {
        if self.is_empty() {
            0
        } else {
            self.parts() * self.part(0).len()
        }
    }
    /// No entries.
    fn is_empty(&self) -> bool {
        self.parts() == 0 || self.part(0).is_empty()
    }
    /// The entry at a flat index, part after part.
    #[inline]
    fn entry(&self, index: usize) -> S {
        if self.parts() == 1 {
            return self.part(0)[index];
        }
        let width = self.part(0).len();
        self.part(index / width)[index % width]
    }
    /// Sets the entry at a flat index, part after part.
    #[inline]
    fn set_entry(&mut self, index: usize, value: S) {
        if self.parts() == 1 {
            self.part_mut(0)[index] = value;
            return;
        }
        let width = self.part(0).len();
        self.part_mut(index / width)[index % width] = value;
    }
    /// The largest [`Scalar::magnitude`] of all entries; not a number if an entry is not.
    #[inline]
    fn max_norm(&self) -> S {
        let mut norm = S::zero();
        for part in 0..self.parts() {
            let largest = S::largest_magnitude(self.part(part));
            norm = if part == 0 {
                largest
            } else {
                S::largest_magnitude(&[norm, largest])
            };
        }
        norm
    }
    /// The lanes in which every entry is finite.
    #[inline]
    fn finite(&self) -> S::Mask {
        // 0 times what is not finite is not a number
        let mut sum = S::zero();
        for part in 0..self.parts() {
            let part = self.part(part);
            // of many entries, sums that do not wait for each other
            let many = if part.len() < 64 {
                0
            } else {
                part.len() / 8 * 8
            };
            let (blocks, rest) = (part[..many].as_chunks::<8>().0, &part[many..]);
            let mut sums = [S::zero(); 8];
            for block in blocks {
                for (sum, &entry) in sums.iter_mut().zip(block) {
                    *sum += entry * S::zero();
                }
            }
            if many > 0 {
                sum = sums.into_iter().fold(sum, |sum, part| sum + part);
            }
            for &entry in rest {
                sum += entry * S::zero();
            }
        }
        sum.finite()
    }
    /// Takes the entries of `other` in the lanes of the mask and keeps its own in the rest.
    #[inline]
    fn assign_where(&mut self, mask: S::Mask, other: &Self) {
        let all = mask.surely_all();
        for part in 0..self.parts() {
            if all {
                self.part_mut(part).copy_from_slice(other.part(part));
                continue;
            }
            for (mine, &theirs) in self.part_mut(part).iter_mut().zip(other.part(part)) {
                *mine = S::select(mask, theirs, *mine);
            }
        }
    }
    /// Subtracts `other` in the lanes of the mask.
    #[inline]
    fn subtract_where(&mut self, mask: S::Mask, other: &Self) {
        let all = mask.surely_all();
        for part in 0..self.parts() {
            for (mine, &theirs) in self.part_mut(part).iter_mut().zip(other.part(part)) {
                let difference = *mine - theirs;
                *mine = if all {
                    difference
                } else {
                    S::select(mask, difference, *mine)
                };
            }
        }
    }
}

/// So many copies of a value: compiled for each type of it, where `from_fn` with a closure is compiled for each function it stands in.
pub(crate) fn copies<T: Clone, const COUNT: usize>(value: &T) -> [T; COUNT] {
    core::array::from_fn(|_| value.clone())
}

/// A point of g*, or an element of g in the dual basis: one contiguous vector.
///
/// Implemented for `nalgebra::SVector`, for arrays, and with the feature `std` for `Vec`.
pub trait State<S: Scalar>: Unknown<S> {
    /// The coordinates in order.
    fn as_slice(&self) -> &[S];
    /// The coordinates in order, to be written.
    fn as_mut_slice(&mut self) -> &mut [S];
    /// Copies the coordinates of another state without allocating.
    #[inline]
    fn copy_from(&mut self, other: &Self) {
        self.as_mut_slice().copy_from_slice(other.as_slice());
    }
    /// Takes over the coordinates of another state, which is left with any: without a copy where they are on the heap.
    #[inline(always)]
    fn take_over(&mut self, other: &mut Self) {
        self.copy_from(other);
    }
    /// Moves the coordinates out, to be given back, without allocating; which ones are left is not specified.
    fn take(&mut self) -> Self;
    /// Sets every coordinate.
    #[inline]
    fn fill(&mut self, value: S) {
        self.as_mut_slice().fill(value);
    }
    /// `self += factor * other`.
    #[inline]
    fn axpy(&mut self, factor: S, other: &Self) {
        for (mine, &theirs) in self.as_mut_slice().iter_mut().zip(other.as_slice()) {
            *mine += factor * theirs;
        }
    }
}

/// The sum of the products of entries.
pub(crate) fn dot<S: Scalar, V: State<S>>(first: &V, second: &V) -> S {
    let pairs = first.as_slice().iter().zip(second.as_slice());
    pairs.fold(S::zero(), |sum, (&one, &other)| sum + one * other)
}

macro_rules! one_part {
    ($type:ty, [$($generics:tt)*], $slice:expr, $slice_mut:expr, $take:expr, $take_over:expr) => {
        impl<S: Scalar, $($generics)*> Unknown<S> for $type {
            #[inline(always)]
            fn parts(&self) -> usize {
                1
            }
            #[inline(always)]
            fn part(&self, _index: usize) -> &[S] {
                $slice(self)
            }
            #[inline(always)]
            fn part_mut(&mut self, _index: usize) -> &mut [S] {
                $slice_mut(self)
            }
        }

        impl<S: Scalar, $($generics)*> State<S> for $type {
            #[inline(always)]
            fn as_slice(&self) -> &[S] {
                $slice(self)
            }
            #[inline(always)]
            fn as_mut_slice(&mut self) -> &mut [S] {
                $slice_mut(self)
            }
            #[inline(always)]
            fn take_over(&mut self, other: &mut Self) {
                $take_over(self, other)
            }
            #[inline(always)]
            fn take(&mut self) -> Self {
                $take(self)
            }
        }
    };
}

/// As `SVector::as_slice`, without its calls in crates that are not optimised.
#[cfg(any(feature = "nalgebra", test))]
#[inline(always)]
fn column<S, const N: usize>(state: &SVector<S, N>) -> &[S] {
    &state.data.0[0]
}

#[cfg(any(feature = "nalgebra", test))]
#[inline(always)]
fn column_mut<S, const N: usize>(state: &mut SVector<S, N>) -> &mut [S] {
    &mut state.data.0[0]
}

#[cfg(any(feature = "nalgebra", test))]
one_part!(SVector<S, N>, [const N: usize], column, column_mut, |state: &mut Self| *state, |to: &mut Self, from: &mut Self| *to = *from);
one_part!([S; N], [const N: usize], <[S; N]>::as_slice, <[S; N]>::as_mut_slice, |state: &mut Self| *state, |to: &mut Self, from: &mut Self| *to = *from);
#[cfg(feature = "std")]
one_part!(
    std::vec::Vec<S>,
    [],
    std::vec::Vec::as_slice,
    std::vec::Vec::as_mut_slice,
    core::mem::take,
    core::mem::swap
);

/// The unknowns of a method with several stages: the parts of each, one after the other; a stage is one part, or stages itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Stages<V, const STAGES: usize>(pub [V; STAGES]);

impl<S: Scalar, V: Unknown<S>, const STAGES: usize> Unknown<S> for Stages<V, STAGES> {
    #[inline(always)]
    fn parts(&self) -> usize {
        STAGES * self.0[0].parts()
    }
    #[inline(always)]
    fn part(&self, index: usize) -> &[S] {
        let parts = self.0[0].parts();
        self.0[index / parts].part(index % parts)
    }
    #[inline(always)]
    fn part_mut(&mut self, index: usize) -> &mut [S] {
        let parts = self.0[0].parts();
        self.0[index / parts].part_mut(index % parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_indexed_part_after_part() {
        let mut stages = Stages([SVector::from([1.0, 2.0]), SVector::from([3.0, -4.0])]);
        assert_eq!(Unknown::<f64>::len(&stages), 4);
        assert_eq!(Unknown::<f64>::entry(&stages, 2), 3.0);
        stages.set_entry(1, 7.0);
        assert_eq!(stages.0[0][1], 7.0);
        assert_eq!(Unknown::<f64>::max_norm(&stages), 7.0);
        stages.set_entry(3, f64::NAN);
        assert!(Unknown::<f64>::max_norm(&stages).is_nan());
        assert!(!Unknown::<f64>::finite(&stages));
    }

    #[test]
    fn stages_of_stages_are_indexed_part_after_part() {
        let mut stages = Stages([Stages([[1.0], [2.0]]), Stages([[3.0], [-4.0]])]);
        assert_eq!(Unknown::<f64>::parts(&stages), 4);
        assert_eq!(Unknown::<f64>::entry(&stages, 2), 3.0);
        stages.set_entry(1, 7.0);
        assert_eq!(stages.0[0].0[1], [7.0]);
        assert_eq!(Unknown::<f64>::max_norm(&stages), 7.0);
    }

    #[test]
    fn axpy_and_copy() {
        let mut state = [1.0, 2.0];
        state.axpy(2.0, &[10.0, 20.0]);
        assert_eq!(state, [21.0, 42.0]);
        State::copy_from(&mut state, &[0.5, 0.25]);
        assert_eq!(state, [0.5, 0.25]);
    }
}
