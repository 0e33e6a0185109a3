//! The body of the macro, from tokens to items: whatever stands there, the expansion is Rust.

#![no_main]

use std::path::Path;

use libfuzzer_sys::{Corpus, fuzz_target};
use lie_codegen::expand::expand_macro;
use proc_macro2::TokenStream;

fuzz_target!(|text: &str| -> Corpus {
    // What Rust's own lexer refuses never reaches a macro; a spec by path is the other target.
    let Ok(tokens) = text.parse::<TokenStream>() else { return Corpus::Reject };
    if text.contains("spec") {
        return Corpus::Reject;
    }
    let expanded = expand_macro(tokens, Path::new("nowhere"));
    assert!(!expanded.is_empty(), "no items and no error");
    assert!(syn::parse2::<syn::File>(expanded).is_ok(), "the expansion is no Rust");
    Corpus::Keep
});
