//! An array of NumPy.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| lie_fuzz::npy(bytes));
