//! An assembler for straight-line codes, over registers of eight numbers (AVX-512), four or one (AVX2).
//!
//! A code goes through small parts. [`allocation`] decides which register of the processor holds what, [`check`] follows the
//! result from the code alone and refuses what does anything else, [`function`] adds the frame and the loop, and [`encoding`] and
//! [`general`] have the bytes of the instructions. Operations stay in their order, and none is contracted to a fused multiply-add: the bits
//! are those of the interpreter. Elementary functions that are programs stand written out in the code, and a call for the few arguments that
//! they are not for behind the end of the function ([`asides`]); the others are called lane by lane ([`calls`]). Parts of a step jump one into another
//! ([`chain`]).
//!
//! The time is proportional to the length of a code.

mod allocation;
mod asides;
mod calls;
pub mod chain;
mod check;
mod encoding;
mod function;
mod general;
pub mod making;
mod operation;
mod pages;
#[cfg(test)]
mod tests;
mod uses;

use operation::{Layout, Width};
use pages::Pages;

use lie_dynamic::Code;

/// Longer codes are left to others: what they hold at a time no longer fits into caches.
const LONGEST: usize = 200_000;

/// The function of a code, with its constants; none where it is not for this assembler.
pub fn assemble(code: &Code, layout: Layout) -> Option<Vec<u8>> {
    if code.instructions.len() > LONGEST {
        return None;
    }
    let program = allocation::allocate(code, layout);
    let right = check::computes(&program, code, layout);
    debug_assert!(right, "registers are allocated as the code says");
    right.then(|| function::function(&program, layout))?
}
