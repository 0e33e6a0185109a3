//! Equilibria where the rank of the bracket drops, against closed formulas, and leaves that lower ranks divide.

use lie_equilibria::exact::Prover;
use lie_equilibria::{At, Equations, Equilibrium, LowRank, Stability, System};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Graph, Symbol};

fn number(n: i64, d: i64) -> Rational {
    Rational::new(n, d).expect("a fraction")
}

/// A system in the plane, `{x, y} = b` and H, from a state.
fn plane(
    bracket: impl FnOnce(&mut Graph, [ExprId; 2]) -> ExprId,
    hamiltonian: impl FnOnce(&mut Graph, [ExprId; 2]) -> ExprId,
    state: [Rational; 2],
    has_leaves: bool,
) -> System {
    let mut graph = Graph::new();
    let both = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let value = bracket(&mut graph, both);
    System {
        hamiltonian: hamiltonian(&mut graph, both),
        casimirs: Vec::new(),
        levels: Vec::new(),
        bracket: vec![(0, 1, value)],
        has_leaves,
        integrals: Vec::new(),
        state: state.iter().map(|x| graph.number(x.clone())).collect(),
        coordinates: ["x", "y"].map(str::to_owned).to_vec(),
        parameters: Vec::new(),
        graph,
    }
}

fn all(system: System) -> (Vec<Equilibrium>, Vec<LowRank>) {
    let equations = Equations::new(system, None).expect("expressions");
    let at = At {
        equations: &equations,
        parameters: &[],
    };
    let found = at.search(100, 1, true).expect("a level set");
    let prover = Prover::new(&equations);
    let known = found.candidates.iter();
    let known = known.filter_map(|one| Equilibrium::new(&prover, at, &[], one));
    (known.collect(), at.low_rank(100, 1))
}

/// `a x^2/2 + b y^2/2 + c x y` with the shift of its centre.
fn form(graph: &mut Graph, [x, y]: [ExprId; 2], [a, b, c]: [Rational; 3]) -> ExprId {
    let (xx, yy, xy) = (graph.mul(x, x), graph.mul(y, y), graph.mul(x, y));
    let half = number(1, 2);
    graph.linear(&[(xx, &a * &half), (yy, &b * &half), (xy, c)])
}

/// A body of Suslov, `{x, y} = c(x, y) = x/8 - y/10`: at rest are the states of the line c = 0, and no others. Along it one eigenvalue is
/// zero; the other one is the trace `c_x H_y - c_y H_x`, and the half of the line where it is negative attracts.
#[test]
fn steady_rotations_of_a_body_of_suslov() {
    let kinetic = [number(31, 32), number(97, 150), number(1, 40)];
    let slope = [0.125, -0.1];
    let of = |bracket: fn(&mut Graph, [ExprId; 2]) -> ExprId| {
        let h = kinetic.clone();
        let state = [number(-17, 20), number(-1, 4)];
        all(plane(
            bracket,
            |graph, both| form(graph, both, h),
            state,
            false,
        ))
    };
    let (regular, found) =
        of(|graph, [x, y]| graph.linear(&[(x, number(1, 8)), (y, number(-1, 10))]));
    assert!(regular.is_empty(), "{regular:?}");
    let [a, b, c] = kinetic.clone().map(|x| x.to_f64());
    let energy = |x: f64, y: f64| 0.5 * (a * x * x + b * y * y) + c * x * y;
    let families: Vec<&LowRank> = found.iter().filter(|one| one.family == 1).collect();
    assert_eq!(families.len(), 2, "{found:#?}");
    for one in families {
        let [x, y] = [one.state[0], one.state[1]];
        assert!((slope[0] * x + slope[1] * y).abs() < 1e-14, "{one:?}");
        assert!((one.energy - energy(-0.85, -0.25)).abs() < 1e-12, "{one:?}");
        let trace = slope[0] * (b * y + c * x) - slope[1] * (a * x + c * y);
        let sum: f64 = one.eigenvalues.iter().map(|z| z.re).sum();
        assert!((sum - trace).abs() < 1e-12 && trace.abs() > 0.1, "{one:?}");
        let expected = match trace < 0.0 {
            true => Stability::Stable,
            false => Stability::Unstable,
        };
        assert_eq!((one.judgement.stability, one.rank), (expected, 0));
    }
    // at the origin of the line H has its minimum
    let origin: Vec<&LowRank> = found.iter().filter(|one| one.family == 0).collect();
    assert_eq!(origin.len(), 1, "{found:#?}");
    assert_eq!(origin[0].state, [0.0, 0.0]);
    assert_eq!(origin[0].judgement.stability, Stability::Stable);
    // the control: of full rank everywhere the origin is all there is, and is an equilibrium as others are
    let (regular, found) = of(|graph, _| graph.integer(1));
    assert_eq!((regular.len(), found.len()), (1, 0));
}

/// `{x, y} = x + 1`: the line x = -1 divides the plane, and every point of it is a leaf. With `H = (x - a)^2/2 + y^2/2` from the origin the
/// state (a, 0) is on the same leaf for a > -1 alone. Near (-1, y) it is `x' = (x + 1) y`, with the eigenvalue y.
#[test]
fn a_line_of_lower_rank_divides_the_plane() {
    for (a, other) in [(number(-3, 1), true), (number(2, 1), false)] {
        let shift = a.to_f64();
        let (regular, found) = all(plane(
            |graph, [x, _]| {
                let one = graph.integer(1);
                graph.add(x, one)
            },
            |graph, [x, y]| {
                let a = graph.number(a.clone());
                let x = graph.sub(x, a);
                form(graph, [x, y], [1, 1, 0].map(|k| number(k, 1)))
            },
            [number(0, 1), number(1, 2)],
            true,
        ));
        assert_eq!(regular.len(), 1);
        assert_eq!(regular[0].on_other_leaf, Some(other), "{shift}");
        assert!((regular[0].state[0] - shift).abs() < 1e-12);
        let line: Vec<&LowRank> = found.iter().filter(|one| one.family == 1).collect();
        assert_eq!(line.len(), 2, "{found:#?}");
        for one in line {
            assert!(
                (one.state[0] + 1.0).abs() < 1e-14 && one.rank == 0,
                "{one:?}"
            );
            let sum: f64 = one.eigenvalues.iter().map(|z| z.re).sum();
            assert!((sum - one.state[1]).abs() < 1e-12, "{one:?}");
            let stable = one.judgement.stability == Stability::Stable;
            assert_eq!(stable, one.state[1] < 0.0, "{one:?}");
        }
    }
}

/// `{x, y} = exp(-2 x)` has the rank 2 everywhere, though far out it is below round-off. With `{x, y} = x` the rank drops on the line x = 0.
#[test]
fn a_bracket_that_dies_out_keeps_its_rank() {
    let of = |bracket: fn(&mut Graph, [ExprId; 2]) -> ExprId| {
        let state = [number(1, 1), number(1, 2)];
        let one = [1, 1, 0].map(|k| number(k, 1));
        all(plane(
            bracket,
            |graph, both| form(graph, both, one),
            state,
            true,
        ))
    };
    let (regular, found) = of(|graph, [x, _]| {
        let double = graph.scale(x, &number(-2, 1));
        graph.call(Elementary::Exp, &[double])
    });
    assert_eq!((regular.len(), found.len()), (1, 0), "{found:#?}");
    let (_, found) = of(|_, [x, _]| x);
    assert!(found.iter().any(|one| one.family == 1), "{found:#?}");
}
