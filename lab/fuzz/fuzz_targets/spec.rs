//! A spec file, from bytes to generated code.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| lie_fuzz::spec(bytes));
