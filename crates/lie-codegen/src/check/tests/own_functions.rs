//! Functions of Rust: what is known of them, what is refused, and where.

use super::*;
use crate::structure::found::terms;
use crate::structure::smoothness::joints;
use lie_symbolic::prove::joints::reached;
use lie_syntax::front::declaration;

/// so(3) with functions and statements.
fn body(functions: &str, rest: &str) -> String {
    format!(
        "pub system Test; algebra {{ basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }} state x, y, z;
        functions {{ {functions} }} {rest}"
    )
}

fn checked(text: &str) -> (Option<Structure>, Vec<Diagnostic>) {
    let tokens = text
        .parse()
        .unwrap_or_else(|error| panic!("{text}: {error}"));
    let mut report = Report::new();
    let parsed = declaration::parse(tokens, &mut report);
    let model = match parsed.body {
        Some(Body::Declaration(declaration)) => {
            analysed(&declaration, Effort::Declaration, &mut report)
        }
        _ => None,
    };
    (model, report.into_diagnostics())
}

fn sound(functions: &str, rest: &str) -> Structure {
    let (model, diagnostics) = checked(&body(functions, rest));
    model.unwrap_or_else(|| panic!("{diagnostics:#?}"))
}

/// The kind and the message of the first mistake, which has a remedy.
fn mistake(text: &str) -> (Kind, String) {
    let (model, diagnostics) = checked(text);
    assert!(model.is_none(), "{text}");
    let first = diagnostics.first().expect("a mistake");
    assert!(first.help.is_some() && first.origin.is_some(), "{first:?}");
    (first.kind, first.message.clone())
}

const F: &str = "f(r) = crate::f;";

#[test]
fn derivatives_are_those_of_the_chain_rule() {
    let model = sound(
        "g(u, v) = m::g;",
        "hamiltonian = z + 3*g(x^2, x*y) + g(1, 2);",
    );
    let mut graph = model.graph.clone();
    let slope = graph.derivative(model.hamiltonian(), Symbol::Coordinate(0));
    let text = graph.display(slope, &|symbol| model.symbol_name(symbol));
    assert!(
        text.contains("g^(1, 0)(x^2, x*y)") && text.contains("g^(0, 1)(x^2, x*y)"),
        "{text}"
    );
    let at = |x: f64| {
        graph.evaluate(model.hamiltonian(), &|symbol| match symbol {
            Symbol::Coordinate(0) => x,
            _ => 0.7,
        })
    };
    let difference = (at(0.3 + 1e-5) - at(0.3 - 1e-5)) / 2e-5;
    let exact = model.graph.evaluate(slope, &|symbol| match symbol {
        Symbol::Coordinate(0) => 0.3,
        _ => 0.7,
    });
    assert!((difference - exact).abs() < 1e-8);
}

#[test]
fn identities_hold_that_hold_for_every_function() {
    for (casimir, proven) in [
        ("f(x^2 + y^2 + z^2)", true),
        ("f(x^2 + y^2 + z^2)^2 + x^2 + y^2 + z^2", true),
        ("f(2*(x + y)^2 - 4*x*y + 2*z^2)", true),
        ("x^2 + y^2 + z^2 + f(x) - f(x*(y + 1) - x*y)", true),
        ("f(x^2 + y^2)", false),
        ("f(x) - f(y)", false),
        ("x^2 + y^2 + z^2 + f(0)*x", false),
    ] {
        let rest = format!("hamiltonian = x^2 + 2*y^2 + f(z); casimir C = {casimir};");
        let (model, diagnostics) = checked(&body(F, &rest));
        assert_eq!(model.is_some(), proven, "{casimir}: {diagnostics:#?}");
        if !proven {
            assert_eq!(diagnostics[0].kind, Kind::Casimir);
        }
    }
}

#[test]
fn declared_smoothness_limits_the_orders() {
    let order = |functions: &str, hamiltonian: &str, order: u32| {
        let model = sound(functions, &format!("hamiltonian = {hamiltonian};"));
        reached(&joints(&model), order)
    };
    assert_eq!(order(F, "f(x) + y^2", 6), Some(6));
    assert_eq!(order("f(r) = f, smooth 2;", "f(x) + y^2", 6), Some(3));
    assert_eq!(order("f(r) = f, smooth 2;", "f(x) + y^2", 2), Some(2));
    // one that H does not call limits nothing
    assert_eq!(order("f(r) = f, smooth 0;", "x + y^2", 6), Some(6));
    let both = "f(r) = f, smooth 4; t1 = table [(0, 0), (1, 1), (2, 0), (3, 2), (4, 4)], degree 3;";
    assert_eq!(order(both, "f(x) + t1(y)", 8), Some(3));
    assert_eq!(order(both, "f(x) + y", 8), Some(5));
    // whether a joint inside a function is smooth is not known
    assert_eq!(order(F, "f(abs(x)) + y^2", 6), None);
}

