//! Systems made at run time: a declaration becomes a system that every method runs on, without a compiler of Rust.
//!
//! The compiler ends in a [`Plan`](lie_codegen::plan::Plan): straight-line programs with what surrounds them. The macro prints it as Rust.
//! Here each program becomes a [`Code`] over registers, which an [`Engine`] runs: the interpreter
//! [`Interpreted`], for every scalar, machine code (crate `lie-jit`), or WebAssembly (crate `lie-wasm`). [`Dynamic`] implements the traits of the
//! numeric core over states on the heap, so that each method is compiled once for all systems: over numbers in `lie-methods`, over dual numbers in
//! `lie-tangents`, over a scalar that records what a step does here.
//!
//! The order of operations, the constants and the elementary functions are those of the printed code: a step gives the same
//! bits.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod cache;
mod code;
mod compiled;
mod engine;
mod equations;
mod methods;
mod recording;
mod system;

pub use cache::Cache;
pub use code::{Bitwise, Code, Instruction, Number, Register, Source, Store};
pub use engine::{
    AROUND, BETWEEN, BINARY, Binary, Chain, Engine, Frame, Interpreted, Interpreter, Lengths,
    Machine, Next, OF_STEP, SLICES, Separate, Stop, Targets, UNARY, Unary, in_turns, phi,
    place_by_place, stumpff,
};
pub use lie_runtime::methods::Tolerances;
pub use methods::{
    Method, at_defaults_over, composition, explicit, has_equation, is_compiled_for_lanes,
    method_over,
};
pub use recording::{PATIENCE, RecordedMethod, TracedInLanes, TracedMethod};
pub use system::{Declared, Dynamic};
