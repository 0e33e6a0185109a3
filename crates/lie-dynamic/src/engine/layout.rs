//! What compiled code agrees on with those who call it: the order of the slices it reads, and their least lengths.

use super::machine::{ARGUMENTS, Frame, SLICES, Targets};
use crate::code::{Code, Source};

impl Source {
    /// The slice of [`Frame::slices`] that it is in, and its entry there; none of a number.
    pub fn place(&self) -> Option<(usize, usize)> {
        Some(match *self {
            Self::Argument(argument, entry) => (usize::from(argument), entry as usize),
            Self::System(position) => (ARGUMENTS, position as usize),
            Self::OfStep(position) => (ARGUMENTS + 1, position as usize),
            Self::Parameter(position) => (ARGUMENTS + 2, position as usize),
            Self::Step => (ARGUMENTS + 3, 0),
            Self::Time => (ARGUMENTS + 3, 1),
            Self::Number(_) => return None,
        })
    }
}

/// Whether lengths are at least as large as they are to be; all are compared, with one jump.
#[inline]
fn are_long(lengths: impl Iterator<Item = (usize, usize)>) -> bool {
    lengths.fold(true, |all, (length, least)| all & (length >= least))
}

/// The least lengths of the slices that a code reads and writes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lengths {
    /// Those of the slices of a frame, 0 of what is not read.
    inputs: [usize; SLICES],
    outputs: [usize; 2],
}

impl Lengths {
    /// Those of a code.
    pub fn new(code: &Code) -> Self {
        let mut lengths = Self::default();
        for (slice, entry) in code.sources.iter().filter_map(Source::place) {
            lengths.inputs[slice] = lengths.inputs[slice].max(entry + 1);
        }
        for store in &code.stores {
            let least = &mut lengths.outputs[usize::from(store.target)];
            *least = (*least).max(store.entry as usize + 1);
        }
        for (least, clear) in lengths.outputs.iter_mut().zip(code.clear) {
            *least = (*least).max(clear.unwrap_or(0) as usize);
        }
        lengths
    }

    /// The least length of a slice, 0 where it is not read.
    pub fn input(&self, slice: usize) -> usize {
        self.inputs[slice]
    }

    /// The least lengths of the vector and the matrix.
    pub fn outputs(&self) -> [usize; 2] {
        self.outputs
    }

    /// Compares them with what a code is called with over columns: each has at least the places of the first target.
    ///
    /// # Panics
    /// A slice is shorter than the code needs, or a column than the first target.
    pub fn check_columns<S>(&self, columns: &[&[S]], frame: &Frame<'_, S>, to: &[&mut [S]]) {
        let places = to.first().map_or(0, |to| to.len());
        let columns_long = columns.iter().all(|column| column.len() >= places);
        let enough = columns.len() >= self.inputs[0] && to.len() >= self.outputs[0];
        assert!(enough, "there are too few columns for a code");
        let targets_long = to.iter().all(|to| to.len() >= places);
        assert!(columns_long && targets_long, "a column is too short");
        assert!(self.outputs[1] == 0, "a code over columns has no matrix");
        let others = frame.slices().iter().zip(self.inputs).skip(1);
        assert!(
            are_long(others.map(|(slice, least)| (slice.len(), least))),
            "a slice is too short for its code"
        );
    }

    /// Compares them with what a code is called with of which one slice takes turns with the vector that it gives: each of both is read
    /// and written.
    ///
    /// # Panics
    /// A slice is shorter than the code needs, or it gives a matrix.
    #[inline]
    pub fn check_in_turns<S>(&self, frame: &Frame<'_, S>, turning: usize, both: [&[S]; 2]) {
        let shorter = both[0].len().min(both[1].len());
        let mut lengths = frame.slices().map(<[S]>::len);
        lengths[turning] = shorter;
        assert!(
            are_long(lengths.into_iter().zip(self.inputs)),
            "a slice is too short for its code"
        );
        assert!(
            shorter >= self.outputs[0],
            "a target is too short for its code"
        );
        assert!(
            self.outputs[1] == 0,
            "a code that is repeated has no matrix"
        );
    }

    /// Compares them with what a code is called with.
    ///
    /// # Panics
    /// A slice is shorter than the code needs.
    #[inline]
    pub fn check<S>(&self, frame: &Frame<'_, S>, targets: &Targets<'_, S>) {
        let slices = frame.slices().iter().zip(self.inputs);
        assert!(
            are_long(slices.map(|(slice, least)| (slice.len(), least))),
            "a slice is too short for its code"
        );
        for (target, least) in targets.iter().zip(self.outputs) {
            assert!(target.len() >= least, "a target is too short for its code");
        }
    }
}
