//! Remedies lead out: what they say to write is right.

use super::{model, run, system};

type Keys<'a> = &'a [(&'a str, &'a str)];

/// One mistake with these words in message and remedy, and what the remedy makes of the spec.
#[track_caller]
fn leads_out(wrong: &str, says: &str, helps: &[&str], right: &str) {
    let (_, diagnostics) = run(wrong);
    let [found] = diagnostics.as_slice() else {
        panic!("{wrong}: {diagnostics:?}")
    };
    assert!(found.message.contains(says), "{}", found.message);
    let help = found.help.as_deref().unwrap_or_default();
    for part in helps {
        assert!(help.contains(part), "{part}: {help}");
    }
    model(right);
}

fn ring(extra: Keys<'_>) -> String {
    let base = [
        ("algebra", r#""so(3)^N""#),
        ("state", r#"["x[i]", "y[i]", "z[i]"]"#),
        ("parameters", r#"{"N": 8}"#),
    ];
    system(&base, extra)
}

fn top(extra: Keys<'_>) -> String {
    let base = [
        ("algebra", r#""se(3)""#),
        ("state", r#"["m1", "m2", "m3", "p1", "p2", "p3"]"#),
        ("hamiltonian", r#""m1^2/2 + p1""#),
    ];
    system(&base, extra)
}

fn body(extra: Keys<'_>) -> String {
    let base = [
        ("algebra", r#""so(3)""#),
        ("hamiltonian", r#""x^2/2 + y^2""#),
    ];
    system(&base, extra)
}

/// What differs from site to site is a list of values.
#[test]
fn coefficients_of_a_family_that_differ_are_listed() {
    let values = r#"{"N": 8, "B": {"values": [1, "1/2", 0, 3, -1, 2, 5, 1e-3]}}"#;
    let out = |sum: &str| ring(&[("parameters", values), ("hamiltonian", sum)]);
    let helps = &["a parameter with a list", "`B[i]` in a sum"];
    for (index, sum) in [
        ("i", "sum(i in 0..N: cos(i)*x[i]*x[i+1])"),
        ("k", "sum(k in 0..N-1: x[k] + k*y[k])"),
        ("site", "sum(site in 0..N: x[site]^site)"),
    ] {
        let says = format!("`{index}` is an index and no number");
        let listed = format!("\"sum({index} in 0..N: B[{index}]*x[{index}])\"");
        let sum = format!("{sum:?}");
        leads_out(&ring(&[("hamiltonian", &sum)]), &says, helps, &out(&listed));
    }
    let field = r#""sum(i in 0..N: B[i]*x[i])""#;
    let unknown = ring(&[("hamiltonian", field)]);
    leads_out(&unknown, "`B` has an index", helps, &out(field));
    // a list where there are no sites
    for value in ["[1, 2]", r#"{"values": [1, 2]}"#, r#"{"file": "B.npy"}"#] {
        let parameters = format!(r#"{{"B": {value}}}"#);
        let (_, diagnostics) = run(&body(&[("parameters", &parameters)]));
        let first = &diagnostics[0];
        let expected = match value.contains("file") {
            true => "`B.npy` cannot be read here",
            false => "`B` has a value for each site of a family, and this declaration is none",
        };
        assert_eq!(first.message, expected);
        assert!(first.help.is_some());
    }
}

/// The proposed name is not the one that is taken.
#[test]
fn another_index_is_free() {
    for (parameters, index, free) in [
        (r#"{"N": 8, "i": 1}"#, "i", "j"),
        (r#"{"N": 8, "i": 1, "j": 2, "k": 3}"#, "k", "l"),
        (r#"{"N": 8, "J": 1}"#, "J", "i"),
    ] {
        let sum = |index: &str| format!("\"sum({index} in 0..N: x[{index}]^2 + y[{index}])\"");
        let keys = |sum| ring(&[("parameters", parameters), ("hamiltonian", sum)]);
        let says = format!("the index `{index}` is the name of something else");
        let helps = format!("such as `{free}`");
        leads_out(&keys(&sum(index)), &says, &[&helps], &keys(&sum(free)));
    }
}

#[test]
fn keys_for_equations_and_forces_say_where_those_stand() {
    for (key, value, says) in [
        (
            "equations",
            r#"["x' = y"]"#,
            "derived from the brackets and the energy",
        ),
        (
            "rhs",
            r#"["y", "z", "x"]"#,
            "derived from the brackets and the energy",
        ),
        ("odes", "[]", "derived from the brackets and the energy"),
        ("torque", r#"["0", "0", "1"]"#, "`forces`"),
        ("controls", r#"{"x": "1"}"#, "`inputs`"),
        ("damping", "0.1", "`dissipation`"),
        ("thermal", "0.1", "`dissipation`"),
        ("langevin", "0.1", "`noise`"),
    ] {
        let wrong = body(&[(key, value)]);
        leads_out(&wrong, &format!("unknown key `{key}`"), &[says], &body(&[]));
    }
    // control: other keys are told by their spelling
    let (_, diagnostics) = run(&body(&[("hamiltonain", r#""x""#)]));
    assert!(
        diagnostics[0]
            .help
            .as_deref()
            .is_some_and(|help| help.contains("did you mean"))
    );
}

/// The names of a basis that nobody wrote.
#[test]
fn elements_of_a_named_algebra_are_told() {
    let energy = ("hamiltonian", r#""m1^2/(2*J1) + p1""#);
    let says = "the basis J1, J2, J3, P1, P2, P3";
    let right = [
        ("parameters", r#"{"J1_": 2}"#),
        ("hamiltonian", r#""m1^2/(2*J1_) + p1""#),
    ];
    let wrong = top(&[("parameters", r#"{"J1": 2}"#), energy]);
    leads_out(&wrong, says, &["such as `J1_`"], &top(&right));
    let named = r#"{"named": "se(3)", "basis": ["L1", "L2", "L3", "T1", "T2", "T3"]}"#;
    model(&top(&[
        ("algebra", named),
        ("parameters", r#"{"J1": 2}"#),
        energy,
    ]));
    let wrong = top(&[("let", r#"["J1 = 2"]"#), energy]);
    leads_out(&wrong, says, &["such as `J1_`"], &top(&right));
    // nobody declared it
    let helps = &[
        "use the state name of the same position, `m1`",
        "a parameter needs a name",
    ];
    leads_out(
        &top(&[energy]),
        "`J1` is a basis element",
        helps,
        &top(&right),
    );
    // control: the basis was written
    let written = r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}"#;
    let state = ("state", r#"["x", "y", "z"]"#);
    let keys = [("algebra", written), state, ("parameters", r#"{"e1": 2}"#)];
    let (_, diagnostics) = run(&body(&keys));
    assert_eq!(
        diagnostics[0].message,
        "the parameter `e1` has the name of a basis element"
    );
}

#[test]
fn inverses_are_declared() {
    let vectors =
        r#"{"J": [["I1", 0], [0, 2]], "Jinv": [["1/I1", 0], [0, "1/2"]], "v": ["x", "y"]}"#;
    let keys = |energy: &str| {
        let energy = format!("{energy:?}");
        body(&[
            ("parameters", r#"{"I1": 3}"#),
            ("vectors", vectors),
            ("hamiltonian", &energy),
        ])
    };
    let right = keys("quad(Jinv, v)/2 + dot(v, Jinv*v)/3 + x/I1");
    for (energy, says) in [
        ("quad(inv(J), v)/2", "no function `inv`"),
        ("dot(v, inverse(J)*v)/2", "no function `inverse`"),
        ("inv(I1)*x", "no function `inv`"),
        ("dot(v, solve(J, v))", "no function `solve`"),
        ("dot(v, J^-1*v)", "J is a matrix of 2 by 2"),
        ("dot(v, v/J)", "J is a matrix of 2 by 2"),
    ] {
        leads_out(
            &keys(energy),
            says,
            &["`Ainv*v` or `quad(Ainv, v)`", "`1/a`"],
            &right,
        );
    }
}

#[test]
fn a_tangent_algebra_of_one_has_other_names() {
    let of = |algebra: &str| body(&[("algebra", algebra), ("hamiltonian", r#""0""#)]);
    let energy = ("hamiltonian", r#""x^2/2 + y^2""#);
    for (inner, name) in [("so(3)", "de1"), ("se(2)", "dJ")] {
        let wrong = of(&format!("\"tangent(tangent({inner}))\""));
        let right = format!("\"semidirect(tangent({inner}), adjoint)\"");
        let helps = format!("write `semidirect(tangent({inner}), adjoint)`");
        let (_, diagnostics) = run(&wrong);
        assert_eq!(diagnostics.len(), 1, "{diagnostics:?}");
        assert!(
            diagnostics[0]
                .message
                .contains(&format!("would be called `{name}`"))
        );
        assert!(
            diagnostics[0]
                .help
                .as_deref()
                .is_some_and(|help| help.starts_with(&helps))
        );
        if inner == "so(3)" {
            let found = model(&body(&[("algebra", &right), energy]));
            assert_eq!(found.dimension(), 12);
        }
    }
}
