//! Bytes of instructions of x86-64 on registers of numbers, with VEX and EVEX prefixes.
//!
//! Intel's *Software Developer's Manual*, volume 2, sections 2.1 (REX), 2.3 (VEX) and 2.7 (EVEX). Every instruction is the shortest form that
//! GNU's assembler chooses; the test beside this file compares them.

mod choices;

pub use super::general::General;
use super::operation::{Arithmetic, Vector, Width};

/// A place in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// So many bytes behind an address.
    At(General, i32),
    /// At the sum of two addresses.
    Sum(General, General),
    /// A constant behind the code.
    Constant(u32),
}

/// What an instruction reads besides registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Read {
    Vector(Vector),
    /// As many numbers as a register has.
    Whole(Memory),
    /// One number, for all lanes.
    Single(Memory),
}

/// The prefix that is part of the code of an instruction.
#[derive(Clone, Copy)]
enum Prefix {
    /// 66, of packed numbers.
    Packed = 1,
    /// F2, of one number.
    One = 3,
}

/// The table of instructions that a code is in.
#[derive(Clone, Copy)]
enum Table {
    Of0F = 1,
    Of0F38 = 2,
    Of0F3A = 3,
}

/// A vector instruction but for its operands.
#[derive(Clone, Copy)]
struct Opcode {
    prefix: Prefix,
    table: Table,
    code: u8,
    /// The byte behind the operands, if there is one.
    behind: Option<u8>,
    mask: u8,
    /// Whether lanes that are not in the mask become 0.
    clears: bool,
}

impl Opcode {
    const fn new(prefix: Prefix, table: Table, code: u8) -> Self {
        Self {
            prefix,
            table,
            code,
            behind: None,
            mask: 0,
            clears: false,
        }
    }
}

/// Bytes in the making.
#[derive(Default)]
pub struct Bytes {
    pub all: Vec<u8>,
    /// Where the distance to a constant goes, from where it counts, and the constant.
    pub distances: Vec<(usize, usize, u32)>,
}

impl Bytes {
    pub fn extend(&mut self, bytes: impl IntoIterator<Item = u8>) {
        self.all.extend(bytes);
    }

    /// Operands behind the code: a register with one or a place; distances of one byte count in units.
    pub fn operands(&mut self, register: u8, read: Read, unit: i32, behind: Option<u8>) {
        let register = (register & 7) << 3;
        let memory = match read {
            Read::Vector(vector) => {
                self.extend([0xC0 | register | (vector.0 & 7)]);
                self.extend(behind);
                return;
            }
            Read::Whole(memory) | Read::Single(memory) => memory,
        };
        match memory {
            Memory::At(base, distance) => {
                let low = base.low();
                let sib = (low == General::Rsp.low()).then_some(0x24);
                let short = i8::try_from(distance / unit).ok();
                let short = short.filter(|_| distance % unit == 0);
                let mode = match short {
                    Some(0) if low != General::Rbp.low() => 0x00,
                    Some(_) => 0x40,
                    None => 0x80,
                };
                self.extend([mode | register | low]);
                self.extend(sib);
                match short {
                    Some(_) if mode == 0 => {}
                    Some(short) => self.extend([short as u8]),
                    None => self.extend(distance.to_le_bytes()),
                }
            }
            Memory::Sum(base, index) => {
                let sib = index.low() << 3 | base.low();
                match base.low() == General::Rbp.low() {
                    true => self.extend([0x44 | register, sib, 0]),
                    false => self.extend([0x04 | register, sib]),
                }
            }
            Memory::Constant(constant) => {
                self.extend([0x05 | register]);
                let place = self.all.len();
                let from = place + 4 + usize::from(behind.is_some());
                self.distances.push((place, from, constant));
                self.extend([0; 4]);
            }
        }
        self.extend(behind);
    }

    /// A vector instruction.
    fn vector(&mut self, width: Width, opcode: Opcode, register: u8, second: u8, read: Read) {
        match width {
            Width::Eight => self.evex(opcode, register, second, read),
            Width::Four | Width::One => self.vex(width, opcode, register, second, read),
        }
    }

    fn vex(&mut self, width: Width, opcode: Opcode, register: u8, second: u8, read: Read) {
        let (x, b) = high_bits(read);
        let long = u8::from(width == Width::Four) << 2;
        let last = (!second & 15) << 3 | long | opcode.prefix as u8;
        let r = (!register & 8) << 4;
        match opcode.table {
            Table::Of0F if x == 0 && b == 0 => self.extend([0xC5, r | last]),
            table => {
                let first = r | (x ^ 1) << 6 | (b ^ 1) << 5 | table as u8;
                self.extend([0xC4, first, last]);
            }
        }
        self.extend([opcode.code]);
        self.operands(register, read, 1, opcode.behind);
    }

    fn evex(&mut self, opcode: Opcode, register: u8, second: u8, read: Read) {
        let (x, b) = high_bits(read);
        let x = match read {
            Read::Vector(vector) => vector.0 >> 4 & 1,
            _ => x,
        };
        let first = (!register & 8) << 4
            | (x ^ 1) << 6
            | (b ^ 1) << 5
            | (!register & 16)
            | opcode.table as u8;
        // W of double precision
        let second_byte = 0x84 | (!second & 15) << 3 | opcode.prefix as u8;
        let (single, unit) = match read {
            Read::Single(_) => (0x10, 8),
            _ => (0, 64),
        };
        // a load of one number into all lanes says so by its code
        let single = if opcode.code == BROADCAST { 0 } else { single };
        let clears = u8::from(opcode.clears) << 7;
        let third = clears | 2 << 5 | single | (!second & 16) >> 1 | opcode.mask;
        self.extend([0x62, first, second_byte, third, opcode.code]);
        self.operands(register, read, unit, opcode.behind);
    }

