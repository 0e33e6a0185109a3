//! Systems made at run time: a declaration becomes a system that every method runs on, without a compiler of Rust.
//!
//! The compiler ends in a [`Plan`](lie_codegen::plan::Plan): straight-line programs with what surrounds them. The macro prints it as Rust.
//! Here each program becomes a [`Code`] over registers, which an [`Engine`] runs: the interpreter
//! [`Interpreted`], for every scalar, machine code (crate `lie-jit`), or WebAssembly (crate `lie-wasm`). [`Dynamic`] implements the traits of the
//! numeric core over states on the heap, so that each method is compiled once for all systems.
//!
//! The order of operations, the constants and the elementary functions are those of the printed code: a step gives the same
//! bits.
//!
//! ```
//! use lie_dynamic::{Dynamic, Interpreted, method};
//! use lie_codegen::{compile::compile_spec, methods::Choice, plan::plan};
//! use lie_runtime::{Poisson, newton::NewtonOptions};
//!
//! let spec = r#"{ "format": 1, "name": "Body", "algebra": "so(3)", "state": ["x", "y", "z"],
//!                 "hamiltonian": "x^2/2 + y^2/4 + z^2/6" }"#;
//! let model = compile_spec(spec).map_err(|errors| format!("{errors:?}"))?;
//! let midpoint = Choice::from_id("midpoint").map_err(|error| error.message)?;
//! let system = Dynamic::new(plan(&model, std::slice::from_ref(&midpoint)), &[], &Interpreted)?;
//! let method = method(&midpoint, Default::default());
//! let mut stepper = method.any_stepper(&system, 0.1, &NewtonOptions::default());
//! let mut mu = vec![0.3, -0.4, 1.2];
//! let energy = system.hamiltonian(&mu);
//! stepper.step(&mut mu).map_err(|failure| format!("{failure:?}"))?;
//! assert!((system.hamiltonian(&mu) - energy).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
    AROUND, BINARY, Binary, Engine, Frame, Interpreted, Interpreter, Lengths, Machine, SLICES,
    Targets, UNARY, Unary, in_turns, phi, place_by_place, stumpff,
};
pub use lie_runtime::methods::Tolerances;
pub use methods::{
    Method, at_defaults, at_defaults_over, is_compiled_for_lanes, method, method_in_lanes,
    method_over,
};
pub use recording::PATIENCE;
pub use system::{Declared, Dynamic};
