//! The block `retraction`.

use super::entry::Entry;
use super::vectors;
use crate::ast::Name;
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::schema::Retraction;
use crate::front::vectors::Value;
use crate::front::{Names, item};

/// `{ map = [[…]]; second = [[…]]; }`
pub fn read(block: &[Entry<'_>], names: &Names, report: &mut Report) -> Option<Vec<(Name, Value)>> {
    let mut fields: Vec<(Name, Value)> = Vec::new();
    for entry in block {
        let what = "a matrix of the retraction";
        let (name, value) = item::definition(entry.tokens, what, entry.origin(), report)?;
        let mistake = if !Retraction::KEYS.contains(&name.text.as_str()) {
            let message = format!("the retraction has no `{}`", name.text);
            Some((message, "its matrices are `map` and `second`"))
        } else if fields.iter().any(|(known, _)| known.text == name.text) {
            let message = format!("`{}` stands twice", name.text);
            Some((message, "remove one of the two"))
        } else {
            None
        };
        if let Some((message, help)) = mistake {
            report.push(Diagnostic::new(Kind::Syntax, name.origin, message).help(help));
            return None;
        }
        let value = vectors::value(&name, value, names, report)?;
        fields.push((name, value));
    }
    Some(fields)
}
