//! The declarations of a Rust source file: what stands in `lie_poisson! { … }`.

use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};

use super::{REMEDY, message};
use crate::compile::{compile_declaration, declared_choices, expand_on};
use crate::print::Surface;
use lie_syntax::diagnostic::{Diagnostic, MOST_SHOWN, Origin, Report, not_shown};
use lie_syntax::front::{Body, declaration};

/// A declaration of a source file: the name of its system and its generated code, or the path of the spec that it names.
pub(super) enum Declared {
    /// The system's name, and the code.
    Code(String, String),
    /// The path, from the folder of the manifest.
    Spec(String),
}

/// All declarations of a source file in their order, or what is wrong.
pub(super) fn declarations(path: &Path) -> Result<Vec<Declared>, String> {
    let place = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| format!("{place}: {error}"))?;
    let tokens: TokenStream = text
        .parse()
        .map_err(|error| format!("{place}: this is not Rust: {error}"))?;
    let mut found = Vec::new();
    invocations(tokens, &mut found);
    if found.is_empty() {
        let help = "name a file with `lie_poisson! { … }` in it";
        return Err(format!("{place}: no declaration{REMEDY}{help}"));
    }
    found
        .into_iter()
        .map(|input| declared(&place.to_string(), input))
        .collect()
}

/// What the macro is called with, wherever that is.
fn invocations(tokens: TokenStream, found: &mut Vec<TokenStream>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    for (index, token) in tokens.iter().enumerate() {
        let TokenTree::Group(group) = token else {
            continue;
        };
        let before = |back: usize| {
            index
                .checked_sub(back)
                .map(|index| tokens[index].to_string())
        };
        match (before(2).as_deref(), before(1).as_deref()) {
            (Some("lie_poisson"), Some("!")) => found.push(group.stream()),
            _ => invocations(group.stream(), found),
        }
    }
}

fn declared(place: &str, input: TokenStream) -> Result<Declared, String> {
    let mut report = Report::new();
    let parsed = declaration::parse(input, &mut report);
    let refused = |diagnostics: Vec<Diagnostic>| {
        let errors = diagnostics.iter().filter(|d| !d.warning);
        let rest = not_shown(errors.clone().count());
        let shown = errors.take(MOST_SHOWN).map(|d| {
            let place = match d.origin {
                Some(Origin::Span(id)) => {
                    let start = id.span().start();
                    format!("{place}:{}:{}", start.line, start.column + 1)
                }
                _ => place.to_owned(),
            };
            message(&place, d)
        });
        shown.chain(rest).collect::<Vec<_>>().join("\n")
    };
    report.gate().map_err(refused)?;
    match &parsed.body {
        Some(Body::Declaration(declaration)) => {
            let structure = compile_declaration(declaration).map_err(refused)?;
            let choices = declared_choices(&structure);
            let surface = Surface::new(&structure).as_declared(&parsed);
            Ok(Declared::Code(
                structure.name.clone(),
                expand_on(&structure, &choices, &surface),
            ))
        }
        Some(Body::Spec { path }) => Ok(Declared::Spec(path.text.clone())),
        None => Err(refused(report.into_diagnostics())),
    }
}
