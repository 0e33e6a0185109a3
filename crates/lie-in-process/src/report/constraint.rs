//! A constraint and what it leaves, for programs.

use lie_codegen::structure::Structure;
use serde_json::{Map, Value, json};

/// Adds the equations, the basis of what they leave with the coordinates that belong to it, momenta and velocity in these
/// coordinates, and whether the Jacobi identity holds, null where that was not decided.
pub(super) fn add(model: &Structure, report: &mut Map<String, Value>) {
    let Some(constraint) = &model.constraint else {
        return;
    };
    let basis = constraint.basis_in_words(model).into_iter();
    let basis: Map<String, Value> = basis
        .map(|(coordinate, element)| (coordinate, element.into()))
        .collect();
    let names = constraint.declared.iter().map(|name| name.text.clone());
    let momenta = names.zip(&constraint.momenta);
    let momenta: Map<String, Value> = momenta
        .take(constraint.components.len())
        .map(|(name, value)| (name, model.display(*value).into()))
        .collect();
    let velocity = constraint.components.iter().cloned();
    let velocity: Map<String, Value> = velocity
        .zip(&constraint.velocity)
        .map(|(name, value)| (name, model.display(*value).into()))
        .collect();
    let added = json!({
        "equations": constraint.forms,
        "basis": basis,
        "momenta": momenta,
        "velocity": velocity,
        "almost_poisson": true,
        "jacobi": constraint.jacobi,
    });
    report.insert("constraint".into(), added);
}
