//! Constraints on the velocity: which methods and states they refuse, and what is no constraint.

use super::constraint::{SO3, body, by_hamiltonian};
use super::*;
use crate::methods::{Choice, refusal};

#[test]
fn methods_that_need_the_jacobi_identity_are_refused() {
    let found = model(&body(SO3, r#"["w = 0"]"#, &[]));
    for id in [
        "midpoint",
        "gauss4",
        "gauss16",
        "gonzalez",
        "mean-value",
        "itoh-abe",
        "orbit-energy",
        "cohen-hairer4",
        "taylor",
        "rk4",
        "dopri5",
        "compose4(gonzalez)",
    ] {
        let choice = Choice::from_id(id).expect("a method");
        assert_eq!(refusal(&found, &choice), None, "{id}");
    }
    for id in [
        "k-hj2",
        "k-hj6",
        "lie-midpoint",
        "splitting2",
        "generating4",
        "collective4",
        "isospectral4",
        "rkmk4",
        "lie-taylor",
        "exact",
        "compose4(lie-midpoint)",
    ] {
        let choice = Choice::from_id(id).expect("a method");
        let (reason, help) = refusal(&found, &choice).expect(id);
        assert!(reason.contains("almost Poisson"), "{id}: {reason}");
        assert!(help.contains("`orbit-energy`"), "{id}: {help}");
    }
    let variational = Choice::from_id("variational2").expect("a method");
    let (reason, _) = refusal(&found, &variational).expect("refused");
    assert!(reason.contains("does not keep the energy"), "{reason}");
}

#[test]
fn initial_states_in_either_coordinates() {
    let start = |initial: &str| {
        let text = by_hamiltonian(r#"["e3 = 0"]"#, &[("initial", initial)]);
        model(&text).initial_values(&[]).expect("a state")
    };
    assert_eq!(start(r#"["3/5", "-1/2"]"#), [0.6, -0.5]);
    assert_eq!(start(r#"["3/5", "-1/2", "29/100"]"#), [0.6, -0.5]);
    let found = model(&by_hamiltonian(r#"["e3 = 0"]"#, &[]));
    assert_eq!(
        found.complete_state(&[0.6, -0.5, 0.29], &[]),
        Some(vec![0.6, -0.5])
    );
    assert_eq!(
        found.complete_state(&[0.6, -0.5], &[]),
        Some(vec![0.6, -0.5])
    );
    assert_eq!(found.complete_state(&[0.6], &[]), None);
    assert_eq!(found.violation(&[0.6, -0.5, 0.29], &[]), None);
    assert_eq!(found.violation(&[0.6, -0.5], &[]), None);
    let wrong = found
        .violation(&[0.6, -0.5, 0.3], &[])
        .expect("a violation");
    assert!(wrong.help.ends_with("0.6, -0.5, 0.29"), "{}", wrong.help);
    expect(
        &by_hamiltonian(
            r#"["e3 = 0"]"#,
            &[("initial", r#"["3/5", "-1/2", "3/10"]"#)],
        ),
        &["constraint at 3/10: the initial state violates the constraint e3 = 0"],
    );
    expect(
        &by_hamiltonian(r#"["e3 = 0"]"#, &[("initial", "[1]")]),
        &["state-length at [1]: the initial state has 1 value"],
    );
}

#[test]
fn what_is_no_constraint_is_refused() {
    let of_body = |constraint: &str, expected: &[&str]| {
        expect(&by_hamiltonian(constraint, &[]), expected);
    };
    of_body(r#"["e3"]"#, &["syntax at e3: `e3` is no equation"]);
    of_body(r#"["e1 = e2 = e3"]"#, &["syntax at =: a second equation"]);
    of_body(
        r#"["e1*e2 = 0"]"#,
        &["constraint at e1*e2 = 0: a constraint is linear"],
    );
    of_body(
        r#"["sin(e1) = 0"]"#,
        &["constraint at sin(e1) = 0: a constraint is linear"],
    );
    of_body(
        r#"["e1 = 1"]"#,
        &["constraint at e1 = 1: a constraint is homogeneous"],
    );
    of_body(
        r#"["e1 = e1"]"#,
        &["constraint at e1 = e1: this constraint holds"],
    );
    of_body(
        r#"["sqrt(2)*e1 = e2"]"#,
        &["constraint at sqrt(2)*e1 = e2: the coefficients"],
    );
    of_body(
        r#"["e1 = e2", "e2 = e3", "2*e1 = 2*e3"]"#,
        &["constraint at 2*e1 = 2*e3: this constraint follows"],
    );
    of_body(
        r#"["e1 = e2", "e2 = e3", "e1 = 2*e3"]"#,
        &["constraint at e1 = e2: the constraints leave no velocity"],
    );
    of_body(
        r#"["e4 = 0"]"#,
        &["unknown-symbol at e4: unknown symbol `e4`"],
    );
    of_body(
        r#"["x = 0"]"#,
        &["unknown-symbol at x: `x` cannot stand here"],
    );
    expect(
        &body(SO3, r#"["e3 = 0"]"#, &[]),
        &["unknown-symbol at e3: `e3` is a basis element; with `velocity`"],
    );
    let with = |hamiltonian: &str, expected: &str| {
        let keys = [
            ("hamiltonian", hamiltonian),
            ("constraint", r#"["e3 = 0"]"#),
        ];
        expect(&so3(&keys), &[expected]);
    };
    with(
        r#""x^2 + y^2 + z^4""#,
        "constraint at x^2 + y^2 + z^4: H is not quadratic",
    );
    with(
        r#""x^2 + y^2 + x*z^2""#,
        "constraint at x^2 + y^2 + x*z^2: H is not quadratic",
    );
    with(
        r#""x^2 + y^2 + x*z""#,
        "constraint at x^2 + y^2 + x*z: the constraint e3 = 0 leaves",
    );
    with(
        r#""x^2 + y^2 + z^2 + abs(z)""#,
        "constraint at x^2 + y^2 + z^2 + abs(z): H has several branches",
    );
    with(
        r#""x^2 + y^2 + z^2 + x*z + max(x, 0)""#,
        "constraint at x^2 + y^2 + z^2 + x*z + max(x, 0): H has several branches",
    );
    // along the other directions H may be any function
    model(&so3(&[
        ("hamiltonian", r#""x^4 + cosh(y) + z^2/2 + sin(x)*z""#),
        ("constraint", r#"["e3 = 0"]"#),
    ]));
}

#[test]
fn what_stands_beside_no_constraint() {
    let beside = |key: &str, value: &str, expected: &str| {
        let found = errors(&by_hamiltonian(r#"["e3 = 0"]"#, &[(key, value)]));
        assert!(
            found.len() == 1
                && found[0].starts_with("constraint at ")
                && found[0].contains(expected),
            "{key}: {found:#?}"
        );
    };
    beside("forces", r#"{"x": "-x"}"#, "forces, dissipation and noise");
    beside(
        "noise",
        r#"[{"hamiltonian": "x"}]"#,
        "forces, dissipation and noise",
    );
    beside("inputs", r#"{"u": {"default": 0}}"#, "inputs");
    beside("attitude", r#"{"quaternion": [1, 0, 0, 0]}"#, "`attitude`");
    let general = system(
        &[
            ("poisson", r#"["{x, y} = 1"]"#),
            ("state", r#"["x", "y"]"#),
            ("hamiltonian", r#""x^2 + y^2""#),
        ],
        &[("constraint", r#"["x = 0"]"#)],
    );
    expect(
        &general,
        &["schema at [\"x = 0\"]: `constraint` cannot be combined with `poisson`"],
    );
    let quartic = body(
        SO3,
        r#"["w = 0"]"#,
        &[("lagrangian", r#""u^2 + v^2 + w^2 + w^4""#)],
    );
    expect(
        &quartic,
        &["constraint at u^2 + v^2 + w^2 + w^4: beside a constraint"],
    );
}
