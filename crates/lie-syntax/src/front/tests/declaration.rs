//! The macro's body: what is read, and mistakes at their tokens.

use proc_macro2::TokenStream;

use super::*;
use crate::ast::{Declaration, Invariance};
use crate::front::{Body, Parsed, declaration};

const BODY: &str = r#"
    /// Free rigid body in the body frame.
    /// Second line.
    pub(crate) system RigidBody;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = k*e1; [e3, e1] = e2; }
    state x, y, z;
    parameters {
        /// First moment of inertia.
        I1 = 2.0; I2 = 2e0;
        exact k = 1/3;
    }
    let w2 = y/I2;
    hamiltonian = x^2/(2*I1) + y*w2/2 + z^2;
    casimir C = x^2 + y^2 + z^2;
    casimir x^2;
    methods = [lie-midpoint, gauss4, compose4(midpoint)];
    invariance = right;
    initial = [0.3, -1/2, cos(I1)];
"#;

fn read(text: &str) -> (Parsed, Vec<Diagnostic>) {
    let tokens: TokenStream = text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
    let mut report = Report::new();
    let parsed = declaration::parse(tokens, &mut report);
    (parsed, report.into_diagnostics())
}

pub(super) fn declared(text: &str) -> Declaration {
    match read(text) {
        (
            Parsed {
                body: Some(Body::Declaration(declaration)),
                ..
            },
            _,
        ) => *declaration,
        (_, diagnostics) => panic!("{diagnostics:#?}"),
    }
}

/// Kinds and source texts of the mistakes of `BODY` with a change.
fn changed(from: &str, to: &str) -> Vec<(Kind, String)> {
    assert!(BODY.contains(from), "{from}");
    mistakes(&BODY.replacen(from, to, 1))
}

pub(super) fn mistakes(text: &str) -> Vec<(Kind, String)> {
    let place = |d: Diagnostic| {
        assert!(d.help.is_some(), "{d:?}");
        match d.origin {
            Some(Origin::Span(id)) => (d.kind, id.span().source_text().unwrap_or_default()),
            other => panic!("no token: {other:?}"),
        }
    };
    read(text).1.into_iter().map(place).collect()
}

fn one(kind: Kind, place: &str) -> Vec<(Kind, String)> {
    vec![(kind, place.to_owned())]
}

#[test]
fn everything_is_read() {
    let d = declared(BODY);
    let texts =
        |names: &[crate::ast::Name]| names.iter().map(|n| n.text.clone()).collect::<Vec<_>>();
    assert_eq!(d.visibility.to_string().replace(' ', ""), "pub(crate)");
    assert_eq!(d.name.text, "RigidBody");
    assert_eq!(
        d.description,
        ["Free rigid body in the body frame.", "Second line."]
    );
    assert_eq!(texts(d.basis()), ["e1", "e2", "e3"]);
    let brackets = d.algebra().unwrap().brackets.clone().unwrap();
    assert_eq!(
        (brackets.len(), explicit(&brackets[1].value)),
        (3, "(k*e1)".into())
    );
    assert_eq!(texts(&d.state), ["x", "y", "z"]);
    let parameters: Vec<_> = d
        .parameters
        .iter()
        .map(|p| (p.name.text.as_str(), explicit(&p.default), p.exact))
        .collect();
    assert_eq!(
        parameters,
        [
            ("I1", "2".into(), false),
            ("I2", "2".into(), false),
            ("k", "(1/3)".into(), true)
        ]
    );
    assert_eq!(
        d.parameters[0].description.as_deref(),
        Some("First moment of inertia.")
    );
    assert_eq!(
        (d.lets[0].0.text.as_str(), explicit(&d.lets[0].1)),
        ("w2", "(y/I2)".into())
    );
    assert_eq!(
        explicit(d.energy.expression()),
        "(((x^2)/(2*I1))+(y*w2/2)+(z^2))"
    );
    assert_eq!(d.casimirs[0].name.as_ref().unwrap().text, "C");
    assert!(d.casimirs[1].name.is_none());
    assert_eq!(
        texts(&d.methods),
        ["lie-midpoint", "gauss4", "compose4(midpoint)"]
    );
    assert_eq!(d.invariance, Invariance::Right);
    assert_eq!(
        d.initial.unwrap().iter().map(explicit).collect::<Vec<_>>(),
        ["3/10", "((-1)/2)", "cos(I1)"]
    );
}

