//! A spec file, from bytes to generated code: mistakes are diagnostics with a place inside the
//! text, and what passes the checks becomes Rust.

#![no_main]

use libfuzzer_sys::fuzz_target;
use lie_codegen::compile::{compile_spec, generate};
use lie_codegen::diagnostic::Origin;
use lie_codegen::methods::{Choice, Retraction, refusal};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match compile_spec(text) {
        Ok(model) => {
            let mut choices = vec![
                Choice::Midpoint,
                Choice::Gauss(2),
                Choice::Gauss(3),
                Choice::LieMidpoint(Retraction::Exp),
                Choice::LieMidpoint(Retraction::Cayley),
            ];
            choices.retain(|choice| refusal(&model, *choice).is_none());
            let tokens = generate(&model, &choices).tokens;
            assert!(syn::parse2::<syn::File>(tokens).is_ok(), "the generated code is no Rust");
        }
        Err(diagnostics) => {
            assert!(diagnostics.iter().any(|d| !d.warning), "refused without an error");
            for diagnostic in diagnostics {
                assert!(!diagnostic.message.is_empty() && diagnostic.help.is_some_and(|h| !h.is_empty()));
                if let Some(Origin::Text { start, end }) = diagnostic.origin {
                    assert!(start <= end && end <= text.len(), "{start}..{end} of {}", text.len());
                    assert!(text.is_char_boundary(start) && text.is_char_boundary(end));
                }
            }
        }
    }
});
