//! The initial state: one expression in constants and parameters for every coordinate.

use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use lie_symbolic::symbolic::{ExprId, Graph};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, plural};

/// Lowers the initial state; `Some(None)` where none is declared. It may be that of a system which is `constrained`.
pub fn initial_state(
    declaration: &Declaration,
    graph: &mut Graph,
    environment: &Environment<'_>,
    constrained: bool,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Option<Vec<ExprId>>> {
    let Some(entries) = &declaration.initial else {
        return Some(None);
    };
    let lowered: Vec<Option<ExprId>> = entries
        .iter()
        .map(|entry| Lowering::new(graph, environment, mistakes, Allowed::Parameters).lower(entry))
        .collect();
    let (count, dimension) = (entries.len(), declaration.dimension());
    // with constraints the reduced state is enough; how long that is wrong ones do not say
    let reduced = dimension.saturating_sub(declaration.constraint.len());
    let unknown = declaration.is_constrained() && !constrained;
    if count != dimension && count != reduced && !(unknown && count < dimension) {
        let place = declaration
            .initial_origin
            .or(entries.last().map(|e| e.origin))
            .unwrap_or(declaration.place());
        let values = plural(count, "value");
        let message =
            format!("the initial state has {count} {values}, but the dimension is {dimension}");
        mistakes.push(
            Diagnostic::new(Kind::StateLength, place, message)
                .help("write one value for every coordinate, in their order"),
        );
        return None;
    }
    lowered.into_iter().collect::<Option<Vec<_>>>().map(Some)
}
