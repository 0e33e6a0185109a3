//! The Poisson matrix of a system.

use std::collections::BTreeMap;

use super::poisson;
use crate::algebra::StructureConstants;
use crate::model::PoissonMatrix;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// The entries: `-C_ij^k x_k` of an algebra, where a central coordinate is 1, and what is declared. Nothing is known of their degree.
pub fn poisson_matrix(
    graph: &mut Graph,
    dimension: usize,
    constants: Option<(&StructureConstants<ExprId>, Option<usize>)>,
    brackets: &[poisson::Entry],
) -> PoissonMatrix {
    let mut terms: BTreeMap<(usize, usize), Vec<ExprId>> = BTreeMap::new();
    let (constants, unit) = constants.unzip();
    for (i, j, k, value) in constants.into_iter().flat_map(StructureConstants::entries) {
        let x = match Some(*k) == unit.flatten() {
            true => graph.integer(1),
            false => graph.symbol(Symbol::Coordinate(*k)),
        };
        let product = graph.mul(*value, x);
        let term = graph.neg(product);
        terms.entry((*i, *j)).or_default().push(term);
    }
    for entry in brackets {
        let pair = (entry.row, entry.column);
        terms.entry(pair).or_default().push(entry.value);
    }
    let entries = terms.into_iter();
    let entries = entries.map(|((i, j), terms)| (i, j, graph.sum(&terms)));
    let entries: Vec<_> = entries.collect();
    PoissonMatrix {
        dimension,
        entries,
        degree: None,
    }
}
