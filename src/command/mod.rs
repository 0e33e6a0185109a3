//! The commands, one module each.

pub mod args;
pub mod usage;

use args::{Command, Later};

use crate::message::{Failure, Message};

/// Runs a command.
///
/// # Errors
/// What to print on stderr, and the exit code.
pub fn run(command: Command) -> Result<u8, Failure> {
    match command {
        Command::Later(later) => Err(not_built(&later)),
        _ => Ok(0),
    }
}

fn not_built(later: &Later) -> Failure {
    let name = later.name();
    Message::option(name, format!("`lie {name}` is not built yet"))
        .help("the commands are check, expand, run, methods, schema; see `lie --help`")
        .into()
}
