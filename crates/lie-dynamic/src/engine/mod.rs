//! What runs codes: the interface of an engine, what codes and their callers agree on, and the engine that needs no compiler.

mod chain;
mod elementary;
mod interpreter;
mod layout;
mod machine;

pub use chain::{BETWEEN, Chain, Next, OF_STEP, Separate, Stop};
pub use elementary::{BINARY, Binary, UNARY, Unary};
pub use interpreter::{Interpreted, Interpreter, phi, stumpff};
pub use layout::Lengths;
pub use machine::{
    ARGUMENTS, AROUND, Engine, Frame, Machine, SLICES, Targets, in_turns, place_by_place,
};
