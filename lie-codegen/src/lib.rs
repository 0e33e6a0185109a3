//! The compiler of lie-poisson.
pub mod algebra;
pub mod ast;
pub mod check;
pub mod compile;
pub mod derive;
pub mod diagnostic;
pub mod emit;
pub mod exact;
pub mod expand;
pub mod front;
pub mod golden;
pub mod methods;
pub mod model;
pub mod schedule;
pub mod suggest;
pub mod symbolic;
