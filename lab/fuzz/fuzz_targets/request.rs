//! What is asked of runs, as JSON.

#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|text: &str| -> Corpus {
    match lie_fuzz::request(text) {
        true => Corpus::Keep,
        false => Corpus::Reject,
    }
});
