use super::*;

fn so3_with(casimirs: &str) -> String {
    so3(&[("casimirs", casimirs), ("parameters", r#"{"k": 2}"#)])
}

/// `[a, b_i] = weight_i b_i`, coordinates a, b1, b2, ….
fn diagonal(weights: &[&str], casimir: &str) -> String {
    let names: Vec<String> = (1..=weights.len()).map(|i| format!("b{i}")).collect();
    let basis: Vec<&str> = ["a"]
        .into_iter()
        .chain(names.iter().map(String::as_str))
        .collect();
    let brackets: Vec<String> = names
        .iter()
        .zip(weights)
        .map(|(b, w)| format!("[a, {b}] = {w}*{b}"))
        .collect();
    let algebra = format!(r#"{{"basis": {basis:?}, "brackets": {brackets:?}}}"#);
    let state = format!("{basis:?}");
    let casimirs = format!("[{casimir:?}]");
    let parameters = r#"{"k": {"default": "3/2", "exact": true}}"#;
    system(
        &[
            ("algebra", &algebra),
            ("state", &state),
            ("hamiltonian", r#""a^2""#),
            ("parameters", parameters),
            ("casimirs", &casimirs),
        ],
        &[],
    )
}

#[test]
fn polynomials_and_functions_of_them() {
    for casimir in [
        "x^2 + y^2 + z^2",
        "(x^2 + y^2 + z^2)^3/k",
        "sqrt(x^2 + y^2 + z^2)",
        "1/(x^2 + y^2 + z^2)^(3/2)",
        "sin(x^2 + y^2 + z^2)^2 + k*exp(x^2 + y^2 + z^2)",
        "log((x^2 + y^2 + z^2)*(1 + x^2 + y^2 + z^2))",
        "atan2(x^2 + y^2 + z^2, k)",
        "(x + y + z)^2 - 2*(x*y + y*z + z*x)",
        "x^2 + (y^2 + z^2)*(sin(x)^2 + cos(x)^2)",
        "x^2 + y^2 + z^2*(cosh(y)^2 - sinh(y)^2)",
        "x^2 + y^2 + (z*sqrt(1 + x^2))^2/(1 + x^2)",
    ] {
        let model = model(&so3_with(&format!("[{casimir:?}]")));
        assert_eq!(model.casimirs.len(), 1, "{casimir}");
    }
}

#[test]
fn degrees() {
    for (casimir, degree) in [
        ("(x^2 + y^2 + z^2)^2/k", Some(4)),
        ("sqrt(k)*exp(k)*(x^2 + y^2 + z^2)", Some(2)),
        ("(x^2 + y^2 + z^2)*(sin(x)^2 + cos(x)^2)", Some(2)),
        ("1/(x^2 + y^2 + z^2)", None),
        ("sin(x^2 + y^2 + z^2)", None),
    ] {
        let model = model(&so3_with(&format!("[{casimir:?}]")));
        assert_eq!(model.casimirs[0].degree, degree, "{casimir}");
    }
}

#[test]
fn what_is_none_is_refused_with_the_bracket() {
    let refused = |casimir: &str, bracket: &str| {
        let found = errors(&so3_with(&format!("[\"C = {casimir}\"]")));
        let expected = format!("casimir at {casimir}: `C` is not a Casimir: {bracket}");
        assert!(
            found.len() == 1 && found[0] == expected,
            "{found:#?}\n{expected}"
        );
    };
    refused("x^2 + y^2", "{C, x} = 2*y*z");
    refused("x", "{C, y} = -z");
    refused(
        "x^2 + y^2 + z^2 + 1e-18*x",
        "{C, y} = -1/1000000000000000000*z",
    );
    refused("sin(x)", "{C, y} = -z*cos(x)");
    refused("log(z)", "{C, x} = -y/z");
    let found = errors(&so3_with(r#"["x*y", "exp(z)", "x^2 + y^2 + z^2"]"#));
    assert_eq!(found.len(), 2, "{found:#?}");
    assert!(
        found[0].contains("`C1` is not") && found[1].contains("`C2` is not"),
        "{found:#?}"
    );
}

#[test]
fn what_cannot_be_decided_is_refused_as_unproven() {
    for casimir in [
        "x^2 + y^2 + z^2 + x*(cos(pi/5) - (1 + sqrt(5))/4)",
        "x^2 + y^2 + z^2 + y*(asin(x/9) + acos(x/9) - pi/2)",
        "x^2 + y^2 + z^2 + x*(sqrt(3 + 2*sqrt(2)) - 1 - sqrt(2))",
    ] {
        let found = errors(&so3_with(&format!("[{casimir:?}]")));
        assert!(
            found.len() == 1 && found[0].starts_with("casimir") && found[0].contains("unproven"),
            "{found:#?}"
        );
    }
}

#[test]
fn rational_and_transcendental_ones_of_solvable_algebras() {
    // {b_i, a} is proportional to weight_i b_i.
    assert_eq!(
        model(&diagonal(&["1", "1"], "b1/b2")).casimirs[0].degree,
        None
    );
    model(&diagonal(&["1", "2"], "b1^2/b2"));
    model(&diagonal(&["1", "-1"], "b1*b2"));
    model(&diagonal(&["2", "3"], "3*log(b1) - 2*log(b2)"));
    model(&diagonal(&["2", "3"], "b1^(1/2)/b2^(1/3)"));
    model(&diagonal(&["1", "k"], "b2*exp(-k*log(b1))"));
    model(&diagonal(&["1", "k"], "b2/b1^k"));
    model(&diagonal(&["1", "k"], "log(b2*b1^(-2*k)) + k*log(b1)"));
    for wrong in ["b1*b2", "b2/b1^2", "log(b1) - log(b2)", "b1^k/b2^2"] {
        let found = errors(&diagonal(&["1", "k"], wrong));
        assert!(
            found.len() == 1 && found[0].contains("is not a Casimir: {C1, "),
            "{found:#?}"
        );
    }
    // [a, b] = b has none at all.
    let found = errors(&diagonal(&["1"], "b1^2"));
    assert_eq!(
        found,
        ["casimir at b1^2: `C1` is not a Casimir: {C1, a} = 2*b1^2"]
    );
}

#[test]
fn dependent_ones_are_left_out_with_a_warning() {
    let text = so3_with(r#"["2", "x^2 + y^2 + z^2", "D = exp(x^2 + y^2 + z^2)", "k^2"]"#);
    let (found, diagnostics) = run(&text);
    let found = found.unwrap();
    assert_eq!(
        found
            .casimirs
            .iter()
            .map(|c| c.name.as_str())
            .collect::<Vec<_>>(),
        ["C1"]
    );
    assert_eq!(diagnostics.len(), 3);
    assert!(
        diagnostics
            .iter()
            .all(|d| d.warning && d.kind == Kind::Casimir)
    );
    assert!(diagnostics[1].message.contains("`D` depends on"));
    assert_eq!(found.warnings.len(), 3);
    assert_eq!(found.dimension() - found.generic_rank, 1);
}

#[test]
fn names_skip_what_is_taken() {
    let algebra = r#"{"basis": ["a", "b", "c"], "brackets": []}"#;
    let text = so3(&[
        ("algebra", algebra),
        ("parameters", r#"{"C2": 1}"#),
        ("casimirs", r#"["x", "C3 = y", "x + y", "z"]"#),
    ]);
    let (model, warnings) = run(&text);
    let model = model.unwrap();
    let names: Vec<_> = model
        .casimirs
        .iter()
        .map(|c| (c.name.as_str(), model.display(c.expr), c.degree))
        .collect();
    let expected = [("C1", "x"), ("C3", "y"), ("C4", "z")];
    assert_eq!(names, expected.map(|(n, e)| (n, e.to_string(), Some(1))));
    let left_out = warnings.iter().filter(|d| d.kind == Kind::Casimir);
    assert_eq!(left_out.count(), 1);
    assert_eq!(model.generic_rank, 0);
}

#[test]
fn the_bracket_with_the_wrong_sign_is_named() {
    // so(3) with one sign changed is so(2, 1): the Jacobi identity holds, the sphere is no Casimir.
    let help = |brackets: &str, casimirs: &str| {
        let algebra = format!(r#"{{"basis": ["e1", "e2", "e3"], "brackets": {brackets}}}"#);
        let (_, found) = run(&so3(&[("algebra", &algebra), ("casimirs", casimirs)]));
        assert_eq!(found.len(), 1, "{found:#?}");
        assert_eq!(found[0].kind, Kind::Casimir);
        assert!(found[0].message.contains(" = "), "the residual is named");
        found[0].help.clone().unwrap_or_default()
    };
    let sphere = r#"["x^2 + y^2 + z^2"]"#;
    let wrong = r#"["[e1, e2] = e3", "[e2, e3] = e1", "[e1, e3] = e2"]"#;
    let named = help(wrong, sphere);
    assert!(
        named.starts_with("with the other sign of [e1, e3] the Jacobi"),
        "{named}"
    );
    // The Casimir itself is wrong: no sign mends it.
    let right = r#"["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]"#;
    let both = help(right, r#"["x^2 + y^2 + 2*z^2"]"#);
    assert!(both.contains("either it is wrong, or the sign"), "{both}");
}
