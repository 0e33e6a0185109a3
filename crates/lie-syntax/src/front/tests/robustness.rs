//! Whatever comes in, no front end panics.

use proc_macro2::TokenStream;
use proptest::prelude::*;

use super::*;
use crate::front::{declaration, line_column, parse_constant_text, spec};

/// Text that often gets past the first token.
fn formula_like() -> impl Strategy<Value = String> {
    let piece = prop::sample::select(vec![
        "x",
        "y",
        "e3",
        "2",
        "1.5",
        "2e3",
        "1e9",
        ".",
        "..",
        "(",
        ")",
        "[",
        "]",
        "+",
        "-",
        "*",
        "/",
        "^",
        ",",
        "sin",
        "atan2",
        "sum",
        " in ",
        "i",
        ":",
        "=",
        "·",
        "é",
        " ",
        "\"",
        "_",
        "0x",
        "{",
        "}",
        ";",
        "sum(i in 0..N:",
    ]);
    prop::collection::vec(piece, 0..30).prop_map(|pieces| pieces.concat())
}

/// A macro body in which statements contain and are followed by anything.
fn body_like() -> impl Strategy<Value = String> {
    let piece = prop::sample::select(vec![
        "system",
        "A",
        "pub",
        "pub(crate)",
        "algebra",
        "{",
        "}",
        "basis",
        "e1",
        "e2",
        "[e1, e2] = e1",
        ";",
        ";",
        ",",
        "state",
        "x",
        "parameters",
        "exact",
        "k",
        "=",
        "1/3",
        "let",
        "hamiltonian",
        "casimir",
        "integrals",
        "observables",
        "unwrap",
        "events",
        "direction",
        "stop",
        "methods",
        "[",
        "]",
        "lie-midpoint",
        "invariance",
        "left",
        "initial",
        "spec",
        "\"a\"",
        "#[doc = \"d\"]",
        "#",
        "///d\n",
        "(",
        ")",
        "!",
        "r#fn",
        "'a",
        "'x'",
        "b\"x\"",
        "1.5",
        "2x",
        "..",
        "poisson",
        "so(3)",
        "_",
    ]);
    prop::collection::vec(piece, 0..40).prop_map(|pieces| pieces.join(" "))
}

/// A spec with one part replaced.
fn spec_like() -> impl Strategy<Value = String> {
    let value = prop_oneof![
        Just("null".to_owned()),
        Just("1".to_owned()),
        Just("[[1]]".to_owned()),
        Just("{}".to_owned()),
        Just("{\"default\": {}}".to_owned()),
        formula_like().prop_map(|text| serde_json::to_string(&text).unwrap()),
        formula_like().prop_map(|text| format!("[{}]", serde_json::to_string(&text).unwrap())),
        formula_like().prop_map(|text| format!("{{{}: 1}}", serde_json::to_string(&text).unwrap())),
        "\\PC{0,20}",
    ];
    let key = prop::sample::select(crate::front::schema::Spec::KEYS.to_vec());
    prop::collection::vec((key, value), 0..8).prop_map(|members| {
        let members: Vec<String> = members
            .into_iter()
            .map(|(key, value)| format!("\"{key}\": {value}"))
            .collect();
        format!("{{{}}}", members.join(", "))
    })
}

fn in_range(text: &str, report: Report) -> Result<(), TestCaseError> {
    for diagnostic in report.into_diagnostics() {
        prop_assert!(diagnostic.help.is_some(), "no remedy: {diagnostic:?}");
        let Some(Origin::Text { start, end }) = diagnostic.origin else {
            return Err(TestCaseError::fail(format!("no place: {diagnostic:?}")));
        };
        prop_assert!(
            start <= end && text.get(start..end).is_some(),
            "{diagnostic:?}"
        );
        line_column(text, start);
    }
    Ok(())
}

proptest! {
    #[test]
    fn expressions(text in prop_oneof![formula_like(), "\\PC*", ".*"]) {
        let mut report = Report::new();
        let found = parse_expression_text(&text, 0, &names(), &mut report);
        prop_assert_eq!(found.is_none(), report.has_errors());
        in_range(&text, report)?;
        let mut report = Report::new();
        prop_assert_eq!(parse_constant_text(&text, 0, &mut report).is_none(), report.gate().is_err());
    }

    #[test]
    fn specs(text in prop_oneof![spec_like(), "\\PC*", ".*"]) {
        let mut report = Report::new();
        let parsed = spec::read(&text, &mut report);
        prop_assert_eq!(parsed.body.is_none(), report.has_errors());
        in_range(&text, report)?;
    }

    #[test]
    fn bodies(text in prop_oneof![body_like(), formula_like(), "\\PC*"]) {
        let Ok(tokens) = text.parse::<TokenStream>() else { return Ok(()) };
        let mut report = Report::new();
        let parsed = declaration::parse(tokens, &mut report);
        prop_assert_eq!(parsed.body.is_none(), report.has_errors());
        for diagnostic in report.into_diagnostics() {
            prop_assert!(diagnostic.help.is_some() && matches!(diagnostic.origin, Some(Origin::Span(_))), "{diagnostic:?}");
        }
    }

    #[test]
    fn bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let text = String::from_utf8_lossy(&bytes);
        let mut report = Report::new();
        spec::read(&text, &mut report);
        in_range(&text, report)?;
    }
}

#[test]
fn deep_json_is_refused_without_recursion() {
    for text in [
        "[".repeat(200_000),
        format!("{}1{}", "[".repeat(200_000), "]".repeat(200_000)),
    ] {
        let mut report = Report::new();
        spec::read(&text, &mut report);
        assert!(report.gate().is_err());
    }
    let deep = format!(
        r#"{{"name": {}{}, "parameters": {{"a": {}{}}}}}"#,
        "[".repeat(100_000),
        "]".repeat(100_000),
        "{\"default\":".repeat(1_000),
        "}".repeat(1_000)
    );
    let mut report = Report::new();
    spec::read(&deep, &mut report);
    assert!(report.gate().is_err());
}
