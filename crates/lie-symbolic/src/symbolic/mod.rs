//! Symbolic expressions: an interned arena with normalising constructors and exact calculus.

mod calculus;
mod display;
mod evaluate;
mod fractions;
mod function;
mod graph;
mod opaque;
mod parts;
mod power;
mod slope;
mod written;

#[cfg(test)]
mod tests;

pub use function::{Function, chosen};
pub use graph::{ExprId, Graph, Node, Symbol};
pub use lie_core::Elementary;
pub use opaque::{Declared, MOST_ARGUMENTS, Opaque};
