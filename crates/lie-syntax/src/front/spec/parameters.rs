//! The key `parameters`.

use std::path::Path;

use super::{quantity, sites};
use crate::ast::{Name, Parameter};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::entries::Parameters;
use crate::front::json::{Type, Value};
use crate::front::object::{Object, string, wrong_type};
use crate::front::schema::DescribedParameter;
use crate::front::{item, prose};

/// Reads the parameters. Keys are the user's names here, so a repeated one is a repeated name, which later checks know.
/// Those of a family may have a value for each site, which files may give, relative to a folder.
pub fn read(value: Value<'_>, folder: Option<&Path>, report: &mut Report) -> Parameters {
    let mut parameters = Parameters::default();
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, "`parameters`", "an object"));
        return parameters;
    }
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let what = format!("the parameter `{}`", member.key.text.escape_debug());
        if sites::is_list(member.value) {
            let data = sites::read(member.value, &what, name, folder, report);
            parameters.sites.extend(data);
            continue;
        }
        parameters.names.extend(name.clone());
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
