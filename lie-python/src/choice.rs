//! Methods by their labels.

use crate::errors::method_error;
use lie_codegen::methods::{Choice, refusal};
use lie_codegen::model::Model;
use pyo3::prelude::*;

/// The method of a label such as `lie-midpoint --retraction cayley`, if it applies.
pub fn wanted(py: Python<'_>, model: &Model, label: &str) -> PyResult<Choice> {
    let choice = Choice::from_label(label)
        .map_err(|unusable| method_error(py, &unusable.message, &unusable.help))?;
    match refusal(model, &choice) {
        None => Ok(choice),
        Some((reason, remedy)) => {
            let text = format!("`{label}` does not apply to {}: {reason}", model.name);
            Err(method_error(py, &text, &remedy))
        }
    }
}
