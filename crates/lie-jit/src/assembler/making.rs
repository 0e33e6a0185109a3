//! Functions by the assembler.

use super::chain::End;
use super::{Layout, Pages, Width, assemble};
use crate::lanes::LANES;
use crate::make::{Functions, Made, Purpose, with_all_lanes};
use crate::registers::Registers;
use lie_dynamic::Code;
use std::borrow::Cow;

/// The memory of compiled functions.
pub struct Memory(Pages);

/// A function is so many bytes behind the beginning.
pub type Place = usize;

impl Memory {
    /// The address of a function.
    pub fn pointer(&self, place: Place) -> *const u8 {
        self.0.at(place)
    }
}

fn width(registers: Registers) -> Option<Width> {
    match registers {
        Registers::Avx512 => Some(Width::Eight),
        Registers::Avx2 => Some(Width::Four),
        Registers::Pairs => None,
    }
}

/// The function of a code; none where it is not for the assembler.
pub fn make(code: &Code, purpose: Purpose, registers: Registers) -> Option<Made> {
    let width = width(registers)?;
    let layout = match purpose {
        Purpose::Repeated(slice) => {
            return all_lanes(code, width, |layout| layout.repeated(slice));
        }
        Purpose::Lanes if code.exchanges() => return all_lanes(code, width, |layout| layout),
        Purpose::Lanes => Layout::lanes(width, LANES),
        Purpose::ColumnsOfNumbers => Layout::columns_of_numbers(width),
        Purpose::ColumnsOfLanes => Layout::columns_of_lanes(width, LANES),
    };
    Some(Made {
        memory: Memory(Pages::new(&assemble(code, layout)?)?),
        place: 0,
        at_once: width.lanes(),
    })
}

/// The function of a code that does all lanes in a call.
fn all_lanes(code: &Code, width: Width, layout: impl FnOnce(Layout) -> Layout) -> Option<Made> {
    let whole = with_all_lanes(code, width.lanes());
    let layout = layout(Layout::lanes(width, width.lanes()));
    Some(Made {
        memory: Memory(Pages::new(&assemble(&whole, layout)?)?),
        place: 0,
        at_once: LANES,
    })
}

/// A part of a step over one number, or over all lanes; none where it is not for the assembler.
pub fn part(code: &Code, lanes: usize, end: End, registers: Registers) -> Option<(Memory, Place)> {
    let width = width(registers)?;
    let bytes = match lanes {
        1 => assemble(code, Layout::NUMBER.part(lanes, end))?,
        _ => {
            let layout = Layout::lanes(width, width.lanes()).part(lanes, end);
            assemble(&with_all_lanes(code, width.lanes()), layout)?
        }
    };
    Some((Memory(Pages::new(&bytes)?), 0))
}

/// The functions of codes over numbers, as far as they are for the assembler.
pub fn over_numbers(codes: &[Cow<'_, Code>], registers: Registers) -> Option<Functions> {
    width(registers)?;
    let mut all = Vec::new();
    let places = codes.iter().map(|code| {
        let function = assemble(code, Layout::NUMBER)?;
        let place = all.len();
        all.extend(function);
        all.resize(all.len().next_multiple_of(64), 0xCC);
        Some(place)
    });
    let places = places.collect();
    if all.is_empty() {
        if !codes.is_empty() {
            return None;
        }
        // memory has at least one byte
        all.push(0xCC);
    }
    Some(Functions {
        memory: Memory(Pages::new(&all)?),
        places,
    })
}
