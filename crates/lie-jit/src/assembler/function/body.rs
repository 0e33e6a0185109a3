//! The operations of a program one after the other, with the places that they read and write.

use super::{ALONG, ARGUMENTS, COLUMN, FIRST, Writer};
use crate::assembler::asides::Aside;
use crate::assembler::encoding::{General, Memory, Read};
use crate::assembler::operation::{Called, Operand, Operation, Place, Width};

impl Writer<'_> {
    pub fn body(&mut self) -> Option<()> {
        let width = self.layout.width;
        let program = self.program;
        for (place, operation) in program.operations.iter().enumerate() {
            match *operation {
                // the result of a function of numbers is there
                Operation::Load { to: FIRST, from } if self.has_result(place, from) => {}
                Operation::Load { to, from } => {
                    let from = self.read(from)?;
                    self.bytes.load(width, to, from);
                }
                Operation::Store { from, to } => {
                    let to = self.memory(to)?;
                    self.bytes.store(width, to, from);
                }
                Operation::Arithmetic {
                    what,
                    to,
                    left,
                    right,
                    ..
                } => {
                    let right = match right {
                        Operand::Vector(vector) => Read::Vector(vector),
                        Operand::Place(place) => self.read(place)?,
                    };
                    self.bytes.arithmetic(width, what, to, left, right);
                }
                Operation::Sqrt { to, of, .. } => self.bytes.sqrt(width, to, of),
                Operation::Compare {
                    equal,
                    to,
                    left,
                    right,
                    one,
                    ..
                } => {
                    let one = self.read(one)?;
                    self.bytes
                        .compare_numbers(width, to, [left, right], equal, one);
                }
                Operation::Larger {
                    to, left, right, ..
                } => self.bytes.larger(width, to, [left, right]),
                Operation::Exchange {
                    distance, to, of, ..
                } => self.bytes.exchange(width, to, of, distance)?,
                Operation::Shift { to, of, places, .. } => self.bytes.shift(width, to, of, places),
                Operation::Rare {
                    value,
                    test,
                    zero,
                    x,
                    scratch,
                    function,
                    kept,
                    ..
                } => {
                    let zero = self.read(zero)?;
                    let jump = self.bytes.jump_unless_all_above(width, test, zero, scratch);
                    self.asides.push(Aside {
                        jump,
                        back: self.bytes.all.len(),
                        value,
                        x,
                        test,
                        function,
                        kept,
                    });
                }
                Operation::Below {
                    jumps,
                    to,
                    test,
                    zero,
                    then,
                    otherwise,
                    ..
                } => {
                    let zero = self.read(zero)?;
                    let operands = [test, then, otherwise];
                    self.bytes.below(width, jumps, to, operands, zero);
                }
                Operation::Call { called, .. } => self.call(place, called),
            }
        }
        Some(())
    }

    /// A place in memory; the beginning of a column is loaded for it.
    fn memory(&mut self, place: Place) -> Option<Memory> {
        let bytes = self.layout.width.bytes();
        let at = |base, entry: u32, stride: u32| {
            let offset = entry.checked_mul(stride)?;
            Some(Memory::At(base, i32::try_from(offset).ok()?))
        };
        match place {
            Place::Slice { slice: 0, entry } if self.layout.columns.is_some() => {
                self.column(General::Rsi, entry)
            }
            Place::Target { target: 0, entry } if self.layout.columns.is_some() => {
                self.column(General::Rdx, entry)
            }
            Place::Slice { slice, entry } => {
                let mut bases = self.bases.iter();
                let (_, base) = bases.find(|(known, _)| *known == slice)?;
                at(*base, entry, self.layout.stride)
            }
            Place::Target { target, entry } if self.layout.columns.is_none() => {
                let base = *ARGUMENTS[1..3].get(usize::from(target))?;
                at(base, entry, self.layout.stride)
            }
            Place::Target { .. } => None,
            Place::Shared(place) => at(General::Rsp, place, bytes),
            Place::Slot(slot) => at(General::Rsp, self.program.shared + slot, bytes),
            Place::Constant(constant) => Some(Memory::Constant(constant)),
        }
    }

    fn column(&mut self, table: General, entry: u32) -> Option<Memory> {
        let offset = i32::try_from(entry.checked_mul(8)?).ok()?;
        self.bytes.load_word(COLUMN, Memory::At(table, offset));
        Some(Memory::Sum(COLUMN, ALONG))
    }

    fn read(&mut self, place: Place) -> Option<Read> {
        let memory = self.memory(place)?;
        Some(match self.layout.is_single(place) {
            true => Read::Single(memory),
            false => Read::Whole(memory),
        })
    }

    /// Whether the first register has this number since the operation before, which called a function of numbers.
    fn has_result(&self, place: usize, from: Place) -> bool {
        let before = place
            .checked_sub(1)
            .map(|place| self.program.operations[place]);
        let called = match before {
            Some(Operation::Call { called, .. }) => called,
            _ => return false,
        };
        let is_of_numbers = matches!(called, Called::Unary(_) | Called::Binary(_));
        self.layout.width == Width::One && is_of_numbers && from == Place::Shared(0)
    }
}
