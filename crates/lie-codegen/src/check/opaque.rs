//! Where functions of Rust may stand: nothing is known of their values while the compiler runs.

use super::poisson::Entry;
use lie_symbolic::symbolic::{ExprId, Graph};
use lie_syntax::ast::{Declaration, Energy};
use lie_syntax::diagnostic::{Diagnostic, Kind, Report};

/// Reports functions of Rust in brackets, whose Jacobi identity and rank need more than a symbol, and in Lagrangians, whose
/// Legendre transform does.
pub fn check(
    declaration: &Declaration,
    graph: &Graph,
    brackets: Option<&[Entry]>,
    energy: Option<ExprId>,
    report: &mut Report,
) {
    let mut refuse = |id: ExprId, kind, origin, what: &str, help: &str| {
        if let Some(own) = graph.own_functions(id).first() {
            let name = &own.declared().name;
            let message = format!("`{name}` is a function of Rust, which {what}");
            report.push(Diagnostic::new(kind, origin, message).help(help));
        }
    };
    for entry in brackets.into_iter().flatten() {
        let help = "write a formula, or give a table";
        let what = "cannot stand in a bracket";
        refuse(entry.value, Kind::Jacobi, declaration.place(), what, help);
    }
    if let Some(energy) = energy
        && !matches!(declaration.energy, Energy::Hamiltonian(_))
    {
        let origin = declaration.energy.expression().origin;
        let help = "declare the Hamiltonian, or write a formula in place of the function";
        let what = "the Legendre transform cannot look into";
        refuse(energy, Kind::Legendre, origin, what, help);
    }
}
