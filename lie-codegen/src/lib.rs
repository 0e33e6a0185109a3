//! The compiler of lie-poisson.
pub mod algebra;
pub mod ast;
pub mod derive;
pub mod diagnostic;
pub mod exact;
pub mod front;
pub mod schedule;
pub mod suggest;
pub mod symbolic;
