use super::*;
use crate::model::Energy;

/// so(3) with a Lagrangian in the velocity w1, w2, w3.
fn lagrangian(value: &str, extra: &[(&str, &str)]) -> String {
    let algebra = r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}"#;
    let value = format!("{value:?}");
    system(
        &[
            ("algebra", algebra),
            ("state", r#"["x", "y", "z"]"#),
            ("velocity", r#"["w1", "w2", "w3"]"#),
            ("lagrangian", &value),
            ("parameters", r#"{"a": 2, "b": "1/3", "c": "-3/2"}"#),
        ],
        extra,
    )
}

#[test]
fn a_diagonal_lagrangian_gives_the_hamiltonian_that_one_writes() {
    let model = model(&lagrangian("a*w1^2/2 + b*w2^2/2 + w3^2", &[]));
    let text = model.display(model.hamiltonian());
    let expected = so3(&[
        ("parameters", r#"{"a": 2, "b": "1/3"}"#),
        ("hamiltonian", r#""x^2/(2*a) + y^2/(2*b) + z^2/4""#),
    ]);
    let expected = super::model(&expected);
    assert_eq!(text, expected.display(expected.hamiltonian()));
    let hamiltonian = model.energy.expression().expect("an expression");
    assert_eq!(hamiltonian.degree, Some(2));
    assert_eq!(model.separable, Some(Ok(vec![0, 1, 2])));
}

/// `l = <A w, w>/2 + <b, w> + c` as text and as numbers at a = 2, b = 1/3, c = -3/2.
type Form = (&'static str, [[f64; 3]; 3], [f64; 3], f64);
const FORMS: [Form; 6] = [
    (
        "w1^2 + a*w1*w2/2 + w2^2 + w3^2/2 + b*w2*w3 + c*w1 - w3 + a*b",
        [
            [2.0, 1.0, 0.0],
            [1.0, 2.0, 1.0 / 3.0],
            [0.0, 1.0 / 3.0, 1.0],
        ],
        [-1.5, 0.0, -1.0],
        2.0 / 3.0,
    ),
    // no diagonal to begin with
    (
        "a*w1*w2 + w3^2/2 + c",
        [[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [0.0; 3],
        -1.5,
    ),
    (
        "w1*w2 + w2*w3 + w1*w3 + b*w2",
        [[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]],
        [0.0, 1.0 / 3.0, 0.0],
        0.0,
    ),
    // indefinite
    (
        "c*w1^2/2 + (w1 + w2)^2/2 - w3^2",
        [[-0.5, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, -2.0]],
        [0.0; 3],
        0.0,
    ),
    // quadratic, but not at first sight
    (
        "w1^2*(sin(w2)^2 + cos(w2)^2) + (w2 + w3)^2 - 2*w2*w3",
        [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]],
        [0.0; 3],
        0.0,
    ),
    // the pivot that the order of the names suggests is 1e-9
    (
        "w1^2/2000000000 + w1*w2 + w2^2/2 + w3^2/2",
        [[1e-9, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [0.0; 3],
        0.0,
    ),
];

/// `mu = l'(w)` has the energy `<mu, w> - l(w)`, and `grad H(mu)` is w.
#[test]
fn the_gradient_of_h_inverts_the_legendre_map() {
    let w = [0.7, -0.4, 1.1];
    for (text, matrix, linear, constant) in FORMS {
        let model = model(&lagrangian(text, &[]));
        let times = |i: usize| (0..3).map(|j| matrix[i][j] * w[j]).sum::<f64>();
        let mu: Vec<f64> = (0..3).map(|i| times(i) + linear[i]).collect();
        let kinetic = 0.5 * (0..3).map(|i| times(i) * w[i]).sum::<f64>();
        let mut graph = model.graph.clone();
        let mut roots = vec![model.hamiltonian()];
        roots.extend((0..3).map(|i| graph.derivative(model.hamiltonian(), Symbol::Coordinate(i))));
        let values = graph.evaluate_all(&roots, &|symbol| match symbol {
            Symbol::Coordinate(i) => mu[i],
            Symbol::Parameter(p) => [2.0, 1.0 / 3.0, -1.5][p],
            _ => f64::NAN,
        });
        let expected = [kinetic - constant, w[0], w[1], w[2]];
        for (value, expected) in values.iter().zip(expected) {
            assert!(
                (value - expected).abs() < 1e-13,
                "{text}: {values:?}, expected {expected}, H = {}",
                model.display(model.hamiltonian())
            );
        }
    }
}

#[test]
fn abbreviations_serve_lagrangians() {
    let extra = [("let", r#"["turn = w1 + w2"]"#)];
    let model = model(&lagrangian("turn^2/2 + w2^2/2 + w3^2/2", &extra));
    let hamiltonian = model.energy.expression().expect("an expression");
    assert_eq!(hamiltonian.degree, Some(2));
}

#[test]
fn what_has_no_transform_is_refused() {
    let refused = |value: &str, message: &str| {
        let found = errors(&lagrangian(value, &[]));
        let expected = format!("legendre at {value}: {message}");
        assert!(
            found.len() == 1 && found[0].starts_with(&expected),
            "{found:#?}\n{expected}"
        );
    };
    let singular = |rank: usize, names: &str| {
        format!(
            "the Lagrangian is singular at the default parameters: its Hessian has rank {rank} of 3, \
             and the momenta do not determine {names}"
        )
    };
    refused("w1^2 + w2^2", &singular(2, "`w3`"));
    refused("(w1 + a*w2)^2 + w3^2", &singular(2, "`w2`"));
    refused("b*(w1/3 + w2/7 + w3/11)^2", &singular(1, "`w2`, `w3`"));
    refused("w1^2 + (a - 2)*w2^2 + w3^2", &singular(2, "`w2`"));
    refused("c", &singular(0, "`w1`, `w2`, `w3`"));
    let at_rest = |rank: usize| {
        format!(
            "the Lagrangian is singular at rest with the default parameters: its Hessian has rank {rank} of 3 there"
        )
    };
    refused("w1^2 + w2^3 + w3^2", &at_rest(2));
    refused("w1^4 + w2^4 + w3^4", &at_rest(0));
    refused("w1*w2 + w1^2*w3^2 + exp(w1)", &at_rest(2));
}

/// Lagrangians that are not quadratic: no expression of H, and the velocity of a momentum by iteration.
#[test]
fn others_are_left_to_newtons_iteration() {
    use crate::methods::{Choice, refusal};

    for (value, xi, mu) in [
        (
            "w1^2 + w2^2/2 + w3^2/3 + w1^4/10 + w2^2*w3^2/5",
            [0.4, 0.5, 0.7],
            [0.8256, 0.598, 161.0 / 300.0],
        ),
        // a full step of Newton leaves the domain
        (
            "-sqrt(1 - w1^2 - w2^2 - w3^2)",
            [0.9, 0.0, 0.3],
            [0.9, 0.0, 0.3].map(|x: f64| x / 0.1_f64.sqrt()),
        ),
        ("w1*w2 + w3^2/2 + w3^4", [1.5, -2.0, 0.5], [-2.0, 1.5, 1.0]),
    ] {
        let model = model(&lagrangian(value, &[]));
        let Energy::Legendre(lagrangian, _) = &model.energy else {
            panic!("{value}: {:?}", model.energy)
        };
        let found = super::super::velocity::velocity(
            &mut model.graph.clone(),
            lagrangian,
            &mu,
            &model.defaults(),
        );
        let found = found.expect("a velocity");
        for (found, expected) in found.iter().zip(xi) {
            assert!(
                (found - expected).abs() < 1e-14,
                "{value}: {found} {expected}"
            );
        }
        for id in [
            "variational2",
            "variational6",
            "generating6",
            "lie-midpoint",
            "mean-value",
        ] {
            let choice = Choice::from_id(id).expect("a method");
            assert_eq!(refusal(&model, &choice), None, "{id}");
        }
        for id in ["splitting2", "moser-veselov"] {
            let choice = Choice::from_id(id).expect("a method");
            assert!(refusal(&model, &choice).is_some(), "{id}");
        }
    }
}

/// The transform is exact where the derivatives of third order can be shown to vanish.
#[test]
fn a_quadratic_lagrangian_in_disguise_is_exact() {
    let text = lagrangian("(w1^2 + w2^2)*(cos(w1)^2 + sin(w1)^2) + w3^2", &[]);
    let model = model(&text);
    assert!(matches!(model.energy, Energy::Lagrangian(..)));
    assert_eq!(model.display(model.hamiltonian()), "x^2/4 + y^2/4 + z^2/4");
}

#[test]
fn the_initial_state_has_a_velocity() {
    let text = |initial: &str| lagrangian("sqrt(1 + w1^2) + w2^2 + w3^2", &[("initial", initial)]);
    assert!(model(&text("[0.9, 5, 7]")).initial_rank.is_some());
    expect(
        &text("[1.5, 5, 7]"),
        &["domain at [1.5, 5, 7]: the Hamiltonian is not finite because no velocity"],
    );
}

#[test]
fn a_lagrangian_is_defined_at_rest() {
    expect(
        &lagrangian("w1^2 + w2^4/w2^2 + w3^2 + log(a - 2)", &[]),
        &[
            "legendre at w1^2 + w2^4/w2^2 + w3^2 + log(a - 2): the Lagrangian or one of its first two derivatives is not finite at rest",
        ],
    );
}

#[test]
fn momenta_and_velocities_do_not_mix() {
    let l = "w1^2 + w2^2 + w3^2";
    expect(
        &lagrangian("w1^2 + w2^2 + w3^2 + x", &[]),
        &["unknown-symbol at x"],
    );
    expect(
        &lagrangian(l, &[("casimirs", r#"["w1^2"]"#)]),
        &["unknown-symbol at w1"],
    );
    expect(
        &lagrangian(l, &[("velocity", r#"["w1", "w2"]"#)]),
        &["unknown-symbol at w3", "state-length at w2"],
    );
    expect(
        &lagrangian(l, &[("velocity", r#"["w1", "w2", "w3", "w4"]"#)]),
        &["state-length at w4"],
    );
    expect(
        &lagrangian("w2^2", &[("velocity", r#"["x", "w2", "w3"]"#)]),
        &["duplicate-name"],
    );
    expect(&lagrangian(" ", &[]), &["empty-hamiltonian"]);
}

#[test]
fn one_function_gives_the_system() {
    let l = "w1^2 + w2^2 + w3^2";
    expect(
        &lagrangian(l, &[("hamiltonian", r#""x^2""#)]),
        &["schema at \"w1^2 + w2^2 + w3^2\": `lagrangian` and `hamiltonian` are both given"],
    );
    expect(
        &so3(&[("velocity", r#"["w1", "w2", "w3"]"#)]),
        &["schema at [\"w1\", \"w2\", \"w3\"]: `velocity` cannot be combined with `hamiltonian`"],
    );
    expect(
        &so3(&[("lagrangian", r#""x^2""#)]),
        &["schema at \"x^2\": `lagrangian` and"],
    );
    let alone = system(
        &[
            ("algebra", r#"{"basis": ["e1"], "brackets": []}"#),
            ("state", r#"["x"]"#),
            ("lagrangian", r#""1""#),
        ],
        &[],
    );
    expect(
        &alone,
        &["schema at \"1\": the Lagrangian has no `velocity`"],
    );
}

/// so(3) with a discrete Lagrangian in the coordinates w1, w2, w3.
fn discrete(value: &str) -> String {
    lagrangian(value, &[]).replace("\"lagrangian\"", "\"discrete_lagrangian\"")
}

/// The Lagrangian that a discrete one approximates, and its Hamiltonian.
#[test]
fn discrete_lagrangians_have_their_limit() {
    for (value, limit, hamiltonian) in [
        (
            "(w1^2 + w2^2/2)/(2*h) + w3^2/h - w1*w2*w3/h^2 + 3/h + 1",
            "w1^2/2 + w2^2/4 + w3^2 - w1*w2*w3",
            None,
        ),
        (
            "h*(a*(w1/h)^2/2 + (w2/h)^2 + (w3/h)^2) + b*w1",
            "w1*b + a*w1^2/2 + w2^2 + w3^2",
            Some("(x - b)^2/(2*a) + y^2/4 + z^2/4"),
        ),
        // of higher order in h: no part of the limit
        (
            "(w1^2 + w2^2 + w3^2)/(2*h) + w1^3/h + h^3 + (w1/h)^2*w2^2",
            "w1^2/2 + w2^2/2 + w3^2/2",
            Some("x^2/2 + y^2/2 + z^2/2"),
        ),
        (
            "((1 - cos(w1)) + log(1 + w2^2)/2)/h + sqrt(h^2 + w3^2) - h",
            "w1^2/2 + w2^2/2 + (w3^2 + 1)^(1/2) - 1",
            None,
        ),
        (
            "2*(w1^2 + w2^2 + w3^2)/(h*(4 + w1^2 + w2^2 + w3^2))",
            "w1^2/2 + w2^2/2 + w3^2/2",
            Some("x^2/2 + y^2/2 + z^2/2"),
        ),
    ] {
        let model = model(&discrete(value));
        let found = model.energy.lagrangian().expect("it has one");
        assert!(found.discrete.is_some());
        let at = |value: ExprId, w: [f64; 3]| {
            model.graph.evaluate(value, &|symbol| match symbol {
                Symbol::Input(i) => w[i],
                Symbol::Parameter(p) => model.defaults()[p],
                _ => f64::NAN,
            })
        };
        let expected = super::model(&lagrangian(limit, &[]));
        let value_of_limit = expected.energy.lagrangian().expect("it has one").value;
        for w in [[0.3, -0.7, 1.1], [2.0, 0.25, -0.5]] {
            let (a, b) = (
                at(found.value, w),
                expected
                    .graph
                    .evaluate(value_of_limit, &|symbol| match symbol {
                        Symbol::Input(i) => w[i],
                        Symbol::Parameter(p) => model.defaults()[p],
                        _ => f64::NAN,
                    }),
            );
            assert!(
                (a - b).abs() < 1e-14,
                "{value}: {} is not {limit}: {a} {b}",
                model.display(found.value)
            );
        }
        if let Some(hamiltonian) = hamiltonian {
            assert!(model.energy.expression().is_some());
            let expected = so3(&[
                ("parameters", r#"{"a": 2, "b": "1/3", "c": "-3/2"}"#),
                ("hamiltonian", &format!("{hamiltonian:?}")),
            ]);
            let expected = super::model(&expected);
            let value = |model: &crate::model::Model| {
                model
                    .graph
                    .evaluate(model.hamiltonian(), &|symbol| match symbol {
                        Symbol::Coordinate(i) => [0.3, 0.8, -1.2][i],
                        Symbol::Parameter(p) => model.defaults()[p],
                        _ => f64::NAN,
                    })
            };
            assert!(
                (value(&model) - value(&expected)).abs() < 1e-14,
                "{hamiltonian}"
            );
        }
    }
}

#[test]
fn discrete_lagrangians_without_a_limit_are_refused() {
    for value in [
        "(w1^2 + w2^2 + w3^2)/(2*h^2)",
        "w1 + w1^2 + w2^2 + w3^2",
        "w1/h + (w1^2 + w2^2 + w3^2)/(2*h)",
        "exp(1/h)*w1^2 + w2^2 + w3^2",
        "atan2(w1, h) + (w2^2 + w3^2)/h",
    ] {
        let expected = "legendre at ".to_owned()
            + value
            + ": the discrete Lagrangian is not consistent with any";
        if value.starts_with("w1 + ") {
            // the limit is linear: nothing is left of the kinetic energy
            expect(&discrete(value), &["legendre"]);
        } else {
            expect(&discrete(value), &[&expected]);
        }
    }
}

/// Behind folds of a Lagrangian that is not convex there is a velocity where it is the only one of its momentum.
#[test]
fn a_velocity_behind_folds() {
    let lagrangian = |initial: &str| {
        so3(&[
            ("hamiltonian", "null"),
            ("velocity", r#"["u", "v", "w"]"#),
            (
                "lagrangian",
                r#""u^2/2 - u^4/4 + 3*u^6/60 + v^2 + w^2*3/2""#,
            ),
            ("initial", initial),
        ])
        .replace("\"hamiltonian\": null,\n", "")
    };
    for x in [
        "0.2", "0.41", "0.42", "0.83", "0.97", "1", "1.03", "-1", "40",
    ] {
        let (model, diagnostics) = run(&lagrangian(&format!("[{x}, 0.9, 0.8]")));
        assert!(model.is_some(), "{x}: {diagnostics:#?}");
    }
}
