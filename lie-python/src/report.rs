//! What `lie check` and `lie methods` say, as JSON.

use crate::declaration::{Declaration, runs};
use crate::errors::shown;
use lie_codegen::check::Effort;
use lie_codegen::methods::{CATALOGUE, Choice, applicability};
use lie_codegen::model::Model;
use lie_in_process::catalogue;
use lie_in_process::report::Report;
use pyo3::prelude::*;
use serde_json::{Value, json};

/// The methods with the reason where one does not apply, and whether it runs in Python.
pub fn methods(model: &Model) -> String {
    let known = applicability(model);
    let reason = |id: &str| {
        let found = known.iter().find(|(known, _)| *known == id);
        found.and_then(|(_, reason)| reason.clone())
    };
    let rows = CATALOGUE.iter().map(|method| {
        let mut row = catalogue::json(method);
        row["keeps"] = catalogue::kept(method).into();
        row["reason"] = reason(method.id).into();
        // a composition runs where its base does
        row["here"] = Choice::from_id(method.id)
            .is_ok_and(|choice| runs(&choice))
            .into();
        row
    });
    rows.collect::<Value>().to_string()
}

/// The object of `lie check --json`, with the warnings.
pub fn check(py: Python<'_>, declaration: &Declaration, deep: bool) -> PyResult<String> {
    let effort = match deep {
        true => Effort::Deep,
        false => Effort::Report,
    };
    declaration.with_effort(py, effort, |model| {
        let mut found = Report::on(&model, effort).json(&model);
        let warnings = model.warnings.iter();
        let warnings: Vec<String> = warnings
            .map(|warning| shown(&declaration.text, warning))
            .collect();
        found["warnings"] = json!(warnings);
        found.to_string()
    })
}
