//! The bytes of instructions are those of GNU's assembler; what a program computes is what the interpreter does; what computes anything
//! else is refused.

mod chains;
mod encoding;
mod memory;
mod programs;

#[path = "../../../../../tests/common/random.rs"]
mod random;
