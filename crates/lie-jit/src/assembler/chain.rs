//! Parts of a step that jump one into another: a step is one call.
//!
//! Each part is a function of its own, made once for all steppers. What links them, and what they read as constants of the step size, belongs to a
//! stepper: a record of each part, whose address is handed on with the jump.

use super::making::{self, Memory};
use crate::SameCodes;
use crate::registers::Registers;
use lie_dynamic::{BETWEEN, Cache, Chain, Code, Frame, Lengths, Next, OF_STEP, SLICES, Stop};
use lie_runtime::Scalar;
use std::mem::offset_of;
use std::sync::Arc;

/// Where the table of slices has what the step gives.
pub const RESULTS: usize = SLICES;

/// How a part ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum End {
    /// The step is done.
    Done,
    /// With a jump to one of two others: an answer is asked of every lane, or of any. The vector begins so many numbers
    /// behind the beginning of what is given to later parts.
    Question { from: usize, every: bool },
}

/// Reads from a table of the slices in a frame and writes the answers to a place. It takes no notice of the vector, whose place it has from
/// the table.
type Function =
    unsafe extern "sysv64" fn(*const *const f64, *mut f64, *mut f64, *const Record) -> Stopped;

/// Why a step stopped, and at which part.
#[repr(C)]
struct Stopped {
    why: u64,
    part: usize,
}

/// The step is at its end.
pub const DONE: u64 = 0;
/// The part is not for all lanes.
pub const MISSED: u64 = 1;
/// The part is not there.
const UNKNOWN: u64 = 2;

/// What a part is handed.
#[repr(C)]
struct Record {
    part: usize,
    of_step: *const f64,
    /// Where it goes on if the answer is no, and if it is yes.
    links: [Link; 2],
}

#[derive(Clone, Copy)]
#[repr(C)]
struct Link {
    function: Function,
    record: *const Record,
}

/// Where a record has its number, its constants of the step size, and its links by the answer: function and record.
pub const PART_AT: usize = offset_of!(Record, part);
pub const OF_STEP_AT: usize = offset_of!(Record, of_step);
pub const LINKS_AT: [[usize; 2]; 2] = {
    let links = offset_of!(Record, links);
    let [function, record] = [offset_of!(Link, function), offset_of!(Link, record)];
    let second = links + size_of::<Link>();
    [
        [links + function, links + record],
        [second + function, second + record],
    ]
};

/// What stands in the place of a part that is not there.
///
/// # Safety
/// The record is one.
unsafe extern "sysv64" fn unknown(
    _table: *const *const f64,
    _vector: *mut f64,
    _answers: *mut f64,
    record: *const Record,
) -> Stopped {
    // SAFETY: as above
    let part = unsafe { (*record).part };
    let why = UNKNOWN;
    Stopped { why, part }
}

/// A part that was made.
pub struct Made {
    function: Function,
    lengths: Lengths,
    _memory: Memory,
}

impl Made {
    /// Of the only code of these; none where it is not for the assembler.
    fn new(code: &[Code], lanes: usize, end: End, registers: Registers) -> Option<Self> {
        let [code] = code else {
            return None;
        };
        assert!(code.clear == [None, None], "a part clears nothing");
        let (memory, place) = making::part(&code.expanded(), lanes, end, registers)?;
        let pointer = memory.pointer(place);
        Some(Self {
            // SAFETY: the pointer is that of a function which was made with this signature.
            function: unsafe { std::mem::transmute::<*const u8, Function>(pointer) },
            lengths: Lengths::new(code),
            _memory: memory,
        })
    }
}

/// Parts that were made, for all chains of a machine.
pub type Parts = Cache<Made, (SameCodes, End)>;

/// So many parts, none of them added, with so many numbers that are given to later ones.
pub fn linked<S: Scalar>(
    registers: Registers,
    made: &Arc<Parts>,
    parts: usize,
    between: usize,
) -> Option<Box<dyn Chain<S>>> {
    Some(Box::new(Linked::new(registers, made, parts, between)))
}

/// Parts that jump one into another.
struct Linked<S> {
    registers: Registers,
    made: Arc<Parts>,
    parts: Vec<Option<Part<S>>>,
    /// Those that are there jump to others, by pointers into this list, which has all places from the beginning.
    records: Vec<Record>,
    /// The least lengths of the slices in a frame, and of what the step gives.
    least: [usize; SLICES],
    results: usize,
    between: Vec<S>,
    answers: [S; 2],
}

struct Part<S> {
    made: Arc<Made>,
    of_step: Vec<S>,
    next: Next,
}

impl<S: Scalar> Linked<S> {
    /// All lanes of a number are one behind the other.
    const HAS_LANES: () = assert!(size_of::<S>() == S::LANES * size_of::<f64>());

