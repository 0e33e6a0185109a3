//! The files that a measuring command writes: opened before anything is measured.

use std::path::Path;

use crate::command::files::{Inputs, unwritable};
use crate::command::run::outputs;
use crate::message::Failure;
use lie_output::Destination;

/// Opens the files of `--out` and `--plot`, if they are given.
///
/// # Errors
/// `io`, with exit code 1; `option` if one is an input, or has the name of another form.
pub fn open(
    out: Option<&Path>,
    plot: Option<&Path>,
    inputs: &Inputs,
) -> Result<[Option<Destination>; 2], Failure> {
    outputs::table("--out", out)?;
    outputs::picture("--plot", plot)?;
    inputs.open_both(out, plot)
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
            .map_err(|error| unwritable(path, &error)),
        // what was not written to goes away with its destination
        _ => Ok(()),
    }
}
