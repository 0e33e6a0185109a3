//! The commands that measure many methods on one system: `lie verify`, `lie bench`, `lie stress`.

pub mod bench;
mod evidence;
mod files;
mod growth;
mod list;
mod quiet;
pub mod stress;
mod table;
pub mod verify;

use std::path::PathBuf;
use std::process::Command;

use lie_codegen::diagnostic::Kind;
use lie_codegen::methods::Choice;
use lie_codegen::program::{Purpose, program};

use super::args::{self, Cpu, Measured};
use super::run::bar::Bar;
use super::run::plan;
use crate::build::protocol::{self, Progress, Words};
use crate::build::{self, Request};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, INTERRUPTED, Message};
use crate::render;

/// A system at an initial state with the methods to measure, checked.
pub struct Bed {
    /// The spec.
    pub spec: Spec,
    /// The methods.
    pub choices: Vec<Choice>,
    /// Values of the parameters, in order.
    pub parameters: Vec<f64>,
    /// The initial state.
    pub initial: Vec<f64>,
}

/// How a session with a measuring program ended.
pub enum Ended {
    /// With all measurements.
    Done,
    /// By a signal, with the exit code that it asks for.
    Interrupted(u8),
    /// With a message of the program: its first word and the rest.
    Said(String, String),
}

/// Reads and checks what the commands share.
///
/// # Errors
/// Every mistake.
pub fn bed(flags: &Measured, defaults: impl Fn(&Spec) -> Vec<Choice>) -> Result<Bed, Failure> {
    let spec = compiler::load(&flags.spec)?;
    let as_run = args::Run {
        param: flags.param.clone(),
        initial: flags.initial.clone(),
        ..args::Run::default()
    };
    let mut mistakes = Vec::new();
    let mut keep = |messages: Vec<Message>| mistakes.extend(messages);
    let start = plan::start(&spec, &as_run).map_err(&mut keep).ok();
    let choices = match &flags.methods {
        Some(text) => list::parse(text, &spec.model).map_err(&mut keep).ok(),
        None => Some(defaults(&spec)),
    };
    let (Some((parameters, initial)), Some(choices)) = (start, choices) else {
        return Err(Failure::invalid(mistakes));
    };
    if !flags.quiet {
        render::print(&spec.warnings());
    }
    Ok(Bed {
        spec,
        choices,
        parameters,
        initial,
    })
}

impl Bed {
    /// The built program of these methods.
    ///
    /// # Errors
    /// The surroundings fail.
    pub fn program(
        &self,
        flags: &Measured,
        purpose: Purpose,
        interrupt: &Interrupt,
    ) -> Result<PathBuf, Failure> {
        let request = Request {
            name: &self.spec.model.name,
            source: &program(&self.spec.model, &self.choices, purpose),
            native: flags.cpu == Some(Cpu::Native),
            quiet: flags.quiet,
            purpose,
        };
        build::program(&request, interrupt)
    }

    /// Has a program measure everything; `line` takes the fields of each line of results.
    ///
    /// # Errors
    /// The program cannot be started, or dies.
    pub fn measure(
        &self,
        flags: &Measured,
        program: PathBuf,
        numbers: &[(&str, f64)],
        interrupt: &Interrupt,
        line: &mut dyn FnMut(&[&str]),
    ) -> Result<Ended, Failure> {
        let mut lines = String::new();
        for choice in &self.choices {
            lines.push_str(&format!("method {}\n", choice.label()));
        }
        for (index, value) in self.parameters.iter().enumerate() {
            lines.push_str(&format!("parameter {index} {value:?}\n"));
        }
        lines.push_str("initial");
        for value in &self.initial {
            lines.push_str(&format!(" {value:?}"));
        }
        for (key, value) in numbers {
            lines.push_str(&format!("\n{key} {value:?}"));
        }
        lines.push_str("\nrun\n");
        let bar = Bar::of_stages(!flags.quiet);
        let words = protocol::measure(
            Command::new(&program),
            &lines,
            interrupt,
            &mut |text| line(&text.split('\t').collect::<Vec<_>>()),
            &mut |progress| match progress {
                Progress::Done(done, all) => bar.show(done, all),
                Progress::Stage(done, all, what) => bar.stage(done, all, what),
            },
        );
        bar.clear();
        match words {
            Ok(Words { code: Some(0), .. }) => Ok(Ended::Done),
            Ok(Words {
                code: Some(130), ..
            }) if interrupt.seen().is_some() => {
                Ok(Ended::Interrupted(interrupt.seen().unwrap_or(INTERRUPTED)))
            }
            Ok(Words {
                code: Some(2),
                last,
                ..
            }) => {
                let (word, rest) = last.split_once(' ').unwrap_or((&last, ""));
                if word == "parameter" {
                    let message = Message::new(Kind::Domain, format!("parameter {rest}"));
                    let help = "give it another value with `--param NAME=VALUE`";
                    return Err(message.at_option("--param").help(help).into());
                }
                Ok(Ended::Said(word.to_owned(), rest.to_owned()))
            }
            Ok(words) => {
                let how = format!("{}: {}", words.status, words.last);
                Err(build::broken(&program, &how))
            }
            Err(error) => Err(build::not_started(&program, &error)),
        }
    }
}

/// A signal in words.
pub fn interrupted(flags: &Measured, code: u8) -> u8 {
    if !flags.quiet {
        eprintln!("Interrupted; what was measured so far is shown.");
    }
    code
}
