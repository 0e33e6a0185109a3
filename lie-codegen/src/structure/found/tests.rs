use super::{refusal, terms};
use crate::compile::compile_spec;
use crate::model::Model;

const SO3: &str = r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}"#;

fn model(algebra: &str, state: &[&str], rest: &str) -> Model {
    let state: Vec<String> = state.iter().map(|name| format!("{name:?}")).collect();
    let spec = format!(
        r#"{{"format": 1, "name": "Test", "algebra": {algebra}, "state": [{}], {rest}}}"#,
        state.join(", ")
    );
    compile_spec(&spec).expect("a spec without mistakes")
}

fn body(rest: &str) -> Model {
    model(SO3, &["x", "y", "z"], rest)
}

fn pieces(model: &Model) -> Vec<Vec<String>> {
    terms(model).expect("pieces").pieces
}

#[test]
fn a_multiple_of_the_casimir_is_taken_away() {
    let body = body(r#""hamiltonian": "x^2/2 + y^2/4 + z^2/6""#);
    assert_eq!(pieces(&body), [["x^2/4"], ["-z^2/12"]]);
    assert!(terms(&body).is_some_and(|terms| terms.shifted));
}

/// Of equal moments two squares are one multiple of the Casimir.
#[test]
fn a_symmetric_body_is_one_piece() {
    let symmetric = body(r#""hamiltonian": "x^2/2 + y^2/2 + z^2/6""#);
    assert_eq!(pieces(&symmetric), [["-z^2/3"]]);
}

#[test]
fn an_inertia_matrix_is_brought_to_squares() {
    let full = body(r#""hamiltonian": "x^2 + x*y + y^2 + y*z + z^2 + z""#);
    assert_eq!(pieces(&full).len(), 3);
    assert_eq!(refusal(&full, 2), None);
    // a product alone has no square to begin with
    let product = body(r#""hamiltonian": "x*y""#);
    assert_eq!(pieces(&product).len(), 2);
    // one square of a form is one piece
    let square = body(r#""hamiltonian": "(x + 2*y - 3*z)^2/2 + x + 2*y - 3*z""#);
    assert_eq!(pieces(&square).len(), 1);
}

#[test]
fn linear_terms_are_one_form() {
    let linear = body(r#""hamiltonian": "x + 2*y + 3*z""#);
    assert_eq!(pieces(&linear), [["x + 2*y + 3*z"]]);
}

#[test]
fn coordinates_that_commute_are_one_piece() {
    let two = r#"{"basis": ["e1", "e2", "e3", "f1", "f2", "f3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1",
        "[e3, e1] = e2", "[f1, f2] = f3", "[f2, f3] = f1", "[f3, f1] = f2"]}"#;
    let state = ["x", "y", "z", "u", "v", "w"];
    let coupled = model(
        two,
        &state,
        r#""hamiltonian": "x*u + 2*y*v + 3*z*w + exp(x*u)""#,
    );
    let found = pieces(&coupled);
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found.iter().any(|terms| terms.len() == 2), "{found:?}");
}

#[test]
fn what_cannot_be_split_is_named() {
    let body = body(r#""hamiltonian": "sin(x) + sqrt(1 + x^2 + y^2)""#);
    assert_eq!(terms(&body), None);
    let (reason, _) = refusal(&body, 2).expect("a reason");
    assert!(
        reason.contains("`sqrt(x^2 + y^2 + 1)` contains `x` and `y`"),
        "{reason}"
    );
    let cubic = self::body(r#""hamiltonian": "x*y*z""#);
    assert_eq!(terms(&cubic), None);
}

/// A divisor that vanishes at the default parameters is not one.
#[test]
fn divisors_have_values() {
    let body =
        body(r#""parameters": {"a": 0, "b": 1}, "hamiltonian": "a*x^2 + x*y + b*y^2 + z^2/3""#);
    let found = pieces(&body);
    assert!(
        found.iter().flatten().all(|term| !term.contains("/a")),
        "{found:?}"
    );
}
