//! The keys `forces`, `dissipation`, `noise` and `inputs`.

use super::{line, quantity, vectors};
use crate::ast::{Input, Name};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::entries::Line;
use crate::front::json::{Type, Value};
use crate::front::object::{Object, list, string, wrong_type};
use crate::front::{Names, driving, expression, families, item, schema};

/// `{"m1": "-k*m1"}`: names, each with an expression.
pub fn definitions(value: Value<'_>, key: &str, report: &mut Report) -> Vec<(Name, Line<'static>)> {
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, &format!("`{key}`"), "an object"));
        return Vec::new();
    }
    let mut defined = Vec::new();
    for member in value.members(report) {
        let name = families::target(&member.key.tokens(), member.key.extent(), report);
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

/// `[{"hamiltonian": "sigma*x"}, {"force": {"m1": "s"}}]`
pub fn noise(value: Value<'_>, report: &mut Report) -> Vec<driving::Noisy<'static>> {
    let mut all = Vec::new();
    for value in list(value, "`noise`", report).unwrap_or_default() {
        let place = value.head();
        let Some(object) = Object::read(value, "a noise", schema::Noise::KEYS, report) else {
            continue;
        };
        object.require("a noise", schema::Noise::REQUIRED, report);
        match (object.get("hamiltonian"), object.get("force")) {
            (Some(value), None) => {
                let line = line(value, "`hamiltonian`", report);
                all.extend(line.map(driving::Noisy::Hamiltonian));
            }
            (None, Some(value)) => {
                let lines = definitions(value, "force", report);
                all.push(driving::Noisy::Force(lines, place));
            }
            _ => {
                let message = "a noise has one of `hamiltonian` and `force`";
                let help =
                    "write `{\"hamiltonian\": \"sigma*x\"}` or `{\"force\": {\"m1\": \"s\"}}`";
                report.push(Diagnostic::new(Kind::Schema, place, message).help(help));
            }
        }
    }
    all
}

/// `{"u": {"default": 0, "sampling": 0.1}}`
pub fn inputs(value: Value<'_>, report: &mut Report) -> Vec<Input> {
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, "`inputs`", "an object"));
        return Vec::new();
    }
    let mut all = Vec::new();
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let what = format!("the input `{}`", member.key.text.escape_debug());
        let Some(object) = Object::read(member.value, &what, schema::Input::KEYS, report) else {
            continue;
        };
        object.require(&what, schema::Input::REQUIRED, report);
        let default = object.get("default");
        let default = default.and_then(|v| quantity(v, "`default`", None, report));
        let sampling = object.get("sampling");
        let sampling = sampling.map(|v| quantity(v, "`sampling`", None, report));
        if let (Some(name), Some(default)) = (name, default)
            && sampling.as_ref().is_none_or(Option::is_some)
        {
            all.push(Input {
                name,
                default,
                sampling: sampling.flatten(),
            });
        }
    }
    all
}
