use super::{Conjugate, Form, conjugate, of_matrix};
use crate::compile::compile_spec;
use crate::model::Model;
use crate::structure::elementwise::Side;
use crate::structure::numbers::Numbers;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

impl Numbers {
    fn of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.below(all.len() as u64) as usize]
    }

    /// B of a pair x, y with a closed integral over y, its text; c is in no bracket.
    fn density(&mut self, [x, y, c]: [&str; 3]) -> String {
        let mut sum = "4 + 11*Y^2".to_owned();
        for _ in 0..1 + self.below(3) {
            let of_x = self.of(&[
                "1",
                "X",
                "X^2",
                "cos(X)",
                "exp(-X^2)",
                "sqrt(1 + X^2)",
                "C*X",
            ]);
            let of_y = self.of(&[
                "1",
                "Y",
                "Y^2",
                "(2*Y + 1)^3",
                "exp(Y/2)",
                "sin(2*Y)",
                "cosh(1 - Y)",
            ]);
            let term = format!("({})*{of_x}*{of_y}", self.factor());
            sum = format!("{sum} + {term}");
        }
        sum.replace('X', x).replace('Y', y).replace('C', c)
    }
}

fn model(state: &[&str], brackets: &[String]) -> Model {
    let quoted = |items: &[String]| {
        let items = items.iter().map(|item| format!("\"{item}\""));
        items.collect::<Vec<_>>().join(", ")
    };
    let state: Vec<String> = state.iter().map(|&name| name.to_owned()).collect();
    let spec = format!(
        r#"{{"format": 1, "name": "Pairs", "state": [{}], "poisson": [{}], "hamiltonian": "x + u",
            "parameters": {{"k": {{"default": 0, "exact": true}}}}}}"#,
        quoted(&state),
        quoted(brackets)
    );
    let compiled = compile_spec(&spec).unwrap_or_else(|why| panic!("{spec}: {why:?}"));
    (*compiled.model).clone()
}

fn found(model: &Model) -> Option<(Conjugate, Graph)> {
    let mut graph = model.graph.clone();
    conjugate(model, &mut graph).map(|found| (found, graph))
}

/// That `{partner, w} = c` with a number c, by values: the slope of w is taken by differences.
fn is_constant(model: &Model, found: &Conjugate, graph: &Graph, number: u64) {
    let matrix = model.own_matrix().expect("entries");
    for change in &found.changes {
        let (y, Form::Integral(x)) = (change.coordinate, &change.form) else {
            continue;
        };
        let entry = matrix.entries.iter();
        let mut entry = entry.filter(|(i, j, _)| [*i, *j] == [y.min(*x), y.max(*x)]);
        let entry = entry.next().expect("an entry").2;
        let at = |value: ExprId, point: usize, moved: f64| {
            graph.evaluate(value, &|symbol| match symbol {
                Symbol::Coordinate(k) => {
                    let place = ((3 * k + 7 * point) as f64).sin();
                    place + if k == y { moved } else { 0.0 }
                }
                _ => 1.0,
            })
        };
        let products = (0..5).map(|point| {
            let h = 1e-5;
            let [ahead, behind] = [h, -h].map(|moved| at(change.value, point, moved));
            at(entry, point, 0.0) * (ahead - behind) / (2.0 * h)
        });
        let products: Vec<f64> = products.collect();
        for product in &products {
            let off = (product / products[0] - 1.0).abs();
            assert!(off < 1e-6, "number {number}: {products:?}");
        }
    }
}

/// 200 brackets, scaled, their coordinates in any order, beside a constant pair and a Casimir, and near misses.
#[test]
fn random_pairs_are_recognised_and_others_are_not() {
    let mut numbers = Numbers(11);
    for number in 0..200 {
        let mut state = ["x", "y", "z", "u", "p", "q", "c"];
        for i in (1..state.len()).rev() {
            state.swap(i, numbers.below(i as u64 + 1) as usize);
        }
        let place = |name: &str| state.iter().position(|own| *own == name);
        // the integral is over the later coordinate, where it has a closed form there
        let mut ordered = [["x", "y"], ["z", "u"]];
        for pair in &mut ordered {
            pair.sort_by_key(|name| place(name));
        }
        let both = numbers.below(2) == 0;
        let mut brackets = vec!["{p, q} = 2/3".to_owned()];
        let count = 1 + usize::from(both);
        for [x, y] in &ordered[..count] {
            let density = numbers.density([x, y, "c"]);
            let scale = numbers.factor();
            let [a, b] = if numbers.below(2) == 0 {
                [x, y]
            } else {
                [y, x]
            };
            brackets.push(format!("{{{a}, {b}}} = ({scale})/({density})"));
        }
        let own = model(&state, &brackets);
        let (conjugate, graph) =
            found(&own).unwrap_or_else(|| panic!("number {number}: {brackets:?}"));
        assert_eq!(
            conjugate.changes.len(),
            count,
            "number {number}: {brackets:?}"
        );
        is_constant(&own, &conjugate, &graph, number);
        // what has no closed integral over either, no quotient, and what depends on a coordinate of another pair
        let [x, y] = ordered[0];
        let pair = brackets[1].clone();
        for wrong in [
            pair.replace(")/(", &format!(")/(exp({x}*{y})/100 + ")),
            format!("{pair} + 1/1000*{x}*{y}"),
        ] {
            brackets[1] = wrong;
            let near = model(&state, &brackets);
            assert!(found(&near).is_none(), "number {number}: {brackets:?}");
        }
        let mut matrix = own.own_matrix().expect("entries");
        let mut graph = own.graph.clone();
        let p = place("p").expect("a place");
        let added = graph.symbol(Symbol::Coordinate(p));
        let added = graph.scale(added, &Rational::new(1, 1000).expect("a number"));
        let [i, j] = [x, y].map(|name| place(name).expect("a place"));
        for (a, b, entry) in &mut matrix.entries {
            if [*a, *b] == [i, j] {
                *entry = graph.add(*entry, added);
            }
        }
        let near = of_matrix(&own, &matrix, &mut graph);
        assert!(
            near.is_none(),
            "number {number}: a coordinate of another pair"
        );
        matrix.entries.push((i.min(p), i.max(p), added));
        let near = of_matrix(&own, &matrix, &mut graph);
        assert!(near.is_none(), "number {number}: three coordinates");
    }
}

