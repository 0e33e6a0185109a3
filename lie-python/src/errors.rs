//! Mistakes as exceptions of the package.

use lie_in_process::message::{Fault, Message, Place};
use lie_in_process::request::Front;
use lie_syntax::diagnostic::{Diagnostic, Origin};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::io;

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
pub struct Mistakes {
    message: String,
    kind: &'static str,
    place: Option<(usize, usize)>,
}

impl Mistakes {
    pub fn new(text: &str, diagnostics: &[Diagnostic]) -> Self {
        let shown = diagnostics
            .iter()
            .map(|diagnostic| describe(text, diagnostic));
        let first = diagnostics.first();
        Self {
            message: shown.collect::<Vec<_>>().join("\n"),
            kind: first.map_or("syntax", |diagnostic| diagnostic.kind.as_str()),
            place: first.and_then(|diagnostic| place(text, diagnostic)),
        }
    }

    pub fn raise(self, py: Python<'_>) -> PyErr {
        let (line, column) = self.place.unzip();
        raise(
            py,
            "DeclarationError",
            (self.message, self.kind, line, column),
        )
    }
}

/// Line and column in the text.
fn place(text: &str, diagnostic: &Diagnostic) -> Option<(usize, usize)> {
    match diagnostic.origin {
        Some(Origin::Text { start, .. }) => Some(lie_syntax::front::line_column(text, start)),
        _ => None,
    }
}

/// A mistake or a warning with its line and its remedy.
pub fn describe(text: &str, diagnostic: &Diagnostic) -> String {
    let message = format!("{}: {}", diagnostic.kind.as_str(), diagnostic.message);
    let start = match diagnostic.origin {
        Some(Origin::Text { start, .. }) => Some(start),
        _ => None,
    };
    with_place(message, text, start, diagnostic.help.as_deref())
}

/// A message with the line of the declaration in which it is, and with its remedy.
fn with_place(mut message: String, text: &str, start: Option<usize>, help: Option<&str>) -> String {
    if let Some(start) = start {
        let (line, column) = lie_syntax::front::line_column(text, start);
        message.push_str(&format!(" (line {line}, column {column})"));
        if let Some(source) = text.lines().nth(line.saturating_sub(1)) {
            message.push_str(&format!("\n    {}", source.trim()));
        }
    }
    if let Some(help) = help {
        message.push_str(&format!("\n  help: {}", Front::Call.reword(help)));
    }
    message
}

/// All mistakes of what a call asks for; the class is that of the first.
pub fn refused(py: Python<'_>, messages: &[Message]) -> PyErr {
    let said = |message: &Message| {
        let help = message.help.as_deref();
        let text = message.text.clone();
        match &message.place {
            // the method and what is quoted are named by the text
            Place::Argument { name, .. }
                if name != "method" && !text.contains(&format!("`{name}`")) =>
            {
                with_place(format!("{name}: {text}"), "", None, help)
            }
            Place::Text(source, range) => with_place(text, &source.text, Some(range.start), help),
            _ => with_place(text, "", None, help),
        }
    };
    let text = messages.iter().map(said).collect::<Vec<_>>().join("\n");
    match messages.first().map(|message| message.fault) {
        Some(Fault::Method) => raise(py, "MethodError", (text,)),
        Some(Fault::Arguments) => PyTypeError::new_err(text),
        Some(Fault::Memory) => PyMemoryError::new_err(text),
        _ => PyValueError::new_err(text),
    }
}

/// What the system does not give: memory, or something else.
pub fn of_system(error: io::Error) -> PyErr {
    match error.kind() {
        io::ErrorKind::OutOfMemory => {
            let help = "save fewer rows, with every=… or at=[…], or go on from the last row of a shorter run";
            PyMemoryError::new_err(format!("{error}\n  help: {help}"))
        }
        _ => error.into(),
    }
}

/// A method that does not apply.
pub fn method_error(py: Python<'_>, text: &str, help: &str) -> PyErr {
    raise(py, "MethodError", (format!("{text}\n  help: {help}"),))
}
