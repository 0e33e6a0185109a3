//! The files that a measuring command writes: opened before anything is measured.

use std::io;
use std::path::Path;

use crate::message::{Failure, Message};
use crate::output::Destination;

/// Opens the file of a flag, if it is given.
///
/// # Errors
/// `io`, with exit code 1; `option` if it is the spec.
pub fn open(flag: &str, path: Option<&Path>, spec: &Path) -> Result<Option<Destination>, Failure> {
    let Some(path) = path else { return Ok(None) };
    if flag == "--plot" {
        crate::command::run::outputs::picture(flag, Some(path))?;
    }
    if flag == "--out" {
        crate::command::run::outputs::table(flag, path)?;
    }
    let same = |a: &Path, b: &Path| {
        a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
    };
    if same(path, spec) {
        let message = Message::option(flag, "this is the spec, which would be overwritten");
        return Err(message.help("give another file").into());
    }
    match Destination::file(path) {
        Ok(destination) => Ok(Some(destination)),
        Err(error) => Err(failed(path, &error)),
    }
}

/// Writes all of a file, or takes it away again if there is nothing to write.
///
/// # Errors
/// `io`, with exit code 1.
pub fn write(
    destination: Option<Destination>,
    path: Option<&Path>,
    text: Option<String>,
) -> Result<(), Failure> {
    match (destination, path, text) {
        (Some(destination), Some(path), Some(text)) => destination
            .replace(text.as_bytes())
            .map_err(|error| failed(path, &error)),
        // what was not written to goes away with its destination
        _ => Ok(()),
    }
}

fn failed(path: &Path, error: &io::Error) -> Failure {
    let message = Message::io(path, format!("cannot be written: {error}"));
    Failure::surroundings(message.help("give a file in a folder that exists and can be written"))
}
