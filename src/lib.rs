//! The library part of the root package: what the examples and the tests share, and the `lie` command, which is compiled here while the
//! crates that it stands on become machine code. A program would wait for that.

mod build;
mod command;
mod compiler;
mod interrupt;
mod message;
mod process;
mod render;

pub use lie_plot as plot;
pub use process::main;

/// The code of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;

/// The code of the page on declarations.
#[cfg(doctest)]
#[doc = include_str!("../docs/declaration.md")]
pub struct DeclarationPage;

/// The code of the book's tutorial in Rust.
#[cfg(doctest)]
#[doc = include_str!("../docs/book/src/tutorials/engineer.md")]
pub struct BookEngineer;

/// The code of the book's page on the language.
#[cfg(doctest)]
#[doc = include_str!("../docs/book/src/reference/language.md")]
pub struct BookLanguage;
