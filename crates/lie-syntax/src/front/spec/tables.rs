//! The key `functions`.

mod csv;

use std::path::Path;

use super::quantity;
use crate::ast::{Expr, ExprKind};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::item;
use crate::front::json::{Type, Value};
use crate::front::object::{Object, list, string, wrong_type};
use crate::front::schema::TableFunction;
use crate::front::tables::{Outside, Point, Read, Written};
use lie_symbolic::exact::Rational;

/// Reads the tables; files are named relative to the folder.
pub fn read(value: Value<'_>, folder: Option<&Path>, report: &mut Report) -> Vec<Read> {
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, "`functions`", "an object"));
        return Vec::new();
    }
    let mut read = Vec::new();
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let written = table(member.value, folder, report);
        read.extend(name.map(|name| (name, written)));
    }
    read
}

fn table(value: Value<'_>, folder: Option<&Path>, report: &mut Report) -> Option<Written> {
    if value.kind() == Type::String {
        let message = "a function of Rust cannot stand in a spec";
        let help = "give a table, as in `{\"table\": [[0, 0], [1, \"1/2\"]], \"degree\": 1}`, or declare the system with the macro `lie_poisson!`";
        report.push(Diagnostic::new(Kind::Schema, value.origin(), message).help(help));
        return None;
    }
    let object = Object::read(value, "a function", TableFunction::KEYS, report)?;
    object.require("a function", TableFunction::REQUIRED, report);
    let points = points(object.get("table")?, folder, report)?;
    let degree = match object.get("degree") {
        Some(value) => (quantity(value, "`degree`", None, report)?, value.origin()),
        None => (cubic(value.head()), value.head()),
    };
    let outside = match object.get("outside") {
        Some(value) => {
            let word = string(value, "`outside`", report)?;
            Outside::read(&word.text, word.extent(), report)?
        }
        None => Outside::default(),
    };
    Some(Written {
        points,
        degree,
        outside,
    })
}

/// The points as a list, or those of a file.
fn points(value: Value<'_>, folder: Option<&Path>, report: &mut Report) -> Option<Vec<Point>> {
    if value.kind() == Type::String {
        let path = string(value, "`table`", report)?;
        let read = csv::read(&path.text, path.extent(), folder);
        return read.map_err(|mistake| report.push(mistake)).ok();
    }
    let points = list(value, "`table`", report)?;
    let points = points.into_iter().map(|value| point(value, report));
    points.collect()
}

/// The degree where none is given.
fn cubic(origin: Origin) -> Expr {
    Expr {
        kind: ExprKind::Number(Rational::from(3)),
        origin,
    }
}

/// `[x, y]`
fn point(value: Value<'_>, report: &mut Report) -> Option<Point> {
    let elements = list(value, "a point of a table", report)?;
    let [x, y] = elements.as_slice() else {
        report.push(wrong_type(&value, "a point of a table", "a pair `[x, y]`"));
        return None;
    };
    let mut number = |value: &Value<'_>| quantity(*value, "a number of a table", None, report);
    let (x, y) = (number(x), number(y));
    Some((x?, y?, value.origin()))
}
