//! The key `algebra`.

use super::{line, quantity};
use crate::ast::{Algebra, Bracket, Matrix};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::json::{Type, Value};
use crate::front::object::{Object, list, wrong_type};
use crate::front::reader::Entries as _;
use crate::front::schema;
use crate::front::{Names, item};

/// Reads the algebra; values of brackets may use `parameters`.
pub fn read(value: Value<'_>, parameters: &[String], report: &mut Report) -> Option<Algebra> {
    if value.kind() == Type::String {
        report.push(
            Diagnostic::new(
                Kind::Schema,
                value.origin(),
                "named algebras are not built yet",
            )
            .help("write an object with `basis` and `brackets`"),
        );
        return None;
    }
    let object = Object::read(value, "`algebra`", schema::Algebra::KEYS, report)?;
    object.require("`algebra`", schema::Algebra::REQUIRED, report);
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
    Some(Algebra {
        basis,
        brackets,
        matrices,
        origin: value.origin(),
    })
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
        let name = item::name(&member.key.tokens(), member.key.whole(), report);
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
