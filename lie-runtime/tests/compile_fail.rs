//! Broken macros: every error at the offending token, and none in the code that uses the type.
//!
//! After a change of a message, `TRYBUILD=overwrite cargo test -p lie-runtime --test compile_fail -- --ignored` writes the
//! `.stderr` files anew; read the difference before you commit it.

const WITHOUT_DEBUG: (&str, &str) = ("CARGO_PROFILE_DEV_DEBUG", "0");

/// The crate that trybuild makes has no profile: the compiler in it is built without debug information if this process says so, which
/// is why the test starts itself once more.
#[test]
#[ignore = "a minute, it builds the compiler once more: .ci/nightly runs it"]
fn errors_stand_at_their_tokens() {
    if std::env::var_os(WITHOUT_DEBUG.0).is_none() {
        let program = std::env::current_exe().expect("this program");
        let again = std::process::Command::new(program)
            .args([
                "--exact",
                "--ignored",
                "--nocapture",
                "errors_stand_at_their_tokens",
            ])
            .env(WITHOUT_DEBUG.0, WITHOUT_DEBUG.1)
            .status();
        assert!(again.expect("it starts").success());
        return;
    }
    let cases = trybuild::TestCases::new();
    cases.compile_fail("tests/compile_fail/*.rs");
    // what only rustc can find, at the token of the declaration
    cases.compile_fail("tests/compile_fail/of_rustc/*.rs");
}

/// What the cases have in common is sound: their `main` is no source of errors.
#[test]
fn no_other_code_is_blamed() {
    for entry in std::fs::read_dir("tests/compile_fail").expect("the cases") {
        let path = entry.expect("an entry").path();
        if path
            .extension()
            .is_none_or(|extension| extension != "stderr")
        {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("the errors");
        let mut errors = text
            .lines()
            .filter(|line| line.starts_with("error"))
            .peekable();
        assert!(errors.peek().is_some(), "{}", path.display());
        for error in errors {
            assert!(error.starts_with("error: ["), "{}: {error}", path.display());
        }
        assert!(text.contains("help: "), "{}", path.display());
    }
}
