//! The body of the macro, from tokens to the syntax tree.

#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|text: &str| -> Corpus {
    match lie_fuzz::read_declaration(text) {
        true => Corpus::Keep,
        false => Corpus::Reject,
    }
});
