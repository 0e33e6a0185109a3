//! What an iteration over stages side by side writes.

use core::array::from_fn;
use core::ops::Range;

use super::diagonals::product_from;
use super::stage_parallel::program::{RATIOS, WEIGHTS};
use crate::poisson::Poisson;
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

/// The stages of a step before their points are there.
#[derive(Debug)]
pub struct Open<'a, S: Scalar, V> {
    stages: usize,
    ratios: &'a [S::Wide],
    weights: S::Wide,
    base: &'a V,
    increments: &'a V,
    points: &'a mut V,
}

impl<'a, S: Scalar, V: State<S::Wide>> Open<'a, S, V> {
    /// The next increments by what gives the slopes at the points of the stages.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn at_points(self, slopes: impl FnOnce(At<'_, V>, &mut V), next: &mut V) {
        let all = 0..self.points.as_slice().len();
        let Self {
            base, increments, ..
        } = self;
        let points = self.points;
        set_points::<S>(
            self.stages,
            self.ratios,
            [base, increments].map(V::as_slice),
            points.as_mut_slice(),
            all,
        );
        let at = At {
            base,
            increments,
            points,
        };
        slopes(at, next);
        for next in next.as_mut_slice() {
            *next *= self.weights;
        }
    }

    /// The next increments by the field of a system, which may take the points part by part: of many sites those of a few stay in
    /// the cache until their slopes are there.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn by_parts<P: Poisson<S::Wide, State = V>>(self, system: &P, next: &mut V) {
        let (stages, ratios, weights) = (self.stages, self.ratios, self.weights);
        let from = [self.base, self.increments].map(V::as_slice);
        let before = |points: &mut [S::Wide], entries| {
            set_points::<S>(stages, ratios, from, points, entries);
        };
        let after = |next: &mut [S::Wide], entries: Range<usize>| {
            next[entries].iter_mut().for_each(|next| *next *= weights);
        };
        system.vector_field_by_parts(self.points, next, before, after);
    }
}

/// Sets some entries of the points of so many stages, from the base and the increments.
#[cfg_attr(not(debug_assertions), inline(always))]
fn set_points<S: Scalar>(
    stages: usize,
    ratios: &[S::Wide],
    from: [&[S::Wide]; 2],
    points: &mut [S::Wide],
    entries: Range<usize>,
) {
    match stages {
        ..5 => set_points_with::<S, 4>(ratios, from, points, entries),
        _ => set_points_with::<S, 8>(ratios, from, points, entries),
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn set_points_with<S: Scalar, const PLACES: usize>(
    ratios: &[S::Wide],
    [base, increments]: [&[S::Wide]; 2],
    points: &mut [S::Wide],
    entries: Range<usize>,
) {
    let from = base[entries.clone()]
        .iter()
        .zip(&increments[entries.clone()]);
    for (point, (y, increments)) in points[entries].iter_mut().zip(from) {
        *point = product_from::<S, PLACES>(*y, ratios, *increments);
    }
}

/// What gives the next increments of the stages of a step; a function gives the slopes at their points.
pub trait Rule<S: Scalar, V> {
    /// The next increments: `h b_i` times the slopes.
    fn increments(&mut self, stages: Open<'_, S, V>, next: &mut V);
}

impl<S, V, F> Rule<S, V> for F
where
    S: Scalar,
    V: State<S::Wide>,
    F: FnMut(At<'_, V>, &mut V),
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn increments(&mut self, stages: Open<'_, S, V>, next: &mut V) {
        stages.at_points(self, next);
    }
}

impl<V> Work<V> {
    /// Moves it out, to be given back.
    #[cfg_attr(not(debug_assertions), inline(always))]
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
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn both<W: Scalar>(&mut self) -> [&mut [W]; 2]
    where
        V: State<W>,
    {
        [self.increments.as_mut_slice(), self.next.as_mut_slice()]
    }

    /// Takes over the next increments.
    #[cfg(feature = "std")]
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn exchange(&mut self) {
        core::mem::swap(&mut self.increments, &mut self.next);
    }

    /// The points of so many stages.
    pub(super) fn set_points<S: Scalar>(&mut self, stages: usize, ratios: &[S::Wide], base: &V)
    where
        V: State<S::Wide>,
    {
        let (from, points) = ([base, &self.increments], self.points.as_mut_slice());
        let all = 0..points.len();
        set_points::<S>(stages, ratios, from.map(V::as_slice), points, all);
    }

    /// The next increments: `h b_i`, the weights, times the field at the points of the stages.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn evaluate<S: Scalar>(
        &mut self,
        stages: usize,
        table: &[S::Wide],
        base: &V,
        rule: &mut impl Rule<S, V>,
    ) where
        V: State<S::Wide>,
    {
        let stages = Open {
            stages,
            ratios: &table[RATIOS],
            weights: table[WEIGHTS],
            base,
            increments: &self.increments,
            points: &mut self.points,
        };
        rule.increments(stages, &mut self.next);
    }

    /// Takes over the next increments of some entries, which then do not count as changes.
    #[cfg_attr(not(debug_assertions), inline(always))]
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
    #[cfg_attr(not(debug_assertions), inline(always))]
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

    #[cfg_attr(not(debug_assertions), inline(always))]
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
#[cfg_attr(not(debug_assertions), inline(always))]
fn chosen<S: Scalar>(ended: S::Mask, old: S::Wide, new: S::Wide) -> S::Wide {
    if S::LANES == 1 {
        return new;
    }
    let (old, new) = (S::scatter(old), S::scatter(new));
    S::gather(from_fn(|i| S::select(ended, old[i], new[i])))
}
