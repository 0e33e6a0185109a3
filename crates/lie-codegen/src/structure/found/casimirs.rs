//! H without a combination of quadratic Casimirs, which generate no flow: the combination that leaves the fewest pieces.
//!
//! Of `H = sum_i x_i^2/(2 I_i)` on so(3) the multiple `1/(2 I_2)` of the Casimir takes away one piece of three. The
//! multiples are those that cancel one second derivative of H that depends on parameters alone. Casimirs of subalgebras have flows of their own, and
//! may still leave fewer pieces: with `|m|^2/(2 I_2)` taken from the kinetic energy of a top in a field along one of its axes and added as a function of one argument, there
//! are two.

use super::additive;
use super::atoms::{Atom, Commuting};
use super::colouring;
use super::invariants::Invariant;
use super::search::{Work, classes};
use crate::model::Model;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Larger systems are not searched.
const LARGEST: usize = 40;
/// Multiples of one Casimir that are tried.
const MULTIPLES: usize = 64;

/// A Hamiltonian that may be split, and how well.
#[derive(Clone, Copy)]
struct Candidate {
    value: ExprId,
    /// Pairs of coordinates in one term that do not commute.
    mixed: usize,
    /// Classes of terms that commute.
    pieces: usize,
    /// The largest second derivative at the default parameters.
    spread: f64,
}

impl Candidate {
    fn is_better(&self, other: &Self) -> bool {
        let (one, two) = ((self.mixed, self.pieces), (other.mixed, other.pieces));
        one < two
    }
}

/// H without multiples of quadratic Casimirs, where that leaves less to split; of a Casimir of a subalgebra the multiple
/// is added as one of its symbol.
pub(super) fn subtract_casimirs(
    model: &Model,
    commuting: &Commuting<'_>,
    graph: &mut Graph,
    (start, casimirs): (ExprId, &[&Invariant]),
    work: Work<'_>,
) -> Option<ExprId> {
    if model.dimension() > LARGEST {
        return None;
    }
    let measure =
        |graph: &mut Graph, value: ExprId| candidate(model, commuting, graph, value, work);
    let mut value = start;
    let mut current = measure(graph, value)?;
    for _ in 0..casimirs.len() {
        let before = value;
        for casimir in casimirs {
            let mut taken = casimir.value;
            if !casimir.moved.is_empty() {
                let symbol = graph.symbol(casimir.symbol);
                taken = graph.sub(taken, symbol);
            }
            let mut best = current;
            for multiple in multiples(model, graph, value, casimir.value) {
                let part = graph.mul(multiple, taken);
                let other = graph.sub(value, part);
                let other = graph.normal(other);
                let Some(other) = measure(graph, other) else {
                    continue;
                };
                let level = !best.is_better(&other) && best.is_better(&current);
                if other.is_better(&best) || (level && other.spread < best.spread) {
                    best = other;
                }
            }
            (value, current) = (best.value, best);
        }
        if value == before {
            break;
        }
    }
    (value != start).then_some(value)
}

/// The multiples of a Casimir that cancel a second derivative of H, each once.
fn multiples(model: &Model, graph: &mut Graph, value: ExprId, casimir: ExprId) -> Vec<ExprId> {
    let n = model.dimension();
    let mut found = Vec::new();
    for i in 0..n {
        let of_casimir = graph.derivative(casimir, Symbol::Coordinate(i));
        let of_value = graph.derivative(value, Symbol::Coordinate(i));
        for j in i..n {
            let below = graph.derivative(of_casimir, Symbol::Coordinate(j));
            let below = graph.normal(below);
            let above = graph.derivative(of_value, Symbol::Coordinate(j));
            let above = graph.normal(above);
            if constant(model, graph, below).is_none() || constant(model, graph, above).is_none() {
                continue;
            }
            let multiple =
                graph.power_product(&[(above, Rational::ONE), (below, Rational::MINUS_ONE)]);
            let multiple = graph.normal(multiple);
            if !found.contains(&multiple) && found.len() < MULTIPLES {
                found.push(multiple);
            }
        }
    }
    found
}

/// How well a function can be split by coordinates; `None` where it has too many terms.
fn candidate(
    model: &Model,
    commuting: &Commuting<'_>,
    graph: &mut Graph,
    value: ExprId,
    work: Work<'_>,
) -> Option<Candidate> {
    let terms = additive::terms(graph, value)?;
    let mut atoms = commuting.by_arguments(graph, &terms);
    let pairs = |atom: &Atom| match atom {
        Atom::Function(set, _) => commuting.mixed(set).len(),
        Atom::Form { .. } => 0,
    };
    let mixed = atoms.iter().map(pairs).sum();
    atoms.retain(|atom| !commuting.is_idle(atom));
    let pieces = colouring::count(&classes(commuting, &atoms, work));
    let mut spread = 0.0_f64;
    for i in 0..model.dimension() {
        let slope = graph.derivative(value, Symbol::Coordinate(i));
        let second = graph.derivative(slope, Symbol::Coordinate(i));
        let second = graph.normal(second);
        if let Some(second) = constant(model, graph, second) {
            spread = spread.max(second.abs());
        }
    }
    Some(Candidate {
        value,
        mixed,
        pieces,
        spread,
    })
}

/// The value of an expression at the default parameters, where it is one and not 0.
fn constant(model: &Model, graph: &Graph, id: ExprId) -> Option<f64> {
    let value = model.at_defaults(graph, id);
    value.filter(|value| *value != 0.0)
}
