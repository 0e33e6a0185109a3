//! What a built program says.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| lie_fuzz::messages(bytes));
