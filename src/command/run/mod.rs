//! `lie run`: integrates a spec with its generated, compiled code.

pub mod bar;
mod layout;
pub mod outputs;
pub mod plan;
mod reception;
mod summary;
pub mod values;

use std::io::{self, IsTerminal as _};
use std::time::Instant;

use lie_codegen::diagnostic::Kind;
use lie_codegen::program::{Purpose, program};
use lie_program::protocol::{Obstacle, Stop};
use lie_runtime::driver::Pace;

use super::args::{self, Format};
use crate::build::talk::{Outcome, Worker};
use crate::build::{self, Processor, Request};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, STOPPED};
use crate::render;
use bar::Bar;
use outputs::Outputs;
use plan::Plan;
use reception::{Received, Reception};
use summary::Drift;

/// Runs a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(flags: &args::Run) -> Result<u8, Failure> {
    let [path] = flags.specs.as_slice() else {
        let text = format!("{} specs are given, `lie run` takes one", flags.specs.len());
        let help = "run them one after the other; `lie check` takes several";
        return Err(Message::option("SPEC", text).help(help).into());
    };
    Processor::of(flags.cpu.unwrap_or_default(), flags.fma)?;
    let spec = compiler::load(path)?;
    let plan = plan::plan(&spec, flags).map_err(Failure::invalid)?;
    let format = outputs::format(flags, path)?;
    if !flags.quiet {
        render::print(&spec.warnings());
    }
    let outputs = Outputs::open(flags)?;
    let interrupt = Interrupt::install();
    let worker = worker(&spec, &plan, flags, &interrupt)?;
    integrate(&spec, &plan, flags, format, outputs, &worker, &interrupt)
}

/// What runs the method: this program, or one that is built where that is asked for or has to be.
fn worker(
    spec: &Spec,
    plan: &Plan,
    flags: &args::Run,
    interrupt: &Interrupt,
) -> Result<Worker, Failure> {
    let processor = Processor::of(flags.cpu.unwrap_or_default(), flags.fma)?;
    let purpose = plan.chart.map_or(Purpose::Run, Purpose::OnGroup);
    let methods = std::slice::from_ref(&plan.method);
    let compiled = flags.compile || flags.fma || flags.cpu.is_some();
    if !compiled && let Some(worker) = build::here(&spec.model, methods, purpose) {
        return Ok(worker);
    }
    let request = Request {
        name: &spec.model.name,
        source: &program(&spec.model, methods, purpose),
        processor,
        quiet: flags.quiet,
        purpose,
    };
    Ok(Worker::Program(build::program(&request, interrupt)?))
}

fn integrate(
    spec: &Spec,
    plan: &Plan,
    flags: &args::Run,
    format: Format,
    outputs: Outputs,
    worker: &Worker,
    interrupt: &Interrupt,
) -> Result<u8, Failure> {
    let lost = |error: io::Error| match (error.kind(), &flags.out) {
        (io::ErrorKind::BrokenPipe, None) => Failure::quiet(),
        (_, out) => outputs::writing_failed(out.as_deref(), &error),
    };
    let draws = outputs.plot.is_some();
    let mut reception = Reception::start(spec, plan, format, outputs.rows, draws).map_err(lost)?;
    let request = request(plan, &reception);
    // Rows that scroll by on the same terminal say enough.
    let scrolls = flags.out.is_none() && io::stdout().is_terminal();
    let bar = Bar::new(!flags.quiet && !scrolls);
    let clock = Instant::now();
    let outcome = worker.talk(
        &request,
        interrupt,
        &mut |found, rest| reception.take(found, rest),
        &mut |progress| bar.show(progress.done, progress.all),
    );
    bar.clear();
    let outcome = match outcome {
        Ok(Outcome::NotTaken(error)) if error.kind() == io::ErrorKind::InvalidData => {
            Outcome::Broken(error.to_string())
        }
        Ok(Outcome::NotTaken(error)) => return Err(lost(error)),
        Ok(outcome) => outcome,
        Err(error) => {
            reception.finish("failed").map_err(lost)?;
            return Err(worker.not_started(&error));
        }
    };
    let mut received = reception.finish(word(&outcome)).map_err(lost)?;
    let plot = received.plot.take().zip(outputs.plot);
    if let Some(((plot, destination), path)) = plot.zip(flags.plot.as_ref()) {
        destination
            .replace(plot.to_svg().as_bytes())
            .map_err(|error| outputs::unwritable(path, &error))?;
    }
    if !flags.quiet && matches!(outcome, Outcome::Done) {
        say_of_tolerance(plan, &received);
        let title = title(spec, plan, received.step);
        let adaptive = plan.method.is_adaptive();
        let (work, drift) = (&received.work, &received.drift);
        let text = summary::text(&title, work, adaptive, drift, clock.elapsed());
        eprint!("{text}");
    }
    let by_tolerance = matches!(plan.pace.0, Pace::Tolerance(_));
    match outcome {
        Outcome::Refused(Obstacle::Option, why) if by_tolerance => {
            let help = "give a step by `--step`, or another tolerance";
            Err(Message::option("--tol", why).help(help).into())
        }
        outcome => ended(outcome, &received.drift, flags.quiet, worker),
    }
}

