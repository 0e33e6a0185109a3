//! The compiler as the commands use it: files in, checked models and generated text out.

use std::path::Path;
use std::sync::Arc;

use lie_codegen::structure::Effort;
pub use lie_in_process::spec::Spec;
use lie_syntax::diagnostic::Kind;
use lie_syntax::front::file;

use crate::command::files::Inputs;
use crate::message::{Failure, Message, Source};

/// Reads and checks a spec.
///
/// # Errors
/// `io` if the file cannot be read (exit 1), else every mistake in it (exit 2); `option` where standard output goes to it.
pub fn load(path: &Path) -> Result<Spec, Failure> {
    load_with(path, Effort::Declaration)
}

/// The same with as much work on what is searched for as is said.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: &Path, effort: Effort) -> Result<Spec, Failure> {
    let source = Arc::new(read(path)?);
    let folder = path.parent();
    match lie_codegen::compile::compile_spec_in(&source.text, folder, effort) {
        Ok(model) => {
            let spec = Spec::new(source, model);
            Inputs::of_spec(path, &spec).spare_from_stdout()?;
            Ok(spec)
        }
        Err(diagnostics) => {
            let all = diagnostics.into_iter();
            Err(Failure::invalid(
                all.map(|one| Message::from_spec(&source, one)).collect(),
            ))
        }
    }
}

/// What to do about a path at which there is no file.
fn remedy(path: &Path) -> String {
    if path.as_os_str() == "-" {
        return "a spec is a file; that of standard input is `/dev/stdin`".to_owned();
    }
    let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
    let specs = entries.map(|entry| entry.path());
    let first = specs
        .filter(|path| path.extension().is_some_and(|end| end == "json"))
        .min();
    match first {
        Some(first) => format!("give a file in this folder, such as {}", first.display()),
        None => "give the path of a JSON file, such as specs/se3_heavy_top.json".to_owned(),
    }
}

fn read(path: &Path) -> Result<Source, Failure> {
    let name = path.display().to_string();
    let bytes = file::read(path).map_err(|error| {
        let message = Message::io(path, format!("the spec cannot be read: {error}"));
        Failure::surroundings(message.help(remedy(path)))
    })?;
    if let Some(oversized) = file::oversized(bytes.len()) {
        let source = Arc::new(Source {
            path: name,
            text: String::new(),
        });
        return Err(Message::from_spec(&source, oversized).into());
    }
    // Editors of some systems put a mark in front, which is no part of the text.
    let bytes = bytes
        .strip_prefix(b"\xef\xbb\xbf")
        .map_or(bytes.as_slice(), |rest| rest)
        .to_vec();
    String::from_utf8(bytes)
        .map(|text| Source { path: name, text })
        .map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            let before = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
            let source = Arc::new(Source {
                path: path.display().to_string(),
                text: before,
            });
            let message = Message::new(Kind::Schema, "the file is not UTF-8 from here on");
            message
                .at_place(crate::message::Place::Text(source, at..at))
                .help("save it as UTF-8")
                .into()
        })
}
