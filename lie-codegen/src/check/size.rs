//! Dimension, and one coordinate for every basis element.

use crate::ast::Declaration;
use crate::diagnostic::{Diagnostic, Kind, Report};

/// Kernels are straight-line code; above this dimension no compiler gets through them.
pub const MAX_DIMENSION: usize = 256;

/// Checks that the basis is neither empty nor beyond every size, and that the state fits it;
/// whether the other checks of the stage make sense.
pub fn check(declaration: &Declaration, report: &mut Report) -> bool {
    let dimension = declaration.algebra.basis.len();
    let state = declaration.state.len();
    if dimension == 0 {
        report.push(
            Diagnostic::new(
                Kind::Basis,
                declaration.algebra.origin,
                "the basis is empty",
            )
            .help("name at least one basis element"),
        );
        return false;
    }
    if dimension > MAX_DIMENSION {
        report.push(
            Diagnostic::new(
                Kind::Limit,
                declaration.algebra.origin,
                format!("the dimension {dimension} is above the limit of {MAX_DIMENSION}"),
            )
            .help("kernels are straight-line code; declare a smaller system"),
        );
        return false;
    }
    if state != dimension {
        let place = match declaration
            .state
            .get(dimension)
            .or(declaration.state.last())
        {
            Some(name) => name.origin,
            None => declaration.algebra.origin,
        };
        report.push(
            Diagnostic::new(
                Kind::StateLength,
                place,
                format!("the state has {state} {}, but the basis has {dimension} {}", plural(state, "name"), plural(dimension, "element")),
            )
            .help("the state names the coordinates of mu in the dual basis: one for every basis element"),
        );
    }
    true
}

/// The word for so many things.
pub fn plural(count: usize, word: &str) -> String {
    if count == 1 {
        word.to_string()
    } else {
        format!("{word}s")
    }
}