/// What the built program is asked for.
fn request(plan: &Plan, reception: &Reception) -> lie_program::protocol::Run {
    lie_program::protocol::Run {
        method: plan.method.label(),
        start: plan.start.clone(),
        pace: plan.pace.0,
        times: reception.times(plan),
        tolerances: plan.tolerances,
        newton: plan.newton,
    }
}

fn title(spec: &Spec, plan: &Plan, step: f64) -> String {
    let (name, method) = (&spec.model.name, plan.method.title());
    let written = plan.pace.1.trim();
    match plan.pace.0 {
        Pace::Step(_) => format!("{name}, {method}, step {written}"),
        Pace::Tolerance(_) => format!("{name}, {method}, tolerance {written}, step {step:.4e}"),
    }
}

/// Why the method is the one it is, and what the tolerance may miss.
fn say_of_tolerance(plan: &Plan, received: &Received) {
    if plan.picked {
        eprintln!(
            "{} was picked: it applies to every system, has order 16, and keeps quadratic Casimirs and a quadratic energy to \
             round-off; --method chooses another",
            plan.method.id()
        );
    }
    if received.at_round_off {
        eprintln!("the round-off of this many steps may exceed the tolerance");
    }
    if let Some((parts, time)) = received.divided {
        eprintln!(
            "from t = {time:.6} on each step was made in {parts} parts: the motion is faster there than at the start"
        );
    }
    match received.assessed {
        Some((error, true)) if error.is_nan() => {
            eprintln!(
                "warning: the error at the end is not known: telling it takes too many steps, or failed"
            );
        }
        Some((error, true)) => eprintln!(
            "warning: the error at the end is about {error:.1e} of the state, more than the tolerance: errors grow on this orbit, \
             or the method cannot keep it"
        ),
        _ => {}
    }
}

/// Says how the run ended; answers the exit code.
fn ended(outcome: Outcome, drift: &Drift, quiet: bool, worker: &Worker) -> Result<u8, Failure> {
    match outcome {
        Outcome::Done => Ok(0),
        Outcome::Interrupted(code) => {
            if !quiet {
                let time = drift.time();
                eprintln!("Interrupted at t = {time:?}; the rows so far are written.");
            }
            Ok(code)
        }
        Outcome::Stopped(stop) => {
            render::stopped(&stopped_text(&stop), &stop.remedy);
            Ok(STOPPED)
        }
        Outcome::Parameter(name, why) => Err(impossible(&name, &why)),
        Outcome::Refused(what, why) => Err(worker.broken(&format!("{what:?}: {why}"))),
        Outcome::Broken(how) => Err(worker.broken(&how)),
        Outcome::NotTaken(error) => Err(worker.broken(&error.to_string())),
    }
}

/// A parameter with a value of which no system can be made.
pub fn impossible(name: &str, why: &str) -> Failure {
    let message = Message::new(Kind::Domain, format!("parameter {name}: {why}"));
    let help = format!("give {name} another value with `--param {name}=VALUE`");
    message.at_option("--param").help(help).into()
}

/// How the run ended, for the output.
fn word(outcome: &Outcome) -> &'static str {
    match outcome {
        Outcome::Done => "done",
        Outcome::Interrupted(_) => "interrupted",
        Outcome::Stopped(_) => "stopped",
        Outcome::Parameter(..)
        | Outcome::Refused(..)
        | Outcome::Broken(_)
        | Outcome::NotTaken(_) => "failed",
    }
}

fn stopped_text(stop: &Stop) -> String {
    format!(
        "the integration stopped in step {} at t = {:?}: {} ({} iterations, residual {:?})\nthe rows so far are written",
        stop.step, stop.time, stop.reason, stop.iterations, stop.residual
    )
}
