//! Constants of the motion.

use lie_codegen::check::motions::Motions;
use lie_codegen::model::Model;
use serde_json::{Value, json};

/// The functions in the names of the declaration, with their degrees.
pub fn named(model: &Model, motions: &Motions) -> Vec<(String, u32)> {
    let name = |v: usize| match v.checked_sub(model.dimension()) {
        Some(parameter) => model.parameters[parameter].name.clone(),
        None => model.coordinates[v].text.clone(),
    };
    let found = motions.found.iter();
    found
        .map(|motion| (motion.function.display(&name), motion.degree))
        .collect()
}

/// The constants for programs; null where none were looked for.
pub(super) fn json(model: &Model, motions: &Result<Motions, &'static str>) -> Value {
    let Ok(motions) = motions else {
        return Value::Null;
    };
    let found = named(model, motions);
    let found = found.into_iter();
    found
        .map(|(function, degree)| json!({ "expression": function, "degree": degree }))
        .collect()
}
