//! Dimension, and one coordinate for every basis element.

use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, plural};
use lie_syntax::limits::MAX_DIMENSION;

/// Each parameter is a field of the generated type and a word of every system; a quadratic H with a parameter
/// for every coefficient has as many in 76 dimensions.
const MOST_PARAMETERS: usize = 3_000;

/// The mistake of an empty basis, or of one beyond every size: no other check makes sense then.
pub fn dimension(declaration: &Declaration) -> Option<Diagnostic> {
    empty(declaration).or_else(|| beyond_every_size(declaration))
}

/// What does not have the length of the basis: velocity and state.
pub fn lengths(declaration: &Declaration) -> impl Iterator<Item = Diagnostic> {
    let velocity = velocity(declaration).into_iter();
    velocity.chain(state(declaration))
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
