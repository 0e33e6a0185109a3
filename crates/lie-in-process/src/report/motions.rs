//! Constants of the motion.

use lie_codegen::structure::Structure;
use lie_codegen::structure::motions::Motions;
use serde_json::{Value, json};

/// The functions in the names of the declaration, with their degrees.
pub fn named(model: &Structure, motions: &Motions) -> Vec<(String, u32)> {
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
pub(super) fn json(model: &Structure) -> Value {
    let Some(Ok(motions)) = &model.motions else {
        return Value::Null;
    };
    let found = named(model, motions);
    let found = found.into_iter();
    found
        .map(|(function, degree)| json!({ "expression": function, "degree": degree }))
        .collect()
}
