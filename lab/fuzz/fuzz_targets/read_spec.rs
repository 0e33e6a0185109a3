//! A spec file, from bytes to the syntax tree.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| lie_fuzz::read_spec(bytes));
