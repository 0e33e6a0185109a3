//! `lie run`: integrates a spec with its generated, compiled code.

mod plan;
mod summary;
mod values;

use std::io::{self, IsTerminal as _};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use indicatif::{HumanCount, ProgressBar, ProgressState, ProgressStyle};
use lie_codegen::compile;
use lie_codegen::diagnostic::Kind;
use lie_poisson::plot::Plot;

use super::args::{self, Cpu, Format};
use super::method;
use crate::build::protocol::{self, End, Job, Stop, Times};
use crate::build::{self, Request};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, INTERRUPTED, Message, STOPPED, SURROUNDINGS};
use crate::output::{Destination, Header, Rows};
use crate::render;
use plan::Plan;
use summary::Drift;

/// A run of this length shows how far it is.
const LONG: Duration = Duration::from_millis(700);

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
    let spec = compiler::load(path)?;
    let plan = plan::plan(&spec, flags).map_err(Failure::invalid)?;
    let format = format(flags, path)?;
    if !flags.quiet {
        render::print(&spec.warnings());
    }
    let outputs = Outputs::open(flags)?;
    let interrupt = Interrupt::install();
    let request = Request {
        name: &spec.model.name,
        source: &compile::program(&spec.model, &[plan.method]),
        native: flags.cpu == Some(Cpu::Native),
        quiet: flags.quiet,
    };
    match build::program(&request) {
        Ok(program) => integrate(&spec, &plan, flags, format, outputs, &program, &interrupt),
        Err(failure) => {
            outputs.discard();
            Err(failure)
        }
    }
}

/// The form of the output, and whether the files make sense.
fn format(flags: &args::Run, spec: &Path) -> Result<Format, Failure> {
    let same = |a: &Path, b: &Path| {
        a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
    };
    for (flag, path) in [("--out", &flags.out), ("--plot", &flags.plot)] {
        if path.as_deref().is_some_and(|path| same(path, spec)) {
            let message = Message::option(flag, "this is the spec, which would be overwritten");
            return Err(message.help("give another file").into());
        }
    }
    if let (Some(out), Some(plot)) = (&flags.out, &flags.plot)
        && same(out, plot)
    {
        let message = Message::option("--plot", "rows and picture cannot go to the same file");
        return Err(message.help("give another file").into());
    }
    let by_name = |path: &Path| match path.extension()?.to_str()? {
        "json" => Some(Format::Json),
        "npy" => Some(Format::Npy),
        _ => None,
    };
    let format = flags
        .format
        .or_else(|| by_name(flags.out.as_deref()?))
        .unwrap_or(Format::Csv);
    if format == Format::Npy && flags.out.is_none() && io::stdout().is_terminal() {
        let message = Message::option(
            "--format",
            "npy is binary and does not belong on a terminal",
        );
        return Err(message
            .help("add `--out FILE.npy`, or redirect the output")
            .into());
    }
    Ok(format)
}

/// Opened before anything runs, so that a long run does not end in front of a closed door.
struct Outputs {
    rows: Destination,
    plot: Option<Destination>,
}

impl Outputs {
    fn open(flags: &args::Run) -> Result<Self, Failure> {
        let open = |path: &Path| Destination::file(path).map_err(|error| unwritable(path, &error));
        let rows = match &flags.out {
            Some(path) => open(path)?,
            None => Destination::stdout(),
        };
        match flags.plot.as_deref().map(open).transpose() {
            Ok(plot) => Ok(Self { rows, plot }),
            Err(failure) => {
                rows.discard();
                Err(failure)
            }
        }
    }

    fn discard(self) {
        self.rows.discard();
        if let Some(plot) = self.plot {
            plot.discard();
        }
    }
}

fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let message = Message::io(path, format!("cannot be written: {error}"));
    Failure::surroundings(message.help("give a file in a folder that exists and can be written"))
}

