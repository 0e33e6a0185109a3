use super::*;
use crate::check::domain::{Domain, fault};

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

/// Where H is a polynomial, and its entries are not too large, no state is looked at; elsewhere each one is.
#[test]
fn polynomials_are_certain_up_to_a_size() {
    let asked = |hamiltonian: &str, states: &[[f64; 3]]| -> Vec<&str> {
        let hamiltonian = format!("{hamiltonian:?}");
        let parameters = r#"{"k": 2}"#;
        let model = model(&so3(&[
            ("hamiltonian", &hamiltonian),
            ("parameters", parameters),
        ]));
        let domain = Domain::of(&model);
        let found = |mu: &[f64; 3]| {
            let is_fine = domain.fault(&model, mu, &[2.0]).is_none();
            match (domain.is_certain(mu, &[2.0]), is_fine) {
                (true, true) => "certain",
                (true, false) => "certain, and wrong",
                (false, true) => "found",
                (false, false) => "refused",
            }
        };
        states.iter().map(found).collect()
    };
    let (small, large) = ([1.0, -2.0, 0.0], [1e60, 0.0, 0.0]);
    assert_eq!(
        asked("x^2/k + y^3*z - 4", &[small, large]),
        ["certain", "found"]
    );
    // the entries are finite, and H is not
    let both = [1e60, 1e60, 0.0];
    assert_eq!(asked("(x*y)^4", &[small, both]), ["certain", "refused"]);
    let steep = [[1e3, 0.0, 0.0], [1e5, 0.0, 0.0]];
    assert_eq!(asked("1e300*x^2", &steep), ["certain", "refused"]);
    let nan = [f64::NAN, 0.0, 0.0];
    assert_eq!(asked("x^2", &[small, nan]), ["certain", "refused"]);
    // no polynomials
    let ones = [1.0; 3];
    assert_eq!(asked("x/z + y", &[ones, small]), ["found", "refused"]);
    let negative = [-1.0, 0.0, 0.0];
    assert_eq!(
        asked("log(x) + y^2", &[small, negative]),
        ["found", "refused"]
    );
    let pole = [1.0, 0.0, 2.0];
    assert_eq!(asked("x*y^(-2)", &[small, pole]), ["found", "refused"]);
}

#[test]
fn what_is_certain_is_so_of_its_parameters() {
    let model = model(&so3(&[
        ("hamiltonian", r#""x^2/k""#),
        ("parameters", r#"{"k": 1}"#),
    ]));
    let domain = Domain::of(&model);
    let is_fine = |k: f64| domain.fault(&model, &[1.0, 2.0, 3.0], &[k]).is_none();
    assert_eq!(
        [1.0, 0.0, 2.0, f64::NAN].map(is_fine),
        [true, false, true, false]
    );
    let again = Domain::of(&model);
    assert!(again.fault(&model, &[1.0, 2.0, 3.0], &[0.0]).is_some());
    assert!(again.fault(&model, &[1.0, 2.0, 3.0], &[1.0]).is_none());
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
