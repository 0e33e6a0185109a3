//! Codes over lanes.

use crate::columns::{Along, Columns};
use crate::compile::{Compiler, Shape};
use crate::{Entry, Function, LONGEST, Memory};
use lie_dynamic::{Code, Frame, Interpreter, Machine, Targets};
use lie_runtime::Scalar;
use std::sync::{Arc, OnceLock};

/// Lanes of double precision, and lanes of these: the stages of a step, eight members in each.
pub type Wide = <f64 as Scalar>::Wide;
type Wider = <Wide as Scalar>::Wide;

/// The lanes of a scalar, which must be numbers one behind the other, and come in pairs.
const fn lanes_of<S: Scalar>() -> usize {
    let lanes = size_of::<S>() / size_of::<f64>();
    assert!(lanes.is_multiple_of(2) && lanes == S::LANES);
    lanes
}
pub const LANES: usize = lanes_of::<Wide>();
const WIDER: usize = lanes_of::<Wider>();

/// Codes over so many lanes, each compiled when it is first run.
pub struct Lanes<const COUNT: usize> {
    entries: Vec<OnceLock<Option<(Entry, Function, Memory)>>>,
    codes: Arc<[Code]>,
    along: Along,
    interpreted: Interpreter,
    wide: OnceLock<Arc<Lanes<WIDER>>>,
}

impl<const COUNT: usize> Lanes<COUNT> {
    pub fn new(codes: &Arc<[Code]>) -> Self {
        Self {
            entries: codes.iter().map(|_| OnceLock::new()).collect(),
            codes: Arc::clone(codes),
            along: Along::new(codes.len()),
            interpreted: Interpreter::new(Arc::clone(codes)),
            wide: OnceLock::new(),
        }
    }

    fn compile(code: &Code) -> Option<(Entry, Function, Memory)> {
        if code.instructions.len() > LONGEST {
            return None;
        }
        let mut compiler = Compiler::new()?;
        let place = compiler.add(code, Shape::two_of(COUNT))?;
        let memory = Memory::new(compiler)?;
        let function = memory.function(place);
        Some((Entry::new(code, Some(function)), function, memory))
    }

    fn run_lanes<S: Scalar>(&self, code: usize, frame: &Frame<'_, S>, targets: Targets<'_, S>) {
        let compiled = self.entries[code].get_or_init(|| Self::compile(&self.codes[code]));
        match compiled {
            Some((entry, function, _)) => entry.call(*function, frame, targets),
            None => self.interpreted.run(code, frame, targets),
        }
    }

    fn lanes_along<S: Scalar>(
        &self,
        code: usize,
        columns: &[&[S]],
        frame: &Frame<'_, S>,
        to: &mut [&mut [S]],
    ) {
        let places = to.first().map_or(0, |to| to.len());
        let compiled = self
            .along
            .get(code, &self.codes[code], Columns::lanes(COUNT));
        match compiled {
            Some(compiled) if places > 0 => compiled.call(columns, frame, to, places),
            _ => Machine::<S>::along(&self.interpreted, code, columns, frame, to),
        }
    }
}

macro_rules! machine {
    ($scalar:ident, $count:ident, { $($wide:item)* }) => {
        impl Machine<$scalar> for Lanes<$count> {
            fn run(&self, code: usize, frame: &Frame<'_, $scalar>, targets: Targets<'_, $scalar>) {
                self.run_lanes(code, frame, targets);
            }

            fn along(
                &self,
                code: usize,
                columns: &[&[$scalar]],
                frame: &Frame<'_, $scalar>,
                to: &mut [&mut [$scalar]],
            ) {
                self.lanes_along(code, columns, frame, to);
            }

            $($wide)*
        }
    };
}

machine!(Wide, LANES, {
    fn wide(&self) -> Option<Arc<dyn Machine<Wider>>> {
        let lanes = || Arc::new(Lanes::new(&self.codes));
        Some(Arc::clone(self.wide.get_or_init(lanes)) as Arc<dyn Machine<Wider>>)
    }
});
machine!(Wider, WIDER, {});
