//! The library part of the root package: what the `lie` command, the examples and the tests share.

pub mod plot;
