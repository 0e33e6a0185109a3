//! The keys `forces` and `dissipation`.

use super::{line, quantity, vectors};
use crate::ast::Name;
use crate::diagnostic::Report;
use crate::front::json::{Type, Value};
use crate::front::object::{Object, list, string, wrong_type};
use crate::front::reader::Line;
use crate::front::{Names, driving, expression, item, schema};

/// `{"m1": "-k*m1"}`: names, each with an expression.
pub fn definitions(value: Value<'_>, key: &str, report: &mut Report) -> Vec<(Name, Line<'static>)> {
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, &format!("`{key}`"), "an object"));
        return Vec::new();
    }
    let mut defined = Vec::new();
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let what = format!("a value of `{key}`");
        let line = line(member.value, &what, report);
        defined.extend(name.zip(line));
    }
    defined
}

/// `[{"kind": "double-bracket", "strength": "alpha"}]`; one with a mistake is left out.
pub fn dissipation(value: Value<'_>, names: &Names, report: &mut Report) -> Vec<driving::Entry> {
    let elements = list(value, "`dissipation`", report).unwrap_or_default();
    let entry = |value| one(value, names, report);
    elements.into_iter().filter_map(entry).collect()
}

fn one(value: Value<'_>, names: &Names, report: &mut Report) -> Option<driving::Entry> {
    let keys = schema::Dissipation::KEYS;
    let object = Object::read(value, "a dissipation", keys, report)?;
    object.require("a dissipation", schema::Dissipation::REQUIRED, report);
    let kind = string(object.get("kind")?, "`kind`", report)?;
    let mut fields = Vec::new();
    for member in object.members() {
        if member.key.text == "kind" {
            continue;
        }
        let name = Name {
            text: member.key.text.to_string(),
            origin: member.key.extent(),
        };
        let what = format!("`{}`", name.text);
        let value = match member.value.kind() {
            Type::Array => vectors::vector(member.value, names, report)?,
            Type::String => {
                let line = line(member.value, &what, report)?;
                if line.tokens.is_empty() {
                    report.push(item::missing_constant(line.place));
                    return None;
                }
                expression::parse_value(&line.tokens, names, report)?
            }
            _ => crate::front::vectors::Value::Scalar(quantity(
                member.value,
                &what,
                Some(names),
                report,
            )?),
        };
        fields.push((name, value));
    }
    Some(driving::Entry {
        kind: Name {
            origin: kind.extent(),
            text: kind.text.into_owned(),
        },
        fields,
    })
}