#[test]
fn a_spec_by_its_path() {
    let (parsed, diagnostics) = read("/// Heavy top.\npub spec = \"specs/se3 \\u{e9}.json\";");
    assert!(diagnostics.is_empty());
    let Some(Body::Spec { path }) = parsed.body else {
        panic!()
    };
    assert_eq!(
        (path.text.as_str(), parsed.visibility.to_string().as_str()),
        ("specs/se3 é.json", "pub")
    );
    assert_eq!(mistakes("spec = path;"), one(Kind::Syntax, "path"));
    assert_eq!(
        mistakes("spec = \"a\"; state x;"),
        one(Kind::Syntax, "state")
    );
    assert_eq!(mistakes("spec \"a\";"), one(Kind::Syntax, "spec"));
}

#[test]
fn the_path_of_the_runtime() {
    let whole = |path: &str| format!("crate = {path}; {BODY}");
    for path in [
        "my_crate::lie_runtime",
        "::a",
        "crate::a::b",
        "super::super::a",
    ] {
        for text in [
            whole(path),
            format!("crate = {path}; spec = \"a\";"),
            format!("spec = \"a\"; crate = {path};"),
        ] {
            let (parsed, diagnostics) = read(&text);
            assert!(diagnostics.is_empty() && parsed.body.is_some(), "{text}");
            let written = parsed.runtime.path().unwrap();
            assert_eq!(written.to_string().replace(' ', ""), path);
        }
    }
    for path in [
        "my-crate::a",
        "\"a\"",
        "a::",
        "a::<b>",
        "a b",
        "a.b",
        "a::{b}",
    ] {
        assert_eq!(mistakes(&whole(path)), one(Kind::Syntax, path), "{path}");
    }
    assert_eq!(mistakes("crate; spec = \"a\";"), one(Kind::Syntax, "crate"));
}

#[test]
fn expressions_at_their_tokens() {
    use Kind::{Arity, EmptyHamiltonian, Number, Syntax, UnknownFunction};
    for (from, to, kind, place) in [
        ("z^2;", "2x;", Syntax, "2x"),
        ("z^2;", "2(x+y);", Syntax, "2("),
        ("z^2;", "x(y);", Syntax, "x("),
        ("z^2;", "ω·Π;", Syntax, "ω·Π"),
        ("z^2;", "1..5;", Number, "1..5"),
        ("z^2;", "1.2.3;", Number, "1.2.3"),
        ("z^2;", "1.x;", Number, "1.x"),
        ("z^2;", "1f64;", Number, "1f64"),
        ("z^2;", "1_000;", Number, "1_000"),
        ("z^2;", "0x1;", Number, "0x1"),
        ("z^2;", "0b1;", Number, "0b1"),
        ("z^2;", "sni(x);", UnknownFunction, "sni"),
        ("z^2;", "atan2(x);", Arity, "atan2(x)"),
        ("z^2;", "+ x;", Syntax, "+"),
        ("z^2;", "x**2;", Syntax, "*"),
        ("z^2;", "\"x\";", Syntax, "\"x\""),
        ("z^2;", "'x';", Syntax, "'x'"),
        ("z^2;", "r#type;", Syntax, "r#type"),
        ("z^2;", "x[i+1];", Syntax, "x[i+1]"),
        (
            "z^2;",
            "sum(i in 0..3: x[i]);",
            Syntax,
            "sum(i in 0..3: x[i])",
        ),
        ("z^2;", "1e999999999;", Kind::Limit, "1e999999999"),
        (
            "= x^2/(2*I1) + y*w2/2 + z^2;",
            "= ;",
            EmptyHamiltonian,
            "hamiltonian",
        ),
        ("k*e1", "2e1", Syntax, "2e1"),
        ("I1 = 2.0", "I1 = one", Number, "one"),
        ("I1 = 2.0", "I1 = ", Number, "I1"),
        ("w2 = y/I2", "w2", Syntax, "w2"),
        ("0.3", "0.3 x", Syntax, "0.3 x"),
    ] {
        assert_eq!(changed(from, to), one(kind, place), "{to}");
    }
    // `e1` cannot stand in the Hamiltonian, but is declared; a default has no names at all.
    assert_eq!(changed("z^2;", "2e1;"), one(Syntax, "2e1"));
    assert_eq!(changed("I2 = 2e0", "I2 = 2e1"), []);
    assert_eq!(changed("z^2;", "2e4;"), []);
    assert_eq!(changed("z^2;", "1.*x - 0.5;"), []);
}

