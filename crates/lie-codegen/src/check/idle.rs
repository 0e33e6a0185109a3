//! What a declaration says without effect: names that nothing uses, and a system in which nothing
//! moves. Nothing of it is wrong, but most of it is a slip, so that it is a warning.

use std::collections::BTreeSet;

use crate::model::{Bracket, Model};
use lie_symbolic::symbolic::Symbol;
use lie_syntax::ast::{Declaration, Expr, ExprKind, Size, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind, Report};

/// Warns of parameters and abbreviations that no expression mentions, of brackets that are all
/// zero and of a Hamiltonian that is constant.
pub fn check(declaration: &Declaration, model: &Model, report: &mut Report) {
    unused(declaration, report);
    motionless(declaration, model, report);
}

/// Warns of parameters and abbreviations that no expression mentions.
pub fn unused(declaration: &Declaration, report: &mut Report) {
    let mut mentioned = mentioned(declaration);
    for size in declaration.family.iter().flat_map(|family| &family.sizes) {
        if let Size::Parameter(name) = size {
            mentioned.insert(&name.text);
        }
    }
    let parameters = declaration
        .parameters
        .iter()
        .map(|p| (&p.name, "parameter"));
    let lets = declaration.lets.iter();
    let lets = lets.map(|(name, _)| (name, "abbreviation"));
    for (name, what) in parameters.chain(lets) {
        if !mentioned.contains(name.text.as_str()) {
            let message = format!("the {what} `{}` is not used", name.text);
            let warning = Diagnostic::new(Kind::Unused, name.origin, message);
            report.push(
                warning
                    .help("remove it, or use it in an expression")
                    .warning(),
            );
        }
    }
}

/// A sum of brackets that are zero, or a constant H: every state is at rest.
fn motionless(declaration: &Declaration, model: &Model, report: &mut Report) {
    let no_bracket = match &model.bracket {
        Bracket::Lie(algebra) => algebra.constants.entries().is_empty(),
        Bracket::General(matrix) => matrix.entries.is_empty(),
        Bracket::Extended(..) => false,
    };
    // A single coordinate has no bracket but with itself, and whoever declares it knows.
    if no_bracket && declaration.dimension() > 1 {
        let message = "all brackets are zero: no state moves, whatever the Hamiltonian is";
        let help = match declaration.structure {
            Structure::Lie { .. } => {
                "declare the brackets that are not zero, such as \"[e1, e2] = e3\"; one that is left out is zero"
            }
            Structure::General { .. } => {
                "declare the brackets that are not zero, such as \"{q, p} = 1\"; one that is left out is zero"
            }
        };
        let warning = Diagnostic::new(Kind::Motionless, declaration.place(), message);
        report.push(warning.help(help).warning());
    }
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Coordinate(_));
    let energy = model.energy.expression().map(|h| h.energy);
    if energy.is_some_and(|energy| !model.graph.symbols(energy).iter().any(moves)) {
        let place = declaration.energy.expression().origin;
        let message = "the Hamiltonian does not depend on the state: no state moves";
        let warning = Diagnostic::new(Kind::Motionless, place, message);
        report.push(warning.help("write it in the names of the state").warning());
    }
}

/// Every name in every expression.
fn mentioned(declaration: &Declaration) -> BTreeSet<&str> {
    let mut pending: Vec<&Expr> = Vec::new();
    match &declaration.structure {
        Structure::Lie { algebra, cocycle } => {
            pending.extend(algebra.brackets.iter().flatten().map(|b| &b.value));
            pending.extend(cocycle.iter().map(|b| &b.value));
            let rows = algebra.matrices.iter().flat_map(|matrix| &matrix.rows);
            pending.extend(rows.flatten());
        }
        Structure::General { brackets, .. } => pending.extend(brackets.iter().map(|b| &b.value)),
    }
    pending.extend(declaration.lets.iter().map(|(_, value)| value));
    pending.push(declaration.energy.expression());
    pending.extend(declaration.casimirs.iter().map(|c| &c.value));
    if let Some(realization) = &declaration.realization {
        pending.extend(realization.map.iter().map(|(_, value)| value));
        pending.extend(realization.start.iter().flatten());
    }
    pending.extend(declaration.initial.iter().flatten());
    let mut names = BTreeSet::new();
    while let Some(expression) = pending.pop() {
        match &expression.kind {
            ExprKind::Number(_) => {}
            ExprKind::Name { name, .. } => {
                names.insert(name.as_str());
            }
            ExprKind::Negative(a) => pending.push(a),
            ExprKind::Power(a, b) => pending.extend([&**a, &**b]),
            ExprKind::Sum(operands) | ExprKind::Product(operands) => {
                pending.extend(operands.iter().map(|(_, operand)| operand));
            }
            ExprKind::Call { arguments, .. } => pending.extend(arguments),
            ExprKind::IndexedSum { from, to, body, .. } => {
                pending.extend([&**from, &**to, &**body])
            }
        }
    }
    names
}
