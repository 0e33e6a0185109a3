//! The engines that run a plan: interpreter, machine code, WebAssembly and what rustc compiles give the same bits.

#[path = "../common/bits.rs"]
mod bits;
#[path = "../common/cpython/mod.rs"]
mod cpython;
#[path = "../common/random.rs"]
mod random;
#[path = "../../crates/lie-wasm/tests/wasmi_engine/mod.rs"]
mod wasmi_engine;

mod families;
mod systems;
