//! The key `parameters`.

use super::quantity;
use crate::ast::{Name, Parameter};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::json::{Type, Value};
use crate::front::object::{Object, string, wrong_type};
use crate::front::reader::Parameters;
use crate::front::schema::DescribedParameter;
use crate::front::{item, prose};

/// Reads the parameters. Keys are the user's names here, so a repeated one is a repeated name, which later checks know.
pub fn read(value: Value<'_>, report: &mut Report) -> Parameters {
    let mut parameters = Parameters::default();
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, "`parameters`", "an object"));
        return parameters;
    }
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let what = format!("the parameter `{}`", member.key.text.escape_debug());
        parameters.names.extend(name.clone());
        if let Some(list) = list(member.value) {
            let message = format!("{what} is one number, not a list");
            report.push(Diagnostic::new(Kind::Schema, list.head(), message).help(LIST));
            continue;
        }
        let parameter = if member.value.kind() == Type::Object {
            described(member.value, &what, name, report)
        } else {
            let default = quantity(member.value, &what, None, report);
            name.zip(default).map(|(name, default)| Parameter {
                name,
                default,
                exact: false,
                positive: false,
                unit: None,
                description: None,
            })
        };
        parameters.whole.extend(parameter);
    }
    parameters
}

/// What to do in place of a list of values.
const LIST: &str = "declare a parameter for each entry, such as `B1`, `B2`, `B3`; those of a family are the same at all sites: \
                    for a few sites write the copies out, `\"algebra\": \"so(3)^3\"` without an index in the state, so that the \
                    coordinates are x1, y1, z1, x2, …";

/// The list that somebody gives as the value of a parameter, alone or in an object.
fn list(value: Value<'_>) -> Option<Value<'_>> {
    let mut ignored = Report::new();
    let inner = match value.kind() {
        Type::Object => value.members(&mut ignored).into_iter().find_map(|member| {
            let key = &*member.key.text;
            ["values", "value", "default"]
                .contains(&key)
                .then_some(member.value)
        }),
        _ => Some(value),
    };
    ignored.ignore("the object is read again");
    inner.filter(|value| value.kind() == Type::Array)
}

fn described(
    value: Value<'_>,
    what: &str,
    name: Option<Name>,
    report: &mut Report,
) -> Option<Parameter> {
    let object = Object::read(value, what, DescribedParameter::KEYS, report)?;
    let (default, value) = (object.get("default"), object.get("value"));
    if let (Some(_), Some(value)) = (default, value) {
        let message = format!("{what} has both `default` and `value`, which mean the same");
        report.push(
            Diagnostic::new(Kind::Schema, value.origin(), message).help("remove one of the two"),
        );
    }
    let needed = match value {
        Some(_) => DescribedParameter::REQUIRED,
        None => &["default"],
    };
    object.require(what, needed, report);
    let mut text = |key: &str, place: &str| string(object.get(key)?, place, report);
    let (unit, description) = (text("unit", "`unit`"), text("description", "`description`"));
    let unit = unit.map(|text| prose::inline(&text, "the unit", report));
    let description = description.map(|text| prose::paragraph(&text, "the description", report));
    let mut flag = |key: &str| {
        object.get(key).is_some_and(|v| {
            if v.boolean().is_none() {
                report.push(wrong_type(&v, &format!("`{key}`"), "a boolean"));
            }
            v.boolean() == Some(true)
        })
    };
    let (exact, positive) = (flag("exact"), flag("positive"));
    let default = quantity(
        default.or(value)?,
        &format!("the default of {what}"),
        None,
        report,
    )?;
    Some(Parameter {
        name: name?,
        default,
        exact,
        positive,
        unit,
        description,
    })
}
