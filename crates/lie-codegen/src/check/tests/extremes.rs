//! Coefficients and exponents at the ends of machine words: exact all the same, and no panic.

use super::*;
use lie_symbolic::exact::Budget;
use lie_symbolic::symbolic::Graph;
use proptest::prelude::*;

const ENDS: [i64; 9] = [
    i64::MIN,
    i64::MIN + 1,
    -(1 << 62),
    -1,
    1,
    3,
    1 << 62,
    i64::MAX - 1,
    i64::MAX,
];

#[test]
fn the_least_word_is_a_coefficient_like_any_other() {
    for text in [
        "(-9223372036854775808*x - 9223372036854775808*y)^2",
        "x^2/(-9223372036854775808*y - 9223372036854775808)",
        "(9223372036854775807*x/9223372036854775806 + y/9223372036854775805)^-1",
        "sqrt(-9223372036854775808*x)*log(-9223372036854775808*y)",
        "exp(-9223372036854775808*x)/(x - 9223372036854775808)",
    ] {
        let hamiltonian = format!("{text:?}");
        model(&so3(&[("hamiltonian", &hamiltonian)]));
    }
    for text in [
        "x^-9223372036854775808",
        "x^9223372036854775807",
        "1e-9223372036854775808",
    ] {
        let hamiltonian = format!("{text:?}");
        assert_eq!(
            errors(&so3(&[("hamiltonian", &hamiltonian)])).len(),
            1,
            "{text}"
        );
    }
    let algebra = r#"{"basis": ["a", "b"], "brackets": ["[a, b] = k^-9223372036854775808*b"]}"#;
    let spec = system(
        &[("state", r#"["x", "y"]"#), ("hamiltonian", r#""x""#)],
        &[
            ("algebra", algebra),
            ("parameters", r#"{"k": {"default": 2, "exact": true}}"#),
        ],
    );
    assert_eq!(errors(&spec).len(), 1);
}

fn end() -> impl Strategy<Value = Rational> {
    let word = prop::sample::select(ENDS.to_vec());
    (word.clone(), word).prop_map(|(n, d)| Rational::new(n, d).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// `c (a x + b y)^n - c (a x + b y)^(n-1) (a x + b y) = 0`, by every part of the compiler that sees it.
    #[test]
    fn identities_hold_at_the_ends(
        a in end(), b in end(), c in end(), constant in end(), n in 1i64..4, negative: bool
    ) {
        let mut graph = Graph::new();
        let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
        let constant = graph.number(constant);
        let sum = graph.linear(&[(x, a.clone()), (y, b.clone()), (constant, c.clone())]);
        let n = if negative { -n } else { n };
        let power = graph.pow(sum, &Rational::from(n));
        let lower = graph.pow(sum, &Rational::from(n - 1));
        let product = graph.mul(lower, sum);
        let left = graph.scale(power, &c);
        let right = graph.scale(product, &c);
        let rest = graph.sub(left, right);
        let slope = graph.derivative(left, Symbol::Coordinate(0));
        let factor = &(&a * &Rational::from(n)) * &c;
        let expected = graph.scale(lower, &factor);
        let difference = graph.sub(slope, expected);
        let budget = Budget::new(1_000_000);
        let mut normal = lie_symbolic::prove::normal::NormalForm::new(&graph, &budget);
        for zero in [rest, difference] {
            prop_assert!(matches!(normal.verdict(zero), lie_symbolic::prove::normal::Verdict::Zero));
        }
        prop_assert!(!matches!(normal.verdict(left), lie_symbolic::prove::normal::Verdict::Zero));
        graph.display(left, &|_| "x".into());
    }

    /// Sums and products agree with those of big integers.
    #[test]
    fn rationals_are_exact_at_the_ends(a in end(), b in end()) {
        let (p, q) = (a.to_big(), b.to_big());
        prop_assert_eq!((&a + &b).to_big(), &p + &q);
        prop_assert_eq!((&a - &b).to_big(), &p - &q);
        prop_assert_eq!((&a * &b).to_big(), &p * &q);
        prop_assert_eq!((&a / &b).to_big(), &p / &q);
        prop_assert_eq!((-&a).to_big(), -&p);
        prop_assert_eq!(a.cmp(&b), p.cmp(&q));
        prop_assert!(!a.abs().is_negative());
    }
}
