//! The key `realization`.

use super::quantity;
use crate::ast::Realization;
use crate::diagnostic::Report;
use crate::front::entries::{Entries as _, Line};
use crate::front::json::Value;
use crate::front::object::Object;
use crate::front::schema;
use crate::front::{Names, item};

/// Reads a realization; its map may use `parameters`.
pub fn read(value: Value<'_>, parameters: &[String], report: &mut Report) -> Option<Realization> {
    let keys = schema::Realization::KEYS;
    let object = Object::read(value, "`realization`", keys, report)?;
    object.require("`realization`", schema::Realization::REQUIRED, report);
    let [positions, momenta] = ["positions", "momenta"].map(|key| object.names(key, report));
    let own = positions.iter().chain(&momenta).map(|n| n.text.clone());
    let known: Names = own.chain(parameters.iter().cloned()).collect();
    let map = object.lines("map", report);
    let component = |line: &Line<'_>| {
        let (name, value) = item::definition(&line.tokens, "a component", line.place, report)?;
        let example = ("its value", "q*p");
        let value = item::formula(value, example, line.place, &known, report)?;
        Some((name, value))
    };
    let map = map.iter().filter_map(component).collect();
    let parameters: Names = parameters.iter().cloned().collect();
    let start = object.get("start").map(|_| {
        let elements = object.elements("start", report);
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
