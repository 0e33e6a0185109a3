//! What an iteration over stages side by side writes.

use core::array::from_fn;
use core::ops::Range;

use super::diagonals::product_from;
use super::stage_parallel::program::{RATIOS, WEIGHTS};
use crate::scalar::Scalar;
use crate::state::State;

/// What an iteration writes.
#[derive(Clone, Debug)]
pub(super) struct Work<V> {
    /// `h b_i` times the field, at the stages.
    pub(super) increments: V,
    pub(super) points: V,
    pub(super) next: V,
}

/// The stages of a step: its base, which is the same in all places, the increments, and the points of the stages.
#[derive(Debug)]
pub struct At<'a, V> {
    /// y
    pub base: &'a V,
    /// `D_i`
    pub increments: &'a V,
    /// `Y_i = y + sum_j (a_ij/b_j) D_j`
    pub points: &'a V,
}

impl<V> Work<V> {
    /// Moves it out, to be given back.
    #[inline(always)]
    pub(super) fn take<S: Scalar>(&mut self) -> Self
    where
        V: State<S::Wide>,
    {
        Self {
            increments: self.increments.take(),
            points: self.points.take(),
            next: self.next.take(),
        }
    }

    /// The increments, and what is written over.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub(super) fn both<W: Scalar>(&mut self) -> [&mut [W]; 2]
    where
        V: State<W>,
    {
        [self.increments.as_mut_slice(), self.next.as_mut_slice()]
    }

    /// Takes over the next increments.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub(super) fn exchange(&mut self) {
        core::mem::swap(&mut self.increments, &mut self.next);
    }

    /// The points of so many stages.
    #[inline(always)]
    pub(super) fn set_points<S: Scalar>(&mut self, stages: usize, ratios: &[S::Wide], base: &V)
    where
        V: State<S::Wide>,
    {
        match stages {
            ..5 => self.set_points_with::<S, 4>(ratios, base),
            _ => self.set_points_with::<S, 8>(ratios, base),
        }
    }

    #[inline(always)]
    fn set_points_with<S: Scalar, const PLACES: usize>(&mut self, ratios: &[S::Wide], base: &V)
    where
        V: State<S::Wide>,
    {
        let entries = self.points.as_mut_slice().iter_mut().zip(base.as_slice());
        for ((point, y), increments) in entries.zip(self.increments.as_slice()) {
            *point = product_from::<S, PLACES>(*y, ratios, *increments);
        }
    }

    /// The next increments: `h b_i`, the weights, times the field at the points of the stages.
    #[inline(always)]
    pub(super) fn evaluate<S: Scalar>(
        &mut self,
        stages: usize,
        table: &[S::Wide],
        base: &V,
        field: &mut impl FnMut(At<'_, V>, &mut V),
    ) where
        V: State<S::Wide>,
    {
        self.set_points::<S>(stages, &table[RATIOS], base);
        let weights = table[WEIGHTS];
        let at = At {
            base,
            increments: &self.increments,
            points: &self.points,
        };
        field(at, &mut self.next);
        for next in self.next.as_mut_slice() {
            *next *= weights;
        }
    }

    /// Takes over the next increments of some entries, which then do not count as changes.
    #[inline(always)]
    pub(super) fn replace_entries<S: Scalar>(&mut self, entries: &[usize], ended: S::Mask)
    where
        V: State<S::Wide>,
    {
        for &entry in entries {
            let increment = &mut self.increments.as_mut_slice()[entry];
            let next = &mut self.next.as_mut_slice()[entry];
            *increment = chosen::<S>(ended, *increment, *next);
            *next = *increment;
        }
    }

    /// Takes over the next increments but in the lanes that have ended; the sum of all changes at each stage. Entries that have
    /// a unit of their own come with one over it.
    #[inline(always)]
    pub(super) fn replace<S: Scalar>(
        &mut self,
        ended: S::Mask,
        momenta: Option<(Range<usize>, S::Wide)>,
    ) -> S::Wide
    where
        V: State<S::Wide>,
    {
        let Some((entries, per_unit)) = momenta else {
            return self.replace_each::<S>(ended, |_, change| change);
        };
        self.replace_each::<S>(ended, |k, change| match entries.contains(&k) {
            true => change * per_unit,
            false => change,
        })
    }

    #[inline(always)]
    fn replace_each<S: Scalar>(
        &mut self,
        ended: S::Mask,
        counted: impl Fn(usize, S::Wide) -> S::Wide,
    ) -> S::Wide
    where
        V: State<S::Wide>,
    {
        let mut change = S::Wide::zero();
        let increments = self.increments.as_mut_slice().iter_mut();
        for (k, (increment, &next)) in increments.zip(self.next.as_slice()).enumerate() {
            change += counted(k, (next - *increment).magnitude());
            *increment = chosen::<S>(ended, *increment, next);
        }
        change
    }
}

/// The old numbers in the lanes that have ended, the new ones in the others; of a single lane, which has not, the new ones.
#[inline(always)]
fn chosen<S: Scalar>(ended: S::Mask, old: S::Wide, new: S::Wide) -> S::Wide {
    if S::LANES == 1 {
        return new;
    }
    let (old, new) = (S::scatter(old), S::scatter(new));
    S::gather(from_fn(|i| S::select(ended, old[i], new[i])))
}
