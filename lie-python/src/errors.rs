//! Mistakes as exceptions of the package.

use lie_codegen::diagnostic::{Diagnostic, Origin};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// An exception of the package by its name.
fn raise(py: Python<'_>, name: &str, arguments: impl for<'a> pyo3::call::PyCallArgs<'a>) -> PyErr {
    let made = py
        .import("liepoisson._errors")
        .and_then(|module| module.getattr(name))
        .and_then(|class| class.call1(arguments));
    match made {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => PyRuntimeError::new_err(error.to_string()),
    }
}

/// All mistakes of a declaration; kind and place are those of the first.
pub fn declaration(py: Python<'_>, text: &str, diagnostics: &[Diagnostic]) -> PyErr {
    let place = |diagnostic: &Diagnostic| match diagnostic.origin {
        Some(Origin::Text { start, .. }) => Some(lie_codegen::front::line_column(text, start)),
        _ => None,
    };
    let shown = diagnostics.iter().map(|diagnostic| {
        let mut message = format!("{}: {}", diagnostic.kind.as_str(), diagnostic.message);
        if let Some((line, column)) = place(diagnostic) {
            message.push_str(&format!(" (line {line}, column {column})"));
            if let Some(source) = text.lines().nth(line.saturating_sub(1)) {
                message.push_str(&format!("\n    {}", source.trim()));
            }
        }
        if let Some(help) = &diagnostic.help {
            message.push_str(&format!("\n  help: {help}"));
        }
        message
    });
    let message = shown.collect::<Vec<_>>().join("\n");
    let first = diagnostics.first();
    let kind = first.map_or("syntax", |diagnostic| diagnostic.kind.as_str());
    let (line, column) = first.and_then(place).unzip();
    raise(py, "DeclarationError", (message, kind, line, column))
}

/// A method that does not apply.
pub fn method_error(py: Python<'_>, text: &str, help: &str) -> PyErr {
    raise(py, "MethodError", (format!("{text}\n  help: {help}"),))
}
