//! The two front ends: macro tokens and JSON specs become one syntax tree.
//!
//! [`spec::read`] reads the text of a spec file, [`declaration::parse`] the body of the macro.
//! Both turn expressions into the same tokens and give them to the same parser, so that an
//! expression means the same in both.

pub mod declaration;
pub mod file;
pub mod names;
pub mod npy;
pub mod spec;
pub mod vocabulary;

pub mod place;

mod attitude;
mod driving;
mod entries;
mod equations;
mod expression;
mod families;
pub mod habits;
mod item;
mod json;
mod mistakes;
mod named;
mod number;
mod object;
mod operand;
mod piecewise;
mod prose;
mod reader;
mod retraction;
mod rust;
mod schema;
mod tables;
mod text;
mod token;
mod vectors;

pub use names::{Names, PIECEWISE};
pub use place::line_column;
pub use schema::schema;

use crate::ast::Runtime;
use crate::ast::{Declaration, Expr, Name};
use crate::diagnostic::{Diagnostic, Kind, Report};
use proc_macro2::TokenStream;
use text::Source;

/// What a front end made of its input. What it found is there even where the whole is not, so
/// that a stub of the type can stand in for a broken declaration.
#[derive(Clone, Debug, Default)]
pub struct Parsed {
    /// Visibility tokens (`pub`, `pub(crate)`, nothing); `pub` for specs.
    pub visibility: TokenStream,
    /// Where the generated code finds the runtime.
    pub runtime: Runtime,
    /// Name of the system.
    pub name: Option<Name>,
    /// Names of the coordinates, as far as they could be read.
    pub state: Vec<Name>,
    /// The indices of these names, of a family.
    pub indices: Vec<Name>,
    /// Number of coordinates, those with unreadable names included.
    pub dimension: usize,
    /// Names of the parameters, as far as they could be read.
    pub parameters: Vec<Name>,
    /// The whole, if nothing was wrong.
    pub body: Option<Body>,
}

/// What stands in a macro.
#[derive(Clone, Debug)]
pub enum Body {
    /// A declaration.
    Declaration(Box<Declaration>),
    /// `spec = "path";`, the path relative to the manifest.
    Spec {
        /// The path as written, and its place.
        path: Name,
    },
}

/// Parses expression text that stands from byte `offset` of its file (or argument) on; `names`
/// may stand in it. `None` if anything was reported; blank text is a `syntax` error.
pub fn parse_expression_text(
    text: &str,
    offset: usize,
    names: &Names,
    report: &mut Report,
) -> Option<Expr> {
    let source = Source::plain(text, offset);
    let tokens = source.tokens();
    if tokens.is_empty() {
        report.push(
            Diagnostic::new(Kind::Syntax, source.extent(), "an expression is missing")
                .help("write one, such as x^2/2"),
        );
        return None;
    }
    expression::parse(&tokens, names, report)
}

/// Parses an exact constant (`1/7`, `-1/2`, `cos(11/10)`): numbers, `pi` and functions only.
/// Blank text and names are `number` errors.
pub fn parse_constant_text(text: &str, offset: usize, report: &mut Report) -> Option<Expr> {
    let source = Source::plain(text, offset);
    let tokens = source.tokens();
    if tokens.is_empty() {
        report.push(item::missing_constant(source.extent()));
        return None;
    }
    item::constant(&tokens, report)
}

#[cfg(test)]
mod tests;
