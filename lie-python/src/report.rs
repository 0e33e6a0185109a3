//! What `lie check` and `lie methods` say, as JSON.

use crate::declaration::Declaration;
use crate::errors::describe;
use lie_codegen::methods::{CATALOGUE, applicability};
use lie_codegen::structure::Effort;
use lie_codegen::structure::Structure;
use lie_dynamic::Dynamic;
use lie_in_process::catalogue;
use lie_in_process::formula::{Latex, formula, names};
use lie_in_process::report::Report;
use pyo3::prelude::*;
use serde_json::{Value, json};

/// The methods with the reason where one does not apply, and whether it runs in Python.
pub fn methods(model: &Structure) -> String {
    let known = applicability(model);
    let reason = |id: &str| {
        let found = known.iter().find(|(known, _)| *known == id);
        found.and_then(|(_, reason)| reason.clone())
    };
    let supported = Dynamic::supports(&lie_codegen::plan::plan(model, &[]));
    let rows = CATALOGUE.iter().map(|method| {
        let mut row = catalogue::json(method);
        row["keeps"] = catalogue::preserved(method).into();
        row["reason"] = reason(method.id).into();
        row["here"] = supported.into();
        row
    });
    rows.collect::<Value>().to_string()
}

/// The Hamiltonian and the equations of motion by lines; the Hamiltonian alone where they are long.
pub fn equations(model: &Structure) -> Vec<String> {
    let plan = lie_codegen::plan::plan(model, &[]);
    let kernels = plan.system.poisson.iter();
    let explicit: Vec<String> = kernels.flat_map(|kernel| kernel.explicit.clone()).collect();
    match (model.energy.expression(), &model.family) {
        (Some(hamiltonian), None) if explicit.is_empty() => {
            vec![format!("H = {}", model.display(hamiltonian.energy))]
        }
        (_, Some(family)) => vec![format!("H = {}", model.display_of_family(family))],
        _ => explicit,
    }
}

/// Formulas of a system as lines of LaTeX.
pub fn latex(model: &Structure, lines: &[String]) -> String {
    let names = names(model);
    let lines = lines.iter().map(|line| formula(line, &names, &Latex));
    lines.collect::<Vec<_>>().join(r" \\ ")
}

/// The object of `lie check --json`, with the warnings.
pub fn check(py: Python<'_>, declaration: &Declaration, deep: bool) -> PyResult<String> {
    let effort = match deep {
        true => Effort::Deep,
        false => Effort::Report,
    };
    let spec = declaration.spec();
    declaration.with_effort(py, effort, move |model| {
        let mut found = Report::new(model).json(model);
        let warnings = model.warnings.iter();
        let warnings: Vec<String> = warnings
            .map(|warning| describe(&spec.source.text, warning))
            .collect();
        found["warnings"] = json!(warnings);
        found.to_string()
    })
}
