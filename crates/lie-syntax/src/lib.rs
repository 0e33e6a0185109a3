//! Declarations as they are written: tokens of a macro and JSON specs in, syntax trees and diagnostics with places out.
//!
//! [`front`] reads both forms into one [`ast::Declaration`]; [`constructors`] are the algebras that have a name; [`linear`] are
//! the linear forms of brackets and matrices; [`diagnostic`] is what is said of a mistake, at its place and with a remedy.

pub mod ast;
pub mod characters;
pub mod constructors;
pub mod diagnostic;
pub mod front;
mod hints;
pub mod limits;
pub mod linear;
pub mod suggest;
