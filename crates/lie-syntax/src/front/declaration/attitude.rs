//! The block `attitude`.

use super::entry::Entry;
use super::vectors;
use crate::ast::Name;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::attitude::Written;
use crate::front::schema::Attitude;
use crate::front::token::{render, span};
use crate::front::{Names, item};

/// `{ quaternion = [1, 0, 0, 0]; }`, `{ matrix = [[…]]; }`, `{ euler = zxz; angles = […]; }`
pub fn read(
    block: &[Entry<'_>],
    origin: Origin,
    names: &Names,
    report: &mut Report,
) -> Option<Written> {
    let (mut euler, mut fields) = (None, Vec::new());
    for entry in block {
        let what = "what belongs to the attitude";
        let (name, value) = item::definition(entry.tokens, what, entry.origin(), report)?;
        let known = |(known, _): &(Name, _)| known.text == name.text;
        let again = fields.iter().any(known) || (name.text == "euler" && euler.is_some());
        if again || !Attitude::KEYS.contains(&name.text.as_str()) {
            let (message, help) = match again {
                true => (
                    format!("`{}` stands twice", name.text),
                    "remove one of the two".to_owned(),
                ),
                false => (
                    format!("the attitude has no `{}`", name.text),
                    format!("its parts are {}", Attitude::KEYS.join(", ")),
                ),
            };
            report.push(Diagnostic::new(Kind::Syntax, name.origin, message).help(help));
            return None;
        }
        if name.text == "euler" {
            euler = Some(Name {
                text: render(value),
                origin: span(value).unwrap_or(name.origin),
            });
            continue;
        }
        let value = vectors::value(&name, value, names, report)?;
        fields.push((name, value));
    }
    Some(Written {
        euler,
        fields,
        origin,
    })
}
