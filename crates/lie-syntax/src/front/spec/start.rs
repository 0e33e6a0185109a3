//! The initial state of a family.

use crate::ast::{Name, Start};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::json::{Type, Value};
use crate::front::object::{Object, string, wrong_type};
use crate::front::schema;

/// Reads `{"random": "unit-sphere", "seed": 1}` or `{"npy": "chain.npy"}`.
pub fn read(value: Value<'_>, report: &mut Report) -> Option<Start> {
    if value.kind() != Type::Object {
        let message = "the initial state of a family is not a list";
        let help = "write `{\"random\": \"unit-sphere\", \"seed\": 1}` or `{\"npy\": \"chain.npy\"}`, or give the values by `--initial`";
        report.push(Diagnostic::new(Kind::Schema, value.head(), message).help(help));
        return None;
    }
    let mut ignored = Report::new();
    let members = value.members(&mut ignored);
    ignored.ignore("the members are read again");
    match members.iter().any(|member| member.key.text == "npy") {
        true => file(value, report),
        false => random(value, report).map(Start::UnitSpheres),
    }
}

fn file(value: Value<'_>, report: &mut Report) -> Option<Start> {
    let object = Object::read(value, "`initial`", schema::Numbers::KEYS, report)?;
    object.require("`initial`", schema::Numbers::REQUIRED, report);
    let path = string(object.get("npy")?, "`npy`", report)?;
    Some(Start::File(Name {
        origin: path.extent(),
        text: path.text.into_owned(),
    }))
}

/// The seed.
fn random(value: Value<'_>, report: &mut Report) -> Option<u64> {
    let object = Object::read(value, "`initial`", schema::Random::KEYS, report)?;
    object.require("`initial`", schema::Random::REQUIRED, report);
    let kind = string(object.get("random")?, "`random`", report)?;
    if kind.text != "unit-sphere" {
        let message = format!("unknown distribution `{}`", kind.text.escape_debug());
        let help = "write `unit-sphere`: a point on it for each site";
        report.push(Diagnostic::new(Kind::Schema, kind.extent(), message).help(help));
    }
    let Some(seed) = object.get("seed") else {
        return Some(1);
    };
    let number = seed.raw().parse().ok();
    if number.is_none() {
        report.push(wrong_type(&seed, "`seed`", "a whole number"));
    }
    number
}
