//! Through the whole compiler: what passes the checks must become Rust.

use std::path::Path;

use lie_codegen::compile::{compile_spec, generate, with_options};
use lie_codegen::expand::expand_macro;
use lie_codegen::methods::{CATALOGUE, Choice};
use lie_codegen::structure::Structure;
use proc_macro2::TokenStream;
use proc_macro2::extra::invalidate_current_thread_spans;

use crate::told;

/// Fused code of all methods is made of systems up to this dimension, and of the others that of some:
/// more would take a second for each input.
const SMALL: usize = 4;

/// A spec file, from bytes to generated code: mistakes are diagnostics with a place inside the text,
/// and what passes the checks becomes Rust.
pub fn spec(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    match compile_spec(text) {
        Ok(model) => {
            let tokens = generate(&model, &choices(&model));
            assert!(
                syn::parse2::<syn::File>(tokens).is_ok(),
                "the generated code is no Rust"
            );
        }
        Err(diagnostics) => told(&diagnostics, text),
    }
}

/// Every method that applies, with every option: of a large system those of the lowest order.
pub(crate) fn choices(model: &Structure) -> Vec<Choice> {
    let ids = CATALOGUE
        .iter()
        .filter(|m| model.dimension() <= SMALL || m.order <= 2)
        .map(|m| m.id);
    let composed = ["compose4(lie-midpoint)", "compose8(splitting2)"];
    let choices = ids
        .chain(composed)
        .filter_map(|id| Choice::from_id(id).ok());
    with_options(model, &choices.collect::<Vec<_>>())
}

/// The body of the macro, from tokens to items: whatever stands there, the expansion is Rust. Whether
/// the text could be the body of a macro at all.
pub fn declaration(text: &str) -> bool {
    // What Rust's own lexer refuses never reaches a macro; a spec by path is another target.
    invalidate_current_thread_spans();
    let Ok(tokens) = text.parse::<TokenStream>() else {
        return false;
    };
    if text.contains("spec") {
        return false;
    }
    let expanded = expand_macro(tokens, Path::new("nowhere"));
    assert!(!expanded.is_empty(), "no items and no error");
    assert!(
        syn::parse2::<syn::File>(expanded).is_ok(),
        "the expansion is no Rust"
    );
    true
}
