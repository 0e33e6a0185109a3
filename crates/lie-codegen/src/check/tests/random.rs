use super::*;
use proptest::prelude::*;

/// Names that are known, unknown and reserved, so that all paths are taken.
fn name() -> impl Strategy<Value = String> {
    prop::sample::select(vec![
        "x", "y", "z", "e1", "e2", "e3", "k", "m", "w", "pi", "q", "t", "fn", "C",
    ])
    .prop_map(String::from)
}

fn expression() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        4 => name(),
        2 => (-3i64..10).prop_map(|n| format!("({n})")),
        1 => (0i64..5, 0i64..4).prop_map(|(n, d)| format!("({n}/{d})")),
        1 => Just("1e-18".to_string()),
    ];
    leaf.prop_recursive(4, 24, 3, |inner| {
        let function = prop::sample::select(vec![
            "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh",
            "tanh", "frob",
        ]);
        prop_oneof![
            (
                inner.clone(),
                prop::sample::select(vec!["+", "-", "*", "/", "^"]),
                inner.clone()
            )
                .prop_map(|(a, op, b)| format!("({a} {op} {b})")),
            inner.clone().prop_map(|a| format!("(-{a})")),
            (function, inner.clone()).prop_map(|(f, a)| format!("{f}({a})")),
            (inner.clone(), inner).prop_map(|(a, b)| format!("atan2({a}, {b})")),
        ]
    })
}

fn declaration() -> impl Strategy<Value = String> {
    let names = || prop::collection::vec(name(), 1..4);
    let bracket =
        (name(), name(), expression()).prop_map(|(a, b, value)| format!("[{a}, {b}] = {value}"));
    let so3 = Just(vec![
        "[e1, e2] = e3".to_string(),
        "[e2, e3] = e1".into(),
        "[e3, e1] = e2".into(),
    ]);
    (
        prop_oneof![3 => Just(vec!["e1".to_string(), "e2".into(), "e3".into()]), 1 => names()],
        prop_oneof![3 => so3, 2 => prop::collection::vec(bracket, 0..4)],
        prop_oneof![3 => Just(vec!["x".to_string(), "y".into(), "z".into()]), 1 => names()],
        prop::collection::vec(expression(), 0..3),
        expression(),
        prop::collection::vec(expression(), 0..3),
        prop::option::of(prop::collection::vec(expression(), 3)),
        expression(),
    )
        .prop_map(
            |(basis, brackets, state, lets, hamiltonian, casimirs, initial, default)| {
                let lets: Vec<String> = lets
                    .iter()
                    .enumerate()
                    .map(|(i, l)| {
                        format!(
                            "w{} = {l}",
                            if i == 0 { String::new() } else { i.to_string() }
                        )
                    })
                    .collect();
                let algebra = format!(r#"{{"basis": {basis:?}, "brackets": {brackets:?}}}"#);
                let parameters =
                    format!(r#"{{"k": {{"default": 2, "exact": true}}, "m": {default:?}}}"#);
                let initial = initial
                    .map(|i| format!("{i:?}"))
                    .unwrap_or("[1, 2, 3]".into());
                system(
                    &[
                        ("algebra", &algebra),
                        ("state", &format!("{state:?}")),
                        ("parameters", &parameters),
                        ("let", &format!("{lets:?}")),
                        ("hamiltonian", &format!("{hamiltonian:?}")),
                        ("casimirs", &format!("{casimirs:?}")),
                        ("initial", &initial),
                    ],
                    &[],
                )
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(2018), ..ProptestConfig::default() })]

    /// `errors` asserts that there is a model exactly where there is no error, and that every
    /// mistake has its place and its remedy.
    #[test]
    fn random_declarations_never_panic(text in declaration()) {
        errors(&text);
    }

    /// Whatever is accepted as a Casimir has brackets that vanish at points that the proof did not use.
    #[test]
    fn accepted_casimirs_are_conserved(a in expression(), b in expression(), seed in 1u32..100) {
        let casimirs = format!("[{:?}, {:?}]", format!("({a})*0 + sin(({b})*(x^2 + y^2 + z^2))"), a);
        let text = so3(&[("casimirs", &casimirs), ("parameters", r#"{"k": 2, "m": 3, "w": "1/2", "q": 5}"#)]);
        if let (Some(model), _) = run(&text) {
            let mut graph = model.graph.clone();
            let point = |symbol| match symbol {
                Symbol::Coordinate(i) => [0.31, 0.77, 0.52][i] * f64::from(seed) / 50.0,
                Symbol::Parameter(p) => [2.0, 3.0, 0.5, 5.0][p],
                _ => f64::NAN,
            };
            for casimir in model.casimirs.clone() {
                let slopes: Vec<f64> = (0..3)
                    .map(|i| {
                        let slope = graph.derivative(casimir.expr, Symbol::Coordinate(i));
                        graph.evaluate(slope, &point)
                    })
                    .collect();
                let x: Vec<f64> = (0..3).map(|i| point(Symbol::Coordinate(i))).collect();
                for i in 0..3 {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    let (p, q) = (slopes[j] * x[k], slopes[k] * x[j]);
                    if p.is_finite() && q.is_finite() {
                        prop_assert!((p - q).abs() <= 1e-6 * (p.abs() + q.abs()) + 1e-12, "{text}");
                    }
                }
            }
        }
    }
}
