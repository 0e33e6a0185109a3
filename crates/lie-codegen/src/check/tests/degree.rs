//! The degrees of functions of the coordinates.

use super::{model, so3};
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::degree::degree;
use lie_symbolic::prove::normal::NormalForm;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

const PARAMETERS: &str = r#"{"a": 2, "b": "3/2", "k": 5}"#;

fn of(hamiltonian: &str) -> Option<u32> {
    let text = so3(&[
        ("parameters", PARAMETERS),
        ("hamiltonian", &format!("{hamiltonian:?}")),
    ]);
    model(&text).energy.expression()?.degree
}

#[test]
fn degrees_are_exact() {
    for (hamiltonian, degree) in [
        ("a*x^4 - a*x^4 + x^2", 2),
        ("x^2/x + 0*y", 1),
        ("x^2/(a + b) + y^2/(a - b) + z/a", 2),
        // what is left of leading parts that cancel
        (
            "(x + y)^5 - x^5 - 5*x^4*y - 10*x^3*y^2 - 10*x^2*y^3 - 5*x*y^4 - y^5 + z^3",
            3,
        ),
        ("(a + b)*x^4 - a*x^4 - b*x^4 + y", 1),
        ("(a/(a + b) + b/(a + b) - 1)*x^4 + y^3", 3),
        ("(x^2 + y)*(x^2 - y) - x^4", 2),
        ("((a + b)^2 - a^2 - 2*a*b - b^2 + 1)*x^2", 2),
        // quotients that are polynomials, and constants that obey relations
        ("(x^2 - y^2)/(x + y)", 1),
        ("(x^3 - 8*a^3)/(x - 2*a) + z", 2),
        ("sqrt(2)*x^2 + pi*y + exp(k)*z", 2),
        ("(sin(k)^2 + cos(k)^2 - 1)*x^3 + y^2", 2),
        ("(sqrt(2)*sqrt(3) - sqrt(6))*x^3 + y^2", 2),
        ("sqrt(a)*x^3*y^4 + 3*x^7 - sqrt(a)*x^3*y^4 - 3*x^7 + z", 1),
        // beyond the structure: the normal form
        ("sin(x)^2 + cos(x)^2 + y^2", 2),
        ("sin(x)^2 + cos(x)^2 + y^2/(a + b) + z^5/(a - b)", 5),
        ("sqrt(x^2 + y^2)^2 + z", 2),
        ("((x^2 + y^2)^(1/2))^2*z + 3*z^3", 3),
        ("7", 0),
    ] {
        assert_eq!(of(hamiltonian), Some(degree), "{hamiltonian}");
    }
}

#[test]
fn what_is_no_polynomial_has_no_degree() {
    for hamiltonian in [
        "1/(1 + x^2)",
        "x^3/(1 + y^2)",
        "x^2 + z^2/(a + x)",
        "(x^2 + y^2)/(x + y)",
        "sqrt(1 + x^2) + y^4/(a + b)",
        "sin(x) + y^2/(a - b)",
        "x^k + y",
        "exp(x)*exp(-x)*x/y",
    ] {
        assert_eq!(of(hamiltonian), None, "{hamiltonian}");
    }
}

/// A random function of three coordinates and two parameters: sums, differences, products, quotients.
fn random(graph: &mut Graph, bits: &mut impl FnMut(u64) -> u64, depth: u32) -> ExprId {
    if depth == 0 || bits(6) == 0 {
        return match bits(8) {
            0 => graph.integer(2),
            1 => graph.symbol(Symbol::Parameter(0)),
            2 => graph.symbol(Symbol::Parameter(1)),
            n => graph.symbol(Symbol::Coordinate(n as usize % 3)),
        };
    }
    let a = random(graph, bits, depth - 1);
    let b = random(graph, bits, depth - 1);
    match bits(10) {
        0..3 => graph.add(a, b),
        3..5 => graph.sub(a, b),
        5 if !graph.is_zero(b) => graph.div(a, b),
        6 => graph.pow(a, &Rational::from(2)),
        // a factor that is found again
        7 if !graph.is_zero(b) => {
            let product = graph.mul(a, b);
            let more = graph.add(product, b);
            graph.div(more, b)
        }
        _ => graph.mul(a, b),
    }
}

#[test]
fn random_functions_have_the_degree_of_the_normal_form() {
    let mut state = 2018u64;
    let mut bits = |bound: u64| {
        // the generator of Knuth's MMIX
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % bound
    };
    let (mut polynomials, mut others) = (0, 0);
    for _ in 0..600 {
        let mut graph = Graph::new();
        let function = random(&mut graph, &mut bits, 4);
        let budget = Budget::new(50_000_000);
        let exact = NormalForm::new(&graph, &budget).degree(function);
        let shown = graph.display(function, &|symbol| format!("{symbol:?}"));
        assert_eq!(degree(&graph, function), exact, "{shown}");
        match exact {
            Some(_) => polynomials += 1,
            None => others += 1,
        }
    }
    assert!(polynomials > 100 && others > 100, "{polynomials} {others}");
}
