//! Codes over lanes.

use crate::columns::{ColumnKernels, Columns};
use crate::compile::{Compiler, Shape};
use crate::{Entry, Function, LONGEST, Memory, Others};
use lie_dynamic::{Code, Frame, Interpreter, Machine, Targets};
use lie_runtime::Scalar;
use std::sync::{Arc, OnceLock};

/// Lanes of double precision.
pub type Wide = <f64 as Scalar>::Wide;

const LANES: usize = size_of::<Wide>() / size_of::<f64>();
const _: () = assert!(
    LANES.is_multiple_of(2) && LANES == <Wide as Scalar>::LANES,
    "lanes are numbers one behind the other, and come in pairs"
);

/// Codes over lanes, each compiled when it is first run.
pub struct Lanes {
    entries: Vec<OnceLock<Option<(Entry, Function, Memory)>>>,
    codes: Arc<[Code]>,
    column_kernels: ColumnKernels,
    others: Others<Self>,
    interpreted: Interpreter,
}

impl Lanes {
    pub fn new(codes: &Arc<[Code]>) -> Self {
        Self {
            entries: codes.iter().map(|_| OnceLock::new()).collect(),
            codes: Arc::clone(codes),
            column_kernels: ColumnKernels::new(codes.len()),
            others: Others::new(),
            interpreted: Interpreter::new(Arc::clone(codes)),
        }
    }

    fn compile(code: &Code) -> Option<(Entry, Function, Memory)> {
        if code.instructions.len() > LONGEST {
            return None;
        }
        let mut compiler = Compiler::new()?;
        let place = compiler.add(code, Shape::pair_of_lanes(LANES))?;
        let memory = Memory::new(compiler)?;
        let function = memory.function(place);
        Some((Entry::new(code, Some(function)), function, memory))
    }
}

impl Machine<Wide> for Lanes {
    fn run(&self, code: usize, frame: &Frame<'_, Wide>, targets: Targets<'_, Wide>) {
        let compiled = self.entries[code].get_or_init(|| Self::compile(&self.codes[code]));
        match compiled {
            Some((entry, function, _)) => entry.call(*function, frame, targets),
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
        Some(
            self.others
                .get_or_compile(codes, || Some(Self::new(codes)))?,
        )
    }

    fn run_columns(
        &self,
        code: usize,
        columns: &[&[Wide]],
        frame: &Frame<'_, Wide>,
        to: &mut [&mut [Wide]],
    ) {
        let places = to.first().map_or(0, |to| to.len());
        let compiled = self
            .column_kernels
            .get(code, &self.codes[code], Columns::lanes(LANES));
        match compiled {
            Some(compiled) if places > 0 => compiled.call(columns, frame, to, places),
            _ => Machine::<Wide>::run_columns(&self.interpreted, code, columns, frame, to),
        }
    }
}
