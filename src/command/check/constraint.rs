//! What `lie check` says of a system with a constraint.

use std::fmt::Write as _;

use lie_codegen::structure::Structure;

/// The constraint, the basis of what it leaves, and the velocity there. The momenta that it determines are observables.
pub(super) fn write(model: &Structure, text: &mut String) -> std::fmt::Result {
    let Some(constraint) = &model.constraint else {
        return Ok(());
    };
    writeln!(text, "  constraint: {}", constraint.forms.join(", "))?;
    let basis = constraint.basis_in_words(model).into_iter();
    let basis = basis.map(|(coordinate, element)| format!("{coordinate} along {element}"));
    let basis: Vec<String> = basis.collect();
    writeln!(text, "    momenta on what it leaves: {}", basis.join(", "))?;
    let velocity = constraint.components.iter().zip(&constraint.velocity);
    for (component, value) in velocity {
        writeln!(text, "    velocity {component} = {}", model.display(*value))?;
    }
    let jacobi = match constraint.jacobi {
        Some(true) => "its Jacobi identity holds, which nothing here uses",
        Some(false) => "its Jacobi identity fails",
        None => "whether its Jacobi identity holds was not decided",
    };
    writeln!(text, "    the bracket is almost Poisson: {jacobi}")
}
