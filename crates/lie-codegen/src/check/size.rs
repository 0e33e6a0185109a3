//! Dimension, one coordinate for every basis element, and the size of what is derived.

use crate::model::PoissonMatrix;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, Report, plural};
use lie_syntax::limits::MAX_DIMENSION;

/// Each parameter is a field of the generated type and a word of every system; a quadratic H with a parameter
/// for every coefficient has as many in 76 dimensions.
const MOST_PARAMETERS: usize = 3_000;

/// The largest arena that the derivatives of a system may fill, nodes and operands together. A
/// dense quadratic H on so(7) with a parameter for every coefficient takes a tenth of it.
const MOST_DERIVED: usize = 300_000;

/// Checks that the basis is neither empty nor beyond every size, and that the state fits it;
/// whether the other checks of the stage make sense.
pub fn check(declaration: &Declaration, report: &mut Report) -> bool {
    if let Some(diagnostic) = empty(declaration).or_else(|| beyond_every_size(declaration)) {
        report.push(diagnostic);
        return false;
    }
    let others = [velocity(declaration), state(declaration)];
    others.into_iter().flatten().for_each(|d| report.push(d));
    true
}

fn empty(declaration: &Declaration) -> Option<Diagnostic> {
    let place = declaration.place();
    (declaration.dimension() == 0).then(|| match declaration.algebra() {
        Some(_) => Diagnostic::new(Kind::Basis, place, "the basis is empty")
            .help("name at least one basis element"),
        None => Diagnostic::new(Kind::StateLength, place, "the state is empty")
            .help("name at least one coordinate"),
    })
}

fn beyond_every_size(declaration: &Declaration) -> Option<Diagnostic> {
    let dimension = declaration.dimension();
    if dimension > MAX_DIMENSION {
        let message = format!("the dimension {dimension} is above the limit of {MAX_DIMENSION}");
        return Some(
            Diagnostic::new(Kind::Limit, declaration.place(), message)
                .help("kernels are straight-line code; declare a smaller system"),
        );
    }
    let parameter = declaration.parameters.get(MOST_PARAMETERS)?;
    let count = declaration.parameters.len();
    let message =
        format!("the number of parameters, {count}, is above the limit of {MOST_PARAMETERS}");
    Some(
        Diagnostic::new(Kind::Limit, parameter.name.origin, message)
            .help("write what never varies as numbers, or express many parameters by few"),
    )
}

/// A velocity that does not fit the basis.
fn velocity(declaration: &Declaration) -> Option<Diagnostic> {
    let velocity = declaration.energy.velocity();
    let (count, dimension) = (velocity.len(), declaration.dimension());
    let last = velocity.last().filter(|_| count != dimension)?;
    let place = velocity.get(dimension).unwrap_or(last).origin;
    let (names, elements) = (plural(count, "name"), plural(dimension, "element"));
    let message =
        format!("the velocity has {count} {names}, but the basis has {dimension} {elements}");
    Some(
        Diagnostic::new(Kind::StateLength, place, message)
            .help("the velocity xi has one component for every basis element"),
    )
}

/// A state that does not fit the basis.
fn state(declaration: &Declaration) -> Option<Diagnostic> {
    let state = &declaration.state;
    let (count, dimension) = (state.len(), declaration.dimension());
    if count == dimension {
        return None;
    }
    let nearest = state.get(dimension).or(state.last());
    let place = nearest.map_or(declaration.place(), |name| name.origin);
    let (names, elements) = (plural(count, "name"), plural(dimension, "element"));
    let message =
        format!("the state has {count} {names}, but the basis has {dimension} {elements}");
    Some(Diagnostic::new(Kind::StateLength, place, message).help(
        "the state names the coordinates of mu in the dual basis: one for every basis element",
    ))
}

/// Checks that the kernels of a system stay of reasonable size: products of many factors and deep
/// compositions are short to write, but their derivatives swell.
pub fn derived(
    graph: &Graph,
    poisson: &PoissonMatrix,
    hamiltonian: (ExprId, Origin),
    casimirs: &[(ExprId, Origin)],
    report: &mut Report,
) {
    let mut scratch = graph.clone();
    let mut fails = |what: &str, origin: Origin| report.push(swollen(what, origin));
    if field(&mut scratch, poisson, hamiltonian.0).is_none() {
        fails("the Hamiltonian", hamiltonian.1);
        return;
    }
    for (casimir, origin) in casimirs {
        if gradient(&mut scratch, *casimir, poisson.dimension).is_none() {
            fails("this Casimir", *origin);
            return;
        }
    }
}

/// Checks that a Lagrangian has momentum and inertia of reasonable size.
pub fn lagrangian(
    graph: &Graph,
    value: ExprId,
    dimension: usize,
    origin: Origin,
    report: &mut Report,
) -> bool {
    let mut scratch = graph.clone();
    let mut derivatives = |function: ExprId| -> Option<Vec<ExprId>> {
        (0..dimension)
            .map(|i| scratch.derivative_within(function, Symbol::Input(i), MOST_DERIVED))
            .collect()
    };
    let momentum = derivatives(value);
    let inertia = momentum.and_then(|slopes| {
        slopes
            .into_iter()
            .map(derivatives)
            .collect::<Option<Vec<_>>>()
    });
    if inertia.is_none() {
        report.push(swollen("the Lagrangian", origin));
    }
    inertia.is_some()
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
