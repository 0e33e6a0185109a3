//! A file of initial states.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| lie_fuzz::initial_file(bytes));
