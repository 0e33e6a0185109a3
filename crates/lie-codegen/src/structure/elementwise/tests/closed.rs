//! Brackets whose functions are neither constant nor linear.

use super::elementwise;
use crate::compile::compile_spec;
use crate::structure::elementwise::{Closed, Elementwise, Side, Speed};
use crate::structure::numbers::Numbers;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Functions with a closed integral, and points with a zero or a pole between any two neighbours.
const SPEEDS: [(&str, &[f64]); 34] = [
    ("1 + X^2", &[0.3]),
    ("X^2", &[-0.4, 0.7]),
    ("2*X^2 - 3*X + 5", &[0.3]),
    ("X*(1 - X)", &[-1.2, 0.3, 1.7]),
    ("1 - X^2", &[-1.4, 0.2, 2.5]),
    ("X^2 - 2", &[-2.0, 0.1, 3.0]),
    ("(1 + X^2)^2", &[0.6]),
    ("(X^2 - 3)^2", &[-2.5, 0.1, 1.9]),
    ("X^3", &[-0.4, 0.7]),
    ("X*(1 + X^2)", &[-0.4, 0.7]),
    ("(1 - X)^2*(2 + X)/3", &[-3.0, 0.5, 1.5]),
    ("1/X", &[-0.4, 0.7]),
    ("1/(1 + X^2)", &[0.4]),
    ("(1 + X)/(2 - X)", &[-1.5, 0.5, 2.5]),
    ("(X^2 + 1)/(X^2 + 2)", &[0.4]),
    ("exp(X)", &[0.4]),
    ("exp(-2*X + 1)", &[0.4]),
    ("sqrt(1 + X^2)", &[-0.6]),
    ("(1 + X^2)^(3/2)", &[0.6]),
    ("sqrt(1 - X^2)", &[0.6]),
    ("sqrt(2*X^2 - 1)", &[-1.3, 1.4]),
    ("sqrt(X)", &[0.6]),
    ("X^(2/3)", &[0.6]),
    ("cosh(X)", &[0.6]),
    ("cosh(X/2)^2", &[0.6]),
    ("1/cosh(X)", &[0.6]),
    ("sinh(2*X)", &[-0.6, 0.3]),
    ("sinh(X)^2", &[-0.6, 0.3]),
    ("tanh(X)", &[-0.6, 0.3]),
    ("1/tanh(X)", &[-0.6, 0.3]),
    ("sin(X)", &[-4.0, -0.5, 0.5, 4.0, 8.0]),
    ("sin(X + 1)^2", &[-4.5, -1.6, 0.5, 4.0]),
    ("cos(2*X)", &[-3.0, -1.2, 0.1, 1.0]),
    ("tan(X)", &[-2.0, -0.5, 0.5, 2.0]),
];

/// Functions that are not, or whose integrals are not closed here.
const OTHERS: [&str; 7] = [
    "sqrt(X^2 - 2*X + 1)",
    "1 + X^5",
    "X*exp(X)",
    "exp(X) + X^2",
    "sin(X) + 2",
    "log(X)",
    "(X^2 + 1)*(X^2 + 2)",
];

fn of_brackets(state: &[&str], brackets: &[String]) -> Option<(Elementwise, Graph, Vec<Entry>)> {
    let quoted = |items: Vec<String>| items.join(", ");
    let spec = format!(
        r#"{{"format": 1, "name": "Any", "state": [{}], "poisson": [{}], "hamiltonian": "{}"}}"#,
        quoted(state.iter().map(|name| format!("\"{name}\"")).collect()),
        quoted(
            brackets
                .iter()
                .map(|entry| format!("\"{entry}\""))
                .collect()
        ),
        state[0],
    );
    let model = compile_spec(&spec).unwrap_or_else(|why| panic!("{spec}: {why:?}"));
    let matrix = model.bracket.matrix().expect("entries").clone();
    let mut graph = model.graph.clone();
    let found = elementwise(&model, &matrix, &mut graph)?;
    Some((found, graph, matrix.entries))
}

type Entry = (usize, usize, ExprId);

/// A function of coordinate 0, in the bracket with the coordinate 1.
fn one(speed: &str) -> Option<(Closed, Graph)> {
    let bracket = format!("{{x, y}} = {}", speed.replace('X', "x"));
    let (found, graph, _) = of_brackets(&["x", "y"], &[bracket])?;
    match found.speeds[0].clone() {
        Speed::Other(closed) => Some((closed, graph)),
        Speed::Affine(_) => None,
    }
}

fn at(graph: &Graph, value: ExprId, x: f64) -> f64 {
    graph.evaluate(value, &|_| x)
}

