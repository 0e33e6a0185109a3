//! Functions by tables: mistakes at their places, and how smooth they are.

use super::*;
use crate::structure::smoothness::joints;

const CURVE: &str = r#"[[-2, 1], [-1, "1/3"], [0, 0], [0.5, 0.4], [1, 1], [2, 3], [3, 2], [4, 5]]"#;

fn with(table: &str, hamiltonian: &str) -> String {
    let functions = format!(r#"{{"f": {table}}}"#);
    let hamiltonian = format!("{hamiltonian:?}");
    so3(&[("functions", &functions), ("hamiltonian", &hamiltonian)])
}

fn curve(rest: &str, hamiltonian: &str) -> Structure {
    model(&with(
        &format!(r#"{{"table": {CURVE}{rest}}}"#),
        hamiltonian,
    ))
}

fn value(model: &Structure, x: f64) -> f64 {
    model
        .graph
        .evaluate(model.hamiltonian(), &|symbol| match symbol {
            Symbol::Coordinate(0) => x,
            _ => 0.25,
        })
}

#[test]
fn tables_take_their_values() {
    for degree in [1, 3, 5, 7] {
        let model = curve(&format!(r#", "degree": {degree}"#), "f(x) + y - y");
        let points = [
            (-2.0, 1.0),
            (-1.0, 1.0 / 3.0),
            (0.0, 0.0),
            (0.5, 0.4),
            (1.0, 1.0),
            (2.0, 3.0),
            (3.0, 2.0),
            (4.0, 5.0),
        ];
        for (x, y) in points {
            assert!(
                (value(&model, x) - y).abs() < 1e-13,
                "degree {degree} at {x}"
            );
        }
        assert!(value(&model, -2.001).is_nan() && value(&model, 4.001).is_nan());
    }
    let constant = curve(r#", "outside": "constant""#, "f(x)");
    assert_eq!((value(&constant, -9.0), value(&constant, 7.0)), (1.0, 5.0));
    let linear = curve(r#", "degree": 1, "outside": "linear""#, "f(x)");
    assert!((value(&linear, 5.0) - 8.0).abs() < 1e-14);
    assert!((value(&linear, -3.0) - 5.0 / 3.0).abs() < 1e-14);
}

#[test]
fn a_table_of_a_polynomial_is_the_polynomial() {
    let table =
        r#"{"table": [[-2, -8], [-1, -1], [0, 0], [1, 1], [2, 8], [3, 27]], "outside": "linear"}"#;
    let model = model(&with(table, "f(x)"));
    for x in [-1.7, 0.3, 2.9] {
        assert!((value(&model, x) - x.powi(3)).abs() < 1e-13);
    }
    // its knots are no joints, its ends are
    let found: Vec<_> = joints(&model)
        .into_iter()
        .map(|j| (j.place, j.jump))
        .collect();
    assert_eq!(found, [("x = -2, 3".to_owned(), Some(2))]);
}

#[test]
fn a_spline_of_degree_d_has_a_jump_of_that_order() {
    for (degree, knots) in [
        (1, "x = -1, 0, 1/2, 1, 2, 3"),
        (3, "x = 0, 1/2, 1, 2"),
        (5, "x = 1/2, 1"),
    ] {
        let model = curve(&format!(r#", "degree": {degree}"#), "f(x)*y");
        let found = joints(&model);
        let knot = found.iter().find(|joint| joint.place == knots);
        assert_eq!(
            knot.map(|joint| joint.jump),
            Some(Some(degree)),
            "{found:?}"
        );
    }
    // of a function of the state too, whose joints are spheres
    let radial = curve(r#", "outside": "constant""#, "f(sqrt(x^2 + y^2 + 2*z^2))");
    let found = joints(&radial);
    let inner = found.iter().filter(|joint| joint.jump == Some(3)).count();
    assert_eq!(inner, 1, "{found:?}");
}

#[test]
fn the_end_of_a_table_is_no_joint_but_one_of_a_continued_table() {
    let places = |rest: &str| -> Vec<(String, Option<u32>)> {
        let found = joints(&curve(rest, "f(x)"));
        found.into_iter().map(|j| (j.place, j.jump)).collect()
    };
    let knots = ("x = 0, 1/2, 1, 2".to_owned(), Some(3));
    assert_eq!(places(""), std::slice::from_ref(&knots));
    let constant = places(r#", "outside": "constant""#);
    assert!(
        constant.contains(&knots) && constant.contains(&("x = -2, 4".to_owned(), Some(1))),
        "{constant:?}"
    );
    let linear = places(r#", "outside": "linear""#);
    assert!(
        linear.contains(&knots) && linear.contains(&("x = -2, 4".to_owned(), Some(2))),
        "{linear:?}"
    );
}

#[test]
fn tables_stand_wherever_functions_do() {
    let text = with(
        &format!(r#"{{"table": {CURVE}, "outside": "constant"}}"#),
        "f(x)*f(y - z/2)/2",
    );
    let text = text.replacen("\"hamiltonian\"", "\"let\": [\"w = f(x + y)\"], \"casimirs\": [\"f(x^2 + y^2 + z^2) + w - w\"],\n\"hamiltonian\"", 1);
    assert!(run(&text).0.is_some(), "{:?}", run(&text).1);
}

#[test]
fn mistakes_in_tables_have_places() {
    let of = |table: &str, rest: &str| with(&format!(r#"{{"table": {table}{rest}}}"#), "f(x)");
    for (text, expected) in [
        (
            of("[[0, 1], [2, 1], [1, 3], [4, 5]]", ""),
            "number at [1, 3]: the places of `f` do not ascend here",
        ),
        (
            of("[[0, 1], [2, 1], [2, 3], [4, 5]]", ""),
            "number at [2, 3]: the places of `f` do not ascend here",
        ),
        (
            of("[[0, 1], [2, 1], [3, 3]]", ""),
            "number at f: `f` has 3 points, too few for degree 3",
        ),
        (
            of("[[0, 1], [2, 1], [3, 3]]", r#", "degree": 2"#),
            "number at 2: the degree of a spline is an odd number",
        ),
        (
            of("[[0, 1], [2, 1], [3, 3]]", r#", "degree": 9"#),
            "number at 9: the degree of a spline is an odd number",
        ),
        (
            of(r#"[[0, "pi"], [2, 1]]"#, r#", "degree": 1"#),
            "number at [0, \"pi\"]: the numbers of a table are rational",
        ),
        (of("[[0, 1, 2], [2, 1]]", r#", "degree": 1"#), "schema at ["),
        (
            of("[[0, 1], [2, 1]]", r#", "degree": 1, "outside": "mirror""#),
            "number at mirror: `mirror` does not say",
        ),
        (
            of("[[0, 1], [2, 1]]", r#", "degree": 1, "knots": 3"#),
            "schema at knots: unknown key `knots`",
        ),
    ] {
        let found = errors(&text);
        assert_eq!(found.len(), 1, "{found:#?}");
        assert!(
            found[0].starts_with(expected),
            "{} instead of {expected}",
            found[0]
        );
    }
    let table = format!(r#"{{"table": {CURVE}}}"#);
    for (text, expected) in [
        (with(&table, "f(x, y)"), "arity at f(x, y)"),
        (with(&table, "g(x)"), "unknown-function at g"),
        (
            so3(&[("functions", &format!(r#"{{"x": {table}}}"#))]),
            "duplicate-name at x",
        ),
        (
            so3(&[("functions", &format!(r#"{{"sin": {table}}}"#))]),
            "reserved-name at sin",
        ),
        (
            so3(&[("functions", &format!(r#"{{"norm": {table}}}"#))]),
            "reserved-name at norm",
        ),
        (so3(&[("functions", "[1]")]), "schema at ["),
    ] {
        let found = errors(&text);
        assert!(found[0].starts_with(expected), "{found:?}");
    }
}
