//! The reduced Lagrangian of which a discrete one is an approximation.
//!
//! A discrete Lagrangian is consistent with `l(xi) = lim l_d(h xi)/h`, h to 0: the coefficient of h in the series of
//! `l_d(h xi)`. Those of lower powers must not depend on xi; a constant in l_d moves nothing.

use super::series::in_step;
use crate::model::InEntries;
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// Work allowed for the decisions of the normal form.
const WORK: u64 = 2_000_000;

/// The reduced Lagrangian of a discrete one in the same number of variables, which may be written in entries of the group element.
///
/// # Errors
/// `legendre` where it is consistent with none.
pub fn reduced(
    graph: &mut Graph,
    (discrete, in_entries): (ExprId, Option<&InEntries>),
    count: usize,
    origin: Origin,
) -> Result<ExprId, Diagnostic> {
    limit(graph, discrete, in_entries, count).ok_or_else(|| {
        Diagnostic::new(
            Kind::Legendre,
            origin,
            "the discrete Lagrangian is not consistent with any Lagrangian: `l_d(h xi)/h` has no limit as the step \
             size h goes to 0, or none was found",
        )
        .help("an action of one step is about `h*l(x/h)`, such as `x^2/(2*h)`")
    })
}

/// The mistake of a discrete Lagrangian where there is no group alone to step on.
pub fn elsewhere(origin: Origin) -> Diagnostic {
    Diagnostic::new(
        Kind::Legendre,
        origin,
        "a discrete Lagrangian needs the Lie–Poisson bracket of an algebra, no dependence on the time, and nothing that acts beside it",
    )
    .help("declare a `hamiltonian` or a `lagrangian`")
}

fn limit(
    graph: &mut Graph,
    discrete: ExprId,
    in_entries: Option<&InEntries>,
    count: usize,
) -> Option<ExprId> {
    let series = in_step(graph, discrete, in_entries)?;
    let limit = series.coefficient(graph, 1)?;
    let mut divergent = Vec::new();
    for power in series.start()..1 {
        let coefficient = series.coefficient(graph, power)?;
        for i in 0..count {
            divergent.push(graph.derivative(coefficient, Symbol::Input(i)));
        }
    }
    let budget = Budget::new(WORK);
    let graph = &*graph;
    let mut normal = NormalForm::new(graph, &budget);
    let vanishes =
        |slope: &ExprId| graph.is_zero(*slope) || matches!(normal.verdict(*slope), Verdict::Zero);
    divergent.iter().all(vanishes).then_some(limit)
}
