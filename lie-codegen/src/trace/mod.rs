//! Methods are stated once, in `lie_core::generic`, for any scalar. Here the scalar is an expression: to run an equation
//! over it is to write its formula down, and what is written down is differentiated, scheduled and printed.
//!
//! A trace has one path. An equation that compares numbers has several, and is refused; it runs as it is, or
//! marks what it compares as given from outside.

mod equation;
mod sym;
mod system;

pub use equation::{Formulas, Step, kernels, step};
pub use sym::Sym;
pub use system::{Square, SymbolicSystem};
