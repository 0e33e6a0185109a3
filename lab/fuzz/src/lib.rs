//! What the targets do with an input: an input that panics, hangs or eats memory is a bug, and every mistake has a place and a remedy.

mod asked;
mod compiler;
mod readers;
mod taken_up;

use std::io::Write as _;
use std::path::{Path, PathBuf};

pub use asked::{initial_file, npy, request};
pub use compiler::{declaration, spec};
use lie_syntax::diagnostic::{Diagnostic, Origin};
pub use readers::{messages, read_declaration, read_spec, table};
pub use taken_up::checkpoint;

/// Whether a text was refused with errors at places inside it, and with their remedies.
fn told(diagnostics: &[Diagnostic], text: &str) {
    assert!(
        diagnostics.iter().any(|d| !d.warning),
        "refused without an error"
    );
    for diagnostic in diagnostics {
        remedied(&diagnostic.message, diagnostic.help.as_deref());
        if let Some(Origin::Text { start, end }) = diagnostic.origin {
            assert!(text.get(start..end).is_some(), "{start}..{end}");
        }
    }
}

fn remedied(message: &str, help: Option<&str>) {
    assert!(!message.is_empty(), "an error without words");
    assert!(help.is_some_and(|h| !h.is_empty()), "no remedy: {message}");
}

/// A file with these bytes, of this process alone.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder().join(name);
    let written = std::fs::File::create(&path).and_then(|mut file| file.write_all(bytes));
    written.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    path
}

/// Where such files are.
fn folder() -> &'static Path {
    static FOLDER: std::sync::LazyLock<PathBuf> = std::sync::LazyLock::new(|| {
        let path = std::env::temp_dir().join(format!("lie-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder for files");
        path
    });
    &FOLDER
}

#[cfg(test)]
mod tests;
