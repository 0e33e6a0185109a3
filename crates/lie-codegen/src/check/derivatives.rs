//! The size of what is derived: products of many factors and deep compositions are short to write, but their
//! derivatives swell.

use crate::model::{ENTRIES, PoissonMatrix};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// The largest arena that the derivatives of a system may fill, nodes and operands together. A
/// dense quadratic H on so(7) with a parameter for every coefficient takes a tenth of it.
const MOST_DERIVED: usize = 300_000;

/// The mistake of a system whose kernels are too large.
pub fn kernels(
    graph: &Graph,
    poisson: &PoissonMatrix,
    hamiltonian: (ExprId, Origin),
    (casimirs, integrals): (
        impl IntoIterator<Item = (ExprId, Origin)>,
        impl IntoIterator<Item = (ExprId, Origin)>,
    ),
) -> Option<Diagnostic> {
    let mut scratch = graph.clone();
    if field(&mut scratch, poisson, hamiltonian.0).is_none() {
        return Some(swollen("the Hamiltonian", hamiltonian.1));
    }
    let casimirs = casimirs.into_iter().map(|c| (c, "this Casimir"));
    let integrals = integrals.into_iter().map(|f| (f, "this first integral"));
    let mut kept = casimirs.chain(integrals);
    let large = kept.find(|(f, _)| gradient(&mut scratch, f.0, poisson.dimension).is_none());
    large.map(|((_, origin), what)| swollen(what, origin))
}

/// Whether momentum and inertia of a Lagrangian are of reasonable size.
///
/// # Errors
/// They are too large.
pub fn momenta(
    graph: &Graph,
    value: ExprId,
    dimension: usize,
    origin: Origin,
) -> Result<(), Diagnostic> {
    let mut scratch = graph.clone();
    let entries = graph.symbols(value).into_iter();
    let entries = entries.filter(|symbol| matches!(symbol, Symbol::Input(i) if *i >= ENTRIES));
    let variables: Vec<Symbol> = (0..dimension).map(Symbol::Input).chain(entries).collect();
    let mut slopes = |function: ExprId| -> Option<Vec<ExprId>> {
        let slope = |x: &Symbol| scratch.derivative_within(function, *x, MOST_DERIVED);
        variables.iter().map(slope).collect()
    };
    let momenta = slopes(value);
    let small = momenta.is_some_and(|momenta| momenta.into_iter().all(|p| slopes(p).is_some()));
    small
        .then_some(())
        .ok_or_else(|| swollen("the Lagrangian", origin))
}

fn swollen(what: &str, origin: Origin) -> Diagnostic {
    Diagnostic::new(
        Kind::Limit,
        origin,
        format!("the derivatives of {what} have more than {MOST_DERIVED} terms and factors"),
    )
    .help("shorten its products and compositions: each factor and each level multiplies the size")
}

fn gradient(graph: &mut Graph, function: ExprId, dimension: usize) -> Option<Vec<ExprId>> {
    (0..dimension)
        .map(|i| graph.derivative_within(function, Symbol::Coordinate(i), MOST_DERIVED))
        .collect()
}

/// Gradient, Hessian, field and Jacobian of the field: what all other kernels are made of.
fn field(graph: &mut Graph, poisson: &PoissonMatrix, hamiltonian: ExprId) -> Option<()> {
    let dimension = poisson.dimension;
    let slopes = gradient(graph, hamiltonian, dimension)?;
    for slope in &slopes {
        gradient(graph, *slope, dimension)?;
    }
    let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); dimension];
    for (i, j, value) in &poisson.entries {
        for (i, j) in [(*i, *j), (*j, *i)] {
            terms[j].push(graph.mul(*value, slopes[i]));
            if graph.size() > MOST_DERIVED {
                return None;
            }
        }
    }
    for terms in terms {
        let component = graph.sum(&terms);
        gradient(graph, component, dimension)?;
    }
    Some(())
}
