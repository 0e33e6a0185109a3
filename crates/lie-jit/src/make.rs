//! Functions of codes: the assembler makes them where this program runs on a Unix and x86-64, Cranelift elsewhere.

#[cfg(all(unix, target_arch = "x86_64"))]
use crate::assembler::making;
#[cfg(not(all(unix, target_arch = "x86_64")))]
use crate::cranelift::making;

use crate::lanes::LANES;
use crate::registers::Registers;
use lie_dynamic::Code;
use std::borrow::Cow;

pub use making::{Memory, Place};

/// The function of a code.
pub struct Made {
    /// What it is in.
    pub memory: Memory,
    /// Where it is there.
    pub place: Place,
    /// How many neighbours it does.
    pub at_once: usize,
}

/// What a function is for.
#[derive(Clone, Copy)]
pub enum Purpose {
    /// Lanes.
    Lanes,
    /// All lanes, again and again: this slice takes turns with the vector.
    Repeated(u8),
    /// Columns of numbers.
    ColumnsOfNumbers,
    /// Columns of lanes.
    ColumnsOfLanes,
}

/// The function of a code; none where it is too long.
pub fn make(code: &Code, purpose: Purpose, registers: Registers) -> Option<Made> {
    making::make(&code.expanded(), purpose, registers)
}

/// What exchanges lanes has all of them in one call, in as many registers as that takes.
pub fn with_all_lanes(code: &Code, at_once: usize) -> Code {
    let halvings = (LANES / at_once).ilog2();
    (0..halvings).fold(code.clone(), |code, done| {
        code.halved((LANES >> done) as u8)
    })
}

/// Functions of codes over numbers, in one memory.
pub struct Functions {
    /// What they are in.
    pub memory: Memory,
    /// The place of each; none of those that are too long.
    pub places: Vec<Option<Place>>,
}

/// The functions of codes over numbers. None where there is none, or something fails.
pub fn over_numbers(codes: &[Code], registers: Registers) -> Option<Functions> {
    let codes: Vec<Cow<'_, Code>> = codes.iter().map(Code::expanded).collect();
    making::over_numbers(&codes, registers)
}
