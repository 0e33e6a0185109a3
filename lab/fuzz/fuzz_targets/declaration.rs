//! The body of the macro, from tokens to items.

#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|text: &str| -> Corpus {
    match lie_fuzz::declaration(text) {
        true => Corpus::Keep,
        false => Corpus::Reject,
    }
});
