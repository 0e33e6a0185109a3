//! What is said of a name that an exact expression cannot use.

use super::Scope;
use super::scope::Meaning;
use crate::diagnostic::{Diagnostic, Kind, Origin};
use crate::suggest::{listed, misspelt};

fn unknown(origin: Origin, message: String) -> Diagnostic {
    Diagnostic::new(Kind::UnknownSymbol, origin, message)
}

/// A parameter that is not exact.
fn inexact(name: &str, origin: Origin, whose: &str) -> Diagnostic {
    let message = format!("the parameter `{name}` is not exact, so {whose} cannot use it");
    unknown(origin, message).help(format!(
        "declare it exact: `exact {name} = …;` in the macro, `\"exact\": true` in a spec"
    ))
}

/// A name in a bracket that is declared for something else, or not at all.
pub(super) fn not_in_brackets(
    name: &str,
    origin: Origin,
    meaning: Option<Meaning>,
    scope: &Scope<'_>,
) -> Diagnostic {
    match meaning {
        Some(Meaning::Inexact) => inexact(name, origin, "a bracket"),
        Some(Meaning::Let) => unknown(
            origin,
            format!(
                "`{name}` is an abbreviation; a bracket knows basis names and exact parameters only"
            ),
        )
        .help("write it out"),
        Some(Meaning::Coordinate) => unknown(
            origin,
            format!("`{name}` is a coordinate; a bracket is written in basis names"),
        )
        .help(format!("the basis is {}", scope.basis().join(", "))),
        _ => {
            let diagnostic = unknown(
                origin,
                format!("`{name}` is neither a basis name nor an exact parameter"),
            );
            match scope.nearest_basis(name) {
                Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
                None => diagnostic.help(format!(
                    "the basis is {}: add it, or declare it as an exact parameter",
                    listed(scope.basis())
                )),
            }
        }
    }
}

/// A name in a matrix that is declared for something else, or not at all.
pub(super) fn not_in_matrices(
    name: &str,
    origin: Origin,
    meaning: Option<Meaning>,
    scope: &Scope<'_>,
) -> Diagnostic {
    let what = match meaning {
        Some(Meaning::Inexact) => return inexact(name, origin, "a matrix"),
        Some(Meaning::Let) => {
            let message =
                format!("`{name}` is an abbreviation; a matrix knows exact parameters only");
            return unknown(origin, message).help("write it out");
        }
        Some(Meaning::Basis(_)) => "a basis name, and no exact parameter",
        Some(Meaning::Coordinate) => "a coordinate, and no exact parameter",
        _ => "no exact parameter",
    };
    let help = match misspelt(name, scope.exact()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "write a number, or declare it as an exact parameter".to_owned(),
    };
    unknown(origin, format!("`{name}` is {what}")).help(help)
}
