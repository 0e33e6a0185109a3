//! What is said of numbers that are uncertain: zeros, degenerate equilibria, ends of branches on a threshold.

// each file of tests has use for some of them
#[allow(dead_code)]
mod systems;

use lie_equilibria::exact::Prover;
use lie_equilibria::{
    At, ChangeKind, Equations, Equilibrium, Point, Presence, Reason, Stability, System, trace,
};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use systems::{canonical, lagrange_top, number, rigid_body};

fn all(system: System) -> Vec<Equilibrium> {
    let equations = Equations::new(system, None).expect("expressions");
    let at = At {
        equations: &equations,
        parameters: &[],
    };
    let found = at.search(100, 1, true).expect("a plane");
    let prover = Prover::new(&equations);
    let known = found.candidates.iter();
    let known = known.map(|one| Equilibrium::new(&prover, at, &[], one).expect("finite"));
    known.collect()
}

/// `c (q^2 - 2)^k`
fn well(graph: &mut Graph, q: ExprId, k: i32) -> ExprId {
    let square = graph.mul(q, q);
    let two = graph.integer(-2);
    let base = graph.add(square, two);
    graph.power_product(&[(base, Rational::from(i64::from(k)))])
}

/// Of `(q^2 - 2)^3` the equilibria at the roots of 2 are double, known to half of the digits, and irrational: the error is said and is one. Of
/// `(q^2 - 2)^2` they are simple, enclosed in a box, and right to the last digit.
#[test]
fn degenerate_equilibria_have_their_error() {
    let root = 2.0_f64.sqrt();
    for (k, simple) in [(3, false), (2, true)] {
        let found = all(canonical(|graph, q| well(graph, q, k)));
        let outer: Vec<_> = found
            .iter()
            .filter(|one| one.state[0].abs() > 1.0)
            .collect();
        assert_eq!(outer.len(), 2, "{k}");
        for one in outer {
            let off = (one.state[0].abs() - root).abs();
            if simple {
                assert_eq!((one.error, &one.presence), (0.0, &Presence::Enclosed));
                assert!(off <= 2.0 * f64::EPSILON, "{off}");
            } else {
                assert!(
                    one.degenerate && off <= one.error && one.error < 1e-5,
                    "{one:?}"
                );
                assert_eq!(one.presence, Presence::Numerical);
                assert_eq!(one.judgement.stability, Stability::Undecided);
            }
        }
    }
}

/// A degenerate equilibrium that is rational is found to be: `q^3/3 - q^2/2 + q/4` has the slope `(q - 1/2)^2`.
#[test]
fn degenerate_rational_equilibria_are_proven() {
    let found = all(canonical(|graph, q| {
        let square = graph.mul(q, q);
        let cube = graph.mul(square, q);
        graph.linear(&[
            (cube, number(1, 3)),
            (square, number(-1, 2)),
            (q, number(1, 4)),
        ])
    }));
    assert_eq!(found.len(), 1);
    let one = &found[0];
    let exact = Presence::Rational(vec![number(1, 2), number(0, 1)]);
    assert_eq!((&one.presence, one.error), (&exact, 0.0));
    assert_eq!(one.state, [0.5, 0.0]);
    let imaginary = Reason::Imaginary { simple: false };
    assert_eq!(
        (one.judgement.stability, &one.judgement.reason),
        (Stability::Undecided, &imaginary)
    );
    assert!(
        one.linearisation
            .eigenvalues
            .iter()
            .all(|z| z.norm() == 0.0)
    );
}

/// On the sphere `x^3 + y^2/2 + z` is flat to the fourth order along y at (0, 0, 1): the points that are found there are one, the rational one.
#[test]
fn a_flat_equilibrium_counts_once() {
    let state = [number(0, 1), number(3, 5), number(4, 5)];
    let mut system = rigid_body([1, 1, 1], state);
    let graph = &mut system.graph;
    let [x, y, z] = [0, 1, 2].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let (xx, yy) = (graph.mul(x, x), graph.mul(y, y));
    let cube = graph.mul(xx, x);
    let terms = [(cube, number(1, 1)), (yy, number(1, 2)), (z, number(1, 1))];
    system.hamiltonian = graph.linear(&terms);
    let found = all(system);
    let near = |one: &&Equilibrium| one.degenerate && one.state[2] > 0.9;
    assert!(
        found.iter().filter(near).count() > 1,
        "the control: several are found"
    );
    let hits: usize = found.iter().filter(near).map(|one| one.hits).sum();
    let merged = Equilibrium::merged(found.clone());
    let flat: Vec<&Equilibrium> = merged.iter().filter(near).collect();
    assert_eq!(flat.len(), 1, "{flat:#?}");
    assert_eq!((&flat[0].state, flat[0].hits), (&vec![0.0, 0.0, 1.0], hits));
    let others = |all: &[Equilibrium]| all.iter().filter(|one| !one.degenerate).count();
    assert_eq!(others(&merged), others(&found));
}

/// Zeros are zeros, and small numbers stay: `q^2/2 - q/10^9` is least at 10^-9.
#[test]
fn round_off_is_no_state() {
    for (slope, expected) in [(number(0, 1), 0.0), (number(-1, 1_000_000_000), 1e-9)] {
        let found = all(canonical(|graph, q| {
            let square = graph.mul(q, q);
            graph.linear(&[(square, number(1, 2)), (q, slope.clone())])
        }));
        assert_eq!(found.len(), 1);
        let [q, p] = [found[0].state[0], found[0].state[1]];
        assert!((q - expected).abs() <= 1e-15 * expected, "{q:e}");
        assert_eq!(p, 0.0);
        assert_eq!(
            found[0].energy == 0.0,
            expected == 0.0,
            "{:e}",
            found[0].energy
        );
    }
}

/// The sleeping top is unstable below the spin 2 and stable above it. A branch that ends there says that it ends on the threshold.
#[test]
fn an_end_on_a_threshold_is_said_to_be() {
    for (from, to) in [(1.0, 2.0), (2.0, 3.0), (1.0, 1.9), (2.1, 3.0)] {
        let system = lagrange_top(number(1, 1), number(1, 2), number(1, 1));
        let equations = Equations::new(system, Some(0)).expect("expressions");
        let grid: Vec<f64> = (0..11)
            .map(|k| from + 0.1 * (to - from) * f64::from(k))
            .collect();
        let traced = trace(&equations, &[0.0], 0, &grid, 60, 1);
        let upright = traced.branches.iter();
        let upright = upright.filter(|branch| branch.family == 0 && branch.points[0].y[5] > 0.5);
        let points: Vec<&Point> = upright.flat_map(|branch| &branch.points).collect();
        for point in &points {
            let (stability, threshold) = match point.parameter {
                2.0 => (Stability::Undecided, Some(ChangeKind::Collision)),
                spin if spin < 2.0 => (Stability::Unstable, None),
                _ => (Stability::Stable, None),
            };
            assert_eq!(
                (point.stability, point.threshold),
                (stability, threshold),
                "{point:?}"
            );
        }
        let is_at = points.iter().any(|point| point.threshold.is_some());
        assert_eq!(is_at, from == 2.0 || to == 2.0, "{from} {to}");
    }
}
