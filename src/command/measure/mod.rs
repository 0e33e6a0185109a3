//! The commands that measure many methods on one system: `lie verify`, `lie bench`, `lie stress`.

pub mod bench;
mod files;
mod list;
mod quiet;
mod sense;
pub mod stress;
pub mod verify;

use lie_codegen::diagnostic::Kind;
use lie_codegen::methods::Choice;
use lie_codegen::program::{Purpose, program};
use lie_in_process::families;
use lie_program::protocol::Obstacle;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::args::{self, Measured};
use super::run::bar::Bar;
use super::run::impossible;
use super::run::plan::{self, Point};
use crate::build::talk::{Outcome, Worker};
use crate::build::{self, Processor, Request};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};
use crate::render;

/// A system at an initial state with the methods to measure, checked.
pub struct Bed {
    /// The spec.
    pub spec: Spec,
    /// The methods.
    pub choices: Vec<Choice>,
    /// Where it starts.
    pub point: Point,
}

/// How a session with a measuring program ended.
pub enum Ended {
    /// With all measurements.
    Done,
    /// By a signal, with the exit code that it asks for.
    Interrupted(u8),
    /// With a refusal: what stands against it, and why.
    Refused(Obstacle, String),
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
    let (Some(point), Some(choices)) = (start, choices) else {
        return Err(Failure::invalid(mistakes));
    };
    if spec.model.family.is_some() {
        small(&spec, &point)?;
    }
    if !flags.quiet {
        render::print(&spec.warnings());
    }
    Ok(Bed {
        spec,
        choices,
        point,
    })
}

/// Refuses a family of more coordinates than matrices of all of them are computed for.
fn small(spec: &Spec, point: &Point) -> Result<(), Failure> {
    let Some((text, help)) = families::too_many(&spec.model, point.initial.len()) else {
        return Ok(());
    };
    let help = format!("{help}, as with `--param N=4`: the kernels of a site are the same");
    Err(Message::new(Kind::Limit, text)
        .at_option("--param")
        .help(help)
        .into())
}

impl Bed {
    /// Refuses a family.
    ///
    /// # Errors
    /// It is one.
    pub fn is_no_family(&self, command: &str) -> Result<(), Failure> {
        let model = &self.spec.model;
        if model.family.is_none() {
            return Ok(());
        }
        let text = families::not_measured(model, command);
        let help = "`lie verify` measures a small one; `lie run` says how much energy and Casimirs drift and how long a step takes";
        Err(Message::option("SPEC", text).help(help).into())
    }

    /// What measures these methods: this program, or one that is built.
    ///
    /// # Errors
    /// The surroundings fail.
    pub fn program(
        &self,
        flags: &Measured,
        purpose: Purpose,
        interrupt: &Interrupt,
    ) -> Result<Worker, Failure> {
        let compiled = flags.compile || flags.fma || flags.cpu.is_some();
        if !compiled && let Some(worker) = build::here(&self.spec.model, &self.choices, purpose) {
            return Ok(worker);
        }
        let request = Request {
            name: &self.spec.model.name,
            source: &program(&self.spec.model, &self.choices, purpose),
            processor: Processor::of(flags.cpu.unwrap_or_default(), flags.fma)?,
            quiet: flags.quiet,
            purpose,
        };
        Ok(Worker::Program(build::program(&request, interrupt)?))
    }

    /// Has a program measure everything; `found` takes what it finds.
    ///
    /// # Errors
    /// The program cannot be started, or dies.
    pub fn measure<O: Serialize, R: DeserializeOwned>(
        &self,
        flags: &Measured,
        worker: &Worker,
        options: O,
        interrupt: &Interrupt,
        found: &mut dyn FnMut(R),
    ) -> Result<Ended, Failure> {
        let request = lie_measure::Request {
            methods: self.choices.iter().map(Choice::label).collect(),
            start: self.point.clone().named(&self.spec),
            options,
        };
        let bar = Bar::of_stages(!flags.quiet);
        let outcome = worker.talk(
            &request,
            interrupt,
            &mut |what, _| {
                found(what);
                Ok(())
            },
            &mut |progress| match &progress.stage {
                None => bar.show(progress.done, progress.all),
                Some(what) => bar.stage(progress.done, progress.all, what),
            },
        );
        bar.clear();
        match outcome.map_err(|error| worker.not_started(&error))? {
            Outcome::Done => Ok(Ended::Done),
            Outcome::Interrupted(code) => Ok(Ended::Interrupted(code)),
            Outcome::Parameter(name, why) => Err(impossible(&name, &why)),
            Outcome::Refused(what, why) => Ok(Ended::Refused(what, why)),
            Outcome::Broken(how) => Err(worker.broken(&how)),
            Outcome::Stopped(stop) => Err(worker.broken(&stop.reason)),
            Outcome::NotTaken(error) => Err(worker.broken(&error.to_string())),
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
