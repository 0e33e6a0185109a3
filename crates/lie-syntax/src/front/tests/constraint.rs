//! Constraints in the macro and in a spec.

use super::declaration::{declared, mistakes};
use super::*;
use crate::ast::Declaration;
use crate::front::{Body, spec};

fn body(constraint: &str) -> String {
    format!(
        "pub system Body; algebra {{ basis e1, e2; [e1, e2] = e2; }} state x, y; parameters {{ k = 2; }} \
         hamiltonian = x^2/2 + y^2; {constraint}"
    )
}

fn sides(declaration: &Declaration) -> Vec<String> {
    let constraints = declaration.constraint.iter();
    let side = |c: &crate::ast::Constraint| format!("{} {}", explicit(&c.left), explicit(&c.right));
    constraints.map(side).collect()
}

#[test]
fn equations_are_read_alike() {
    let expected = ["(e1-(k*e2)) 0", "e2 e1"];
    let written = declared(&body("constraint { e1 - k*e2 = 0; e2 = e1; }"));
    assert_eq!(sides(&written), expected);
    let text = r#"{
        "name": "Body", "algebra": { "basis": ["e1", "e2"], "brackets": ["[e1, e2] = e2"] }, "state": ["x", "y"],
        "parameters": { "k": 2 }, "hamiltonian": "x^2/2 + y^2", "constraint": ["e1 - k*e2 = 0", "e2 = e1"]
    }"#;
    let mut report = Report::new();
    let read = spec::read(text, &mut report);
    let Some(Body::Declaration(read)) = read.body else {
        panic!("{:#?}", report.into_diagnostics());
    };
    assert_eq!(sides(&read), expected);
    assert!(report.into_diagnostics().is_empty());
    assert!(!declared(&body("")).is_constrained());
}

#[test]
fn what_is_no_equation() {
    for (wrong, place) in [
        ("constraint { e1; }", "e1"),
        ("constraint { e1 = e2 = 0; }", "="),
        ("constraint { e1 = ; }", "="),
        ("constraint { e1 == 0; }", "=="),
        ("constraint = e1;", "constraint"),
        (
            "constraint { e1 = 0; } constraint { e2 = 0; }",
            "constraint",
        ),
    ] {
        let found = mistakes(&body(wrong));
        assert_eq!(found, [(Kind::Syntax, place.to_owned())], "{wrong}");
    }
    let general = "pub system S; poisson { {x, y} = 1; } state x, y; hamiltonian = x^2; constraint { x = 0; }";
    assert_eq!(mistakes(general), [(Kind::Syntax, "constraint".to_owned())]);
}
