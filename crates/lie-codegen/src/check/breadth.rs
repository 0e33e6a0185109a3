//! How many entries the Poisson matrix and the Hessian have: each is a line of straight-line code.

use std::collections::BTreeMap;

use crate::model::PoissonMatrix;
use lie_symbolic::symbolic::{ExprId, Graph, Node, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// The most entries above the diagonal that may differ from zero. That of gl(16), n = 256, has 4,000, and
/// neither the search for common terms nor the compiler behind it gets through many more.
const MOST_ENTRIES: usize = 6_000;

/// The most terms that the brackets may have together. Those of gl(16) have 7,900, and in a basis in which the
/// brackets are longer there is more code than entries.
const MOST_TERMS: usize = 12_000;

/// A set of coordinates, 64 in a word.
type Set = Vec<u64>;

/// Which of the two matrices is too full.
pub fn fill(
    graph: &Graph,
    (matrix, place): (&PoissonMatrix, Origin),
    (energy, origin): (ExprId, Origin),
) -> Option<Diagnostic> {
    let terms = |id: &ExprId| match graph.node(*id) {
        Node::Sum { terms, .. } => terms.len(),
        _ => 1,
    };
    let brackets = matrix.entries.len();
    let terms: usize = matrix.entries.iter().map(|(.., value)| terms(value)).sum();
    let refused = |origin, what: String, limit: usize, choice: &str| {
        let message = format!("{what}, more than the limit of {limit}");
        let help = format!("kernels are straight-line code; choose {choice}, or a smaller system");
        Some(Diagnostic::new(Kind::Limit, origin, message).help(help))
    };
    if brackets > MOST_ENTRIES {
        let what = format!("{brackets} pairs of coordinates have a bracket that is not zero");
        let choice = "a basis in which more brackets vanish";
        return refused(place, what, MOST_ENTRIES, choice);
    }
    if terms > MOST_TERMS {
        let what = format!("the brackets have {terms} terms together");
        let choice = "a basis in which the brackets are shorter";
        return refused(place, what, MOST_TERMS, choice);
    }
    let mixed = mixed_pairs(graph, energy, matrix.dimension);
    let what = format!("the Hamiltonian mixes {mixed} pairs of coordinates");
    let choice = "coordinates in which more mixed terms vanish";
    if mixed > MOST_ENTRIES {
        return refused(origin, what, MOST_ENTRIES, choice);
    }
    None
}

/// An upper bound of the nonzero entries of the Hessian above the diagonal: pairs of coordinates that occur
/// together in one term.
fn mixed_pairs(graph: &Graph, energy: ExprId, dimension: usize) -> usize {
    let empty: Set = vec![0; dimension.div_ceil(64)];
    let unite = |set: &mut Set, other: &Set| {
        set.iter_mut()
            .zip(other)
            .for_each(|(word, more)| *word |= more);
    };
    let contains = |set: &Set, i: usize| (set[i / 64] >> (i % 64)) & 1 == 1;
    let mut sets: BTreeMap<ExprId, Set> = BTreeMap::new();
    for id in graph.dependencies(&[energy]) {
        let mut set = empty.clone();
        if let Node::Symbol(Symbol::Coordinate(i)) = graph.node(id) {
            set[i / 64] |= 1 << (i % 64);
        }
        for child in graph.children(id) {
            unite(&mut set, &sets[&child]);
        }
        sets.insert(id, set);
    }
    let mut rows = vec![empty; dimension];
    let terms = match graph.node(energy) {
        Node::Sum { terms, .. } => terms.iter().map(|(term, _)| *term).collect(),
        _ => vec![energy],
    };
    for term in terms {
        let set = &sets[&term];
        for (i, row) in rows.iter_mut().enumerate() {
            if contains(set, i) {
                unite(row, set);
            }
        }
    }
    let ones = |row: &Set| -> u32 { row.iter().map(|word| word.count_ones()).sum() };
    let both: u32 = rows.iter().map(|row| ones(row).saturating_sub(1)).sum();
    both as usize / 2
}
