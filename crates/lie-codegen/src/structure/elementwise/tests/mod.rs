mod closed;

use super::{Change, Elementwise, Speed, elementwise};
use crate::compile::compile_spec;
use crate::model::PoissonMatrix;
use crate::structure::numbers::Numbers;
use lie_symbolic::exact::{Fraction, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// `a(x)` with its coefficients, as it may be declared.
fn speed(
    numbers: &mut Numbers,
    graph: &mut Graph,
    x: ExprId,
    degree: u64,
) -> (ExprId, [Rational; 2]) {
    let mut all = [Rational::ZERO; 2];
    for coefficient in all.iter_mut().take(degree as usize) {
        *coefficient = numbers.factor();
    }
    all[degree as usize] = Rational::ONE;
    let terms = all.iter().zip(0..).map(|(coefficient, k)| {
        let power = graph.pow(x, &Rational::from(k));
        graph.scale(power, coefficient)
    });
    let terms: Vec<ExprId> = terms.collect();
    (graph.sum(&terms), all)
}

/// 200 brackets, and near misses: what is added to one entry has no product form.
#[test]
fn random_brackets_are_recognised_and_others_are_not() {
    let spec = r#"{"format": 1, "name": "Any", "state": ["x", "y", "z", "u"],
        "poisson": ["{x, y} = x*y"], "hamiltonian": "x + y + z + u"}"#;
    let model = compile_spec(spec).expect("a spec without mistakes");
    let mut numbers = Numbers(7);
    for number in 0..200 {
        let mut graph = model.graph.clone();
        let x: Vec<ExprId> = (0..4)
            .map(|i| graph.symbol(Symbol::Coordinate(i)))
            .collect();
        // one in three is log-canonical
        let log = number % 3 == 0;
        let speeds: Vec<(ExprId, [Rational; 2])> = x
            .iter()
            .map(|x| match log {
                true => (*x, [Rational::ZERO, Rational::ONE]),
                false => {
                    let degree = numbers.below(2);
                    speed(&mut numbers, &mut graph, *x, degree)
                }
            })
            .collect();
        let mut entries = Vec::new();
        for i in 0..4 {
            for j in i + 1..4 {
                if numbers.below(4) > 0 {
                    let product = graph.mul(speeds[i].0, speeds[j].0);
                    let normal = graph.normal(product);
                    entries.push((i, j, graph.scale(normal, &numbers.factor())));
                }
            }
        }
        let Some((i, j, entry)) = entries.first().copied() else {
            continue;
        };
        let mut matrix = PoissonMatrix {
            dimension: 4,
            entries: entries.clone(),
            degree: None,
        };
        let found = elementwise(&model, &matrix, &mut graph);
        let Elementwise { speeds: found, .. } = found.unwrap_or_else(|| panic!("number {number}"));
        for (place, (found, (_, expected))) in found.iter().zip(&speeds).enumerate() {
            if entries.iter().any(|(a, b, _)| [*a, *b].contains(&place)) {
                let expected = expected.clone().map(Fraction::from);
                assert_eq!(found, &Speed::Affine(expected), "number {number}");
            }
        }
        // powers of both, and a product of them
        let powers = [(x[i], 2), (x[j], 3)].map(|(x, power)| graph.pow(x, &Rational::from(power)));
        let product = graph.mul(powers[0], powers[1]);
        for added in [graph.add(powers[0], powers[1]), product] {
            let added = graph.scale(added, &Rational::new(1, 1000).expect("a number"));
            matrix.entries[0].2 = graph.add(entry, added);
            let found = elementwise(&model, &matrix, &mut graph);
            assert!(found.is_none(), "number {number}: a near miss");
        }
    }
}

/// The flow of `x' = s a(x)` over the time 1.
#[test]
fn flows_of_speeds_solve_their_equation() {
    let mut graph = Graph::new();
    let s = graph.symbol(Symbol::Time);
    let number = |a: i64, b: i64| Rational::new(a, b).expect("a number");
    for coefficients in [
        [number(1, 1), Rational::ZERO],
        [Rational::ZERO, number(1, 1)],
        [number(2, 3), number(1, 1)],
        [number(-5, 2), number(1, 1)],
    ] {
        let speed = Speed::Affine(coefficients.clone().map(Fraction::from));
        let change = speed.flow(0, s, &mut graph).expect("a flow");
        for (start, time) in [(0.7, 0.3), (-1.2, 2.0), (2.5, -1.5)] {
            let at = |symbol| if symbol == Symbol::Time { time } else { start };
            let found = match change {
                Change::Add(value) => start + graph.evaluate(value, &at),
                Change::Multiply(value) => start * graph.evaluate(value, &at),
            };
            let [a, b] = coefficients.clone().map(|value| value.to_f64());
            let expected = match b == 0.0 {
                true => start + time * a,
                false => (start + a) * f64::exp(time) - a,
            };
            let off = (found - expected).abs();
            assert!(
                off < 1e-14 * (1.0 + expected.abs()),
                "{a} {b}: {found} {expected}"
            );
        }
    }
}

fn with_parameter(brackets: &str) -> Option<Elementwise> {
    let spec = format!(
        r#"{{"format": 1, "name": "Any", "state": ["x", "y"], "parameters": {{ "k": 0 }},
            "poisson": ["{{x, y}} = {brackets}"], "hamiltonian": "x + y"}}"#
    );
    let model = compile_spec(&spec).expect("a spec without mistakes");
    let matrix = model.bracket.matrix().expect("entries").clone();
    elementwise(&model, &matrix, &mut model.graph.clone())
}

/// What would be divided by a parameter, which may be 0, is not looked for.
#[test]
fn nothing_is_divided_by_a_parameter() {
    assert!(with_parameter("(1 + k*x)*y").is_none());
    assert!(with_parameter("(x + k)*y").is_some());
    assert!(with_parameter("k*x*y").is_some());
    assert!(with_parameter("(1 + k*x^2)*y").is_none());
}
