//! Names of columns, and of entries of a group element that is not declared, which expressions do not know.

use lie_syntax::ast::Declaration;

/// The column of H.
const ENERGY: &str = "energy";

/// Message and remedy for the name of a column that stands in an expression; none for other names.
pub fn meant(declaration: &Declaration, name: &str) -> Option<(String, String)> {
    let mut observables = declaration.observables.iter().map(|o| &o.name);
    let mut integrals = declaration.integrals.iter().map(|(name, _)| name);
    let mut casimirs = declaration.casimirs.iter().filter_map(|c| c.name.as_ref());
    let what = if observables.any(|known| known.text == name) {
        "an observable"
    } else if integrals.any(|known| known.text == name) {
        "a first integral"
    } else if casimirs.any(|known| known.text == name) {
        "a Casimir"
    } else if name == ENERGY {
        "the column of the energy"
    } else {
        return None;
    };
    let help = match name {
        ENERGY => "write the Hamiltonian out; what both contain can be an abbreviation".to_owned(),
        _ => format!(
            "write the expression of `{name}` out, or make it an abbreviation with another name, which both may contain"
        ),
    };
    Some((
        format!("`{name}` is {what}, and functions, of events too, are expressions of the state"),
        help,
    ))
}

/// What more helps where a name looks like an entry of the group element, `R11`, and there is none.
pub fn element(declaration: &Declaration, name: &str) -> Option<String> {
    let mut letters = name.chars();
    let matrix = letters
        .next()
        .filter(|c| c.is_ascii_uppercase() || *c == 'g')?;
    let indices: Vec<char> = letters.collect();
    let entry = indices.len() == 2 && indices.iter().all(|c| ('1'..='9').contains(c));
    let single = declaration.algebra().is_some() && declaration.family.is_none();
    (entry && single && declaration.group.is_none()).then(|| {
        format!(
            "; if it is an entry of the group element, declare that by `\"group\": \"{matrix}\"`, in the macro `group {matrix};`"
        )
    })
}
