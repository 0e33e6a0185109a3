//! The words of the expression language as lists, from the tables that the parser reads: for documents.

pub use super::habits::functions as elsewhere;
pub use super::names::Function;

/// The functions of scalars.
pub fn functions() -> &'static [Function] {
    super::names::FUNCTIONS
}

/// The functions of vectors and matrices.
pub fn vector_functions() -> &'static [Function] {
    super::vectors::FUNCTIONS
}

/// The names that stand for a value without being declared.
pub fn built_in() -> &'static [&'static str] {
    super::names::BUILT_IN
}
