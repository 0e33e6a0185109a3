//! What the targets do with an input: an input that panics, hangs or eats memory is a bug, and what
//! passes the checks must become Rust.

use std::path::Path;

use lie_codegen::compile::{compile_spec, generate, with_options};
use lie_codegen::expand::expand_macro;
use lie_codegen::methods::{CATALOGUE, Choice};
use lie_codegen::structure::Structure;
use lie_syntax::diagnostic::Origin;
use proc_macro2::TokenStream;

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
        Err(diagnostics) => {
            assert!(
                diagnostics.iter().any(|d| !d.warning),
                "refused without an error"
            );
            for diagnostic in diagnostics {
                assert!(
                    !diagnostic.message.is_empty()
                        && diagnostic.help.is_some_and(|h| !h.is_empty())
                );
                if let Some(Origin::Text { start, end }) = diagnostic.origin {
                    assert!(
                        start <= end && end <= text.len(),
                        "{start}..{end} of {}",
                        text.len()
                    );
                    assert!(text.is_char_boundary(start) && text.is_char_boundary(end));
                }
            }
        }
    }
}

/// Every method that applies, with every option: of a large system those of the lowest order.
fn choices(model: &Structure) -> Vec<Choice> {
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
    // What Rust's own lexer refuses never reaches a macro; a spec by path is the other target.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn files(folder: &str) -> Vec<Vec<u8>> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let entries = std::fs::read_dir(folder).expect("the folder");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        let files = paths.filter(|path| path.is_file());
        files
            .map(|path| std::fs::read(path).expect("a file"))
            .collect()
    }

    #[test]
    fn seeds_of_the_declarations() {
        let texts = files("seeds/declaration");
        let texts = texts
            .iter()
            .filter_map(|bytes| std::str::from_utf8(bytes).ok());
        assert!(texts.filter(|text| declaration(text)).count() > 0);
    }

    /// The choices are all there are: every method applies to one of these systems.
    #[test]
    fn seeds_of_the_specs() {
        let mut seen = std::collections::BTreeSet::new();
        for bytes in files("../../specs")
            .into_iter()
            .chain(files("../../tests/data/declarations/pass"))
        {
            spec(&bytes);
            let Ok(model) = compile_spec(std::str::from_utf8(&bytes).expect("UTF-8")) else {
                continue;
            };
            seen.extend(choices(&model).iter().map(Choice::id));
        }
        for method in CATALOGUE {
            let composed = method.id.starts_with("compose");
            assert!(composed || seen.contains(method.id), "{}", method.id);
        }
        files("../../tests/data/declarations/fail")
            .iter()
            .for_each(|bytes| spec(bytes));
    }
}
