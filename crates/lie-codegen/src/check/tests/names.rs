use super::*;

#[test]
fn all_mistakes_are_reported_together() {
    let text = so3(&[
        ("state", r#"["x", "y", "x"]"#),
        ("parameters", r#"{"I1": 2, "fn": 1}"#),
        ("let", r#"["w = I2*x"]"#),
        ("hamiltonian", r#""w + xx + sin(q)""#),
    ]);
    expect(
        &text,
        &[
            "duplicate-name at x: `x` is declared twice",
            "reserved-name at fn",
            "unknown-symbol at I2: unknown symbol `I2`",
            "unknown-symbol at xx",
            "unknown-symbol at q",
        ],
    );
}

#[test]
fn an_error_in_the_hamiltonian_does_not_hide_one_in_a_bracket() {
    let algebra = r#"{"basis": ["a", "b", "c"], "brackets": ["[a, b] = c", "[b, c] = a", "[c, a] = b + 2*c"]}"#;
    let found = errors(&so3(&[("algebra", algebra), ("hamiltonian", r#""x + u""#)]));
    assert_eq!(found.len(), 2, "{found:#?}");
    assert!(found[0].starts_with("jacobi"), "{found:#?}");
    assert!(found[1].starts_with("unknown-symbol at u"));
}

#[test]
fn name_spaces() {
    let same =
        r#"{"basis": ["x", "y", "z"], "brackets": ["[x, y] = z", "[y, z] = x", "[z, x] = y"]}"#;
    model(&so3(&[
        ("algebra", same),
        ("parameters", r#"{"C": 1}"#),
        ("casimirs", r#"["C = x^2 + y^2 + z^2"]"#),
    ]));
    expect(
        &so3(&[("parameters", r#"{"e1": 1}"#)]),
        &["duplicate-name at e1: the parameter `e1` has the name of a basis element"],
    );
    expect(
        &so3(&[("let", r#"["y = 2"]"#)]),
        &["duplicate-name at y: the abbreviation `y` has the name of a coordinate"],
    );
    expect(
        &so3(&[
            ("parameters", r#"{"k": 1}"#),
            ("let", r#"["k = 2", "m = k", "m = 3"]"#),
        ]),
        &[
            "duplicate-name at k: the abbreviation `k` has the name of a parameter",
            "duplicate-name at m",
        ],
    );
    expect(
        &so3(&[("casimirs", r#"["z = x^2 + y^2 + z^2"]"#)]),
        &["duplicate-name at z: the Casimir `z` has the name of a coordinate"],
    );
    // an abbreviation is recorded under its own name, and nothing else is
    let recorded = |value: &str| {
        let observables = format!(r#"{{"r": "{value}"}}"#);
        so3(&[("let", r#"["r = x*y"]"#), ("observables", &observables)])
    };
    model(&recorded("r"));
    expect(
        &recorded("2*r"),
        &["duplicate-name at r: the observable `r` has the name of an abbreviation"],
    );
}

#[test]
fn reserved_names() {
    for name in [
        "pi", "t", "energy", "sum", "sqrt", "atan2", "gen", "async", "Self", "_x", "yield",
    ] {
        let state = format!(r#"["{name}", "y", "z"]"#);
        let found = errors(&so3(&[("state", &state), ("hamiltonian", r#""y""#)]));
        assert!(
            found.len() == 1 && found[0].starts_with(&format!("reserved-name at {name}")),
            "{found:#?}"
        );
    }
    for name in ["union", "raw", "Pi", "T", "sinus", "ω", "x_"] {
        let state = format!(r#"["{name}", "y", "z"]"#);
        model(&so3(&[("state", &state), ("hamiltonian", r#""y""#)]));
    }
}

#[test]
fn lets_use_earlier_ones_only() {
    let good = model(&so3(&[
        ("let", r#"["a = x^2", "b = 2*a"]"#),
        ("hamiltonian", r#""b + y""#),
    ]));
    assert_eq!(good.display(good.hamiltonian()), "2*x^2 + y");
    expect(
        &so3(&[("let", r#"["a = 2*b", "b = x"]"#)]),
        &["unknown-symbol at b: `b` is not known yet"],
    );
    expect(
        &so3(&[("let", r#"["a = 2*a"]"#)]),
        &["unknown-symbol at a: `a` is not known yet"],
    );
    // A wrong abbreviation is reported once, not at each use.
    expect(
        &so3(&[("let", r#"["a = 2*q"]"#), ("hamiltonian", r#""a + a*x""#)]),
        &["unknown-symbol at q"],
    );
}

#[test]
fn symbols_in_the_wrong_place() {
    expect(
        &so3(&[("hamiltonian", r#""e1 + x""#)]),
        &["unknown-symbol at e1: `e1` is a basis element"],
    );
    expect(
        &so3(&[("casimirs", r#"["t*x"]"#)]),
        &["reserved-name at t: `t` is the time, which cannot stand here"],
    );
    expect(
        &so3(&[
            ("parameters", r#"{"k": 1}"#),
            ("initial", r#"["x", "k", "u"]"#),
        ]),
        &[
            "unknown-symbol at x: `x` cannot stand here",
            "unknown-symbol at u",
        ],
    );
    let found = run(&so3(&[
        ("parameters", r#"{"mass": 1}"#),
        ("hamiltonian", r#""mas*x""#),
    ]))
    .1;
    assert_eq!(found[0].help.as_deref(), Some("did you mean `mass`?"));
}

#[test]
fn another_number_is_no_slip() {
    let parameters = ("parameters", r#"{"I1": 1, "I2": 2}"#);
    for (key, value, says) in [
        (
            "hamiltonian",
            r#""I4*x + I1/I2""#,
            "in this series there are `I1`, `I2`",
        ),
        (
            "initial",
            r#"["I3", "I1", "I2"]"#,
            "in this series there are `I1`, `I2`",
        ),
        ("hamiltonian", r#""I_1*x + I1/I2""#, "did you mean `I1`?"),
    ] {
        let found = run(&so3(&[parameters, (key, value)])).1;
        let help = found[0].help.as_deref().unwrap_or_default();
        assert!(help.ends_with(says), "{value}: {help}");
    }
}

#[test]
fn lengths() {
    expect(&so3(&[("state", r#"["x", "y"]"#)]), &["state-length"]);
    expect(
        &so3(&[("state", r#"["x", "y", "z", "u"]"#)]),
        &["state-length"],
    );
    expect(&so3(&[("initial", "[1, 2]")]), &["state-length"]);
    expect(
        &so3(&[
            ("algebra", r#"{"basis": [], "brackets": []}"#),
            ("state", "[]"),
            ("hamiltonian", r#""1""#),
        ]),
        &["basis"],
    );
}

#[test]
fn names_are_compared_in_normal_form() {
    // `é` as one character and as two, and the sign of the ohm, which is a capital omega.
    let text = so3(&[
        ("state", r#"["\u00e9", "y", "z"]"#),
        ("parameters", r#"{"\u2126": 2}"#),
        ("hamiltonian", "\"e\u{301}^2/\u{3a9} + 2*\u{e9}\""),
    ]);
    let found = model(&text);
    assert_eq!(found.coordinates[0].text, "\u{e9}");
    assert_eq!(found.parameters[0].name, "\u{3a9}");
    let text = so3(&[
        ("state", "[\"e\u{301}\", \"\u{e9}\", \"z\"]"),
        ("hamiltonian", r#""z""#),
    ]);
    expect(
        &text,
        &["duplicate-name at \u{e9}: `\u{e9}` is declared twice"],
    );
    let (_, diagnostics) = run(&text);
    let help = diagnostics[0].help.as_deref().unwrap();
    assert!(help.contains("normalisation form C"), "{help}");
}

#[test]
fn names_have_no_characters_that_are_not_seen() {
    let text = so3(&[
        ("state", "[\"x\", \"x\u{fe0f}\", \"z\"]"),
        ("hamiltonian", r#""x""#),
    ]);
    expect(
        &text,
        &["syntax at x\u{fe0f}: the name `x\\u{fe0f}` contains U+FE0F, which is invisible"],
    );
}

#[test]
fn constants_of_other_languages() {
    for (text, says) in [
        ("π*x", "did you mean `pi`?"),
        ("e^x", "is written `exp(x)`"),
        ("inf*x", "a finite value"),
        ("NaN + x", "a finite value"),
        ("i*x", "all quantities are real"),
        // Cyrillic, and the wide form.
        ("\u{445}^2", "write `x`"),
        ("\u{ff58}^2", "write `x`"),
        ("omega*x", "declare `omega` as a parameter"),
    ] {
        let (_, diagnostics) = run(&so3(&[("hamiltonian", &format!("{text:?}"))]));
        let [found] = diagnostics.as_slice() else {
            panic!("{text}: {diagnostics:?}")
        };
        assert_eq!(found.kind, Kind::UnknownSymbol, "{text}");
        let help = found.help.as_deref().unwrap_or_default();
        assert!(help.contains(says), "{text}: {help}");
    }
}
