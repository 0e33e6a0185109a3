//! Comparisons, choices between two numbers, and jumps.

use super::{BROADCAST, Bytes, Opcode, Prefix, Read, Table, of_numbers};
use crate::assembler::operation::{Arithmetic, Vector, Width};

/// Mask 1, which comparisons of AVX-512 write and choices read.
const MASK: u8 = 1;

/// Less than, false where a number is none.
const LESS: u8 = 0x11;
/// The same, or equal.
const LESS_EQUAL: u8 = 0x12;
/// Less than, true where a number is none.
const NOT_AT_OR_ABOVE: u8 = 0x19;
/// Where a number is none.
const UNORDERED: u8 = 0x03;

/// Jumps where a result is not 0, and where a comparison found less, or no number.
const NOT_ZERO: u8 = 0x85;
const BELOW: u8 = 0x82;

impl Bytes {
    /// `to = one` where `left` is less than `right`, or equal too, 0 elsewhere; `to` is none of the operands.
    pub fn compare_numbers(
        &mut self,
        width: Width,
        to: Vector,
        [left, right]: [Vector; 2],
        equal: bool,
        one: Read,
    ) {
        let compare = Opcode {
            behind: Some(if equal { LESS_EQUAL } else { LESS }),
            ..Opcode::new(of_numbers(width), Table::Of0F, 0xC2)
        };
        if width == Width::Eight {
            self.vector(width, compare, MASK, left.0, Read::Vector(right));
            let load = Opcode {
                mask: MASK,
                clears: true,
                ..Opcode::new(Prefix::Packed, Table::Of0F38, BROADCAST)
            };
            self.vector(width, load, to.0, 0, one);
        } else {
            self.vector(width, compare, to.0, left.0, Read::Vector(right));
            self.arithmetic(width, Arithmetic::And, to, to, one);
        }
    }

    /// `to` is the larger one, `left` where they are equal, no number where one is none; `to` is none of the operands.
    pub fn larger(&mut self, width: Width, to: Vector, [left, right]: [Vector; 2]) {
        let compare = Opcode {
            behind: Some(UNORDERED),
            ..Opcode::new(of_numbers(width), Table::Of0F, 0xC2)
        };
        let mask = if width == Width::Eight { MASK } else { to.0 };
        self.vector(width, compare, mask, right.0, Read::Vector(right));
        // the processor gives the second of two where one is no number, and where they are equal
        self.choose(width, to, [right, left]);
        let larger = Opcode::new(of_numbers(width), Table::Of0F, 0x5F);
        self.vector(width, larger, to.0, right.0, Read::Vector(to));
    }

    /// `to = then` where `test` is below what is read, `otherwise` elsewhere; `to` is none of the operands.
    pub fn below(
        &mut self,
        width: Width,
        jumps: bool,
        to: Vector,
        [test, then, otherwise]: [Vector; 3],
        zero: Read,
    ) {
        if width == Width::One && jumps {
            self.below_of_number(to, [test, then, otherwise]);
            return;
        }
        let compare = Opcode {
            behind: Some(LESS),
            ..Opcode::new(of_numbers(width), Table::Of0F, 0xC2)
        };
        let mask = if width == Width::Eight { MASK } else { to.0 };
        self.vector(width, compare, mask, test.0, zero);
        self.choose(width, to, [then, otherwise]);
    }

    /// The same of one number, by a jump: what is foreseen waits for no comparison, nor for the number that is not taken.
    fn below_of_number(&mut self, to: Vector, [test, then, otherwise]: [Vector; 3]) {
        self.arithmetic(Width::One, Arithmetic::Xor, to, to, Read::Vector(to));
        let compare = Opcode::new(Prefix::Packed, Table::Of0F, 0x2E);
        self.vector(Width::One, compare, to.0, 0, Read::Vector(test));
        self.copy(to, then);
        // 0 is above: neither equal, nor is the other no number
        self.extend([0x77, 0]);
        let jump = self.all.len();
        self.copy(to, otherwise);
        self.all[jump - 1] = (self.all.len() - jump) as u8;
    }

    /// `to = then` in the lanes of the mask, which AVX2 has in `to`, `otherwise` elsewhere.
    fn choose(&mut self, width: Width, to: Vector, [then, otherwise]: [Vector; 2]) {
        let choose = match width {
            Width::Eight => Opcode {
                mask: MASK,
                ..Opcode::new(Prefix::Packed, Table::Of0F38, 0x65)
            },
            Width::Four | Width::One => Opcode {
                behind: Some(to.0 << 4),
                ..Opcode::new(Prefix::Packed, Table::Of0F3A, 0x4B)
            },
        };
        self.vector(width, choose, to.0, otherwise.0, Read::Vector(then));
    }

    /// Goes elsewhere where some number of `test` is not at or above 0; the place of the distance.
    pub fn jump_unless_all_above(
        &mut self,
        width: Width,
        test: Vector,
        zero: Read,
        scratch: Vector,
    ) -> usize {
        let compare = Opcode {
            behind: Some(NOT_AT_OR_ABOVE),
            ..Opcode::new(Prefix::Packed, Table::Of0F, 0xC2)
        };
        let condition = match width {
            Width::Eight => {
                self.vector(width, compare, MASK, test.0, zero);
                // kortestw k1, k1
                self.extend([0xC5, 0xF8, 0x98, 0xC0 | MASK << 3 | MASK]);
                NOT_ZERO
            }
            Width::Four => {
                self.vector(width, compare, scratch.0, test.0, zero);
                let any = Opcode::new(Prefix::Packed, Table::Of0F38, 0x17);
                self.vector(width, any, scratch.0, 0, Read::Vector(scratch));
                NOT_ZERO
            }
            Width::One => {
                let compare = Opcode::new(Prefix::Packed, Table::Of0F, 0x2E);
                self.vector(width, compare, test.0, 0, zero);
                BELOW
            }
        };
        self.extend([0x0F, condition, 0, 0, 0, 0]);
        self.all.len() - 4
    }

    /// A jump whose distance is at a place comes here.
    pub fn land(&mut self, place: usize) {
        let distance = (self.all.len() - place - 4) as i32;
        self.all[place..place + 4].copy_from_slice(&distance.to_le_bytes());
    }

    /// Goes to a place before this one.
    pub fn jump_back(&mut self, to: usize) {
        self.extend([0xE9]);
        let distance = to as i64 - (self.all.len() as i64 + 4);
        self.extend((distance as i32).to_le_bytes());
    }
}
