//! An iteration over stages side by side as programs, which a system may have in place of its kernels.

use core::ops::Range;

use crate::clock::Clock;
use crate::generic::diagonals::{product, total};
use crate::generic::stage_work::{At, Work};
use crate::scalar::Scalar;
use crate::state::State;

/// The numbers that an iteration has of the method and of the length of the step, by their places in a table.
pub(in crate::generic) const RATIOS: Range<usize> = 0..8;
pub(in crate::generic) const AHEAD: Range<usize> = 8..16;
pub(in crate::generic) const WEIGHTS: usize = 16;
pub(in crate::generic) const PER_WEIGHT: usize = 17;
pub(in crate::generic) const PER_UNIT: usize = 18;
/// How many these are.
pub const TABLE: usize = 19;

/// Where the slopes at the stages come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StageSlopes {
    /// The vector field.
    Field,
    /// The flow over the Hopf map.
    Hopf,
    /// The flow over quaternions.
    Quaternion,
    /// The flow over columns of the declared representation.
    Representation,
    /// The flow over factors of a Hermitian matrix.
    Unitary,
}

/// The iteration of [`StageParallel`](super::StageParallel) for one system: every program does the operations of [`StageStep`] in their
/// order, so that the bits are those of kernel by kernel.
#[cfg(feature = "std")]
pub trait StageProgram<W>: core::fmt::Debug {
    /// Iterates so many times, in turn from each of two vectors of increments to the other, from the first to the second one first.
    ///
    /// `table` has [`TABLE`] numbers of the method and of the length of the step, `base` is the point at which the step begins, the
    /// same in all places.
    fn iterate(&mut self, count: u32, table: &[W], base: &[W], increments: [&mut [W]; 2]);
    /// Iterates once, from the first vector to the second; the sum of the changes at each stage.
    fn look(&mut self, table: &[W], base: &[W], increments: [&mut [W]; 2]) -> W;
    /// Continues the polynomial of a step, whose increments are the first vector: writes those from which the next one starts.
    fn go_on(&mut self, table: &[W], increments: [&mut [W]; 2]);
    /// Takes what is constant on the space of a lift.
    fn set_labels(&mut self, labels: &[W]);
}

/// What the programs of an iteration do, once, over any scalar: written down, it is the programs.
#[derive(Clone, Copy, Debug)]
pub struct StageStep {
    /// The number of stages.
    pub stages: usize,
    /// The entries that carry the time.
    pub clock: Option<Clock>,
}

impl StageStep {
    /// The next increments from these, and the sum of the changes, at each stage; `momenta` are the entries with a unit of their own.
    pub fn look<S: Scalar, V: State<S::Wide>>(
        &self,
        (base, increments): (&V, V),
        table: &[S::Wide],
        momenta: Option<Range<usize>>,
        mut field: impl FnMut(At<'_, V>, &mut V),
    ) -> (V, S::Wide) {
        let mut work = Work {
            points: increments.clone(),
            next: increments.clone(),
            increments,
        };
        let momenta = momenta.map(|entries| (entries, table[PER_UNIT]));
        let none = <S::Mask as crate::scalar::Mask>::splat(false);
        work.evaluate::<S>(self.stages, table, base, &mut field);
        if let Some(clock) = self.clock {
            work.replace_entries::<S>(&[clock.momentum, clock.time], none);
        }
        let change = work.replace::<S>(none, momenta) * table[PER_WEIGHT];
        (work.increments, change)
    }

    /// The increments from which the next step starts.
    pub fn go_on<S: Scalar, V: State<S::Wide>>(&self, mut increments: V, table: &[S::Wide]) -> V {
        go_on::<S>(self.stages, increments.as_mut_slice(), table);
        increments
    }
}

/// Continues the polynomial of a step with so many stages.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn go_on<S: Scalar>(stages: usize, increments: &mut [S::Wide], table: &[S::Wide]) {
    match stages {
        ..5 => go_on_with::<S, 4>(increments, &table[AHEAD]),
        _ => go_on_with::<S, 8>(increments, &table[AHEAD]),
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn go_on_with<S: Scalar, const PLACES: usize>(increments: &mut [S::Wide], ahead: &[S::Wide]) {
    for entry in increments {
        *entry = product::<S, PLACES>(ahead, *entry);
    }
}

/// Moves a base by the increments of its step.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn advance<S: Scalar>(base: &mut [S::Wide], increments: &[S::Wide]) {
    for (y, increments) in base.iter_mut().zip(increments) {
        *y += total::<S>(*increments);
    }
}
