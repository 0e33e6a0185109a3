//! Lie algebras over the rationals (or rational functions of exact parameters): lowering of
//! brackets, the identities that they must satisfy, matrix representations, ranks.

pub mod antisymmetry;
pub mod brackets;
pub mod cayley;
mod constants;
mod envelope;
mod field;
pub mod jacobi;
pub mod moving;
pub mod quadratic;
pub mod rank;
pub mod representation;
pub mod ring;
pub mod rotating;
mod sparse;
mod triple;
pub mod written;

#[cfg(test)]
pub(crate) mod known;
#[cfg(test)]
mod tests;

pub use constants::StructureConstants;
pub use envelope::Columns;
pub use representation::{Parametric, Representation, TripleEntry};
