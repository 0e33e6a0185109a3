//! The commands, one module each.

pub mod args;
mod cache;
mod canonical;
mod check;
mod ensemble;
mod equilibria;
mod events;
mod expand;
mod exponents;
pub mod files;
mod fold;
mod frequencies;
mod measure;
mod methods;
mod new;
mod report;
mod resume;
mod run;
mod schema;
mod shell;
pub mod usage;

use std::io::{self, Write as _};

use args::{Command, Later};
use lie_syntax::diagnostic::Kind;

use crate::message::{Failure, Message};

/// Runs a command.
///
/// # Errors
/// What to print on stderr, and the exit code.
pub fn run(command: &Command) -> Result<u8, Failure> {
    match command {
        Command::Check(arguments) => check::run(arguments),
        Command::Expand(arguments) => expand::run(arguments),
        Command::Run(arguments) => run::run(arguments),
        Command::Resume(arguments) => resume::run(arguments),
        Command::Ensemble(arguments) => ensemble::run(arguments),
        Command::Merge(arguments) => ensemble::merge::run(arguments),
        Command::Bench(arguments) => measure::bench::run(arguments),
        Command::Stress(arguments) => measure::stress::run(arguments),
        Command::Verify(arguments) => measure::verify::run(arguments),
        Command::Equilibria(arguments) => equilibria::run(arguments),
        Command::Exponents(arguments) => exponents::run(arguments),
        Command::Frequencies(arguments) => frequencies::run(arguments),
        Command::Report(arguments) => report::run(arguments),
        Command::Methods(arguments) => methods::run(arguments),
        Command::Schema => schema::run(),
        Command::New(arguments) => new::run(arguments),
        Command::Canonical(arguments) => canonical::run(arguments),
        Command::Cache(arguments) => cache::run(arguments),
        Command::Later(later) => Err(not_built(later)),
    }
}

/// The commands that are built.
pub const BUILT: [&str; 18] = [
    "check",
    "expand",
    "run",
    "resume",
    "ensemble",
    "merge",
    "verify",
    "bench",
    "stress",
    "equilibria",
    "exponents",
    "frequencies",
    "report",
    "methods",
    "schema",
    "new",
    "canonical",
    "cache",
];

fn not_built(later: &Later) -> Failure {
    let name = later.name();
    Message::option(name, format!("`lie {name}` is not built yet"))
        .help(format!(
            "the commands are {}; see `lie --help`",
            BUILT.join(", ")
        ))
        .into()
}

/// Prints to stdout; a reader that has gone away is no mistake.
fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush())
    {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Failure::quiet()),
        Err(error) => {
            let message = Message::new(Kind::Io, format!("writing to stdout failed: {error}"));
            Err(Failure::surroundings(
                message.help("make room, or send the output elsewhere"),
            ))
        }
    }
}
