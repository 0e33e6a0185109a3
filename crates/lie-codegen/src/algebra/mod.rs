//! Lie algebras over the rationals (or rational functions of exact parameters): lowering of
//! brackets, the identities that they must satisfy, matrix representations, ranks.

pub mod brackets;
mod constants;
pub mod constructors;
mod envelope;
pub mod jacobi;
mod linear;
pub mod quadratic;
pub mod rank;
pub mod representation;
mod ring;
mod scope;
mod sparse;
mod triple;
pub(crate) mod walk;

#[cfg(test)]
pub(crate) mod known;
#[cfg(test)]
mod tests;

pub use constants::StructureConstants;
pub use envelope::Columns;
pub use linear::{rational, rational_form};
pub use representation::{Representation, TripleEntry};
pub use scope::Scope;

/// Work allowed for the exact checks of one algebra: seconds, not minutes.
pub(crate) const WORK: u64 = 20_000_000;
