//! Codes over lanes.

use crate::columns::ColumnKernels;
use crate::make::{Purpose, make};
use crate::memory::Memory;
use crate::registers::Registers;
use crate::{Entry, Others};
use lie_dynamic::{Code, Frame, Interpreter, Machine, Targets};
use lie_runtime::Scalar;
use std::sync::{Arc, OnceLock};

/// Lanes of double precision.
pub type Wide = <f64 as Scalar>::Wide;

pub const LANES: usize = size_of::<Wide>() / size_of::<f64>();
const _: () = assert!(
    LANES == 8 && LANES == <Wide as Scalar>::LANES,
    "lanes are numbers one behind the other, as many as the widest registers have"
);

/// Codes over lanes, each compiled when it is first run.
pub struct Lanes {
    entries: Vec<OnceLock<Option<(Entry, Memory)>>>,
    codes: Arc<[Code]>,
    registers: Registers,
    column_kernels: ColumnKernels,
    others: Others<Self>,
    interpreted: Interpreter,
}

impl Lanes {
    pub fn new(codes: &Arc<[Code]>, registers: Registers) -> Self {
        Self {
            entries: codes.iter().map(|_| OnceLock::new()).collect(),
            codes: Arc::clone(codes),
            registers,
            column_kernels: ColumnKernels::new(codes.len()),
            others: Others::new(),
            interpreted: Interpreter::new(Arc::clone(codes)),
        }
    }

    fn compiled(&self, code: usize) -> Option<(Entry, Memory)> {
        let code = &self.codes[code];
        let made = make(code, Purpose::Lanes, self.registers)?;
        let function = made.memory.function(made.place);
        Some((Entry::new(code, function, made.at_once), made.memory))
    }
}

impl Machine<Wide> for Lanes {
    fn run(&self, code: usize, frame: &Frame<'_, Wide>, targets: Targets<'_, Wide>) {
        match self.entries[code].get_or_init(|| self.compiled(code)) {
            Some((entry, _)) => entry.call(frame, targets),
            None => self.interpreted.run(code, frame, targets),
        }
    }

    fn compiles(&self) -> bool {
        true
    }

    fn has_compiled(&self, codes: &Arc<[Code]>) -> bool {
        self.others.has_compiled(codes)
    }

    fn compile(&self, codes: &Arc<[Code]>) -> Option<Arc<dyn Machine<Wide>>> {
        let make = || Some(Self::new(codes, self.registers));
        Some(self.others.get_or_compile(codes, make)?)
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
