//! The key `run`: defaults of the command, under the names of its flags.

use super::quantity;
use crate::ast::{Name, RunOption};
use crate::diagnostic::{Origin, Report};
use crate::front::item;
use crate::front::json::{Type, Value};
use crate::front::object::{Object, string, wrong_type};
use crate::front::schema::Run;
use crate::front::text::Source;
use crate::front::token;

/// Reads the options. Constants are checked here and handed on as text, like those of flags.
pub fn read(value: Value<'_>, report: &mut Report) -> Vec<RunOption> {
    let Some(object) = Object::read(value, "`run`", Run::KEYS, report) else {
        return Vec::new();
    };
    object.require("`run`", Run::REQUIRED, report);
    let mut options = Vec::new();
    for member in object.members() {
        let key = &*member.key.text;
        let what = format!("`{key}`");
        let values = match key {
            "step" | "tol" | "from" | "until" | "every" | "rtol" | "atol" | "newton-tolerance"
            | "max-iterations" => constant(member.value, &what, report).into_iter().collect(),
            "at" => times(member.value, &what, report),
            _ => string(member.value, &what, report)
                .map(|s| (s.text.to_string(), s.extent()))
                .into_iter()
                .collect(),
        };
        let name = Name {
            text: key.to_owned(),
            origin: member.key.extent(),
        };
        options.push(RunOption { name, values });
    }
    options
}

fn constant(value: Value<'_>, what: &str, report: &mut Report) -> Option<(String, Origin)> {
    quantity(value, what, None, report)?;
    match value.kind() {
        Type::String => string(value, what, report).map(|s| (s.text.to_string(), s.extent())),
        _ => Some((value.raw().to_owned(), value.origin())),
    }
}

/// A number, a text with commas, or a list of constants.
fn times(value: Value<'_>, what: &str, report: &mut Report) -> Vec<(String, Origin)> {
    match value.kind() {
        Type::Array => {
            let elements = value.elements();
            elements
                .into_iter()
                .filter_map(|v| constant(v, "a time", report))
                .collect()
        }
        Type::Number => constant(value, what, report).into_iter().collect(),
        Type::String => string(value, what, report)
            .map(|s| split(&s, report))
            .unwrap_or_default(),
        _ => {
            report.push(wrong_type(&value, what, "a list of times"));
            Vec::new()
        }
    }
}

fn split(source: &Source<'_>, report: &mut Report) -> Vec<(String, Origin)> {
    let mut times = Vec::new();
    let tokens = source.tokens();
    let parts = token::split_commas(&tokens);
    if parts.is_empty() {
        report.push(item::missing_constant(source.extent()));
    }
    for part in parts {
        let Some(place) = token::span(part) else {
            report.push(item::missing_constant(source.extent()));
            continue;
        };
        if item::constant(part, report).is_some() {
            times.push((token::render_whole(part), place));
        }
    }
    times
}
