//! The initial state of a system with a constraint, in the reduced coordinates or in those that were declared.

use crate::model::Model;
use lie_symbolic::symbolic::Symbol;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// The mistake of an initial state in the declared coordinates that is off the constraint at the default parameters.
pub fn violation(model: &Model, declaration: &Declaration) -> Option<Diagnostic> {
    let initial = model.constraint.as_ref()?.declared_initial.as_ref()?;
    let parameters = model.defaults();
    let value = |symbol| match symbol {
        Symbol::Parameter(p) => parameters[p],
        _ => f64::NAN,
    };
    let given = model.graph.evaluate_all(initial, &value);
    let wrong = model.violation(&given, &parameters)?;
    let entries = declaration.initial.iter().flatten();
    let entries: Vec<Origin> = entries.map(|entry| entry.origin).collect();
    let place = entries.get(wrong.coordinate).copied();
    let place = place.or(declaration.initial_origin);
    let place = place.unwrap_or(declaration.place());
    Some(Diagnostic::new(Kind::Constraint, place, wrong.message).help(wrong.help))
}