fn changed(brackets: &[&str]) -> Option<Vec<String>> {
    let brackets: Vec<String> = brackets.iter().map(|text| (*text).to_owned()).collect();
    let model = model(&["x", "y", "u", "v"], &brackets);
    let (found, graph) = found(&model)?;
    let name = |symbol| model.symbol_name(symbol);
    let texts = found.changes.iter();
    let texts = texts.map(|change| graph.display(change.value, &name));
    Some(texts.collect())
}

/// The terms of a sum, and their factors, in an order of their own.
fn sorted(sum: &str) -> Vec<String> {
    let terms = sum.split(" + ").map(|term| {
        let mut factors: Vec<&str> = term.split('*').collect();
        factors.sort_unstable();
        factors.join("*")
    });
    let mut terms: Vec<String> = terms.collect();
    terms.sort_unstable();
    terms
}

#[test]
fn integrals_are_over_the_coordinate_that_has_one() {
    let is = |bracket: &str, coordinate: usize| {
        let model = model(&["x", "y", "u"], &[bracket.to_owned()]);
        let (found, graph) = found(&model).expect("coordinates");
        assert_eq!(found.changes[0].coordinate, coordinate, "{bracket}");
        is_constant(&model, &found, &graph, 0);
    };
    is("{x, y} = 1/(1 + y^2)", 1);
    is("{x, y} = 3*exp(-y)/(1 + x^2)^2", 1);
    is("{x, y} = 1/(3 + 2*y)^4", 1);
    // the parameter may be 0, over which nothing is divided
    is("{x, y} = k/(2 + x + y^3)", 1);
    is("{x, y} = 1/(2 + sin(k*y))", 0);
    // of exp(y^2) there is no integral over y
    is("{x, y} = 1/(exp(y^2) + x)", 0);
    assert_eq!(changed(&["{x, y} = 1/(exp(y^2) + exp(x^2))"]), None);
}

/// Zeros and poles of a pair's bracket are borders in either coordinate, also where its sign is the same behind them.
#[test]
fn every_zero_of_a_density_is_a_border() {
    let is_beside = |bracket: &str, from: [f64; 2], to: [f64; 2]| {
        let model = model(&["x", "y", "u"], &[format!("{{x, y}} = {bracket}")]);
        let (found, graph) = found(&model).expect("coordinates");
        let at = |value: ExprId, state: [f64; 2]| {
            graph.evaluate(value, &|symbol| match symbol {
                Symbol::Coordinate(k) => state[k],
                _ => 1.0,
            })
        };
        let mut sides = found.changes.iter().flat_map(|change| &change.sides);
        sides.all(|side| match side {
            Side::Sign(value) => at(*value, from) * at(*value, to) > 0.0,
            Side::Turn(angle) => (at(*angle, from) - at(*angle, to)).abs() < 3.0,
        })
    };
    for (bracket, from, within, beyond) in [
        ("1/(y^2 - 1)", [0.1, 1.5], [-0.3, 3.0], [0.1, -1.5]),
        ("1/(y^2 - 1)", [0.1, 1.5], [-0.3, 1.2], [0.1, 0.5]),
        ("x^2", [1.0, 1.0], [0.2, -3.0], [-1.0, 1.0]),
        ("sin(x)/(1 + y^2)", [1.0, 1.0], [2.0, -1.0], [-0.2, 1.0]),
        ("x^2/(x^2 + y^2)", [1.0, 1.0], [0.1, -1.0], [-0.5, 1.0]),
        ("cos(2*y)^2", [1.0, 0.1], [-1.0, -0.2], [1.0, 1.6]),
        ("cos(2*y)^2", [1.0, 0.1], [-1.0, 0.5], [1.0, 3.2]),
    ] {
        assert!(is_beside(bracket, from, within), "{bracket}: {within:?}");
        assert!(!is_beside(bracket, from, beyond), "{bracket}: {beyond:?}");
    }
}

#[test]
fn logarithms_may_stand_beside() {
    let found = changed(&["{x, y} = 1/(1 + y^2)", "{u, v} = 2*u*(v + 1)"]);
    let found = found.expect("coordinates");
    assert_eq!(sorted(&found[0]), sorted("y + y^3/3"));
    assert_eq!(found[1], "log(u^2)/2");
    assert_eq!(found.len(), 3);
    // constant as it is
    assert!(changed(&["{x, y} = 1", "{u, v} = k"]).is_none());
}

#[test]
fn a_block_of_three_is_no_pair() {
    let nambu = [
        "{x, y} = u^2".to_owned(),
        "{y, u} = x^2".to_owned(),
        "{u, x} = y^2".to_owned(),
    ];
    let model = model(&["x", "y", "u"], &nambu);
    assert!(found(&model).is_none());
}