#[test]
fn statements() {
    use Kind::Syntax;
    for (from, to, place) in [
        ("hamiltonian =", "hamiltonain =", "hamiltonain"),
        ("let w2", "w2", "w2"),
        ("state x, y, z;", "state x, 2, z;", "2"),
        ("state x, y, z;", "state x[i], y, z;", "x[i]"),
        ("invariance = right;", "invariance = up;", "up"),
        ("invariance = right;", "invariance right;", "invariance"),
        ("methods = [lie-midpoint", "methods = [\"rk4\"", "\"rk4\""),
        ("[0.3, -1/2, cos(I1)]", "1", "1"),
        (
            "invariance = right;",
            "invariance = right; invariance = left;",
            "invariance",
        ),
        ("invariance = right;", "pub invariance = right;", "pub"),
        ("[e1, e2] = e3;", "[e1 e2] = e3;", "[e1 e2] = e3"),
        ("[e1, e2] = e3;", "[e1, e2] e3;", "[e1, e2] e3"),
        ("basis e1, e2, e3;", "basis e1, e2, e3; basis e1;", "basis"),
        ("[e3, e1] = e2; }", "[e3, e1] = e2 }", "e2"),
        (
            "state x, y, z;",
            "realization = 3; state x, y, z;",
            "realization",
        ),
        ("state x, y, z;", "#[derive(Debug)] state x, y, z;", "#"),
        ("state x, y, z;", "state x, y, z", "z"),
        ("let w2 = y/I2;", "let w2 = y/I2", "I2"),
        (
            "initial = [0.3, -1/2, cos(I1)];",
            "initial = [0.3, -1/2, cos(I1)]",
            "]",
        ),
    ] {
        assert_eq!(changed(from, to), one(Syntax, place), "{to}");
    }
    let algebra = "{ basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = k*e1; [e3, e1] = e2; }";
    assert_eq!(changed(algebra, "= so(3);"), []);
    assert_eq!(changed(algebra, "= so(3) * R;"), one(Syntax, "*"));
    assert_eq!(changed(algebra, "= ;"), one(Syntax, "="));
    assert_eq!(changed(algebra, "= so(0);"), one(Kind::Number, "0"));
    assert_eq!(
        changed(algebra, "= soo(3);"),
        one(Kind::UnknownSymbol, "soo")
    );
    assert_eq!(changed(algebra, ";"), one(Syntax, "algebra"));
    assert_eq!(changed("basis e1, e2, e3; ", ""), one(Syntax, "algebra"));
}

#[test]
fn missing_statements() {
    use Kind::Syntax;
    for statement in ["state x, y, z;", "hamiltonian = x^2/(2*I1) + y*w2/2 + z^2;"] {
        assert_eq!(
            changed(statement, ""),
            one(Syntax, "RigidBody"),
            "{statement}"
        );
    }
    assert_eq!(mistakes("").len(), 4);
    assert_eq!(
        changed("pub(crate) system RigidBody;", ""),
        one(Syntax, "/// Free rigid body in the body frame.")
    );
    assert_eq!(
        changed("hamiltonian =", "discrete_lagrangian ="),
        one(Syntax, "discrete_lagrangian")
    );
    assert_eq!(mistakes("#").len(), 6);
    assert_eq!(mistakes("/// only words").len(), 5);
}

#[test]
fn several_mistakes_and_what_was_found() {
    let text = BODY
        .replacen("k*e1", "2e1", 1)
        .replacen("y/I2", "sni(y)", 1)
        .replacen("x^2/(2*I1)", "x^2/(2I1)", 1);
    let text = text
        .replacen("methods", "methds", 1)
        .replacen("I2 = 2e0", "I2 = two", 1);
    let found: Vec<String> = mistakes(&text)
        .into_iter()
        .map(|(_, place)| place)
        .collect();
    assert_eq!(found, ["methds", "two", "2e1", "sni", "2I1"]);
    let (parsed, _) = read(&text);
    assert!(parsed.body.is_none());
    assert_eq!(parsed.name.unwrap().text, "RigidBody");
    assert_eq!((parsed.state.len(), parsed.parameters.len()), (3, 3));
}

#[test]
fn invisible_groups_are_parentheses() {
    use proc_macro2::{Delimiter, Group, TokenTree};
    let grouped = |text: &str| TokenTree::from(Group::new(Delimiter::None, text.parse().unwrap()));
    let mut tokens: TokenStream = "algebra { basis a; } state x, y; hamiltonian = 2*"
        .parse()
        .unwrap();
    tokens.extend([grouped("x + y")]);
    tokens.extend("*".parse::<TokenStream>().unwrap());
    tokens.extend([grouped("x")]);
    tokens.extend(";".parse::<TokenStream>().unwrap());
    tokens.extend([grouped("pub(crate)")]);
    tokens.extend("system A;".parse::<TokenStream>().unwrap());
    let mut report = Report::new();
    let Some(Body::Declaration(d)) = declaration::parse(tokens, &mut report).body else {
        panic!("{report:?}")
    };
    assert_eq!(explicit(d.energy.expression()), "(2*(x+y)*x)");
    assert_eq!(d.visibility.to_string().replace(' ', ""), "pub(crate)");
    assert!(report.gate().is_ok());
}

