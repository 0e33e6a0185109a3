//! Codes over columns: a loop over places, several numbers at a time.

use crate::make::{Purpose, make};
use crate::memory::Memory;
use crate::registers::Registers;
use lie_dynamic::{AROUND, Code, Frame, Lengths};
use lie_runtime::Scalar;
use smallvec::SmallVec;
use std::ops::Range;
use std::sync::OnceLock;

/// A function over columns: reads from a table of the slices in a frame and from a table of columns, writes to a table of
/// columns, and does this for so many bytes of each.
pub type Function =
    unsafe extern "C" fn(*const *const f64, *const *const f64, *const *mut f64, usize);

/// Codes over columns, each compiled when it is first run.
pub struct ColumnKernels(Vec<OnceLock<Option<OverColumns>>>);

/// A code over columns.
pub struct OverColumns {
    function: Function,
    /// How many neighbours it does: of numbers places, of lanes those of a place.
    pub at_once: usize,
    lengths: Lengths,
    /// The entries that it does not write.
    clear: Vec<usize>,
    _memory: Memory,
}

impl ColumnKernels {
    pub fn new(codes: usize) -> Self {
        Self((0..codes).map(|_| OnceLock::new()).collect())
    }

    /// A code; none where it is too long, or has a matrix.
    pub fn get(&self, place: usize, made: (&Code, Purpose, Registers)) -> Option<&OverColumns> {
        let compile = || OverColumns::new(made.0, made.1, made.2);
        self.0[place].get_or_init(compile).as_ref()
    }
}

impl OverColumns {
    fn new(code: &Code, purpose: Purpose, registers: Registers) -> Option<Self> {
        if code.stores.iter().any(|store| store.target > 0) {
            return None;
        }
        let made = make(code, purpose, registers)?;
        let written = |entry: &usize| {
            let mut stores = code.stores.iter();
            stores.any(|store| store.entry as usize == *entry)
        };
        let all = code.clear[0].unwrap_or(0) as usize;
        Some(Self {
            function: made.memory.over_columns(made.place),
            at_once: made.at_once,
            lengths: Lengths::new(code),
            clear: (0..all).filter(|entry| !written(entry)).collect(),
            _memory: made.memory,
        })
    }

    /// Calls the function for these places, at least one; of numbers, as many as are done at a time or a multiple of it.
    ///
    /// # Panics
    /// A slice is shorter than the code needs, or a column than the first target; or there are other places than that.
    pub fn call<S: Scalar>(
        &self,
        columns: &[&[S]],
        frame: &Frame<'_, S>,
        to: &mut [&mut [S]],
        places: Range<usize>,
    ) {
        self.lengths.check_columns(columns, frame, to);
        let enough = to.first().is_some_and(|to| to.len() >= places.end);
        assert!(
            enough && !places.is_empty(),
            "there are fewer places than are asked for"
        );
        for entry in &self.clear {
            to[*entry][places.clone()].fill(S::zero());
        }
        let lanes = size_of::<S>() / size_of::<f64>();
        assert!(
            (places.len() * lanes).is_multiple_of(self.at_once),
            "numbers are done several at a time"
        );
        let mut table = frame.slices().map(|slice| slice.as_ptr().cast::<f64>());
        let columns = columns.iter();
        let columns = columns.map(|column| column[places.clone()].as_ptr().cast::<f64>());
        let mut columns: SmallVec<[*const f64; AROUND]> = columns.collect();
        let to = to.iter_mut();
        let to = to.map(|to| to[places.clone()].as_mut_ptr().cast::<f64>());
        let mut to: SmallVec<[*mut f64; AROUND]> = to.collect();
        for first in (0..lanes).step_by(self.at_once) {
            if first > 0 {
                table = table.map(|slice| slice.wrapping_add(self.at_once));
                for column in &mut columns {
                    *column = column.wrapping_add(self.at_once);
                }
                for to in &mut to {
                    *to = to.wrapping_add(self.at_once);
                }
            }
            let bytes = places.len() * size_of::<S>();
            // SAFETY: every slice and every column is as long as the code needs, and has this many bytes from its own
            // beginning on; the function does so many numbers for each step, which the places are a multiple of. What is
            // written is borrowed for writing.
            unsafe { (self.function)(table.as_ptr(), columns.as_ptr(), to.as_ptr(), bytes) }
        }
    }
}
