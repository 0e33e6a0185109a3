//! What an iteration over stages side by side writes.

use core::array::from_fn;

use super::diagonals::product_from;
use crate::scalar::Scalar;
use crate::state::State;

/// What an iteration writes.
#[derive(Clone, Debug)]
pub(super) struct Work<V> {
    pub(super) slopes: V,
    pub(super) points: V,
    pub(super) next: V,
}

/// The stages of a step: its base, which is the same in all places, the slopes, and the points of the stages.
#[derive(Debug)]
pub struct At<'a, V> {
    /// y
    pub base: &'a V,
    /// `F_i`
    pub slopes: &'a V,
    /// `Y_i = y + h sum_j a_ij F_j`
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
            slopes: self.slopes.take(),
            points: self.points.take(),
            next: self.next.take(),
        }
    }

    /// The points `y + h A F`.
    #[inline(always)]
    pub(super) fn set_points<S: Scalar, const STAGES: usize>(
        &mut self,
        tableau: &[S::Wide; 8],
        base: &V,
    ) where
        V: State<S::Wide>,
    {
        let entries = self.points.as_mut_slice().iter_mut().zip(base.as_slice());
        for ((point, y), slopes) in entries.zip(self.slopes.as_slice()) {
            *point = product_from::<S, STAGES>(*y, tableau, *slopes);
        }
    }

    /// Evaluates the field at the points of the stages.
    #[inline(always)]
    pub(super) fn evaluate<S: Scalar, const STAGES: usize>(
        &mut self,
        tableau: &[S::Wide; 8],
        base: &V,
        field: &mut impl FnMut(At<'_, V>, &mut V),
    ) where
        V: State<S::Wide>,
    {
        self.set_points::<S, STAGES>(tableau, base);
        let at = At {
            base,
            slopes: &self.slopes,
            points: &self.points,
        };
        field(at, &mut self.next);
    }

    /// Takes over the next slopes but in the lanes that have ended; the sum of all changes at each stage.
    #[inline(always)]
    pub(super) fn replace<S: Scalar>(&mut self, ended: S::Mask) -> S::Wide
    where
        V: State<S::Wide>,
    {
        let mut change = S::Wide::zero();
        let slopes = self.slopes.as_mut_slice().iter_mut();
        for (slope, &next) in slopes.zip(self.next.as_slice()) {
            change += (next - *slope).magnitude();
            *slope = if S::LANES == 1 {
                next
            } else {
                let (old, new) = (S::scatter(*slope), S::scatter(next));
                S::gather(from_fn(|i| S::select(ended, old[i], new[i])))
            };
        }
        change
    }
}