    /// `to = left what right`
    pub fn arithmetic(
        &mut self,
        width: Width,
        what: Arithmetic,
        to: Vector,
        left: Vector,
        right: Read,
    ) {
        let prefix = match (width, what) {
            (Width::One, _) if !what.is_of_bits() => Prefix::One,
            _ => Prefix::Packed,
        };
        let code = match what {
            Arithmetic::Add => 0x58,
            Arithmetic::Mul => 0x59,
            Arithmetic::Sub => 0x5C,
            Arithmetic::Div => 0x5E,
            // AVX-512 has those of numbers in a part that not all processors have; those of integers have the same bits
            Arithmetic::Xor if width == Width::Eight => 0xEF,
            Arithmetic::And if width == Width::Eight => 0xDB,
            Arithmetic::Or if width == Width::Eight => 0xEB,
            Arithmetic::Xor => 0x57,
            Arithmetic::And => 0x54,
            Arithmetic::Or => 0x56,
            Arithmetic::Plus => 0xD4,
        };
        let opcode = Opcode::new(prefix, Table::Of0F, code);
        self.vector(width, opcode, to.0, left.0, right);
    }

    /// `to = sqrt(of)`
    pub fn sqrt(&mut self, width: Width, to: Vector, of: Vector) {
        let second = if width == Width::One { of.0 } else { 0 };
        let opcode = Opcode::new(of_numbers(width), Table::Of0F, 0x51);
        self.vector(width, opcode, to.0, second, Read::Vector(of));
    }

    /// The numbers whose places differ by xor with a distance, each in the place of the other; none of a distance that a register does
    /// not have.
    pub fn exchange(&mut self, width: Width, to: Vector, of: Vector, distance: u8) -> Option<()> {
        // neighbours, then pairs of numbers, which are named by two bits each
        let (code, behind) = match (width, distance) {
            (Width::Eight, 1) => (0x05, 0b0101_0101),
            (Width::Eight, 2) => (0x23, 0b10_11_00_01),
            (Width::Eight, 4) => (0x23, 0b01_00_11_10),
            (Width::Eight, 6) => (0x23, 0b00_01_10_11),
            (Width::Four, 1) => (0x05, 0b0101),
            (Width::Four, 2) => (0x06, 0b0000_0001),
            _ => return None,
        };
        let opcode = Opcode {
            behind: Some(behind),
            ..Opcode::new(Prefix::Packed, Table::Of0F3A, code)
        };
        let second = if distance == 1 { 0 } else { of.0 };
        self.vector(width, opcode, to.0, second, Read::Vector(of));
        Some(())
    }

    /// `to` has the bits of `of` so many places to the left, or to the right where that is negative.
    pub fn shift(&mut self, width: Width, to: Vector, of: Vector, places: i8) {
        const LEFT: u8 = 6;
        const RIGHT: u8 = 2;
        let opcode = Opcode {
            behind: Some(places.unsigned_abs()),
            ..Opcode::new(Prefix::Packed, Table::Of0F, 0x73)
        };
        let direction = if places < 0 { RIGHT } else { LEFT };
        self.vector(width, opcode, direction, to.0, Read::Vector(of));
    }

    /// `to` from memory.
    pub fn load(&mut self, width: Width, to: Vector, from: Read) {
        let opcode = match from {
            Read::Single(_) if width != Width::One => {
                Opcode::new(Prefix::Packed, Table::Of0F38, BROADCAST)
            }
            _ => Opcode::new(of_numbers(width), Table::Of0F, 0x10),
        };
        self.vector(width, opcode, to.0, 0, from);
    }

    /// `from` to memory.
    pub fn store(&mut self, width: Width, to: Memory, from: Vector) {
        let opcode = Opcode::new(of_numbers(width), Table::Of0F, 0x11);
        self.vector(width, opcode, from.0, 0, Read::Whole(to));
    }

    /// `to = from`, of one number.
    pub fn copy(&mut self, to: Vector, from: Vector) {
        // of two codes that which takes the shorter prefix
        let (code, to, from) = match from.0 > 7 && to.0 < 8 {
            true => (0x29, from, to),
            false => (0x28, to, from),
        };
        let copy = Opcode::new(Prefix::Packed, Table::Of0F, code);
        self.vector(Width::One, copy, to.0, 0, Read::Vector(from));
    }
}

const BROADCAST: u8 = 0x19;

fn of_numbers(width: Width) -> Prefix {
    match width {
        Width::Eight | Width::Four => Prefix::Packed,
        Width::One => Prefix::One,
    }
}

/// The high bits of the registers in the last operand: of the index, and of the register itself or the base.
pub fn high_bits(read: Read) -> (u8, u8) {
    match read {
        Read::Vector(vector) => (0, vector.0 >> 3 & 1),
        Read::Whole(memory) | Read::Single(memory) => match memory {
            Memory::At(base, _) => (0, base.high()),
            Memory::Sum(base, index) => (index.high(), base.high()),
            Memory::Constant(_) => (0, 0),
        },
    }
}
