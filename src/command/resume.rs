//! `lie resume`: goes on with a run from its checkpoint.

use std::path::Path;

use super::args::{Command, Resume};
use super::run::{self, checkpoint, checkpoint::Checkpoint, checkpoint::refused};
use super::usage::{Parsed, parse};
use crate::message::Failure;
use lie_output::is_in;

/// Goes on with a run.
///
/// # Errors
/// `checkpoint` for one that does not fit; else as of `lie run`.
pub fn run(arguments: &Resume) -> Result<u8, Failure> {
    let path = &arguments.checkpoint;
    let checkpoint = checkpoint::read(path)?;
    let path = std::path::absolute(path).unwrap_or_else(|_| path.clone());
    let line = std::iter::once("lie".to_owned()).chain(checkpoint.arguments.iter().cloned());
    let flags = match parse(line.map(Into::into)) {
        Ok(Parsed::Command(cli)) => match cli.command {
            Command::Run(flags) => Some(flags),
            _ => None,
        },
        _ => None,
    };
    let Some(mut flags) = flags else {
        let message = refused(&path, "its command is no `lie run` of this program");
        return Err(message.help("begin the run anew with `lie run`").into());
    };
    go_to(&checkpoint);
    checkpoint::check_inputs(&checkpoint)?;
    if let (Some(out), Some(place)) = (&flags.out, &checkpoint.place)
        && let Some(written) = &place.written
        && let Err(why) = is_in(written, out)
    {
        let message = refused(out, format!("the rows so far are not in this file: {why}"));
        let help = "put it back as the run has left it, or begin the run anew with `lie run`";
        return Err(message.help(help).into());
    }
    flags.checkpoint = Some(path);
    run::go(&flags, Some(checkpoint))
}

/// Paths are those of the folder in which the run began, unless the spec is found from here: of a folder that was moved as a
/// whole, the names still hold.
fn go_to(checkpoint: &Checkpoint) {
    let here = checkpoint.inputs.iter().all(|(path, _)| Path::exists(path));
    if !here {
        // where that is not there either, the first file that is missing says so
        let _ = std::env::set_current_dir(&checkpoint.folder);
    }
}
