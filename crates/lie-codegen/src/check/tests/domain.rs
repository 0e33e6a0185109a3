use super::*;
use crate::check::domain::fault;

#[test]
fn what_is_not_finite_points_at_the_entry() {
    let at = |hamiltonian: &str, initial: &str| {
        let hamiltonian = format!("{hamiltonian:?}");
        errors(&so3(&[
            ("hamiltonian", &hamiltonian),
            ("initial", initial),
            ("parameters", r#"{"k": 0}"#),
            ("casimirs", r#"["C = k + x^2 + y^2 + z^2"]"#),
        ]))
    };
    assert_eq!(
        at("log(y) + x", "[11, 0, 33]"),
        ["domain at 0: the Hamiltonian is not finite because of `log(y)` at the initial state"]
    );
    assert_eq!(
        at("sqrt(z) + x", "[11, 22, 0]"),
        [
            "domain at 0: the derivative of the Hamiltonian with respect to `z` is not finite because of `1/sqrt(z)` at the initial state"
        ]
    );
    let found = at("x/(y - z)", "[11, 22, \"2*11\"]");
    assert!(found[0].starts_with("domain at 22"), "{found:#?}");
    assert!(at("x + y", "[\"1/k\", 22, 33]")[0].starts_with("domain at 1/k: `x` is not finite"));
    // Nothing of the state is involved: the whole.
    assert!(at("x/k", "[1, 2, 3]")[0].starts_with("domain"));
    assert!(at("x*exp(y)", "[1, 800, 3]")[0].starts_with("domain at 800"));
    assert!(at("atan(1/x) + log(y^2)", "[1, -2, 3]").is_empty());
    // Without an initial state nothing can be said.
    assert!(errors(&so3(&[("hamiltonian", r#""log(-x^2 - 1)""#)])).is_empty());
}

#[test]
fn casimirs_are_looked_at_too() {
    let found = errors(&so3(&[
        ("casimirs", r#"["C = log(x^2 + y^2 + z^2)"]"#),
        ("initial", "[0, 0, 0]"),
    ]));
    assert!(
        found.len() == 1 && found[0].starts_with("domain at 0: the Casimir `C`"),
        "{found:#?}"
    );
}

#[test]
fn other_states_and_parameters_can_be_asked_for() {
    let model = model(&so3(&[
        ("hamiltonian", r#""k/x""#),
        ("parameters", r#"{"k": 1}"#),
    ]));
    assert_eq!(fault(&model, &[1.0, 0.0, 0.0], &[2.0]), None);
    assert_eq!(
        fault(&model, &[0.0, 0.0, 0.0], &[2.0]).unwrap().coordinate,
        Some(0)
    );
    assert!(fault(&model, &[1.0, 0.0, 0.0], &[f64::INFINITY]).is_some());
}

#[test]
fn methods_must_apply() {
    model(&so3(&[(
        "methods",
        r#"["midpoint", "lie-midpoint", "gauss4"]"#,
    )]));
    expect(
        &so3(&[("methods", r#"["midpont", "euler-arnold2"]"#)]),
        &["method at midpont", "method at euler-arnold2"],
    );
}
