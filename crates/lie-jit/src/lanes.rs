//! Codes over lanes.

use crate::chain::{self, Parts};
use crate::columns::ColumnKernels;
use crate::make::{Purpose, make};
use crate::memory::{Memory, Repeated};
use crate::registers::Registers;
use crate::{Entry, Others, SameCodes};
use lie_dynamic::{Chain, Code, Frame, Interpreter, Lengths, Machine, Targets, in_turns};
use lie_runtime::Scalar;
use std::sync::{Arc, OnceLock};

/// Lanes of double precision.
pub type Wide = <f64 as Scalar>::Wide;

pub const LANES: usize = size_of::<Wide>() / size_of::<f64>();
const _: () = assert!(
    LANES == 8 && LANES == <Wide as Scalar>::LANES,
    "lanes are numbers one behind the other, as many as the widest registers have"
);

/// The argument that takes turns with what a code gives.
const SECOND: usize = 1;

/// Codes over lanes, each compiled when it is first run.
pub struct Lanes {
    entries: Vec<OnceLock<Option<(Entry, Memory)>>>,
    /// Those that are repeated.
    repeated: Vec<OnceLock<Option<(Repeated, Memory)>>>,
    lengths: Vec<Lengths>,
    codes: Arc<[Code]>,
    registers: Registers,
    column_kernels: ColumnKernels,
    others: Others<Self>,
    parts: Arc<Parts>,
    interpreted: Interpreter,
}

impl Lanes {
    pub fn new(codes: &Arc<[Code]>, registers: Registers) -> Self {
        Self {
            entries: codes.iter().map(|_| OnceLock::new()).collect(),
            repeated: codes.iter().map(|_| OnceLock::new()).collect(),
            lengths: codes.iter().map(Lengths::new).collect(),
            codes: Arc::clone(codes),
            registers,
            column_kernels: ColumnKernels::new(codes.len()),
            others: Others::default(),
            parts: Arc::default(),
            interpreted: Interpreter::new(Arc::clone(codes)),
        }
    }

    fn compiled(&self, code: usize) -> Option<(Entry, Memory)> {
        let code = &self.codes[code];
        let made = make(code, Purpose::Lanes, self.registers)?;
        let function = made.memory.function(made.place);
        Some((Entry::new(code, function, made.at_once), made.memory))
    }

    fn compiled_to_repeat(&self, code: usize) -> Option<(Repeated, Memory)> {
        let purpose = Purpose::Repeated(SECOND as u8);
        let made = make(&self.codes[code], purpose, self.registers)?;
        Some((made.memory.repeated(made.place), made.memory))
    }
}

impl Machine<Wide> for Lanes {
    fn run(&self, code: usize, frame: &Frame<'_, Wide>, targets: Targets<'_, Wide>) {
        match self.entries[code].get_or_init(|| self.compiled(code)) {
            Some((entry, _)) => entry.call(frame, targets),
            None => self.interpreted.run(code, frame, targets),
        }
    }

    fn repeat(
        &self,
        code: usize,
        count: u32,
        frame: &Frame<'_, Wide>,
        [one, other]: [&mut [Wide]; 2],
    ) {
        let made = self.repeated[code].get_or_init(|| self.compiled_to_repeat(code));
        let whole = self.codes[code].clear == [None, None];
        let Some((function, _)) = made.as_ref().filter(|_| whole && count > 0) else {
            return in_turns(count, [one, other], |from, to| {
                self.run(code, &frame.with_second(from), [to, &mut []]);
            });
        };
        self.lengths[code].check_in_turns(frame, SECOND, [&*one, &*other]);
        let mut table = frame.slices().map(|slice| slice.as_ptr().cast::<f64>());
        table[SECOND] = one.as_mut_ptr().cast::<f64>().cast_const();
        let vector = other.as_mut_ptr().cast::<f64>();
        // SAFETY: every slice is as long as the code needs, in either turn; both vectors are borrowed for writing, and the code
        // writes to no other place. A code that is repeated has all lanes in one call.
        unsafe { function(table.as_mut_ptr(), vector, vector, count as usize) }
    }

    fn compiles(&self) -> bool {
        true
    }

    fn compiles_quickly(&self) -> bool {
        self.registers != Registers::Pairs
    }

    fn has_compiled(&self, codes: &Arc<[Code]>) -> bool {
        self.others.has_tried(&SameCodes(Arc::clone(codes)))
    }

    fn compile(&self, codes: &Arc<[Code]>) -> Option<Arc<dyn Machine<Wide>>> {
        let make = || Some(Self::new(codes, self.registers));
        Some(self.others.get(&SameCodes(Arc::clone(codes)), make)?)
    }

    fn chain(&self, parts: usize, between: usize) -> Option<Box<dyn Chain<Wide>>> {
        chain::linked(self.registers, &self.parts, parts, between)
    }

    fn run_columns(
        &self,
        code: usize,
        columns: &[&[Wide]],
        frame: &Frame<'_, Wide>,
        to: &mut [&mut [Wide]],
    ) {
        let places = to.first().map_or(0, |to| to.len());
        let made = (&self.codes[code], Purpose::ColumnsOfLanes, self.registers);
        match self.column_kernels.get(code, made) {
            Some(compiled) if places > 0 => compiled.call(columns, frame, to, 0..places),
            _ => Machine::<Wide>::run_columns(&self.interpreted, code, columns, frame, to),
        }
    }
}
