//! The parameters of constants that are added to a Lie–Poisson bracket: they are exact, and have values.

use super::poisson::Entry;
use crate::model::Parameter;
use lie_symbolic::symbolic::{Graph, Symbol};
use lie_syntax::ast::{Declaration, ExprKind, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// Constants that use parameters which are not exact: the identity must hold for what the
/// brackets of the algebra may depend on, and these are exact.
pub fn exactness(declaration: &Declaration) -> Vec<Diagnostic> {
    let Structure::Lie { cocycle, .. } = &declaration.structure else {
        return Vec::new();
    };
    let inexact = |name: &str| {
        let mut parameters = declaration.parameters.iter();
        parameters.any(|p| p.name.text == name && !p.exact)
    };
    let parts = cocycle.iter().flat_map(|bracket| bracket.value.parts());
    let wrong = parts.filter_map(|part| match &part.kind {
        ExprKind::Name { name, .. } if inexact(name) => Some(not_exact(name, part.origin)),
        _ => None,
    });
    wrong.collect()
}

fn not_exact(name: &str, origin: Origin) -> Diagnostic {
    let message = format!("the parameter `{name}` is not exact, so a cocycle cannot use it");
    let help =
        format!("declare it exact: `exact {name} = …;` in the macro, `\"exact\": true` in a spec");
    Diagnostic::new(Kind::UnknownSymbol, origin, message).help(help)
}

/// Constants that reach such parameters through abbreviations, and those that are not finite for the default parameters.
pub fn constants(
    entries: &[Entry],
    graph: &Graph,
    parameters: &[Parameter],
) -> impl Iterator<Item = Diagnostic> {
    entries.iter().filter_map(|entry| {
        let used = graph.symbols(entry.value);
        let inexact = used.into_iter().find_map(|symbol| match symbol {
            Symbol::Parameter(p) => parameters.get(p).filter(|p| p.exact.is_none()),
            _ => None,
        });
        if let Some(parameter) = inexact {
            return Some(not_exact(&parameter.name, entry.origin));
        }
        let value = |symbol| match symbol {
            Symbol::Parameter(p) => parameters[p].default_value,
            _ => f64::NAN,
        };
        let finite = graph.evaluate(entry.value, &value).is_finite();
        let message = "this constant is not finite for the default parameters";
        let wrong = || Diagnostic::new(Kind::Number, entry.origin, message);
        (!finite).then(|| wrong().help("choose another default"))
    })
}