#[test]
fn what_is_not_finite_elsewhere_is_still_found() {
    let rest = "hamiltonian = x + f(log(x)); initial = [-1, 0, 0];";
    let (model, _) = checked(&body(F, rest));
    assert!(model.is_some(), "what f makes of it is not known");
    let rest = "hamiltonian = log(x); casimir C = f(x^2 + y^2 + z^2); initial = [-1, 0, 0];";
    assert_eq!(mistake(&body(F, rest)).0, Kind::Domain);
}

#[test]
fn mistakes_have_kinds_and_remedies() {
    let h = "hamiltonian = x^2 + f(y);";
    let general = "pub system Test; poisson { {x, y} = f(x); } state x, y;
        functions { f(r) = crate::f; } hamiltonian = x^2 + y^2;";
    let lagrangian = body(F, "velocity = a, b, c; lagrangian = a^2 + b^2 + f(c);")
        .replace("velocity = a", "velocity a");
    for (text, kind, message) in [
        (
            body(F, "hamiltonian = f(x, y);"),
            Kind::Arity,
            "`f` takes 1 argument, not 2",
        ),
        (
            body(F, "hamiltonian = g(x);"),
            Kind::UnknownFunction,
            "there is no function `g`",
        ),
        (
            body("f() = crate::f;", h),
            Kind::Arity,
            "`f` has 0 arguments",
        ),
        (
            body("f(a, b, c, d, e) = crate::f;", h),
            Kind::Arity,
            "`f` has 5 arguments",
        ),
        (
            body("f(a, b) = crate::f, derivatives (crate::fa);", h),
            Kind::Arity,
            "`f` has 2 arguments, but here are 1 derivatives",
        ),
        (
            body("f(r) = crate::f, smooth two;", h),
            Kind::Number,
            "`smooth` is followed by",
        ),
        (
            body("f(r) = crate::f, smooth -1;", h),
            Kind::Number,
            "`smooth` is followed by",
        ),
        (
            body("f(r) = crate::f, rough 2;", h),
            Kind::Syntax,
            "this is no function of Rust",
        ),
        (
            body("f(r) = |x| x;", h),
            Kind::Syntax,
            "this is no function of Rust",
        ),
        (
            body("f(r) crate::f;", h),
            Kind::Syntax,
            "this is no function of Rust",
        ),
        (body("f = crate::f;", h), Kind::Syntax, "`f` is no table"),
        (
            body("sin(r) = crate::f;", h),
            Kind::ReservedName,
            "`sin` is a word",
        ),
        (
            body("x(r) = crate::f;", h),
            Kind::DuplicateName,
            "`x` is declared twice",
        ),
        (
            body("f(r) = a; f(r) = b;", h),
            Kind::DuplicateName,
            "`f` is declared twice",
        ),
        (
            body("f(r) = a; f = table [(0, 0), (1, 1)], degree 1;", h),
            Kind::DuplicateName,
            "`f` is declared twice",
        ),
        (
            body(F, "hamiltonian = x; initial = [f(1), 0, 0];"),
            Kind::UnknownFunction,
            "",
        ),
        (
            general.to_owned(),
            Kind::Jacobi,
            "`f` is a function of Rust, which cannot stand in a bracket",
        ),
        (
            lagrangian,
            Kind::Legendre,
            "`f` is a function of Rust, which the Legendre transform cannot",
        ),
    ] {
        let found = mistake(&text);
        assert!(
            found.0 == kind && found.1.starts_with(message),
            "{text}: {found:?}"
        );
    }
}

#[test]
fn a_spec_has_no_functions_of_rust() {
    let text = so3(&[
        ("functions", r#"{"f": "crate::f"}"#),
        ("hamiltonian", r#""f(x)""#),
    ]);
    let found = errors(&text);
    assert!(
        found[0].starts_with("schema at crate::f: a function of Rust cannot stand in a spec")
            || found[0].starts_with("schema at \"crate::f\": a function of Rust"),
        "{found:?}"
    );
}

#[test]
fn functions_of_one_coordinate_are_pieces() {
    let pieces = |hamiltonian: &str| {
        let model = sound(F, &format!("hamiltonian = {hamiltonian};"));
        let searched = &model.splitting;
        let way = searched.ways.first()?;
        Some(terms(&model, searched, way).pieces.len())
    };
    // a multiple of the Casimir is taken away, and two are left
    assert_eq!(pieces("x^2/2 + y^2/3 + f(z)"), Some(2));
    assert!(pieces("x^2/2 + f(3*z + 1)*z").is_some());
    // a Casimir is a constant of the motion of each piece
    assert!(pieces("x^2/2 + f(x^2 + y^2 + z^2)*z").is_some());
    assert_eq!(pieces("x^2/2 + f(x*y*z)"), None);
}
