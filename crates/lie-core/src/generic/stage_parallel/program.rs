//! An iteration over stages side by side as programs, which a system may have in place of its kernels.

use core::ops::Range;

use crate::clock::{Clock, holds};
use crate::generic::diagonals::{product, total};
use crate::generic::stage_ending::most_everywhere;
use crate::generic::stage_work::{At, Work};
use crate::scalar::Scalar;
use crate::state::State;

/// The numbers that an iteration has of the method and of the length of the step, by their places in a table.
pub(in crate::generic) const RATIOS: Range<usize> = 0..8;
pub(in crate::generic) const AHEAD: Range<usize> = 8..16;
pub(in crate::generic) const WEIGHTS: usize = 16;
pub(in crate::generic) const PER_WEIGHT: usize = 17;
pub(in crate::generic) const PER_UNIT: usize = 18;
pub(in crate::generic) const PER_STEP: usize = 19;
/// How many these are.
pub const TABLE: usize = 20;

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
    /// Iterates once, from the first vector to the second; the sum of the changes at the stage where it is largest, in all places.
    fn look(&mut self, table: &[W], base: &[W], increments: [&mut [W]; 2]) -> W;
    /// The end of a step with the increments that the last look gave.
    fn end(&self) -> &[W];
    /// Continues the polynomial of a step, whose increments are the first vector: writes those from which the next one starts. The size
    /// of its slopes, in all places.
    fn go_on(&mut self, table: &[W], base: &[W], increments: [&mut [W]; 2]) -> W;
    /// Takes what is constant on the space of a lift.
    fn set_labels(&mut self, labels: &[W]);
}

/// What the programs of an iteration do, once, over any scalar: written down, it is the programs.
#[derive(Clone, Debug)]
pub struct StageStep {
    /// The number of stages.
    pub stages: usize,
    /// The entries that carry the time.
    pub clock: Option<Clock>,
    /// The entries with a unit of their own.
    pub momenta: Option<Range<usize>>,
}

/// What a look at an iteration gives.
#[derive(Clone, Debug)]
pub struct Look<V, W> {
    /// The next increments.
    pub increments: V,
    /// The sum of the changes at the stage where it is largest, in all places.
    pub change: W,
    /// The end of a step with these increments.
    pub end: V,
}

impl StageStep {
    /// The next increments from these, with what a look tells.
    pub fn look<S: Scalar, V: State<S::Wide>>(
        &self,
        (base, increments): (&V, V),
        table: &[S::Wide],
        mut field: impl FnMut(At<'_, V>, &mut V),
    ) -> Look<V, S::Wide> {
        let mut work = Work {
            points: increments.clone(),
            next: increments.clone(),
            increments,
        };
        let momenta = self.momenta.clone();
        let momenta = momenta.map(|entries| (entries, table[PER_UNIT]));
        let none = <S::Mask as crate::scalar::Mask>::splat(false);
        work.evaluate::<S>(self.stages, table, base, &mut field);
        if let Some(clock) = self.clock {
            work.replace_entries::<S>(&[clock.momentum, clock.time], none);
        }
        let changes = work.replace::<S>(none, momenta) * table[PER_WEIGHT];
        let mut end = base.clone();
        advance::<S>(end.as_mut_slice(), work.increments.as_slice());
        Look {
            increments: work.increments,
            change: most_everywhere::<S>(changes),
            end,
        }
    }

    /// The increments from which the next step starts, and the size of its slopes, in all places.
    pub fn go_on<S: Scalar, V: State<S::Wide>>(
        &self,
        (base, mut increments): (&V, V),
        table: &[S::Wide],
    ) -> (V, S::Wide) {
        go_on::<S>(self.stages, increments.as_mut_slice(), table);
        let entries = [base.as_slice(), increments.as_slice()];
        let size = size::<S>((self.clock, self.momenta.as_ref()), entries, table);
        (increments, size)
    }
}

/// The size of the slopes against which changes are measured, in all places: that of the base over h, or of the slopes themselves.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn size<S: Scalar>(
    (clock, momenta): (Option<Clock>, Option<&Range<usize>>),
    [base, increments]: [&[S::Wide]; 2],
    table: &[S::Wide],
) -> S::Wide {
    let sum = |entries: &[S::Wide]| {
        let counted = entries.iter().enumerate();
        let counted = counted.filter(|(i, _)| !holds(clock, *i));
        counted.fold(S::Wide::zero(), |sum, (i, y)| {
            let has_unit = momenta.is_some_and(|momenta| momenta.contains(&i));
            sum + match has_unit {
                true => y.magnitude() * table[PER_UNIT],
                false => y.magnitude(),
            }
        })
    };
    let slopes = most_everywhere::<S>(sum(increments) * table[PER_WEIGHT]);
    (sum(base) * table[PER_STEP]).max(slopes)
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
