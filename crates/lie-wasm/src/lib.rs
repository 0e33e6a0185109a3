//! WebAssembly for the codes of [`lie_dynamic`]: the bytes of a module, for whoever has something that runs them.
//!
//! One function for each code, with the operations in their order: the digits are those of the interpreter. WebAssembly rounds
//! each operation as IEEE 754 says, and has no fused multiply-add and no elementary functions. Those that are programs are written out in
//! its own instructions. The others are imports of the module, and so is what few arguments of a program ask for; the host gives it those of
//! the numeric core ([`Import::host`]).
//!
//! # The module
//!
//! It imports the memory `lie.memory`, and the elementary functions that its codes call, from `lie` too, by their names. It exports
//! the function of the code at position k under [`export_name`]`(k)`, with three addresses as parameters: those of a table, a
//! vector and a matrix.
//!
//! - The table has the addresses of the slices of [`Frame::slices`](lie_dynamic::Frame::slices), each as an i32. What a code does not
//!   read may be any number.
//! - Slices are f64s one behind the other; vector and matrix are those of [`Targets`](lie_dynamic::Targets). Where a code
//!   clears a target first, its function does.
//!
//! Lengths are the caller's: [`Lengths`](lie_dynamic::Lengths) compares them.
//!
//! ```
//! use lie_dynamic::{Code, Instruction, Source, Store};
//!
//! // the second of two arguments, less its sine
//! let code = Code {
//!     sources: vec![Source::Argument(0, 1)],
//!     instructions: vec![
//!         Instruction::Call(lie_runtime::Elementary::Sin, 0),
//!         Instruction::Sub(0, 1),
//!     ],
//!     stores: vec![Store { target: 0, entry: 0, register: 2 }],
//!     registers: 3,
//!     clear: [None, None],
//! };
//! let module = lie_wasm::module(&[code]);
//! assert_eq!(module.bytes[..4], *b"\0asm");
//! assert_eq!(module.compiled, [true]);
//! assert_eq!(module.imports[0].name, "sin");
//! ```

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod body;
mod host;
mod module;

pub use host::{Family, Host};
pub use module::{Import, LONGEST, MEMORY, Module, NAMESPACE, export_name, module};
