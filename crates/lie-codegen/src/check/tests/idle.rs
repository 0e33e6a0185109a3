//! What has no effect is a warning, and only that.

use super::*;

/// The warnings as `kind at TEXT: message`; the spec passes.
#[track_caller]
fn warnings(text: &str) -> Vec<String> {
    let found = model(text);
    assert_eq!(found.warnings.len(), errors(text).len(), "warnings are all");
    errors(text)
}

#[test]
fn names_that_nothing_uses() {
    let text = so3(&[
        ("parameters", r#"{"used": 1, "idle": 2, "of_initial": 3}"#),
        ("let", r#"["twice = 2*used", "never = x"]"#),
        ("hamiltonian", r#""twice*x^2 + y^2/2""#),
        ("initial", r#"[1, "of_initial", 0]"#),
    ]);
    assert_eq!(
        warnings(&text),
        [
            "unused at idle: the parameter `idle` is not used",
            "unused at never: the abbreviation `never` is not used",
        ]
    );
}

#[test]
fn brackets_matrices_and_casimirs_are_uses() {
    let algebra = r#"{"basis": ["a", "b"], "brackets": ["[a, b] = k*b"]}"#;
    let text = so3(&[
        ("algebra", algebra),
        ("state", r#"["x", "y"]"#),
        (
            "parameters",
            r#"{"k": {"default": 1, "exact": true}, "c": 3}"#,
        ),
        ("hamiltonian", r#""x + y""#),
    ]);
    assert_eq!(
        warnings(&text),
        ["unused at c: the parameter `c` is not used"]
    );
    let text = so3(&[
        ("parameters", r#"{"c": 3}"#),
        ("casimirs", r#"["c*(x^2 + y^2 + z^2)"]"#),
    ]);
    assert_eq!(warnings(&text), [""; 0]);
}

#[test]
fn systems_in_which_nothing_moves() {
    let constant = "the Hamiltonian does not depend on the state: no state moves";
    let text = so3(&[("parameters", r#"{"m": 1}"#), ("hamiltonian", r#""m*2""#)]);
    assert_eq!(warnings(&text), [format!("motionless at m*2: {constant}")]);
    let still = "all brackets are zero: no state moves, whatever the Hamiltonian is";
    let algebra = r#"{"basis": ["a", "b", "c"]}"#;
    assert_eq!(
        warnings(&so3(&[("algebra", algebra)])),
        [format!("motionless at {algebra}: {still}")]
    );
    // A cocycle moves what the algebra leaves at rest, and one coordinate alone is no slip.
    let text = so3(&[("algebra", algebra), ("cocycle", r#"["{x, y} = 1"]"#)]);
    assert_eq!(warnings(&text), [""; 0]);
    let text = so3(&[
        ("algebra", r#"{"basis": ["a"]}"#),
        ("state", r#"["x"]"#),
        ("hamiltonian", r#""x""#),
    ]);
    assert_eq!(warnings(&text), [""; 0]);
}
