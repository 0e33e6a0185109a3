//! The key `realization`.

use super::{Line, lines, name_list, quantity};
use crate::ast::Realization;
use crate::diagnostic::Report;
use crate::front::json::Value;
use crate::front::object::{Object, list};
use crate::front::schema;
use crate::front::{Names, item};

/// Reads a realization; its map may use `parameters`.
pub fn read(value: Value<'_>, parameters: &[String], report: &mut Report) -> Option<Realization> {
    let keys = schema::Realization::KEYS;
    let object = Object::read(value, "`realization`", keys, report)?;
    object.require("`realization`", schema::Realization::REQUIRED, report);
    let mut names = |key| {
        let what = format!("`{key}`");
        object
            .get(key)
            .map(|v| name_list(v, &what, report))
            .unwrap_or_default()
    };
    let (positions, momenta) = (names("positions"), names("momenta"));
    let own = positions.iter().chain(&momenta).map(|n| n.text.clone());
    let known: Names = own.chain(parameters.iter().cloned()).collect();
    let map = lines(&object, "map", report);
    let component = |line: &Line| {
        let (name, value) = item::definition(&line.tokens, "a component", line.place, report)?;
        let example = ("its value", "q*p");
        let value = item::formula(value, example, line.place, &known, report)?;
        Some((name, value))
    };
    let map = map.iter().filter_map(component).collect();
    let parameters: Names = parameters.iter().cloned().collect();
    let start = object.get("start").map(|v| {
        let elements = list(v, "`start`", report).unwrap_or_default();
        let what = "an entry of `start`";
        let entry = |v| quantity(v, what, Some(&parameters), report);
        elements.into_iter().filter_map(entry).collect()
    });
    Some(Realization {
        positions,
        momenta,
        map,
        start,
        origin: value.head(),
    })
}
