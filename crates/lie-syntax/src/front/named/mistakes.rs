//! What is wrong with a name.

use super::EXAMPLES;
use crate::constructors::FAMILIES;
use crate::diagnostic::{Diagnostic, Kind, Origin};
use crate::front::token::{Token, render};
use crate::suggest::did_you_mean;

/// What stands before parentheses and is no family.
const OPERATIONS: [&str; 2] = ["semidirect", "tangent"];

/// A token that does not belong there.
pub fn unexpected(token: &Token) -> Diagnostic {
    let text = render(std::slice::from_ref(token));
    let help = match text.as_str() {
        "*" | "×" | "x" | "⊕" | "-" | "/" => "a direct sum is written `A + B`, a power `A^N`",
        "⋉" | "⋊" => "write `semidirect(A, R^n)`",
        _ => EXAMPLES,
    };
    let message = format!("unexpected `{text}` in the name of an algebra");
    Diagnostic::new(Kind::Syntax, token.origin, message).help(help)
}

/// A name that is none.
pub fn unknown(name: &str, place: Origin) -> Diagnostic {
    let names = || {
        let families = FAMILIES.iter().flat_map(|family| family.names);
        families.copied().chain(OPERATIONS)
    };
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let size = &name[stem.len()..];
    let lower = stem.to_lowercase();
    let help = if !size.is_empty() && names().any(|known| known == lower) {
        format!("write `{lower}({size})`")
    } else if let Some(near) = did_you_mean(name, names()) {
        format!("did you mean `{near}`?")
    } else {
        let forms: Vec<String> = FAMILIES.iter().map(|f| format!("`{}`", f.form)).collect();
        format!(
            "the algebras are {}, sums `A + B`, powers `A^N`, `semidirect(A, R^n)` and `tangent(A)`; \
             any other one is declared by `basis` and `brackets`",
            forms.join(", ")
        )
    };
    let message = format!("there is no algebra `{}`", name.escape_debug());
    Diagnostic::new(Kind::UnknownSymbol, place, message).help(help)
}