fn integrate(
    spec: &Spec,
    plan: &Plan,
    flags: &args::Run,
    format: Format,
    outputs: Outputs,
    program: &Path,
    interrupt: &Interrupt,
) -> Result<u8, Failure> {
    let model = &spec.model;
    let states = model.coordinates.iter().map(|name| name.text.clone());
    let casimirs = model.casimirs.iter().map(|casimir| casimir.name.clone());
    let columns: Vec<String> = std::iter::once("t".to_owned())
        .chain(states)
        .chain(["energy".to_owned()])
        .chain(casimirs)
        .collect();
    let width = columns.len();
    let header = Header {
        system: model.name.clone(),
        method: plan.method.id().to_owned(),
        step: plan.step.0,
        columns: columns.clone(),
    };
    // Errors are taken against the initial state, also where it is not asked for.
    let mut times = plan.times.clone();
    let mut hidden = 0;
    if let Times::At(times) = &mut times
        && times.first() != Some(&0.0)
    {
        times.insert(0, 0.0);
        hidden = width;
    }
    let job = Job {
        method: plan.method.label(),
        step: plan.step.0,
        times,
        parameters: plan.parameters.clone(),
        initial: plan.initial.clone(),
        tolerances: plan.tolerances.clone(),
    };

    let lost = |error: io::Error| match (error.kind(), &flags.out) {
        (io::ErrorKind::BrokenPipe, None) => Failure::quiet(),
        (_, Some(path)) => writing_failed(path, &error),
        (_, None) => writing_failed(Path::new("stdout"), &error),
    };
    let mut rows = Rows::start(outputs.rows, format, &header).map_err(lost)?;
    let mut plot = outputs.plot.as_ref().map(|_| {
        let subtitle = format!("{}, h = {}", method::title(plan.method), plan.step.1.trim());
        Plot::new(&*model.name, &columns, model.dimension(), (0.0, plan.end())).subtitle(subtitle)
    });
    let mut drift = Drift::new(&columns[model.dimension() + 1..]);
    // Rows that scroll by on the same terminal say enough.
    let scrolls = flags.out.is_none() && io::stdout().is_terminal();
    let bar = Bar::new(!flags.quiet && !scrolls);
    let start = Instant::now();
    let mut refused = None;
    let end = protocol::run(
        Command::new(program),
        &job,
        width,
        interrupt,
        &mut |numbers| {
            for row in numbers.chunks_exact(width) {
                drift.push(row);
                if let Some(plot) = &mut plot {
                    plot.push(row);
                }
            }
            let shown = &numbers[hidden.min(numbers.len())..];
            hidden = hidden.saturating_sub(numbers.len());
            rows.push(shown).map_err(|error| {
                let kind = error.kind();
                refused = Some(error);
                kind.into()
            })
        },
        &mut |done, all| bar.show(done, all),
    );
    bar.clear();
    if let Some(error) = refused {
        return Err(lost(error));
    }
    let end = end.map_err(|error| broken(&format!("{}: {error}", program.display())))?;
    rows.finish(word(&end)).map_err(lost)?;
    if let (Some(plot), Some(destination), Some(path)) = (plot, outputs.plot, &flags.plot) {
        destination
            .replace(plot.to_svg().as_bytes())
            .map_err(|e| writing_failed(path, &e))?;
    }
    if !flags.quiet
        && let End::Done(counts) = &end
    {
        let title = format!(
            "{}, {}, step {}",
            model.name,
            method::title(plan.method),
            plan.step.1.trim()
        );
        eprint!("{}", summary::text(&title, counts, &drift, start.elapsed()));
    }
    Ok(match end {
        End::Done(_) => 0,
        End::Interrupted => {
            if !flags.quiet {
                eprintln!(
                    "Interrupted at t = {:?}; the rows so far are written.",
                    drift.time()
                );
            }
            INTERRUPTED
        }
        End::Stopped(stop) => {
            render::stopped(&stopped_text(&stop), &stop.remedy);
            STOPPED
        }
        End::Parameter(name, why) => {
            let message = Message::new(Kind::Domain, format!("parameter {name}: {why}"));
            let help = format!("give {name} another value with `--param {name}=VALUE`");
            return Err(message.at_option("--param").help(help).into());
        }
        End::Broken(how) => return Err(broken(&how)),
    })
}

/// How the run ended, for the output.
fn word(end: &End) -> &'static str {
    match end {
        End::Done(_) => "done",
        End::Interrupted => "interrupted",
        End::Stopped(_) => "stopped",
        End::Parameter(..) | End::Broken(_) => "failed",
    }
}

fn stopped_text(stop: &Stop) -> String {
    let mut text = format!(
        "the integration stopped in step {} at t = {}: {}",
        stop.step, stop.time, stop.reason
    );
    if !stop.iterations.is_empty() {
        text.push_str(&format!(
            " ({} iterations, residual {})",
            stop.iterations, stop.residual
        ));
    }
    text.push_str("\nthe rows so far are written");
    text
}

fn writing_failed(path: &Path, error: &io::Error) -> Failure {
    let message = Message::io(path, format!("writing failed: {error}"));
    Failure::surroundings(
        message.help("make room or give another file; whole rows so far are kept"),
    )
}

fn broken(how: &str) -> Failure {
    let message = Message::new(Kind::Toolchain, format!("the built program failed: {how}"));
    Failure {
        messages: vec![
            message.help("delete the cache folder and try again; if it stays, report it"),
        ],
        code: SURROUNDINGS,
    }
}

/// Shows on a terminal how far a long run is.
struct Bar {
    bar: ProgressBar,
    start: Instant,
}

impl Bar {
    fn new(wanted: bool) -> Self {
        let bar = if wanted && io::stderr().is_terminal() {
            ProgressBar::new(0)
        } else {
            ProgressBar::hidden()
        };
        let template = "{bar:40} {percent}% of {len} steps, {rate} per second, {eta} left";
        let style = ProgressStyle::with_template(template)
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .with_key(
                "rate",
                |state: &ProgressState, out: &mut dyn std::fmt::Write| {
                    // Nobody needs its last digits; a bar that cannot be written is not drawn.
                    let _ = write!(out, "{}", HumanCount(state.per_sec() as u64));
                },
            );
        bar.set_style(style);
        Self {
            bar,
            start: Instant::now(),
        }
    }

    fn show(&self, done: u64, all: u64) {
        if self.start.elapsed() > LONG {
            self.bar.set_length(all);
            self.bar.set_position(done);
        }
    }

    fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
