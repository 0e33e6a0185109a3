//! The key `retraction`.

use super::vectors;
use crate::ast::Name;
use crate::diagnostic::Report;
use crate::front::json::{Member, Value};
use crate::front::object::Object;
use crate::front::{Names, schema, vectors as read};

/// `{"map": [[…]], "second": [[…]]}`
pub fn read(
    value: Value<'_>,
    names: &Names,
    report: &mut Report,
) -> Option<Vec<(Name, read::Value)>> {
    let object = Object::read(value, "the retraction", schema::Retraction::KEYS, report)?;
    object.require("the retraction", schema::Retraction::REQUIRED, report);
    let members = object.members();
    let field = |member: &Member<'_>| {
        let name = Name {
            text: member.key.text.to_string(),
            origin: member.key.extent(),
        };
        Some((name, vectors::vector(member.value, names, report)?))
    };
    members.iter().map(field).collect()
}