#[test]
fn both_front_ends_read_the_same() {
    // Spaces and all: the tokens of the two lexers agree where Rust's lexer accepts the text.
    for text in [
        "x^-1*y",
        "2e3*x",
        "1.5e-3",
        "1.",
        "x*-y",
        "sin(x)^2/atan2(x, y)",
        "-x^2 - -y",
        "x",
        "1..5",
        "2x",
        "1.x",
        "2.x(y)",
    ] {
        let ours = parse(text).map_or_else(|d| d[0].message.clone(), |e| explicit(&e));
        let body =
            format!("system A; algebra {{ basis a; }} state x, y, e3; hamiltonian = {text};");
        let rusts = match read(&body) {
            (
                Parsed {
                    body: Some(Body::Declaration(d)),
                    ..
                },
                _,
            ) => explicit(d.energy.expression()),
            (_, diagnostics) => diagnostics[0].message.clone(),
        };
        assert_eq!(ours, rusts, "{text}");
    }
}

#[test]
fn brackets_of_coordinates() {
    use crate::ast::Structure;
    let algebra = "algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = k*e1; [e3, e1] = e2; }";
    let general = BODY
        .replacen(algebra, "poisson { {x, y} = w2*z^2; {z, x} = -1; }", 1)
        .replacen("invariance = right;", "", 1);
    let d = declared(&general);
    let Structure::General { brackets, .. } = &d.structure else {
        panic!("{:?}", d.structure)
    };
    let texts: Vec<String> = brackets
        .iter()
        .map(|b| format!("{} {} {}", b.left.text, b.right.text, explicit(&b.value)))
        .collect();
    assert_eq!(texts, ["x y (w2*(z^2))", "z x (-1)"]);
    let d = declared(&BODY.replacen(
        algebra,
        &format!("{algebra} cocycle {{ {{x, y}} = k; }}"),
        1,
    ));
    assert!(matches!(d.structure, Structure::Lie { cocycle, .. } if cocycle.len() == 1));
    let with = |statements: &str| changed(algebra, statements);
    assert_eq!(
        with("poisson { {x, y} = 1; }"),
        one(Kind::Syntax, "invariance")
    );
    assert_eq!(
        with(&format!("{algebra} poisson {{ {{x, y}} = 1; }}")),
        one(Kind::Syntax, "poisson")
    );
    for wrong in [
        "{x, y}",
        "{x, y, z} = 1",
        "(x, y) = 1",
        "[x, y] = 1",
        "{x y} = 1",
    ] {
        let found = with(&format!("{algebra} cocycle {{ {wrong}; }}"));
        assert_eq!(found, one(Kind::Syntax, wrong), "{wrong}");
    }
    assert_eq!(
        mistakes("pub system S; poisson { {x, y} = 1 } state x, y; hamiltonian = x;"),
        one(Kind::Syntax, "1")
    );
}

#[test]
fn parameters_may_be_positive() {
    let text = BODY.replacen("I1 = 2.0; I2 = 2e0;", "I1 = 2.0, positive; I2 = 2e0;", 1);
    let text = text.replacen("exact k = 1/3;", "exact k = 1/3, positive;", 1);
    let parameters = declared(&text).parameters;
    let read: Vec<_> = parameters.iter().map(|p| (p.positive, p.exact)).collect();
    assert_eq!(read, [(true, false), (false, false), (true, true)]);
    assert_eq!(explicit(&parameters[0].default), "2");
    let found = changed("I1 = 2.0;", "I1 = 2.0, positve;");
    assert_eq!(found, [(Kind::Syntax, "positve".into())]);
    let found = changed("I1 = 2.0;", "I1 = , positive;");
    assert_eq!(found.len(), 1, "{found:?}");
}

#[test]
fn signs_of_other_languages_and_second_brackets() {
    assert_eq!(changed("[e1, e2] = e3", "[e1, e2] == e3").len(), 1);
    assert_eq!(
        changed("casimir C = x^2 + y^2 + z^2", "casimir C = x^2 + y^2 = 1"),
        one(Kind::Syntax, "= 1")
    );
    let both = "[e1, e2] = e3, [e2, e3] = k*e1";
    let (_, found) = read(&BODY.replacen("[e1, e2] = e3; [e2, e3] = k*e1", both, 1));
    assert_eq!(found[0].help.as_deref(), Some("end each bracket with `;`"));
}
