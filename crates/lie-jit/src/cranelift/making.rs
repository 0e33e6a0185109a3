//! Functions by Cranelift.

use super::columns::Columns;
use super::{Compiler, Shape};
use crate::lanes::LANES;
use crate::make::{Functions, Made, Purpose, with_all_lanes};
use crate::registers::Registers;
use cranelift_jit::JITModule;
use cranelift_module::FuncId;
use lie_dynamic::Code;
use std::borrow::Cow;
use std::mem::ManuallyDrop;

/// Codes with more instructions than this are not for Cranelift, whose time grows faster than they are long.
const LONGEST: usize = 20_000;

/// The memory of compiled functions.
pub struct Memory(Box<ManuallyDrop<JITModule>>);

/// A function of a module.
pub type Place = FuncId;

// SAFETY: functions read nothing but their arguments, and the memory they are in is not changed once they are complete.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: the module is taken once, here; its functions are called only by the machines that own the memory.
        unsafe { ManuallyDrop::take(self.0.as_mut()).free_memory() }
    }
}

impl Memory {
    fn of_module(compiler: Compiler) -> Option<Self> {
        Some(Self(Box::new(ManuallyDrop::new(compiler.finish()?))))
    }

    /// The address of a function.
    pub fn pointer(&self, place: Place) -> *const u8 {
        self.0.get_finalized_function(place)
    }
}

/// The function of a code; none where it is too long.
pub fn make(code: &Code, purpose: Purpose, _registers: Registers) -> Option<Made> {
    if code.instructions.len() > LONGEST {
        return None;
    }
    let mut compiler = Compiler::new()?;
    let place = match purpose {
        Purpose::Lanes if code.exchanges() => {
            let whole = with_all_lanes(code, 2);
            return Some(Made {
                place: compiler.add(&whole, Shape::pair_of_lanes(2))?,
                memory: Memory::of_module(compiler)?,
                at_once: LANES,
            });
        }
        Purpose::Lanes => compiler.add(code, Shape::pair_of_lanes(LANES))?,
        Purpose::Repeated(_) => return None,
        Purpose::ColumnsOfNumbers => compiler.add_columns(code, Columns::NUMBERS)?,
        Purpose::ColumnsOfLanes => compiler.add_columns(code, Columns::lanes(LANES))?,
    };
    Some(Made {
        memory: Memory::of_module(compiler)?,
        place,
        at_once: 2,
    })
}

/// The functions of codes over numbers, but for those that are too long.
pub fn over_numbers(codes: &[Cow<'_, Code>], _registers: Registers) -> Option<Functions> {
    let mut compiler = Compiler::new()?;
    let mut places = Vec::with_capacity(codes.len());
    for code in codes {
        places.push(match code.instructions.len() <= LONGEST {
            true => Some(compiler.add(code, Shape::ONE)?),
            false => None,
        });
    }
    Some(Functions {
        memory: Memory::of_module(compiler)?,
        places,
    })
}
