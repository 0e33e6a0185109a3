//! Bytes of the few instructions of x86-64 on general registers: addresses, frames, loops, calls.

use super::encoding::{Bytes, Memory, Read, high_bits};

/// A general register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum General {
    Rax,
    Rcx,
    Rdx,
    Rbx,
    Rsp,
    Rbp,
    Rsi,
    Rdi,
    R8,
    R9,
    R10,
    R11,
    R12,
    R13,
    R14,
}

impl General {
    pub const fn low(self) -> u8 {
        self as u8 & 7
    }
    pub const fn high(self) -> u8 {
        self as u8 >> 3
    }
}

impl Bytes {
    /// What other code expects between its own instructions and these.
    pub fn clear_upper_halves(&mut self) {
        self.extend([0xC5, 0xF8, 0x77]);
    }

    /// `to = [from]`
    pub fn load_word(&mut self, to: General, from: Memory) {
        self.word(0x8B, to, from);
    }

    /// `[to] = from`
    pub fn store_word(&mut self, to: Memory, from: General) {
        self.word(0x89, from, to);
    }

    /// `to = to & [with]`
    pub fn and_word(&mut self, to: General, with: Memory) {
        self.word(0x23, to, with);
    }

    /// `to = to | [with]`
    pub fn or_word(&mut self, to: General, with: Memory) {
        self.word(0x0B, to, with);
    }

    fn word(&mut self, code: u8, register: General, memory: Memory) {
        let (x, b) = high_bits(Read::Whole(memory));
        self.extend([0x48 | register.high() << 2 | x << 1 | b, code]);
        self.operands(register as u8, Read::Whole(memory), 1, None);
    }

    /// `to = from`
    pub fn copy_word(&mut self, to: General, from: General) {
        self.extend([
            0x48 | from.high() << 2 | to.high(),
            0x89,
            0xC0 | from.low() << 3 | to.low(),
        ]);
    }

    /// `to = word`, in ten bytes.
    pub fn word_constant(&mut self, to: General, word: u64) {
        self.extend([0x48 | to.high(), 0xB8 | to.low()]);
        self.extend(word.to_le_bytes());
    }

    pub fn push(&mut self, register: General) {
        self.extend((register.high() == 1).then_some(0x41));
        self.extend([0x50 | register.low()]);
    }

    pub fn pop(&mut self, register: General) {
        self.extend((register.high() == 1).then_some(0x41));
        self.extend([0x58 | register.low()]);
    }

    /// `register = register & -64`
    pub fn align(&mut self, register: General) {
        self.extend([0x48 | register.high(), 0x83, 0xE0 | register.low(), 0xC0]);
    }

    /// `register = register - bytes`
    pub fn subtract(&mut self, register: General, bytes: u32) {
        self.with_number(0xE8, register, bytes as i32);
    }

    /// `register = register + bytes`
    pub fn add(&mut self, register: General, bytes: u32) {
        self.with_number(0xC0, register, bytes as i32);
    }

    fn with_number(&mut self, code: u8, register: General, number: i32) {
        let rex = 0x48 | register.high();
        match i8::try_from(number) {
            Ok(short) => self.extend([rex, 0x83, code | register.low(), short as u8]),
            Err(_) if register == General::Rax => {
                self.extend([rex, code & 0x38 | 0x05]);
                self.extend(number.to_le_bytes());
            }
            Err(_) => {
                self.extend([rex, 0x81, code | register.low()]);
                self.extend(number.to_le_bytes());
            }
        }
    }

    /// Touches the number at an address and changes nothing.
    pub fn touch(&mut self, at: General) {
        // or qword ptr [at], 0
        let memory = Memory::At(at, 0);
        self.extend([0x48 | at.high(), 0x83]);
        self.operands(1, Read::Whole(memory), 1, Some(0));
    }

    /// `register = 0`
    pub fn zero(&mut self, register: General) {
        let high = register.high();
        self.extend((high == 1).then_some(0x45));
        self.extend([0x31, 0xC0 | register.low() << 3 | register.low()]);
    }

    /// Calls what is at an address.
    pub fn call(&mut self, at: General) {
        self.extend((at.high() == 1).then_some(0x41));
        self.extend([0xFF, 0xD0 | at.low()]);
    }

    /// Compares two registers.
    pub fn compare(&mut self, left: General, right: General) {
        self.extend([
            0x48 | right.high() << 2 | left.high(),
            0x39,
            0xC0 | right.low() << 3 | left.low(),
        ]);
    }

    /// Goes to a place before this one where the left of two numbers without sign was below the right.
    pub fn jump_if_below(&mut self, to: usize) {
        self.extend([0x0F, 0x82]);
        let distance = to as i64 - (self.all.len() as i64 + 4);
        self.extend((distance as i32).to_le_bytes());
    }

    /// Jumps where a register is 0, to where the bytes [land](Self::land) later; the place of the distance.
    pub fn jump_if_zero(&mut self, register: General) -> usize {
        let high = register.high();
        self.extend([
            0x48 | high << 2 | high,
            0x85,
            0xC0 | register.low() << 3 | register.low(),
        ]);
        self.extend([0x0F, 0x84, 0, 0, 0, 0]);
        self.all.len() - 4
    }

    /// Goes to an address.
    pub fn jump(&mut self, at: General) {
        self.extend((at.high() == 1).then_some(0x41));
        self.extend([0xFF, 0xE0 | at.low()]);
    }

    /// `to = base - bytes`, for the end of a function.
    pub fn address_below(&mut self, to: General, base: General, bytes: u8) {
        let memory = Memory::At(base, -i32::from(bytes));
        self.word(0x8D, to, memory);
    }

    pub fn return_(&mut self) {
        self.extend([0xC3]);
    }
}
