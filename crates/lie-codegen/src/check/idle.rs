//! What a declaration says without effect: names that nothing uses, and a system in which nothing
//! moves. Nothing of it is wrong, but most of it is a slip, so that it is a warning.

use std::collections::BTreeSet;

use crate::model::{Bracket, Model};
use lie_symbolic::symbolic::Symbol;
use lie_syntax::ast::{
    Attitude, BONDS, Declaration, Expr, ExprKind, Name, Retraction, Size, Structure,
};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Warnings of parameters and abbreviations that no expression mentions, of brackets that are all
/// zero and of a Hamiltonian that is constant.
pub fn without_effect(declaration: &Declaration, model: &Model) -> Vec<Diagnostic> {
    let mut warnings = unused(declaration);
    if model.family.is_none() && model.driving.is_none() {
        warnings.extend(motionless(declaration, model));
    }
    warnings
}

fn unused(declaration: &Declaration) -> Vec<Diagnostic> {
    let mut mentioned = mentioned(declaration);
    for size in declaration.family.iter().flat_map(|family| &family.sizes) {
        if let Size::Parameter(name) = size {
            mentioned.insert(&name.text);
        }
    }
    let parameters = declaration.parameters.iter();
    let parameters = parameters.map(|p| (&p.name, "parameter"));
    let data = declaration.site_data().iter();
    let parameters = parameters.chain(data.map(|data| (&data.name, "parameter")));
    let lets = declaration.lets.iter();
    let lets = lets.map(|(name, _)| (name, "abbreviation"));
    let all = parameters.chain(lets);
    let unused = all.filter(|(name, _)| !mentioned.contains(name.text.as_str()));
    let bonds = declaration
        .family
        .as_ref()
        .and_then(|family| family.bonds.as_ref());
    let bonds = bonds.filter(|_| !mentioned.contains(BONDS)).map(|bonds| {
        Diagnostic::new(Kind::Unused, bonds.origin, "no sum goes over the bonds")
            .help("write `sum(bonds: value*x[i]*x[j])`, or remove them")
            .warning()
    });
    let warning = |(name, what): (&Name, &str)| {
        let message = format!("the {what} `{}` is not used", name.text);
        Diagnostic::new(Kind::Unused, name.origin, message)
            .help("remove it, or use it in an expression")
            .warning()
    };
    unused.map(warning).chain(bonds).collect()
}

/// A sum of brackets that are zero, or a constant H: every state is at rest.
fn motionless(declaration: &Declaration, model: &Model) -> impl Iterator<Item = Diagnostic> {
    let no_bracket = match &model.bracket {
        Bracket::Lie(algebra) => algebra.constants.entries().is_empty(),
        Bracket::General(matrix) => matrix.entries.is_empty(),
    };
    // A single coordinate has no bracket but with itself, and whoever declares it knows.
    let several = declaration.dimension() > 1 && !declaration.is_constrained();
    let at_rest = (no_bracket && several).then(|| {
        let message = "all brackets are zero: no state moves, whatever the Hamiltonian is";
        let help = match declaration.structure {
            Structure::Lie { .. } => {
                "declare the brackets that are not zero, such as \"[e1, e2] = e3\"; one that is left out is zero"
            }
            Structure::General { .. } => {
                "declare the brackets that are not zero, such as \"{q, p} = 1\"; one that is left out is zero"
            }
        };
        Diagnostic::new(Kind::Motionless, declaration.place(), message)
            .help(help)
            .warning()
    });
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Coordinate(_));
    let energy = model.energy.expression().map(|h| h.energy);
    let constant = energy.filter(|energy| !model.graph.symbols(*energy).iter().any(moves));
    let constant = constant.map(|_| {
        let place = declaration.energy.expression().origin;
        let message = "the Hamiltonian does not depend on the state: no state moves";
        Diagnostic::new(Kind::Motionless, place, message)
            .help("write it in the names of the state")
            .warning()
    });
    at_rest.into_iter().chain(constant)
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
    pending.extend(declaration.driving());
    pending.extend(declaration.constrained());
    pending.extend(declaration.casimirs.iter().map(|c| &c.value));
    pending.extend(declaration.recorded());
    if let Some(realization) = &declaration.realization {
        pending.extend(realization.map.iter().map(|(_, value)| value));
        pending.extend(realization.start.iter().flatten());
    }
    let retraction = declaration.retraction.iter();
    pending.extend(retraction.flat_map(Retraction::entries));
    pending.extend(declaration.initial.iter().flatten());
    pending.extend(declaration.attitude.iter().flat_map(Attitude::entries));
    let names = pending.into_iter().flat_map(Expr::parts);
    let names = names.filter_map(|part| match &part.kind {
        ExprKind::Name { name, .. } => Some(name.as_str()),
        ExprKind::IndexedSum { index, .. } if index.text == BONDS => Some(BONDS),
        _ => None,
    });
    names.collect()
}
