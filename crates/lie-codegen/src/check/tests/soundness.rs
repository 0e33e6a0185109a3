//! Declarations on which an identity holds on one side of a branch only, and their true neighbours.

use super::*;
use crate::model::Hamiltonian;

const SO3: &str = r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}"#;

fn casimir(text: &str) -> Vec<String> {
    errors(&so3(&[("casimirs", &format!("[{text:?}]"))]))
}

#[track_caller]
fn accepted(found: &[String]) {
    assert!(found.is_empty(), "{found:#?}");
}

#[track_caller]
fn refused(found: &[String], kind: &str, with: &str) {
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(
        found[0].starts_with(kind) && found[0].contains(with),
        "{found:#?}"
    );
}

#[test]
fn casimirs_with_logarithms() {
    accepted(&casimir("x^2 + y^2 + z^2 + x + exp(log(-x))"));
    refused(
        &casimir("x^2 + y^2 + z^2 - x + exp(log(-x))"),
        "casimir",
        "is not a Casimir",
    );
    refused(
        &casimir("x^2 + y^2 + z^2 + exp(log(x^2)/2) - x"),
        "casimir",
        "is not a Casimir",
    );
    refused(
        &casimir("x^2 + y^2 + z^2 + exp(log(x^2)/2) + x"),
        "casimir",
        "is not a Casimir",
    );
    accepted(&casimir("x^2 + y^2 + z^2 + exp(log(x^2)/2) - sqrt(x^2)"));
    accepted(&casimir("x^2 + y^2 + z^2 + exp(log(x)) - x"));
    // with the logarithm of x, only its positive side is left
    accepted(&casimir("x^2 + y^2 + z^2 + (sqrt(x^2) - x)*log(x)"));
    refused(
        &casimir("x^2 + y^2 + z^2 + (sqrt(x^2) - x)*log(x^2)"),
        "casimir",
        "is not a Casimir",
    );
    accepted(&casimir(
        "log((x^2 + y^2 + z^2)^2) + 3*exp(log(x^2 + y^2 + z^2)/3)",
    ));
    // a domain without points proves nothing
    refused(
        &casimir("x^2 + y^2 + z^2 + log(-x^2) - log(-x^2 - 1)*0 + x"),
        "casimir",
        "`C1` is",
    );
}