/// Whether two points have in common what states on one side have.
fn is_beside(closed: &Closed, graph: &Graph, x: f64, y: f64) -> bool {
    closed.sides.iter().all(|side| match side {
        Side::Sign(value) => at(graph, *value, y) / at(graph, *value, x) > 0.0,
        Side::Turn(angle) => {
            (at(graph, *angle, y) - at(graph, *angle, x)).abs() < std::f64::consts::PI
        }
    })
}

/// `a dw/dx = 1` by differences on every side, and no two sides are taken for one.
#[test]
fn integrals_are_closed_on_each_side() {
    for (text, points) in SPEEDS {
        let (closed, graph) = one(text).unwrap_or_else(|| panic!("{text}"));
        for (place, &x) in points.iter().enumerate() {
            let h = 1e-5;
            let [ahead, behind] = [x + h, x - h].map(|x| at(&graph, closed.integral, x));
            let product = (ahead - behind) / (2.0 * h) * at(&graph, closed.speed, x);
            assert!((product - 1.0).abs() < 1e-7, "{text} at {x}: {product}");
            assert!(is_beside(&closed, &graph, x, x + 0.05), "{text} at {x}");
            for &other in &points[place + 1..] {
                assert!(
                    !is_beside(&closed, &graph, x, other),
                    "{text}: {x}, {other}"
                );
                assert!(
                    !is_beside(&closed, &graph, other, x),
                    "{text}: {x}, {other}"
                );
            }
        }
    }
    // far out on the other side no digits are lost
    let (closed, graph) = one("sqrt(2*X^2 - 1)").expect("an integral");
    let [here, there] = [1e5, -1e5].map(|x| at(&graph, closed.integral, x));
    assert!((here + there).abs() < 1e-14 * here, "{here}, {there}");
    for text in OTHERS {
        assert!(one(text).is_none(), "{text}");
    }
}

/// 200 brackets in any order of the coordinates, scaled, in half of them with powers multiplied out, and near misses.
#[test]
fn random_brackets_of_such_functions_are_recognised() {
    let mut numbers = Numbers(17);
    for number in 0..200 {
        let mut state = ["x", "y", "z", "u"];
        for i in (1..state.len()).rev() {
            state.swap(i, numbers.below(i as u64 + 1) as usize);
        }
        let speed = |name: &str, numbers: &mut Numbers| {
            let (text, _) = SPEEDS[numbers.below(SPEEDS.len() as u64) as usize];
            let expanded = ["1 + 2*X + X^2", "X^2 - X^3", "4 + X^2 - 4*X", "X^2/2 + 2*X"];
            let text = match numbers.below(3) {
                0 => expanded[numbers.below(4) as usize],
                _ => text,
            };
            text.replace('X', name)
        };
        let speeds: Vec<String> = state.iter().map(|name| speed(name, &mut numbers)).collect();
        let mut brackets = Vec::new();
        for i in 0..4 {
            for j in i + 1..4 {
                if numbers.below(4) > 0 {
                    let [a, b] = [state[i], state[j]];
                    let [f, g] = [&speeds[i], &speeds[j]];
                    brackets.push(format!("{{{a}, {b}}} = ({})*({f})*({g})", numbers.factor()));
                }
            }
        }
        if brackets.is_empty() {
            continue;
        }
        let Some((found, mut graph, entries)) = of_brackets(&state, &brackets) else {
            panic!("number {number}: {brackets:?}");
        };
        for (i, j, entry) in entries {
            let product = [i, j].map(|k| found.speeds[k].at(k, &mut graph));
            let constant = graph.rational_function(&found.constants[i][j]);
            for point in [[0.3, 0.4], [0.61, 0.52]] {
                let value = |value: ExprId| {
                    graph.evaluate(value, &|symbol| {
                        point[usize::from(symbol == Symbol::Coordinate(i))]
                    })
                };
                let expected = value(constant) * value(product[0]) * value(product[1]);
                let off = value(entry) - expected;
                // not where a root has no value
                let close = off.is_nan() || off.abs() < 1e-12 * (1.0 + expected.abs());
                assert!(close, "number {number}: {brackets:?}");
            }
        }
        let (bracket, value) = brackets[0].split_once(" = ").expect("a value");
        let names = bracket
            .trim_matches(['{', '}'])
            .split_once(", ")
            .expect("a pair");
        let near = format!(
            "{bracket} = {value} + ({}*{})^2/1000 + 1/1000",
            names.0, names.1
        );
        assert!(
            of_brackets(&state[..], &[near]).is_none(),
            "number {number}"
        );
    }
}
