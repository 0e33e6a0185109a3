//! Where functions of Rust may stand: nothing is known of their values while the compiler runs.

use super::poisson::Entry;
use lie_symbolic::symbolic::{ExprId, Graph};
use lie_syntax::ast::{Declaration, Energy};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Functions of Rust in brackets, whose Jacobi identity and rank need more than a symbol, and in Lagrangians, whose
/// Legendre transform does.
pub fn own_functions(
    declaration: &Declaration,
    graph: &Graph,
    brackets: Option<&[Entry]>,
    energy: Option<ExprId>,
) -> impl Iterator<Item = Diagnostic> {
    let refused = |id: ExprId, kind, origin, what: &str, help: &str| {
        let own = graph.own_functions(id).into_iter().next()?;
        let name = &own.declared().name;
        let message = format!("`{name}` is a function of Rust, which {what}");
        Some(Diagnostic::new(kind, origin, message).help(help))
    };
    let brackets = brackets.into_iter().flatten().filter_map(move |entry| {
        let help = "write a formula, or give a table";
        let what = "cannot stand in a bracket";
        refused(entry.value, Kind::Jacobi, declaration.place(), what, help)
    });
    let lagrangian = energy.filter(|_| !matches!(declaration.energy, Energy::Hamiltonian(_)));
    let lagrangian = lagrangian.and_then(|energy| {
        let origin = declaration.energy.expression().origin;
        let help = "declare the Hamiltonian, or write a formula in place of the function";
        let what = "the Legendre transform cannot look into";
        refused(energy, Kind::Legendre, origin, what, help)
    });
    brackets.chain(lagrangian)
}
