//! The key `algebra`.

use super::{line, quantity};
use crate::ast::{Algebra, Bracket, Matrix};
use crate::diagnostic::{Kind, Report};
use crate::front::entries::{Entries as _, Read};
use crate::front::json::{Type, Value};
use crate::front::named::{self, Changes};
use crate::front::object::{Object, list, wrong_type};
use crate::front::schema;
use crate::front::{Names, families, item};

/// Reads the algebra; values of brackets may use `parameters`.
pub fn read(value: Value<'_>, parameters: &[String], report: &mut Report) -> Option<Read> {
    if value.kind() == Type::String {
        let line = line(value, "`algebra`", report)?;
        let named = named::parse(&line.tokens, line.place, report)?;
        return Some(named::standard(&named, line.place));
    }
    if value.kind() != Type::Object {
        let help = "write a name such as \"so(3)\", or an object with `basis` and `brackets`";
        report.push(wrong_type(&value, "`algebra`", "a name or an object").help(help));
        return None;
    }
    let object = Object::read(value, "`algebra`", schema::Algebra::KEYS, report)?;
    if let Some(name) = object.get("named") {
        return by_name(value, name, &object, parameters, report);
    }
    object.require("`algebra`", schema::Algebra::REQUIRED, report);
    object.require("`algebra`", &["basis"], report);
    for key in ["action", "central"] {
        if let Some(value) = object.get(key) {
            report.push(named::without_name(Kind::Schema, key, value.origin()));
        }
    }
    let basis = object.names("basis", report);
    let names: Names = basis
        .iter()
        .map(|n| n.text.clone())
        .chain(parameters.iter().cloned())
        .collect();
    let brackets = object.get("brackets");
    let brackets = brackets.map(|_| brackets_of(&object, &names, report));
    let parameters: Names = parameters.iter().cloned().collect();
    let matrices = object
        .get("matrices")
        .map(|v| matrices(v, &parameters, report))
        .unwrap_or_default();
    let algebra = Algebra {
        basis,
        brackets,
        matrices,
        origin: value.origin(),
    };
    Some(Read {
        algebra,
        state: None,
        sizes: Vec::new(),
    })
}

/// The algebra of a site of a family, by its name, and the number of copies.
pub fn family_algebra(value: Value<'_>, report: &mut Report) -> Option<Read> {
    let line = line(value, "the algebra of a family", report)?;
    families::algebra(&line.tokens, line.place, report)
}

/// Whether the algebra is one by its name.
pub fn is_named(value: Value<'_>) -> bool {
    let mut report = Report::new();
    let named = value.kind() == Type::String
        || value.kind() == Type::Object
            && value
                .members(&mut report)
                .iter()
                .any(|member| member.key.text == "named");
    report.ignore("the members are read again");
    named
}

/// An algebra by its name, with what is changed.
fn by_name(
    value: Value<'_>,
    name: Value<'_>,
    object: &Object<'_>,
    parameters: &[String],
    report: &mut Report,
) -> Option<Read> {
    let line = line(name, "`named`", report)?;
    let named = named::parse(&line.tokens, line.place, report);
    let basis = object.get("basis").map(|_| object.lines("basis", report));
    let central = object.names("central", report);
    let brackets = object.lines("brackets", report);
    let parameters: Names = parameters.iter().cloned().collect();
    let matrices = object.get("matrices");
    let matrices = matrices.map(|value| self::matrices(value, &parameters, report));
    let action = object.get("action");
    let action = action.map(|value| self::matrices(value, &parameters, report));
    let changes = Changes {
        action,
        basis,
        central,
        brackets,
        matrices,
        origin: value.origin(),
    };
    changes.apply(named?, report)
}

fn brackets_of(object: &Object<'_>, names: &Names, report: &mut Report) -> Vec<Bracket> {
    let elements = object.elements("brackets", report);
    let bracket = |value| {
        let line = line(value, "a bracket", report)?;
        item::bracket(&line.tokens, line.place, names, report)
    };
    elements.into_iter().filter_map(bracket).collect()
}

fn matrices(value: Value<'_>, names: &Names, report: &mut Report) -> Vec<Matrix> {
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, "`matrices`", "an object"));
        return Vec::new();
    }
    let mut matrices = Vec::new();
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let rows = list(member.value, "a matrix", report).unwrap_or_default();
        let rows = rows.into_iter().map(|row| {
            let entries = list(row, "a row of a matrix", report).unwrap_or_default();
            entries
                .into_iter()
                .filter_map(|v| quantity(v, "an entry of a matrix", Some(names), report))
                .collect()
        });
        let rows = rows.collect();
        matrices.extend(name.map(|name| Matrix {
            name,
            rows,
            origin: member.value.origin(),
        }));
    }
    matrices
}
