//! The Poisson matrix of a system: its entries and its ranks.

use std::collections::BTreeMap;

use super::poisson;
use crate::algebra::StructureConstants;
use crate::model::{Model, PoissonMatrix};
use lie_symbolic::exact::Rational;
use lie_symbolic::prove::ranks;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// The entries: `-C_ij^k x_k` of an algebra, and what is declared. Nothing is known of their degree.
pub fn of(
    graph: &mut Graph,
    dimension: usize,
    constants: Option<&StructureConstants<ExprId>>,
    brackets: &[poisson::Entry],
) -> PoissonMatrix {
    let mut terms: BTreeMap<(usize, usize), Vec<ExprId>> = BTreeMap::new();
    for (i, j, k, value) in constants.into_iter().flat_map(StructureConstants::entries) {
        let x = graph.symbol(Symbol::Coordinate(*k));
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

/// The rank at generic points, exactly where the entries are rational functions, in double precision elsewhere.
/// `bound` is a known upper bound; `None` where no point is in the domain.
pub fn generic_rank(scratch: &mut Graph, poisson: &PoissonMatrix, bound: usize) -> Option<usize> {
    let rows = poisson.rows(scratch);
    let rows: Vec<&Vec<ExprId>> = rows.iter().collect();
    ranks::generic(scratch, &rows, bound)
}

/// The rank at the initial state, rounded to double precision; in the same way.
pub fn initial_rank(
    model: &Model,
    poisson: &PoissonMatrix,
    scratch: &mut Graph,
    mu: &[f64],
) -> Option<usize> {
    let rows = poisson.rows(scratch);
    let rows: Vec<&Vec<ExprId>> = rows.iter().collect();
    let exact = |symbol| match symbol {
        Symbol::Coordinate(i) => Rational::from_f64(mu[i]),
        Symbol::Parameter(p) => {
            let parameter = &model.parameters[p];
            let number = model.graph.as_number(parameter.default).cloned();
            number.or_else(|| Rational::from_f64(parameter.default_value))
        }
        _ => None,
    };
    let number = |symbol| match symbol {
        Symbol::Coordinate(i) => mu[i],
        Symbol::Parameter(p) => model.parameters[p].default_value,
        _ => f64::NAN,
    };
    ranks::at_rationals(scratch, &rows, &exact, model.dimension())
        .or_else(|| ranks::at_numbers(scratch, &rows, &number))
}
