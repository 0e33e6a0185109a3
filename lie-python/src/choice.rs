//! Methods by their labels, their tolerances and their solvers.

use crate::errors::method_error;
use lie_codegen::methods::{Choice, refusal};
use lie_codegen::model::Model;
use lie_dynamic::Tolerances;
use lie_runtime::newton::{Convergence, NewtonOptions};
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

/// What a call says of the solver of implicit methods.
#[derive(FromPyObject)]
pub struct Solver {
    #[pyo3(item)]
    iteration: Option<String>,
    #[pyo3(item)]
    newton_tolerance: Option<f64>,
    #[pyo3(item)]
    max_iterations: Option<u32>,
    #[pyo3(item)]
    converge: Option<String>,
}

impl Solver {
    /// The options of a method.
    pub fn options(
        &self,
        py: Python<'_>,
        choice: &Choice,
        by_tolerance: bool,
    ) -> PyResult<NewtonOptions> {
        let entry = choice.solved().entry();
        let explicit = entry.is_some_and(|method| method.explicit);
        let together = entry.is_some_and(|method| method.fixed_point);
        for (name, given) in [
            ("iteration", self.iteration.is_some()),
            ("newton_tolerance", self.newton_tolerance.is_some()),
            ("max_iterations", self.max_iterations.is_some()),
            ("converge", self.converge.is_some()),
        ] {
            if given && explicit {
                let text = format!(
                    "`{name}` is an option of implicit methods, and {} is explicit",
                    choice.id()
                );
                return Err(method_error(
                    py,
                    &text,
                    "leave it out, or take an implicit method such as \"midpoint\"",
                ));
            }
        }
        let mut options = match self.iteration.as_deref() {
            None | Some("automatic") => NewtonOptions::default(),
            Some("newton") => NewtonOptions::newton(),
            Some("simplified") => NewtonOptions::simplified(),
            Some("fixed-point") => NewtonOptions::fixed_point(),
            Some(other) => {
                return Err(PyValueError::new_err(format!(
                    "no iteration `{other}`: there are \"automatic\", \"newton\", \"simplified\" and \"fixed-point\""
                )));
            }
        };
        if let Some(tolerance) = self.newton_tolerance {
            if tolerance.is_nan() || tolerance < 0.0 {
                return Err(PyValueError::new_err(format!(
                    "newton_tolerance must not be negative, and is {tolerance}"
                )));
            }
            options.tolerance = tolerance;
        }
        if let Some(count) = self.max_iterations {
            if count == 0 {
                return Err(PyValueError::new_err(
                    "max_iterations must be 1, 2, 3, …, not 0",
                ));
            }
            options.max_iterations = count;
        }
        let Some(converge) = &self.converge else {
            return Ok(options);
        };
        if !together {
            let text = format!(
                "`converge` is an option of methods that evaluate their stages together, and {} does not",
                choice.id()
            );
            return Err(method_error(
                py,
                &text,
                "leave it out, or take a method such as \"gauss16\"",
            ));
        }
        options.convergence = match converge.as_str() {
            "state" => Convergence::State,
            "map" => Convergence::Map,
            "tolerance" if by_tolerance => Convergence::Tolerance,
            "tolerance" => {
                return Err(PyValueError::new_err(
                    "converge=\"tolerance\" needs a tolerance: give tol in place of h, or converge=\"state\"",
                ));
            }
            other => {
                return Err(PyValueError::new_err(format!(
                    "`{other}` is nothing that converges: there are \"state\", \"map\" and \"tolerance\""
                )));
            }
        };
        Ok(options)
    }
}

/// Why there is no such method for a system, and what helps.
pub struct Refused {
    text: String,
    help: String,
}

impl Refused {
    pub fn raise(self, py: Python<'_>) -> PyErr {
        method_error(py, &self.text, &self.help)
    }
}

/// The method of a label such as `lie-midpoint --retraction cayley`, if it applies.
pub fn wanted(model: &Model, label: &str) -> Result<Choice, Refused> {
    let choice = Choice::from_label(label).map_err(|unusable| Refused {
        text: unusable.message.clone(),
        help: unusable
            .help
            .replace("`lie methods`", "`System.methods()`")
            .replace("are flags of `lie run`", "are arguments of run"),
    })?;
    match refusal(model, &choice) {
        None => Ok(choice),
        Some((reason, help)) => Err(Refused {
            text: format!("`{label}` does not apply to {}: {reason}", model.name),
            help,
        }),
    }
}

/// A method that only the command has.
pub fn unsupported(py: Python<'_>, label: &str) -> PyErr {
    let text = format!("`{label}` does not run in Python yet");
    method_error(
        py,
        &text,
        "`lie run` has it; or take another method, see System.methods()",
    )
}