    fn new(registers: Registers, made: &Arc<Parts>, parts: usize, between: usize) -> Self {
        let () = Self::HAS_LANES;
        let links = [Link {
            function: unknown,
            record: std::ptr::null(),
        }; 2];
        let records = (0..parts).map(|part| Record {
            part,
            of_step: std::ptr::null(),
            links,
        });
        Self {
            registers,
            made: Arc::clone(made),
            parts: (0..parts).map(|_| None).collect(),
            records: records.collect(),
            least: [0; SLICES],
            results: 0,
            between: vec![S::zero(); between],
            answers: [S::zero(); 2],
        }
    }

    /// Writes the record of every part that is there.
    fn link(&mut self) {
        let start = self.records.as_mut_ptr();
        for (place, part) in self.parts.iter().enumerate() {
            let Some(part) = part else {
                continue;
            };
            // SAFETY: there is a record for each part, which nothing else refers to now.
            let record = unsafe { &mut *start.add(place) };
            record.of_step = part.of_step.as_ptr().cast::<f64>();
            if let Next::Question { parts, .. } = part.next {
                record.links = parts.map(|next| Link {
                    function: match &self.parts[next] {
                        Some(next) => next.made.function,
                        None => unknown,
                    },
                    record: start.wrapping_add(next),
                });
            }
        }
    }
}

impl<S: Scalar> Chain<S> for Linked<S> {
    fn add(&mut self, part: usize, code: &Arc<[Code]>, next: Next) -> bool {
        next.check(self.parts.len(), self.between.len());
        let (end, from, asked) = match next {
            Next::End => (End::Done, self.between.len(), 1),
            Next::Question { from, every, .. } => (End::Question { from, every }, from, 2),
        };
        let make = || Made::new(code, S::LANES, end, self.registers);
        let made = self.made.get(&(SameCodes(Arc::clone(code)), end), make);
        let Some(made) = made else {
            self.parts[part] = None;
            self.link();
            return false;
        };
        let lengths = &made.lengths;
        let [vector, answers] = lengths.outputs();
        assert!(
            next == Next::End || vector <= self.between.len() - from,
            "there is no place for what a part gives to others"
        );
        assert!(
            answers == asked,
            "a part gives answers and nothing else as a matrix"
        );
        let given = lengths.input(BETWEEN);
        assert!(given <= from, "a part reads what none before it gives");
        for (slice, least) in self.least.iter_mut().enumerate() {
            // the chain has these two
            if slice != BETWEEN && slice != OF_STEP {
                *least = lengths.input(slice).max(*least);
            }
        }
        if next == Next::End {
            self.results = self.results.max(vector);
        }
        self.parts[part] = Some(Part {
            of_step: vec![S::zero(); made.lengths.input(OF_STEP)],
            made,
            next,
        });
        self.link();
        true
    }

    fn of_step(&mut self, part: usize) -> &mut [S] {
        let part = self.parts[part].as_mut();
        part.map_or(&mut [], |part| &mut part.of_step)
    }

    fn follow(&mut self, from: usize, frame: &Frame<'_, S>, to: &mut [S]) -> Stop {
        let Some(part) = &self.parts[from] else {
            return Stop::Unknown(from);
        };
        let slices = frame.slices();
        let lengths = slices.iter().zip(self.least);
        let long = lengths.fold(true, |all, (slice, least)| all & (slice.len() >= least));
        assert!(long, "a slice is too short for a part");
        assert!(
            to.len() >= self.results,
            "there is no place for what a step gives"
        );
        let mut table = [std::ptr::null(); SLICES + 1];
        for (to, slice) in table.iter_mut().zip(slices) {
            *to = slice.as_ptr().cast::<f64>();
        }
        table[BETWEEN] = self.between.as_mut_ptr().cast::<f64>();
        table[RESULTS] = to.as_mut_ptr().cast::<f64>();
        let answers = self.answers.as_mut_ptr().cast::<f64>();
        // SAFETY: every slice is as long as every part that is there needs, and so is what they give to others, what the step gives, and what
        // the records have; these are of the parts that they are linked to. What is written is borrowed for writing or owned
        // here, and a number is its lanes one behind the other, all of which a part does.
        let stopped = unsafe {
            (part.made.function)(
                table.as_ptr(),
                std::ptr::null_mut(),
                answers,
                self.records.as_ptr().wrapping_add(from),
            )
        };
        match stopped.why {
            DONE => Stop::Done(stopped.part),
            MISSED => Stop::Missed(stopped.part),
            _ => Stop::Unknown(stopped.part),
        }
    }

    fn answers(&self) -> S {
        self.answers[0]
    }
}
