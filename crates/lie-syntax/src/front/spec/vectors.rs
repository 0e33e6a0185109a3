//! The key `vectors`.

use super::quantity;
use crate::ast::Expr;
use crate::diagnostic::Report;
use crate::front::json::{Type, Value};
use crate::front::object::{list, wrong_type};
use crate::front::vectors::{self, Declared};
use crate::front::{Names, item};

/// Reads vectors and matrices, whose entries may use `names`. One with a mistake is left out.
pub fn read(value: Value<'_>, names: &Names, report: &mut Report) -> Vec<Declared> {
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, "`vectors`", "an object"));
        return Vec::new();
    }
    let mut declared = Vec::new();
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let value = vector(member.value, names, report);
        let both = name.zip(value);
        declared.extend(both.map(|(name, value)| Declared { name, value }));
    }
    declared
}

/// A list of entries, or of rows.
pub fn vector(value: Value<'_>, names: &Names, report: &mut Report) -> Option<vectors::Value> {
    let elements = list(value, "a vector or a matrix", report)?;
    if elements.first().is_none_or(|e| e.kind() != Type::Array) {
        let what = "an entry of a vector";
        return Some(vectors::Value::Vector(entries(
            elements, what, names, report,
        )?));
    }
    let rows = elements.into_iter().map(|row| {
        let row = list(row, "a row of a matrix", report)?;
        entries(row, "an entry of a matrix", names, report)
    });
    Some(vectors::Value::Matrix(rows.collect::<Option<_>>()?))
}

fn entries(
    values: Vec<Value<'_>>,
    what: &str,
    names: &Names,
    report: &mut Report,
) -> Option<Vec<Expr>> {
    let values = values.into_iter();
    let entry = |value| quantity(value, what, Some(names), report);
    values.map(entry).collect()
}
