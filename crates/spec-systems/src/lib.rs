//! The systems of `specs/`, a module each, with fused code of every method that applies: generated once, when this
//! crate is built, for all tests and benchmarks.

// Generated code is laid out by its own printer.
#![allow(missing_docs)]

pub mod methods;

include!(concat!(env!("OUT_DIR"), "/systems.rs"));

/// The same systems with the fused code of generating functions.
pub mod generating {
    include!(concat!(env!("OUT_DIR"), "/generating.rs"));
}
