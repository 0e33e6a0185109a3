//! Pieces of families on whose sites something acts, or that depend on the time.

use super::{model, system};
use crate::methods::{Choice, refusal};

fn ring(extra: &[(&str, &str)]) -> String {
    system(
        &[
            ("algebra", r#""so(3)^N""#),
            ("state", r#"["x[i]", "y[i]", "z[i]"]"#),
            ("parameters", r#"{"N": 3, "k": 1, "s": [1, 2, 3]}"#),
            ("hamiltonian", r#""sum(i in 0..N: x[i]*x[i+1])""#),
        ],
        extra,
    )
}

/// The pieces, or why there are none with what to use.
fn pieces(extra: &[(&str, &str)]) -> Result<String, String> {
    let model = model(&ring(extra));
    let choice = Choice::from_id("splitting2").expect("a method");
    if let Some((why, help)) = refusal(&model, &choice) {
        return Err(format!("{why}; {help}"));
    }
    let found = model.family_pieces.as_ref().expect("a family");
    let found = found.as_ref().expect("pieces");
    let described = found.pieces.iter().map(|piece| piece.describe(&model));
    Ok(described.collect::<Vec<_>>().join(", "))
}

#[test]
fn what_acts_is_a_piece_where_its_flow_is_exact() {
    let found = |key: &str, value: &str| pieces(&[(key, value)]).expect(value);
    assert_eq!(
        found("forces", r#"{"x[i]": "1 - k*s[i+1]*x[i]"}"#),
        "x*x[+1], friction"
    );
    // linear once it is multiplied out
    assert_eq!(
        found("forces", r#"{"y[i]": "(y[i] - 1)^2 - y[i]*(y[i] + 3)"}"#),
        "x*x[+1], friction"
    );
    assert_eq!(
        found(
            "noise",
            r#"[{"hamiltonian": "s[i]*z[i]"}, {"hamiltonian": "z[i]*cos(t)"}, {"hamiltonian": "x[i] - 2*z[i]"}, {"force": {"y[i]": "s[i+1]"}}]"#
        ),
        "x*x[+1], noise along z, noise along a direction, noise as a force"
    );
    // the control: what has no such flow is refused with its reason and what takes it
    for (key, value, reason) in [
        (
            "forces",
            r#"{"x[i]": "-x[i]^3"}"#,
            "that on `x[i]` is not linear in `x[i]`",
        ),
        (
            "forces",
            r#"{"x[i]": "-x[i+1]"}"#,
            "that on `x[i]` depends on `x[i+1]`",
        ),
        (
            "noise",
            r#"[{"hamiltonian": "x[i]^2"}]"#,
            "its direction depends on `x[i]`",
        ),
        (
            "noise",
            r#"[{"force": {"y[i]": "z[i+1]"}}]"#,
            "its direction depends on `z[i+1]`",
        ),
        (
            "dissipation",
            r#"[{"kind": "double-bracket", "strength": 1}]"#,
            "a double bracket damps, whose flow has no closed form",
        ),
        (
            "dissipation",
            r#"[{"kind": "rayleigh", "matrix": [["k", 0, 0], [0, 0, 0], [0, 0, 0]]}]"#,
            "depends on dH/d`x[i]`",
        ),
    ] {
        let why = pieces(&[(key, value)]).expect_err(value);
        assert!(
            why.contains(reason) && why.contains("`gauss16`"),
            "{value}: {why}"
        );
    }
}

#[test]
fn pieces_may_change_with_the_time() {
    let found = |hamiltonian: &str| {
        let text = format!("{hamiltonian:?}");
        pieces(&[
            ("hamiltonian", &text),
            ("inputs", r#"{"u": {"default": 1}}"#),
        ])
    };
    let ok = |text: &str| Ok(text.to_owned());
    assert_eq!(
        found("sum(i in 0..N: cos(t)*x[i]*x[i+1] + u*sin(t*y[i]) + s[i]*t^2)"),
        ok("x*x[+1], f(y), f(t)")
    );
    assert_eq!(
        found("t*sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1]) + u*t^3"),
        ok("exchange with [+1]")
    );
    let why = found("sum(i in 0..N: cos(t)/x[i]^2)").expect_err("no value at 0");
    assert!(
        why.contains("has no value where coordinates are 0"),
        "{why}"
    );
    // the control: without the time nothing is told apart at 0
    assert_eq!(found("sum(i in 0..N: u/x[i]^2)"), ok("f(x)"));
}
