//! What whole declarations are found to be: identities that Casimirs need, configurations at rest, the group element
//! of a discrete Lagrangian, initial states.

use lie_codegen::compile::compile_spec;
use lie_codegen::structure::Structure;
use lie_symbolic::symbolic::Symbol;
use serde_json::{Value, json};

/// so(3) with these keys; the message of the first error where it is refused.
fn body(keys: Value) -> Result<Structure, String> {
    let mut spec = json!({
        "format": 1,
        "name": "Body",
        "algebra": {"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]},
        "state": ["x", "y", "z"],
        "parameters": {"k": 2, "a": 3}
    });
    for (key, value) in keys.as_object().expect("keys") {
        spec[key] = value.clone();
    }
    compile_spec(&spec.to_string()).map_err(|errors| errors[0].message.clone())
}

/// The algebra with the matrices of rotations.
fn rotations() -> Value {
    json!({
        "basis": ["e1", "e2", "e3"],
        "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"],
        "matrices": {
            "e1": [[0, 0, 0], [0, 0, -1], [0, 1, 0]],
            "e2": [[0, 0, 1], [0, 0, 0], [-1, 0, 0]],
            "e3": [[0, -1, 0], [1, 0, 0], [0, 0, 0]]
        }
    })
}

/// Whether `|mu|^2 + x (expression)` is taken for a Casimir, which is so where the expression is proven to be zero.
fn vanishes(expression: &str) -> bool {
    let casimir = format!("C = x^2 + y^2 + z^2 + x*({expression})");
    body(json!({"hamiltonian": "x^2 + 2*y^2", "casimirs": [casimir]})).is_ok()
}

/// `cos(pi k/12)` by roots, all the way round.
#[test]
fn twelfths_of_half_a_turn() {
    let quadrant = [
        "1",
        "(sqrt(6) + sqrt(2))/4",
        "sqrt(3)/2",
        "1/sqrt(2)",
        "1/2",
        "(sqrt(6) - sqrt(2))/4",
        "0",
    ];
    for k in 0..25_usize {
        let place = k % 24;
        let place = place.min(24 - place);
        let cosine = if place > 6 {
            format!("-({})", quadrant[12 - place])
        } else {
            quadrant[place].to_owned()
        };
        assert!(vanishes(&format!("cos({k}*pi/12) - ({cosine})")), "{k}");
        // and with the angle moved by a quarter, and as part of a sum
        let sine = format!("sin({}*pi/12) - ({cosine})", k + 6);
        assert!(vanishes(&sine), "{sine}");
        let sum = format!("cos(a + {k}*pi/12) - ({cosine})*cos(a) + sin({k}*pi/12)*sin(a)");
        assert!(vanishes(&sum), "{sum}");
        assert!(
            !vanishes(&format!("cos({k}*pi/12) - ({cosine}) - 1/1000")),
            "{k}"
        );
    }
}

/// Factors are read as they are written: the sign of `(k - a)^2` is known, that of `k^2 - 2 a k + a^2` is not.
#[test]
fn signs_of_written_factors() {
    for expression in [
        "sqrt(((k - a)^2*(1 + a^2))^2) - (k - a)^2*(1 + a^2)",
        "log((1 + sin(2*k))^3) - 3*log(1 + sin(2*k))",
        "log(((k - a)^2*(1 + a^2) + 1)^2) - 2*log((k - a)^2*(1 + a^2) + 1)",
    ] {
        assert!(vanishes(expression), "{expression}");
    }
    assert!(!vanishes("sqrt(((k - a)*(1 + a^2))^2) - (k - a)*(1 + a^2)"));
}

