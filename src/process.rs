//! The process of the `lie` command.

use std::io::Write as _;
use std::process::ExitCode;

use crate::command::usage::Parsed;
use crate::message::INVALID;
use crate::{command, message, render};

/// Deeply nested specs are refused by the compiler; what it accepts fits in this stack.
const STACK: usize = 256 << 20;

/// Runs the command that the arguments of this process say.
pub fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|panic| {
        let place = panic
            .location()
            .map(ToString::to_string)
            .unwrap_or_default();
        let _ = writeln!(
            std::io::stderr(),
            "error: a bug of lie, at {place}: {panic}"
        );
        let _ = writeln!(
            std::io::stderr(),
            "help: please report it with the spec and the command line"
        );
    }));
    let thread = std::thread::Builder::new()
        .stack_size(STACK)
        .spawn(real_main);
    match thread.map(std::thread::JoinHandle::join) {
        Ok(Ok(code)) => ExitCode::from(code),
        Err(error) => {
            render::say(&format!("error: there is no memory for a thread: {error}"));
            ExitCode::from(message::SURROUNDINGS)
        }
        // The panic hook has said what happened.
        Ok(Err(_)) => ExitCode::from(message::SURROUNDINGS),
    }
}

fn real_main() -> u8 {
    let cli = match command::usage::parse(std::env::args_os()) {
        Ok(Parsed::Command(cli)) => cli,
        Ok(Parsed::Text(text)) => {
            // A reader that has gone away does not want the help.
            let _ = std::io::stdout().write_all(text.as_bytes());
            return 0;
        }
        Err(message) => {
            render::print(&[*message]);
            return INVALID;
        }
    };
    match command::run(&cli.command) {
        Ok(code) => code,
        Err(failure) => {
            render::print(&failure.messages);
            failure.code
        }
    }
}
