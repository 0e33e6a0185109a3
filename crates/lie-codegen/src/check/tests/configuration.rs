use super::*;

/// The energy as it was declared.
fn declared(model: &Structure) -> ExprId {
    model.energy.expression().expect("an expression").energy
}
use crate::derive::Source;
use lie_symbolic::symbolic::Symbol;

const MATRICES: &str = r#""matrices": {"e1": [[0,0,0],[0,0,-1],[0,1,0]], "e2": [[0,0,1],[0,0,0],[-1,0,0]], "e3": [[0,-1,0],[1,0,0],[0,0,0]]}"#;

fn top(extra: &[(&str, &str)]) -> String {
    let algebra = format!(
        r#"{{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"], {MATRICES}}}"#
    );
    let base = [
        ("algebra", algebra.as_str()),
        ("group", r#""R""#),
        ("state", r#"["x", "y", "z"]"#),
        ("hamiltonian", r#""x^2 + 2*y^2 + z^2/2 + R33""#),
    ];
    system(&base, extra)
}

fn value(source: &Source, expr: lie_symbolic::symbolic::ExprId, mu: &[f64]) -> f64 {
    source.graph.evaluate(expr, &|symbol| match symbol {
        Symbol::Coordinate(i) => mu[i],
        _ => f64::NAN,
    })
}

#[test]
fn entries_of_the_group_element_are_coordinates_and_move_with_it() {
    for (invariance, sign) in [("left", 1.0), ("right", -1.0)] {
        let model = model(&top(&[("invariance", &format!("{invariance:?}"))]));
        let names: Vec<&str> = model.coordinates.iter().map(|n| n.text.as_str()).collect();
        assert_eq!(names[..5], ["x", "y", "z", "R11", "R12"]);
        assert_eq!(model.dimension(), 12);
        let mut source = crate::derive::Source::new(&model);
        let field = source.field();
        let g = [0.1, -0.7, 0.3, 0.9, 0.2, -0.4, 0.6, 0.8, -0.5];
        let m = [0.4, -0.3, 0.8];
        let mu: Vec<f64> = m.into_iter().chain(g).collect();
        // xi = dH/dmu, and its matrix as the product with a vector
        let [a, b, c] = [2.0 * m[0], 4.0 * m[1], m[2]];
        let hat = [0.0, -c, b, c, 0.0, -a, -b, a, 0.0];
        let product = |l: &[f64], r: &[f64], i: usize, j: usize| -> f64 {
            (0..3).map(|k| l[3 * i + k] * r[3 * k + j]).sum()
        };
        for i in 0..3 {
            for j in 0..3 {
                let expected = if sign > 0.0 {
                    product(&g, &hat, i, j)
                } else {
                    product(&hat, &g, i, j)
                };
                let found = value(&source, field[3 + 3 * i + j], &mu);
                assert!((found - expected).abs() < 1e-15, "{invariance} {i}{j}");
            }
        }
        // the torque of R33: -F, F = L_g^* dH/dg = dH/da x a for a row a (right: a column)
        let a = if sign > 0.0 {
            [g[6], g[7], g[8]]
        } else {
            [g[2], g[5], g[8]]
        };
        let cross = |u: [f64; 3], v: [f64; 3]| {
            [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ]
        };
        let free = cross(m, [2.0 * m[0], 4.0 * m[1], m[2]]);
        let force = cross([0.0, 0.0, 1.0], a);
        for k in 0..3 {
            // of a right-invariant system F = R_g^* dH/dg = a x dH/da
            let expected = sign * (free[k] - force[k]);
            let found = value(&source, field[k], &mu);
            assert!((found - expected).abs() < 1e-15, "{invariance} m{k}");
        }
    }
}

#[test]
fn the_matrices_of_the_larger_algebra_represent_it() {
    for extra in [
        vec![],
        vec![("invariance", r#""right""#)],
        vec![("hamiltonian", r#""x^2 + R12*sin(t)""#)],
        vec![
            ("hamiltonian", r#""x^2 + R12*sin(t)""#),
            ("invariance", r#""right""#),
        ],
    ] {
        // the check of the representation has passed, and Cayley carries over
        let model = model(&top(&extra));
        let representation = model.bracket.representation().expect("matrices");
        assert!(representation.triple.is_some(), "{extra:?}");
        assert!(representation.dual.is_some(), "{extra:?}");
    }
}

#[test]
fn the_time_is_a_coordinate_with_a_momentum() {
    for (invariance, sign) in [("left", 1.0), ("right", -1.0)] {
        let model = model(&so3(&[
            ("hamiltonian", r#""x^2 + z*cos(2*t)""#),
            ("invariance", &format!("{invariance:?}")),
            ("initial", "[1, 2, 3]"),
        ]));
        let names: Vec<&str> = model.coordinates.iter().map(|n| n.text.as_str()).collect();
        assert_eq!(names, ["x", "y", "z", "_p", "t", "_one"]);
        assert_eq!(model.shown_coordinates(), [0, 1, 2]);
        assert_eq!(model.display(declared(&model)), "x^2 + z*cos(2*t)");
        let start = model.initial_values(&[]).unwrap();
        assert_eq!(start, [1.0, 2.0, 3.0, 0.0, 0.0, 1.0]);
        let mut source = crate::derive::Source::new(&model);
        let field = source.field();
        let mu = [0.3, -0.4, 0.5, 0.7, 0.25, 1.0];
        let f: Vec<f64> = field.iter().map(|f| value(&source, *f, &mu)).collect();
        assert_eq!(f[4], 1.0, "t' = 1");
        assert_eq!(f[5], 0.0);
        assert!(
            (f[3] - 2.0 * mu[2] * 0.5_f64.sin()).abs() < 1e-15,
            "p' = -dH/dt"
        );
        assert!((f[0] - sign * mu[1] * 0.5_f64.cos()).abs() < 1e-15);
    }
}

#[test]
fn a_lagrangian_may_depend_on_the_configuration() {
    let lagrangian = |value: &str| {
        let value = format!("{value:?}");
        let keys = [
            ("velocity", r#"["u", "v", "w"]"#),
            ("lagrangian", value.as_str()),
        ];
        top(&keys).replace("\"hamiltonian\": \"x^2 + 2*y^2 + z^2/2 + R33\",\n", "")
    };
    let model = model(&lagrangian("u^2 + v^2/2 + (1 + R11^2)*w^2/2 - R33*cos(t)"));
    assert_eq!(
        model.display(declared(&model)),
        "R33*cos(t) + x^2/4 + y^2/2 + z^2/(2*(R11^2 + 1))"
    );
    expect(
        &lagrangian("u^2 + v^2/2 + R12*w^2"),
        &["legendre at u^2 + v^2/2 + R12*w^2: the Lagrangian is singular"],
    );
}

#[test]
fn mistakes_with_the_group_element_have_their_places() {
    expect(
        &top(&[("hamiltonian", r#""x^2 + R34""#)]),
        &["unknown-symbol at R34"],
    );
    expect(
        &so3(&[("group", r#""R""#)]),
        &["representation at R: a group element needs the matrices"],
    );
    expect(
        &top(&[("parameters", r#"{"R12": 1}"#)]),
        &["duplicate-name at R12: `R12` is an entry of the group element"],
    );
    expect(
        &top(&[("initial", "[1, 2, 3, 4]")]),
        &["state-length at [1, 2, 3, 4]: the initial state has 4 values"],
    );
    expect(
        &top(&[("group", r#""fn""#), ("hamiltonian", r#""x^2""#)]),
        &["reserved-name at fn"],
    );
    let at_identity = model(&top(&[("initial", "[1, 2, 3]")]));
    let start = at_identity.initial_values(&[]).unwrap();
    assert_eq!(start[3..], [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
}
