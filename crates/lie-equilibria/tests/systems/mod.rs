//! Systems by their expressions: parameters are variables of the arena, states are numbers or parameters.

use lie_equilibria::{Named, System};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

pub fn number(n: i64, d: i64) -> Rational {
    Rational::new(n, d).expect("a fraction")
}

fn x(graph: &mut Graph, i: usize) -> ExprId {
    graph.symbol(Symbol::Coordinate(i))
}

fn square(graph: &mut Graph, i: usize) -> ExprId {
    let x = x(graph, i);
    graph.mul(x, x)
}

/// `sum_i a_i x_i^2/2`.
pub fn quadratic(graph: &mut Graph, from: usize, weights: &[Rational]) -> ExprId {
    let squares: Vec<(ExprId, Rational)> = weights
        .iter()
        .enumerate()
        .map(|(k, a)| (square(graph, from + k), a * &number(1, 2)))
        .collect();
    graph.linear(&squares)
}

/// The entries of `x -> x cross v` for the coordinates from `of` on, at rows and columns from two places.
fn cross(graph: &mut Graph, rows: usize, columns: usize, of: usize) -> Vec<(usize, usize, ExprId)> {
    // {x_i, x_j} = -eps_ijk x_k
    let mut entries = Vec::new();
    for (i, j, k, sign) in [
        (0, 1, 2, -1),
        (1, 2, 0, -1),
        (2, 0, 1, -1),
        (1, 0, 2, 1),
        (2, 1, 0, 1),
        (0, 2, 1, 1),
    ] {
        let (row, column) = (rows + i, columns + j);
        if row < column {
            let x = x(graph, of + k);
            entries.push((row, column, graph.scale(x, &Rational::from(sign))));
        }
    }
    entries
}

/// The free rigid body on so(3)*: `H = sum m_i^2/(2 I_i)`, from a state.
pub fn rigid_body(inertia: [i64; 3], state: [Rational; 3]) -> System {
    let mut graph = Graph::new();
    let weights = inertia.map(|i| number(1, i));
    let hamiltonian = quadratic(&mut graph, 0, &weights);
    let casimir = quadratic(&mut graph, 0, &[2, 2, 2].map(Rational::from));
    let level = state.iter().fold(Rational::ZERO, |sum, x| &sum + &(x * x));
    System {
        coordinates: ["x", "y", "z"].map(str::to_owned).to_vec(),
        parameters: Vec::new(),
        hamiltonian,
        casimirs: vec![Named {
            name: "norm2".into(),
            value: casimir,
        }],
        levels: vec![graph.number(level)],
        bracket: cross(&mut graph, 0, 0, 0),
        has_leaves: true,
        integrals: Vec::new(),
        state: state.iter().map(|x| graph.number(x.clone())).collect(),
        graph,
    }
}

/// A system on se(3)* in (m, p), with Casimirs `|p|^2` and `m.p`; the state is the parameter `spin` along the third axis of m and `p = e3`.
pub fn on_se3(hamiltonian: impl FnOnce(&mut Graph) -> ExprId, integral: bool) -> System {
    let mut graph = Graph::new();
    let hamiltonian = hamiltonian(&mut graph);
    let length = quadratic(&mut graph, 3, &[2, 2, 2].map(Rational::from));
    let mut terms = Vec::new();
    for i in 0..3 {
        let (m, p) = (x(&mut graph, i), x(&mut graph, 3 + i));
        terms.push(graph.mul(m, p));
    }
    let pitch = graph.sum(&terms);
    let mut bracket = cross(&mut graph, 0, 0, 0);
    bracket.extend(cross(&mut graph, 0, 3, 3));
    let spin = graph.symbol(Symbol::Parameter(0));
    let (zero, one) = (graph.integer(0), graph.integer(1));
    let third = x(&mut graph, 2);
    let named = |name: &str, value| Named {
        name: name.into(),
        value,
    };
    System {
        coordinates: ["m1", "m2", "m3", "p1", "p2", "p3"]
            .map(str::to_owned)
            .to_vec(),
        parameters: vec!["spin".into()],
        hamiltonian,
        casimirs: vec![named("length2", length), named("pitch", pitch)],
        levels: vec![one, spin],
        bracket,
        has_leaves: true,
        integrals: if integral {
            vec![named("m3", third)]
        } else {
            Vec::new()
        },
        state: vec![zero, zero, spin, zero, zero, one],
        graph,
    }
}

/// The Lagrange top: moments I1 = I2 and I3, weight times distance mgl.
pub fn lagrange_top(i1: Rational, i3: Rational, mgl: Rational) -> System {
    let weights = [&i1, &i1, &i3].map(|i| i.recip().expect("a moment of inertia"));
    on_se3(
        |graph| {
            let kinetic = quadratic(graph, 0, &weights);
            let height = x(graph, 5);
            let potential = graph.scale(height, &mgl);
            graph.add(kinetic, potential)
        },
        true,
    )
}

/// One degree of freedom, `{q, p} = 1` with `H = p^2/2 + V(q)`.
pub fn canonical(potential: impl FnOnce(&mut Graph, ExprId) -> ExprId) -> System {
    let mut graph = Graph::new();
    let q = x(&mut graph, 0);
    let potential = potential(&mut graph, q);
    let kinetic = quadratic(&mut graph, 1, &[number(1, 1)]);
    let hamiltonian = graph.add(kinetic, potential);
    let one = graph.integer(1);
    System {
        hamiltonian,
        casimirs: Vec::new(),
        levels: Vec::new(),
        bracket: vec![(0, 1, one)],
        has_leaves: true,
        integrals: Vec::new(),
        state: vec![one, one],
        coordinates: ["q", "p"].map(str::to_owned).to_vec(),
        parameters: Vec::new(),
        graph,
    }
}