/// At rest the momenta, that of the time among them, are 0, the group element is 1, the time 0, and the last
/// coordinate of the larger algebra, whose bracket with them gives the velocity of the time, is 1.
#[test]
fn configurations_at_rest() {
    let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let (with, without) = (json!({"group": "R"}), json!({}));
    for (keys, hamiltonian, expected) in [
        (
            &with,
            "x^2 + y^2 + R33",
            [&[0.0; 3][..], &identity].concat(),
        ),
        (
            &with,
            "x^2 + y^2 + R33*cos(t)",
            [&[0.0; 4][..], &identity, &[0.0, 1.0]].concat(),
        ),
        (
            &without,
            "x^2 + y^2*cos(t)",
            vec![0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        ),
    ] {
        let mut keys = keys.clone();
        keys["algebra"] = rotations();
        keys["hamiltonian"] = hamiltonian.into();
        let model = body(keys).expect("a sound declaration");
        let configuration = model.configuration.as_ref().expect("it has one");
        let found: Vec<f64> = (0..configuration.dimension())
            .map(|i| configuration.at_rest(i))
            .collect();
        assert_eq!(found, expected, "{hamiltonian}");
    }
}

/// The entries of the group element in a discrete Lagrangian are those of the Cayley map
/// `1 + (X + X^2/2)/(1 + |x|^2/4)` of rotations.
#[test]
fn entries_of_the_group_element_of_a_step() {
    let names = [
        "R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33",
    ];
    for (place, name) in names.into_iter().enumerate() {
        let lagrangian = format!("(6 - R11 - 2*R22 - 3*R33)/h + h*{name}");
        let model = body(json!({
            "algebra": rotations(),
            "group": "R",
            "velocity": ["u", "v", "w"],
            "discrete_lagrangian": lagrangian
        }));
        let model = model.expect("a sound declaration");
        let lagrangian = model.energy.lagrangian().expect("it has one");
        let discrete = lagrangian.discrete.as_ref().expect("it has one").value;
        for (h, x) in [(0.3, [0.7, -0.4, 1.1]), (1.5, [-2.0, 0.6, 0.5])] {
            let value = model.graph.evaluate(discrete, &|symbol| match symbol {
                Symbol::Input(i) => x[i],
                Symbol::Step => h,
                _ => f64::NAN,
            });
            let [a, b, c] = x;
            let square = a * a + b * b + c * c;
            let hat = [0.0, -c, b, c, 0.0, -a, -b, a, 0.0];
            let entry = |k: usize| {
                let (i, j) = (k / 3, k % 3);
                let unit = f64::from(u8::from(i == j));
                // X^2 = x x^T - |x|^2
                unit + (hat[k] + (x[i] * x[j] - square * unit) / 2.0) / (1.0 + square / 4.0)
            };
            let expected =
                (6.0 - entry(0) - 2.0 * entry(4) - 3.0 * entry(8)) / h + h * entry(place);
            assert!(
                (value - expected).abs() < 1e-13,
                "{name}: {value} {expected}"
            );
        }
    }
}

/// Rotations have orthonormal rows; elements of other groups need not.
#[test]
fn initial_elements_of_groups() {
    let refused = |matrix: Value, element: [f64; 4]| {
        let [a, b, c, d] = element;
        let keys = json!({
            "algebra": {"basis": ["e1"], "brackets": [], "matrices": {"e1": matrix}},
            "group": "R",
            "state": ["x"],
            "hamiltonian": "x^2 + R11",
            "initial": [0.3, a, b, c, d]
        });
        body(keys).err()
    };
    let turn = json!([[0, -1], [1, 0]]);
    assert_eq!(refused(turn.clone(), [0.6, -0.8, 0.8, 0.6]), None);
    let message = refused(turn, [2.0, 0.0, 0.0, 1.0]).expect("no rotation");
    assert!(message.contains("not an element of the group"), "{message}");
    // stretches along one axis or the other, shears
    assert_eq!(refused(json!([[1, 0], [0, 0]]), [2.0, 0.0, 0.0, 1.0]), None);
    assert_eq!(refused(json!([[0, 0], [0, 1]]), [1.0, 0.0, 0.0, 2.0]), None);
    assert_eq!(refused(json!([[0, 1], [0, 0]]), [1.0, 2.0, 0.0, 1.0]), None);
    assert_eq!(refused(json!([[0, 0], [1, 0]]), [1.0, 0.0, 2.0, 1.0]), None);
}

/// `l = sqrt(1 + u^2) + k u + …` has the momenta between `k - 1` and `k + 1`.
#[test]
fn momenta_of_a_lagrangian_with_a_linear_term() {
    for (k, x, inside) in [
        ("1/2", "-2/5", true),
        ("1/2", "7/5", true),
        ("1/2", "-3/5", false),
        ("1/2", "8/5", false),
        ("-1/2", "2/5", true),
        ("-1/2", "3/5", false),
        ("0", "9/10", true),
        ("0", "-11/10", false),
    ] {
        let found = body(json!({
            "velocity": ["u", "v", "w"],
            "lagrangian": format!("sqrt(1 + u^2) + {k}*u + v^2 + w^2"),
            "initial": [x, 0.1, 0.2]
        }));
        assert_eq!(found.is_ok(), inside, "{k}, {x}: {:?}", found.err());
    }
}
