//! A retraction, in the form that both front ends hand on.

use super::vectors::Value;
use crate::ast::{Expr, Name, Retraction};
use crate::diagnostic::{Diagnostic, Kind, Origin};

/// The retraction of its matrices by name.
///
/// # Errors
/// One of them is no matrix, or there is no `map`.
pub fn retraction(
    fields: Vec<(Name, Value)>,
    origin: Origin,
    kind: Kind,
) -> Result<Retraction, Box<Diagnostic>> {
    let mut matrices: [Option<Vec<Vec<Expr>>>; 2] = [None, None];
    for (name, value) in fields {
        let Value::Matrix(rows) = value else {
            let message = format!("`{}` is a matrix, a list of its rows", name.text);
            let help = format!(
                "write `{} = [[1, -x], [x, 1]]` for matrices of size 2",
                name.text
            );
            return Err(Diagnostic::new(kind, name.origin, message)
                .help(help)
                .into());
        };
        matrices[usize::from(name.text == "second")] = Some(rows);
    }
    let [map, second] = matrices;
    let map = map.ok_or_else(|| {
        let message = "the retraction has no `map`";
        let help = "give the matrix of the group element by its rows: `map`";
        Diagnostic::new(kind, origin, message).help(help)
    })?;
    Ok(Retraction {
        map,
        second,
        origin,
    })
}
