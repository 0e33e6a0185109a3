//! The program of the example runs, as everybody would start it.

use std::process::Command;

#[test]
fn both_forms_of_the_method_are_compared() {
    let run = Command::new(env!("CARGO_BIN_EXE_own-method"))
        .output()
        .expect("it starts");
    assert!(run.status.success(), "{run:?}");
    assert!(!run.stdout.is_empty(), "it says what it found");
}
