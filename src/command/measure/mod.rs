//! The commands that measure many methods on one system: `lie verify`, `lie bench`, `lie stress`.

pub mod bench;
mod files;
mod list;
mod quiet;
mod sense;
pub mod stress;
pub mod verify;

use lie_codegen::methods::Choice;
use lie_codegen::model::Driving;
use lie_codegen::program::{Purpose, program};
use lie_in_process::Question;
use lie_in_process::families::Limit;
use lie_in_process::request::{self, Point};
use lie_program::protocol::{Obstacle, Wire};
use lie_syntax::diagnostic::Kind;
use serde::Serialize;

use super::args::Measured;
use super::fold::folded;
use super::run::bar::Bar;
use super::run::impossible;
use super::run::layout::Layout;
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

/// Warns where noise acts, which no reference solution has.
fn noiseless(spec: &Spec) {
    if spec.model.driving.as_ref().is_some_and(Driving::is_noisy) {
        let text = "warning: the noise is left out: a path has no solution that others are compared with. What is measured is the motion without \
                    it, which says nothing of methods on noise; `lie verify` measures their orders";
        render::say(&folded(text));
    }
}

/// Reads and checks what the commands share.
///
/// # Errors
/// Every mistake.
pub fn bed(
    flags: &Measured,
    purpose: Purpose,
    defaults: impl Fn(&Spec) -> Vec<Choice>,
) -> Result<Bed, Failure> {
    let spec = compiler::load(&flags.spec)?;
    let mut mistakes = Vec::new();
    let mut keep = |messages: Vec<Message>| mistakes.extend(messages);
    let start = request::start(&spec, &flags.start())
        .map_err(&mut keep)
        .ok();
    let choices = match flags.methods.is_empty() {
        true => Some(defaults(&spec)),
        false => {
            let parsed = list::parse(&flags.methods.join(","), &spec.model);
            parsed.map_err(&mut keep).ok()
        }
    };
    let (Some(point), Some(choices)) = (start, choices) else {
        return Err(Failure::invalid(mistakes));
    };
    if spec.model.family.is_some() {
        measurable(flags, purpose, &spec, &point)?;
    }
    if !flags.quiet {
        render::print(&spec.warnings());
        if purpose != Purpose::Verify {
            noiseless(&spec);
        }
    }
    Ok(Bed {
        spec,
        choices,
        point,
    })
}

/// Refuses a family of more coordinates than are measured, and one to be measured by a built program where none is made.
fn measurable(
    flags: &Measured,
    purpose: Purpose,
    spec: &Spec,
    point: &Point,
) -> Result<(), Failure> {
    if flags.is_compiled() && purpose != Purpose::Verify {
        let text = format!(
            "{} is a family, which this command measures by machine code of its own alone",
            spec.model.name
        );
        let help = "leave out `--compile`, `--cpu` and `--fma`; `lie run` times a built program";
        let message = Message::option("--compile", text);
        return Err(message.help(help).into());
    }
    let limit = Limit::for_purpose(purpose);
    let exceeded = limit.and_then(|limit| limit.exceeded(&spec.model, point.initial.len()));
    let Some((text, help)) = exceeded else {
        return Ok(());
    };
    let help = format!("{help}, as with `--param N=4`: the kernels of a site are the same");
    Err(Message::new(Kind::Limit, text)
        .at_option("--param")
        .help(help)
        .into())
}

impl Bed {
    /// The columns of a run; of a family those of all sites.
    pub fn layout(&self) -> Layout {
        let model = &self.spec.model;
        let names = model.parameters.iter().map(|p| p.name.clone());
        let parameters = names.zip(self.point.parameters.iter().copied()).collect();
        Layout::new(model, None, &parameters)
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
        if !flags.is_compiled()
            && let Some(worker) = build::in_process_worker(&self.spec.model, &self.choices, purpose)
        {
            return Ok(worker);
        }
        let request = Request {
            name: &self.spec.model.name,
            source: &program(&self.spec.model, &self.choices, purpose),
            processor: Processor::from_options(flags.cpu.unwrap_or_default(), flags.fma)?,
            quiet: flags.quiet,
            purpose,
        };
        Ok(Worker::Program(build::program(&request, interrupt)?))
    }

    /// Has a program measure everything; `found` takes what it finds, and answers what is worth a line while the rest is
    /// measured. A terminal shows it.
    ///
    /// # Errors
    /// The program cannot be started, or dies.
    pub fn measure<O: Serialize, R: Wire>(
        &self,
        flags: &Measured,
        worker: &Worker,
        options: O,
        interrupt: &Interrupt,
        found: &mut dyn FnMut(R) -> Option<String>,
    ) -> Result<Ended, Failure>
    where
        lie_measure::Request<O>: Question<Found = R>,
    {
        let request = lie_measure::Request {
            methods: self.choices.iter().map(Choice::label).collect(),
            start: self.point.clone().named(&self.spec),
            options,
        };
        let bar = Bar::for_stages(!flags.quiet);
        let outcome = worker.talk(
            request,
            interrupt,
            &mut |what| {
                if let Some(line) = found(what) {
                    bar.say(&line);
                }
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
        render::say("Interrupted; what was measured so far is shown.");
    }
    code
}
