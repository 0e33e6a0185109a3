//! The rank of the Poisson matrix: at generic points, and at the initial state with default parameters.

use crate::algebra::rank as algebra_rank;
use crate::model::{Bracket, Model, PoissonMatrix};
use lie_symbolic::exact::Rational;
use lie_symbolic::prove::ranks;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Finds both ranks. Those of a Lie algebra are exact. Those of another bracket are exact where its entries are rational functions;
/// elsewhere they are found numerically. The initial state is rounded to double precision.
pub fn ranks(
    model: &mut Model,
    matrix: &PoissonMatrix,
    scratch: &mut Graph,
    defaults: &[Rational],
) {
    let dimension = model.dimension();
    let bound = (dimension - model.declared_casimirs.len().min(dimension)) & !1;
    let mu = model.initial_values(&model.defaults());
    let (generic, initial) = match &model.bracket {
        Bracket::Lie(algebra) => {
            let generic = algebra_rank::generic_rank(&algebra.exact, bound);
            let mu: Option<Vec<Rational>> =
                mu.and_then(|mu| mu.into_iter().map(Rational::from_f64).collect());
            let initial =
                mu.and_then(|mu| algebra_rank::rank_at(&algebra.exact, &mu, defaults, generic));
            (Some(generic), initial)
        }
        _ => {
            let rows = matrix.rows(scratch);
            let rows: Vec<&Vec<ExprId>> = rows.iter().collect();
            let initial = mu.and_then(|mu| at_state(model, scratch, &rows, &mu));
            (ranks::generic(scratch, &rows, bound), initial)
        }
    };
    model.initial_rank = initial;
    // where no sample is in the domain, what is known is the rank at the initial state
    model.generic_rank = generic.or(initial).unwrap_or(bound);
}

/// The rank at a state.
fn at_state(model: &Model, graph: &Graph, rows: &[&Vec<ExprId>], mu: &[f64]) -> Option<usize> {
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
    ranks::at_rationals(graph, rows, &exact, model.dimension())
        .or_else(|| ranks::at_numbers(graph, rows, &number))
}
