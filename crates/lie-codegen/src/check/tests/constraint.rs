//! Constraints on the velocity: what they leave, against the formulas in numbers.

use super::*;
use crate::model::{Bracket, Model};
use lie_symbolic::symbolic::Graph;

pub(super) const SO3: &str = r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}"#;
const SE2: &str =
    r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e1, e3] = -e2"]}"#;

/// A body by its Lagrangian, with a constraint on its velocity u, v, w.
pub(super) fn body(algebra: &str, constraint: &str, extra: &[(&str, &str)]) -> String {
    system(
        &[
            ("algebra", algebra),
            ("state", r#"["x", "y", "z"]"#),
            ("velocity", r#"["u", "v", "w"]"#),
            (
                "lagrangian",
                r#""(2*u^2 + v^2 + 3/2*w^2)/2 + 3/10*u*w - 2/5*v*w""#,
            ),
            ("constraint", constraint),
        ],
        extra,
    )
}

/// The same by its Hamiltonian with the inverse of the inertia.
pub(super) fn by_hamiltonian(constraint: &str, extra: &[(&str, &str)]) -> String {
    so3(&[
        &[
            (
                "hamiltonian",
                r#""(134*x^2 + 291*y^2 + 200*z^2 - 24*x*y - 60*x*z + 160*y*z)/518""#,
            ),
            ("constraint", constraint),
        ],
        extra,
    ]
    .concat())
}

const INERTIA: [[f64; 3]; 3] = [[2.0, 0.0, 0.3], [0.0, 1.0, -0.4], [0.3, -0.4, 1.5]];

fn shown(model: &Model) -> (Vec<String>, String, Vec<String>) {
    let Bracket::General(matrix) = &model.bracket else {
        panic!("a general bracket");
    };
    let entries = matrix.entries.iter();
    let entries = entries.map(|(i, j, value)| {
        let [a, b] = [*i, *j].map(|k| &model.coordinates[k].text);
        format!("{{{a}, {b}}} = {}", model.display(*value))
    });
    let constraint = model.constraint.as_ref().expect("a constraint");
    let momenta = constraint.momenta.iter();
    (
        entries.collect(),
        model.display(model.hamiltonian()),
        momenta.map(|value| model.display(*value)).collect(),
    )
}

#[test]
fn suslov_with_its_third_axis() {
    let expected = (
        vec!["{x, y} = -3*x/20 + 2*y/5".to_owned()],
        "x^2/4 + y^2/2".to_owned(),
        ["x", "y", "3*x/20 - 2*y/5"].map(str::to_owned).to_vec(),
    );
    for text in [
        body(SO3, r#"["w = 0"]"#, &[]),
        by_hamiltonian(r#"["e3 = 0"]"#, &[]),
        by_hamiltonian(r#"["2*e1 = 2*e1 - e3/7"]"#, &[]),
    ] {
        let found = model(&text);
        assert_eq!(shown(&found), expected, "{text}");
        let constraint = found.constraint.as_ref().expect("a constraint");
        assert_eq!(constraint.jacobi, Some(true), "of dimension 2");
        // what is no coordinate any more is recorded
        let names: Vec<&str> = found.quantities.iter().map(|q| &*q.name).collect();
        assert_eq!(names, ["z"]);
    }
}

/// A right-invariant declaration has the other sign of the bracket and nothing else.
#[test]
fn sides_and_constants_beside_the_bracket() {
    let right = model(&body(SO3, r#"["w = 0"]"#, &[("invariance", r#""right""#)]));
    assert_eq!(shown(&right).0, ["{x, y} = 3*x/20 - 2*y/5"]);
    let cocycle = by_hamiltonian(r#"["e3 = 0"]"#, &[("cocycle", r#"["{x, y} = 1/2"]"#)]);
    assert_eq!(
        shown(&model(&cocycle)).0,
        ["{x, y} = -3*x/20 + 2*y/5 + 1/2"]
    );
}

#[test]
fn names_are_kept_where_the_basis_is_declared() {
    let oblique = model(&body(SO3, r#"["u + 2*v + 2*w = 0"]"#, &[]));
    let names: Vec<&str> = oblique.coordinates.iter().map(|c| &*c.text).collect();
    assert_eq!(names, ["x_D", "y_D"]);
    let constraint = oblique.constraint.as_ref().expect("a constraint");
    assert_eq!(constraint.forms, ["w + 1/2*u + v = 0"]);
    let words = constraint.basis_in_words(&oblique);
    let words: Vec<String> = words.iter().map(|(a, b)| format!("{a}: {b}")).collect();
    assert_eq!(words, ["x_D: e1 - 1/2*e3", "y_D: e2 - e3"]);
    let names: Vec<&str> = oblique.quantities.iter().map(|q| &*q.name).collect();
    assert_eq!(names, ["x", "y", "z"]);
    // only what the form mixes has another name, and none that is taken
    let mixed = model(&by_hamiltonian(
        r#"["e3 = e1"]"#,
        &[("parameters", r#"{"x_D": 1}"#), ("let", r#"["k = x_D"]"#)],
    ));
    let names: Vec<&str> = mixed.coordinates.iter().map(|c| &*c.text).collect();
    assert_eq!(names, ["x_D_", "y"]);
}

/// Solves `A x = b`.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n)
            .max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs()))
            .unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for row in 0..n {
            if row != k {
                let factor = a[row][k] / a[k][k];
                let above = a[k].clone();
                for (entry, above) in a[row].iter_mut().zip(above) {
                    *entry -= factor * above;
                }
                b[row] -= factor * b[k];
            }
        }
    }
    (0..n).map(|k| b[k] / a[k][k]).collect()
}

/// A product of two vectors.
type Product<'a> = &'a dyn Fn(&[f64], &[f64]) -> Vec<f64>;

/// `mu = I E (E^T I E)^-1 m`, `Pi_ab = -<mu, [e_a, e_b]>` and `H = <m, (E^T I E)^-1 m>/2` in numbers.
fn assert_reduced(
    model: &Model,
    inertia: &[&[f64]],
    basis: &[Vec<f64>],
    bracket: Product<'_>,
    parameters: &[f64],
) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let image = |e: &[f64]| -> Vec<f64> { inertia.iter().map(|row| dot(row, e)).collect() };
    let gram = |a: &Vec<f64>| basis.iter().map(|b| dot(a, &image(b))).collect();
    let gram: Vec<Vec<f64>> = basis.iter().map(gram).collect();
    let m: Vec<f64> = (0..basis.len()).map(|k| 0.6 - 0.37 * k as f64).collect();
    let eta = solved(gram, m.clone());
    let xi: Vec<f64> = (0..inertia.len())
        .map(|i| basis.iter().zip(&eta).map(|(e, eta)| e[i] * eta).sum())
        .collect();
    let mu = image(&xi);
    let value = |graph: &Graph, id: ExprId| {
        graph.evaluate(id, &|symbol| match symbol {
            Symbol::Coordinate(i) => m[i],
            Symbol::Parameter(p) => parameters[p],
            _ => f64::NAN,
        })
    };
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-13, "{a} {b}");
    let constraint = model.constraint.as_ref().expect("a constraint");
    for (expr, mu) in constraint.momenta.iter().zip(&mu) {
        close(value(&model.graph, *expr), *mu);
    }
    for (expr, xi) in constraint.velocity.iter().zip(&xi) {
        close(value(&model.graph, *expr), *xi);
    }
    close(
        value(&model.graph, model.hamiltonian()),
        dot(&m, &eta) / 2.0,
    );
    let mut graph = model.graph.clone();
    let mut found = vec![vec![0.0; m.len()]; m.len()];
    for (i, j, entry) in model.bracket.entries(&mut graph) {
        found[i][j] = value(&graph, entry);
    }
    for (a, left) in basis.iter().enumerate() {
        for (b, right) in basis.iter().enumerate().skip(a + 1) {
            close(found[a][b], -dot(&mu, &bracket(left, right)));
        }
    }
}

#[test]
fn reduced_brackets_are_those_of_the_formula() {
    let cross = |x: &[f64], y: &[f64]| {
        let entry = |i: usize, j: usize| x[i] * y[j] - x[j] * y[i];
        vec![entry(1, 2), entry(2, 0), entry(0, 1)]
    };
    let se2 = |x: &[f64], y: &[f64]| {
        let entry = |i: usize, j: usize| x[i] * y[j] - x[j] * y[i];
        vec![0.0, -entry(0, 2), entry(0, 1)]
    };
    let inertia: Vec<&[f64]> = INERTIA.iter().map(|row| &row[..]).collect();
    let oblique = model(&body(SO3, r#"["u + 2*v + 2*w = 0"]"#, &[]));
    let basis = [vec![1.0, 0.0, -0.5], vec![0.0, 1.0, -1.0]];
    assert_reduced(&oblique, &inertia, &basis, &cross, &[]);
    let one = model(&body(SO3, r#"["u = v", "v = w/3"]"#, &[]));
    assert_reduced(&one, &inertia, &[vec![1.0, 1.0, 3.0]], &cross, &[]);
    // a sleigh whose blade stands beside the centre of mass, with parameters in the form and in the inertia
    let sleigh = body(
        SE2,
        r#"["w - b*u = 0"]"#,
        &[
            (
                "parameters",
                r#"{"J": "3/2", "m": 2, "a": "2/5", "b": "-1/3"}"#,
            ),
            ("lagrangian", r#""(J*u^2 + m*v^2 + m*w^2)/2 + m*a*u*w""#),
        ],
    );
    let sleigh = model(&sleigh);
    let (a, b) = (0.4, -1.0 / 3.0);
    let inertia: [&[f64]; 3] = [&[1.5, 0.0, 2.0 * a], &[0.0, 2.0, 0.0], &[2.0 * a, 0.0, 2.0]];
    let basis = [vec![1.0, 0.0, b], vec![0.0, 1.0, 0.0]];
    assert_reduced(&sleigh, &inertia, &basis, &se2, &[1.5, 2.0, a, b]);
}

/// The advected coordinates of a semidirect product stay, and their kernel function is found.
#[test]
fn potentials_and_kernel_functions() {
    let top = system(
        &[
            ("algebra", r#""se(3)""#),
            ("state", r#"["x", "y", "z", "a", "b", "c"]"#),
            (
                "hamiltonian",
                r#""(134*x^2 + 291*y^2 + 200*z^2 - 24*x*y - 60*x*z + 160*y*z)/518 + a/3 + c^3/2 + b^4""#,
            ),
            ("constraint", r#"["J3 = 0"]"#),
        ],
        &[],
    );
    let found = model(&top);
    let (brackets, energy, _) = shown(&found);
    assert_eq!(
        brackets,
        [
            "{x, y} = -3*x/20 + 2*y/5",
            "{x, b} = -c",
            "{x, c} = b",
            "{y, a} = c",
            "{y, c} = -a"
        ]
    );
    assert_eq!(energy, "a/3 + x^2/4 + y^2/2 + c^3/2 + b^4");
    assert_eq!(found.constraint.as_ref().unwrap().jacobi, Some(false));
    let casimirs: Vec<String> = found
        .casimirs
        .iter()
        .map(|c| found.display(c.expr))
        .collect();
    assert_eq!(casimirs, ["a^2 + c^2 + b^2"]);
    let declared = |casimirs: &str| top.replacen('{', &format!("{{\"casimirs\": {casimirs},"), 1);
    model(&declared(r#"["C = a^2 + b^2 + c^2"]"#));
    // a Casimir of the algebra is no kernel function of what is left
    let wrong = errors(&declared(r#"["C = x*a + y*b + z*c"]"#));
    assert!(
        wrong.len() == 1 && wrong[0].starts_with("casimir"),
        "{wrong:?}"
    );
}
