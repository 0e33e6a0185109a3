//! The user's Rust toolchain: which compiler it is, and how cargo is called.

use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use lie_syntax::diagnostic::Kind;

use super::processor::Processor;
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};

/// Settings of the caller's environment that must not change what is built, where, or with what.
const FOREIGN: &[&str] = &[
    "RUSTFLAGS",
    "CARGO_TARGET_DIR",
    "CARGO_INCREMENTAL",
    "CARGO_NET_OFFLINE",
];

/// The same, for everything that begins like this.
const FOREIGN_PREFIXES: &[&str] = &[
    "CARGO_BUILD_",
    "CARGO_PROFILE_",
    "CARGO_TERM_",
    "CARGO_UNSTABLE_",
];

/// What is set in their place. The flags silence every other source of flags; an empty wrapper silences one of the
/// user's configuration too, and the messages are read.
const OURS: &[(&str, &str)] = &[
    ("RUSTC_WRAPPER", ""),
    ("RUSTC_WORKSPACE_WRAPPER", ""),
    ("CARGO_TERM_COLOR", "never"),
];

/// Whether a variable would change what is built. How many jobs may run changes nothing.
fn is_foreign(name: &str) -> bool {
    let begins = |prefix: &&str| name.starts_with(*prefix);
    name != "CARGO_BUILD_JOBS" && (FOREIGN.contains(&name) || FOREIGN_PREFIXES.iter().any(begins))
}

/// A compiler and the processor that it compiles for.
pub struct Toolchain {
    /// `rustc -vV`, and for the native processor the features that it has.
    pub identity: String,
    /// The target triple of this machine.
    pub host: String,
    processor: Processor,
}

fn program(variable: &str, default: &str) -> OsString {
    std::env::var_os(variable)
        .filter(|value| !value.is_empty())
        .unwrap_or_else(|| default.into())
}

/// cargo's name or path as it is called: `$CARGO`, else `cargo`.
pub fn cargo_name() -> OsString {
    program("CARGO", "cargo")
}

impl Toolchain {
    /// Asks the compiler who it is; `folder` is where cargo will run.
    ///
    /// # Errors
    /// `toolchain` if there is no compiler that answers, `option` if the processor cannot do what is asked.
    pub fn find(folder: &Path, processor: Processor) -> Result<Self, Failure> {
        let ask = |arguments: &[&str]| -> Result<String, Failure> {
            let mut command = Command::new(program("RUSTC", "rustc"));
            command
                .args(arguments)
                .current_dir(folder)
                .stdin(Stdio::null());
            match command.output() {
                Ok(output) if output.status.success() => {
                    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
                }
                Ok(output) => Err(missing(&String::from_utf8_lossy(&output.stderr))),
                Err(error) => Err(missing(&format!("rustc cannot be started: {error}"))),
            }
        };
        let mut identity = ask(&["-vV"])?;
        let host = identity
            .lines()
            .find_map(|line| line.strip_prefix("host: "));
        let host = host.unwrap_or_default().trim().to_owned();
        if processor.is_of_this_machine() {
            // A cache that several machines share must not serve one with another's instructions.
            let features = ask(&["--print", "cfg", "-C", "target-cpu=native"])?;
            processor.check(&features)?;
            identity.push_str(&features);
        }
        Ok(Self {
            identity,
            host,
            processor,
        })
    }

    /// `cargo build --release --locked` of the package in `folder`.
    ///
    /// # Errors
    /// cargo could not be started.
    pub fn build(
        &self,
        folder: &Path,
        target: &Path,
        offline: bool,
        interrupt: &Interrupt,
    ) -> io::Result<Output> {
        let mut command = Command::new(cargo_name());
        command.args(["build", "--release", "--locked", "--message-format"]);
        command.arg("json-render-diagnostics");
        // The explicit target keeps the flags away from build scripts and proc-macros, and a
        // target in the user's configuration from producing something that cannot run here.
        command.arg("--target").arg(&self.host);
        command.arg("--target-dir").arg(target);
        if offline {
            command.arg("--offline");
        }
        for (name, _) in std::env::vars_os() {
            if is_foreign(&name.to_string_lossy()) {
                command.env_remove(name);
            }
        }
        command.envs(OURS.iter().copied());
        command.env("CARGO_ENCODED_RUSTFLAGS", self.processor.flags());
        interrupt.build(command.current_dir(folder))
    }
}

fn missing(reason: &str) -> Failure {
    let reason = reason.trim();
    let message = Message::new(Kind::Toolchain, format!("no Rust toolchain: {reason}"));
    Failure::surroundings(message.help(
        "`lie run` compiles the system with cargo: install Rust from https://rustup.rs, or set CARGO and RUSTC",
    ))
}