#[test]
fn parameters_are_positive_where_they_are_declared_so() {
    let with = |parameter: &str| {
        errors(&so3(&[
            ("parameters", &format!(r#"{{"k": {parameter}}}"#)),
            ("casimirs", r#"["x^2 + y^2 + z^2 + (sqrt(k^2) - k)*x"]"#),
        ]))
    };
    refused(&with("2"), "casimir", "is not a Casimir");
    accepted(&with(r#"{"value": "2", "positive": true}"#));
    accepted(&with(r#"{"default": 2, "positive": true}"#));
    for bad in ["-2", "0", "\"sqrt(6) - sqrt(2)*sqrt(3)\"", "\"cos(2)\""] {
        let found = with(&format!(r#"{{"value": {bad}, "positive": true}}"#));
        assert!(
            found[0].starts_with("number at") && found[0].ends_with("is not positive"),
            "{found:#?}"
        );
    }
    refused(
        &with(r#"{"value": 2, "default": 2, "positive": true}"#),
        "schema",
        "mean the same",
    );
    refused(&with(r#"{"positive": true}"#), "schema", "has no `default`");
    refused(
        &with(r#"{"value": 2, "positive": 1}"#),
        "schema",
        "`positive` is a boolean",
    );
}

#[test]
fn brackets_with_logarithms() {
    let brackets = |value: &str| {
        let poisson = format!(
            r#"["{{J1, J2}} = J3", "{{J2, J3}} = J1", "{{J3, J1}} = J2", "{{J1, P2}} = P3", "{{J2, P3}} = P1",
                "{{J3, P1}} = P2", "{{P1, J2}} = {value}", "{{P2, J3}} = P1", "{{P3, J1}} = P2"]"#
        );
        errors(&system(
            &[
                ("state", r#"["J1", "J2", "J3", "P1", "P2", "P3"]"#),
                ("hamiltonian", r#""J1^2 + P3""#),
            ],
            &[("poisson", &poisson)],
        ))
    };
    accepted(&brackets("P3"));
    accepted(&brackets("exp(log(P3))"));
    for wrong in ["-P3", "exp(log(-P3))", "exp(log(P3^2)/2)"] {
        refused(&brackets(wrong), "jacobi", "fails");
    }
    // {z, x} = exp(log(-y)) is -y: another algebra of three dimensions, and a sound one
    let three = |value: &str| {
        let poisson =
            format!(r#"["{{x, y}} = z", "{{y, z}} = x", "{{z, x}} = {value}", "{{x, w}} = 0"]"#);
        errors(&system(
            &[
                ("state", r#"["x", "y", "z", "w"]"#),
                ("hamiltonian", r#""x^2""#),
            ],
            &[("poisson", &poisson)],
        ))
    };
    accepted(&three("-y"));
    accepted(&three("exp(log(-y))"));
}

fn declared(hamiltonian: &str) -> Structure {
    let hamiltonian = format!("{hamiltonian:?}");
    model(&so3(&[("hamiltonian", &hamiltonian), ("algebra", SO3)]))
}

fn known(hamiltonian: &str) -> Hamiltonian {
    let model = declared(hamiltonian);
    model.energy.expression().expect("an expression").clone()
}

#[test]
fn pieces_and_degrees_with_roots() {
    let mixed = |text: &str| declared(text).separable.expect("an expression");
    for text in [
        "x^2/2 + y^2/3 + exp(log(x^2*y^2)/2) - x*y",
        "x^2/2 + y^2/3 + sqrt(x^2*y^2) - x*y",
    ] {
        assert_eq!(mixed(text), Err((0, 1)), "{text}");
    }
    assert_eq!(
        mixed("x^2/2 + sqrt(x^2*y^2) - sqrt(x^2)*sqrt(y^2) + y^4"),
        Ok(vec![0, 1])
    );
    let degree = |text: &str| known(text).degree;
    assert_eq!(degree("x^2 + exp(3*log(z^2)/2)"), None);
    assert_eq!(degree("x^2 + sqrt(z^2)^3"), None);
    assert_eq!(degree("x^2 + exp(2*log(z^2))"), Some(4));
    assert_eq!(degree("x^2 + sqrt(z^2)^4"), Some(4));
}

#[test]
fn casimirs_with_several_branches_are_warned_of() {
    let spiral = |casimir: &str| {
        let casimirs = format!("[{casimir:?}]");
        run(&system(
            &[
                (
                    "algebra",
                    r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = a*e2 - e3", "[e1, e3] = e2 + a*e3"]}"#,
                ),
                ("state", r#"["x", "y", "z"]"#),
                ("hamiltonian", r#""x^2/2 + y^2/3 + z^2/4""#),
                ("parameters", r#"{"a": {"default": "1/3", "exact": true}}"#),
            ],
            &[("casimirs", &casimirs)],
        ))
    };
    for casimir in [
        "log(y^2 + z^2)/2 - a*atan(z/y)",
        "log(y^2 + z^2)/2 - a*atan2(z, y)",
    ] {
        let (model, warnings) = spiral(casimir);
        assert!(model.unwrap().casimirs[0].multivalued);
        assert_eq!(warnings.len(), 1, "{warnings:#?}");
        assert!(warnings[0].warning && warnings[0].message.contains("multi-valued"));
    }
    let (model, warnings) = spiral("cos(log(y^2 + z^2)/(2*a))*y - sin(log(y^2 + z^2)/(2*a))*z");
    // that one is no Casimir
    assert!(model.is_none() && !warnings[0].warning);
    let (_, warnings) = run(&so3(&[("casimirs", r#"["x^2 + y^2 + z^2"]"#)]));
    assert!(warnings.is_empty());
}

#[test]
fn a_contradiction_is_a_mistake_of_the_compiler() {
    use lie_symbolic::prove::contradiction;
    use lie_syntax::diagnostic::Kind;
    let model = declared("x^2 + y^2");
    contradiction::keep(&model.graph, model.hamiltonian());
    let found = refuted_verdict(model.name_origin).unwrap();
    assert_eq!(found.kind, Kind::Limit);
    assert!(found.message.contains("contradicts itself") && found.help.is_some());
    // it is told once, and does not outlive the check in which it was found
    assert!(contradiction::take().is_none());
    contradiction::keep(&model.graph, model.hamiltonian());
    assert!(run(&so3(&[])).1.is_empty());
}
