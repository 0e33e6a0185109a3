//! Who makes the function of a code: the assembler where it can, Cranelift elsewhere.

use crate::columns::Columns;
use crate::compile::{Compiler, Shape};
use crate::lanes::LANES;
use crate::memory::{Memory, Place};
use crate::registers::Registers;
use lie_dynamic::Code;
use std::borrow::Cow;

/// Codes with more instructions than this are not for Cranelift, whose time grows faster than they are long.
const LONGEST: usize = 20_000;

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
    let code = &code.expanded();
    own(code, purpose, registers).or_else(|| by_cranelift(code, purpose))
}

/// What exchanges lanes has all of them in one call, in as many registers as that takes.
fn with_all_lanes(code: &Code, at_once: usize) -> Code {
    let halvings = (LANES / at_once).ilog2();
    (0..halvings).fold(code.clone(), |code, done| {
        code.halved((LANES >> done) as u8)
    })
}

fn by_cranelift(code: &Code, purpose: Purpose) -> Option<Made> {
    if code.instructions.len() > LONGEST {
        return None;
    }
    let mut compiler = Compiler::new()?;
    let place = match purpose {
        Purpose::Lanes if code.exchanges() => {
            let whole = with_all_lanes(code, 2);
            return Some(Made {
                place: Place::Id(compiler.add(&whole, Shape::pair_of_lanes(2))?),
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
        place: Place::Id(place),
        at_once: 2,
    })
}

/// The functions of codes over numbers: of each its memory and its place there; none of those that are too long. None where
/// something fails.
pub fn over_numbers(codes: &[Code], registers: Registers) -> Option<Functions> {
    let codes: Vec<_> = codes.iter().map(Code::expanded).collect();
    let codes = &codes[..];
    let mut functions = own_over_numbers(codes, registers);
    let others = functions.places.iter().zip(codes);
    let is_left = |(place, code): (&Option<_>, &Cow<'_, Code>)| {
        place.is_none() && code.instructions.len() <= LONGEST
    };
    if !others.clone().any(is_left) {
        return Some(functions);
    }
    let mut compiler = Compiler::new()?;
    let memory = functions.memories.len();
    for (place, code) in functions.places.iter_mut().zip(codes) {
        if is_left((place, code)) {
            *place = Some((memory, Place::Id(compiler.add(code, Shape::ONE)?)));
        }
    }
    functions.memories.push(Memory::of_module(compiler)?);
    Some(functions)
}

/// Functions of codes.
pub struct Functions {
    /// What they are in.
    pub memories: Vec<Memory>,
    /// The memory of each and the place there.
    pub places: Vec<Option<(usize, Place)>>,
}

#[cfg(all(unix, target_arch = "x86_64"))]
mod with_assembler {
    use super::{Functions, Made, Purpose};
    use crate::assembler::{Layout, Pages, Width, assemble};
    use crate::lanes::LANES;
    use crate::memory::{Memory, Place};
    use crate::registers::Registers;
    use lie_dynamic::Code;
    use std::borrow::Cow;

    fn width(registers: Registers) -> Option<Width> {
        match registers {
            Registers::Avx512 => Some(Width::Eight),
            Registers::Avx2 => Some(Width::Four),
            Registers::Pairs => None,
        }
    }

    /// The function of a code by the assembler; none where it is not for it.
    pub fn own(code: &Code, purpose: Purpose, registers: Registers) -> Option<Made> {
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
        let pages = Pages::new(&assemble(code, layout)?)?;
        Some(Made {
            memory: Memory::Own(pages),
            place: Place::Offset(0),
            at_once: width.lanes(),
        })
    }

    /// The function of a code that does all lanes in a call.
    fn all_lanes(code: &Code, width: Width, layout: impl FnOnce(Layout) -> Layout) -> Option<Made> {
        let whole = super::with_all_lanes(code, width.lanes());
        let layout = layout(Layout::lanes(width, width.lanes()));
        Some(Made {
            memory: Memory::Own(Pages::new(&assemble(&whole, layout)?)?),
            place: Place::Offset(0),
            at_once: LANES,
        })
    }

    /// The functions of codes over numbers by the assembler, as far as they are for it.
    pub fn own_over_numbers(codes: &[Cow<'_, Code>], registers: Registers) -> Functions {
        let mut places = vec![None; codes.len()];
        let mut all = Vec::new();
        for (place, code) in places.iter_mut().zip(codes) {
            let function = width(registers).and_then(|_| assemble(code, Layout::NUMBER));
            if let Some(function) = function {
                *place = Some((0, Place::Offset(all.len())));
                all.extend(function);
                all.resize(all.len().next_multiple_of(64), 0xCC);
            }
        }
        let pages = (!all.is_empty()).then(|| Pages::new(&all)).flatten();
        if pages.is_none() {
            places.fill(None);
        }
        Functions {
            memories: pages.map(Memory::Own).into_iter().collect(),
            places,
        }
    }
}
#[cfg(all(unix, target_arch = "x86_64"))]
use with_assembler::{own, own_over_numbers};

#[cfg(not(all(unix, target_arch = "x86_64")))]
fn own(_code: &Code, _purpose: Purpose, _registers: Registers) -> Option<Made> {
    None
}

#[cfg(not(all(unix, target_arch = "x86_64")))]
fn own_over_numbers(codes: &[Cow<'_, Code>], _registers: Registers) -> Functions {
    Functions {
        memories: Vec::new(),
        places: vec![None; codes.len()],
    }
}
