//! Methods by their labels, and their tolerances.

use crate::errors::method_error;
use lie_codegen::methods::{Choice, refusal};
use lie_codegen::model::Model;
use lie_dynamic::Tolerances;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The relative tolerance of methods by series, unless another is given: that of `lie run`.
const SERIES: f64 = 1e-15;
/// Their tolerance as a part of one for the end of the run.
const PER_STEP: f64 = 0.01;

/// The tolerances of a method: what was given, else its defaults. `overall` is the error wanted at the end.
pub fn tolerances(
    py: Python<'_>,
    choice: &Choice,
    (rtol, atol): (Option<f64>, Option<f64>),
    overall: Option<f64>,
) -> PyResult<Tolerances> {
    if overall.is_some() && *choice == Choice::Dopri5 {
        let text = "dopri5 chooses its own steps, and takes no `tol`";
        let help = "give `rtol` and `atol` with `h`, or take another method";
        return Err(method_error(py, text, help));
    }
    let mut found = Tolerances::default();
    if matches!(choice, Choice::Taylor | Choice::LieTaylor) {
        found.rtol = overall.map_or(SERIES, |overall| (PER_STEP * overall).max(SERIES));
    }
    for (name, given, place) in [
        ("rtol", rtol, &mut found.rtol),
        ("atol", atol, &mut found.atol),
    ] {
        let Some(value) = given else { continue };
        if !choice.options().iter().any(|(option, _)| *option == name) {
            let text = format!("`{name}` is not an option of {}", choice.id());
            return Err(method_error(py, &text, "leave it out, or take dopri5"));
        }
        // what is not a number is not positive either
        if !(value.is_finite() && value > 0.0) {
            return Err(PyValueError::new_err(format!(
                "{name} must be positive, not {value}"
            )));
        }
        *place = value;
    }
    Ok(found)
}

/// The method of a label such as `lie-midpoint --retraction cayley`, if it applies.
pub fn wanted(py: Python<'_>, model: &Model, label: &str) -> PyResult<Choice> {
    let choice = Choice::from_label(label).map_err(|unusable| {
        let help = unusable.help.replace("`lie methods`", "`System.methods()`");
        method_error(py, &unusable.message, &help)
    })?;
    match refusal(model, &choice) {
        None => Ok(choice),
        Some((reason, remedy)) => {
            let text = format!("`{label}` does not apply to {}: {reason}", model.name);
            Err(method_error(py, &text, &remedy))
        }
    }
}
