//! The compiler of lie-poisson.
pub mod ast;
pub mod diagnostic;
pub mod exact;
pub mod schedule;
pub mod symbolic;
