//! What is seldom done stands behind the end of a function: calls for the few arguments that a program is not for.
//!
//! The rest of the function is written as if there were no call. What registers hold is kept in the frame, and comes back.

use super::calls::rare;
use super::encoding::{General, Memory, Read};
use super::function::{FIRST, Writer};
use super::operation::{Vector, Width};
use lie_dynamic::Unary;

/// A function that is seldom called.
pub struct Aside {
    /// The jump that goes there, and where it comes back to.
    pub jump: usize,
    pub back: usize,
    pub value: Vector,
    pub x: Vector,
    pub test: Vector,
    pub function: Unary,
    pub kept: u32,
}

impl Writer<'_> {
    /// The calls of functions that are seldom called.
    pub fn asides(&mut self) -> Option<()> {
        let width = self.layout.width;
        let first = self.program.shared + self.program.slots;
        for aside in std::mem::take(&mut self.asides) {
            self.bytes.land(aside.jump);
            let kept: Vec<(Memory, Vector)> = (0..width.registers())
                .filter(|register| aside.kept & (1 << register) != 0)
                .zip(first..)
                .map(|(register, place)| {
                    let offset = place.checked_mul(width.bytes())?;
                    let at = Memory::At(General::Rsp, i32::try_from(offset).ok()?);
                    Some((at, Vector(register)))
                })
                .collect::<Option<_>>()?;
            for (at, register) in &kept {
                self.bytes.store(width, *at, *register);
            }
            let shared = Memory::At(General::Rsp, 0);
            if width == Width::One {
                self.bytes.copy(FIRST, aside.x);
                self.call_of_numbers(aside.function as *const () as u64);
            } else {
                for (place, given) in (0..).zip([aside.x, aside.test, aside.value]) {
                    let to = Memory::At(General::Rsp, place * width.bytes() as i32);
                    self.bytes.store(width, to, given);
                }
                let function = aside.function as *const () as u64;
                self.call_helper(rare as *const () as u64, function);
            }
            self.load_arguments();
            self.bytes.load(width, aside.value, Read::Whole(shared));
            for (at, register) in &kept {
                self.bytes.load(width, *register, Read::Whole(*at));
            }
            self.bytes.jump_back(aside.back);
        }
        Some(())
    }
}
