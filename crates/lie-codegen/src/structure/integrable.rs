//! Hamiltonians whose flow is known in closed form.
//!
//! Free rigid bodies: a direct sum of algebras so(3) with a quadratic form H that does not couple them. Constant
//! velocities: H is linear, or the coordinates that it contains commute, so that they and the gradient of H are constant
//! along each solution. Both are identities in the parameters, proven by the normal form that verifies Casimirs.

use crate::model::{Algebra, Model};
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

use super::Structure;
use super::spins::Spin;

/// Work allowed for the identities of one Hamiltonian.
const WORK: u64 = 500_000;

/// How the flow is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Free rigid bodies, one on each factor so(3).
    Bodies,
    /// The gradient of H is constant along each solution.
    Uniform,
}

/// The flow of a system, where it is known.
pub fn motion(model: &Model, spins: Option<&[Spin]>) -> Option<Motion> {
    let algebra = model.bracket.algebra()?;
    let mut graph = model.graph.clone();
    let hamiltonian = model.energy.expression()?;
    let slopes: Vec<ExprId> = (0..model.dimension())
        .map(|i| graph.derivative(hamiltonian.value, Symbol::Coordinate(i)))
        .collect();
    let linear = hamiltonian.degree.is_some_and(|degree| degree <= 1);
    if linear || commute(&graph, algebra, &slopes) {
        return Some(Motion::Uniform);
    }
    (hamiltonian.degree == Some(2) && are_bodies(spins, &mut graph, &slopes))
        .then_some(Motion::Bodies)
}

/// Whether the coordinates on which H depends commute.
fn commute(graph: &Graph, algebra: &Algebra, slopes: &[ExprId]) -> bool {
    let moves = |i: usize| !graph.is_zero(slopes[i]);
    let mut entries = algebra.exact.entries().iter();
    entries.all(|(i, j, _, _)| !(moves(*i) && moves(*j)))
}

/// Whether H is a quadratic form, up to a constant, that does not couple the factors so(3).
fn are_bodies(spins: Option<&[Spin]>, graph: &mut Graph, slopes: &[ExprId]) -> bool {
    let Some(spins) = spins else {
        return false;
    };
    let body_of = |i: usize| spins.iter().position(|spin| spin.coordinates.contains(&i));
    let mut vanishing = Vec::new();
    for (i, &slope) in slopes.iter().enumerate() {
        let mut rest = slope;
        for j in 0..slopes.len() {
            let second = graph.derivative(slope, Symbol::Coordinate(j));
            let constant = |symbol: &Symbol| !matches!(symbol, Symbol::Coordinate(_));
            if !graph.symbols(second).iter().all(constant) {
                return false;
            }
            if body_of(i) != body_of(j) {
                vanishing.push(second);
                continue;
            }
            let x = graph.symbol(Symbol::Coordinate(j));
            let term = graph.mul(second, x);
            rest = graph.sub(rest, term);
        }
        vanishing.push(rest);
    }
    let budget = Budget::new(WORK);
    let mut normal = NormalForm::new(graph, &budget);
    vanishing
        .iter()
        .all(|id| graph.is_zero(*id) || matches!(normal.verdict(*id), Verdict::Zero))
}

/// Why the flow is not known, with the nearest method.
pub fn refusal(structure: &Structure) -> Option<(String, String)> {
    structure.motion.is_none().then(|| {
        let reason = "no closed form of the flow is known: it is for a direct sum of algebras so(3) in a basis with \
                      [e1, e2] = c e3 and its cyclic permutations and a quadratic form H that does not couple them, and for H \
                      that is linear or contains only coordinates that commute";
        let help = "use `gauss16` with `--tol 1e-12`";
        (reason.into(), help.into())
    })
}
