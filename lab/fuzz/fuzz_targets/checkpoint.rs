//! What `lie resume` reads.

#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|bytes: &[u8]| -> Corpus {
    match lie_fuzz::checkpoint(bytes) {
        true => Corpus::Keep,
        false => Corpus::Reject,
    }
});
