//! `lie ensemble`: many trajectories of one spec, as an array.

mod beside;
mod copying;
mod gathering;
mod lost;
pub mod merge;
mod record;
mod reductions;
mod shard;
mod stops;
mod table;

use std::path::Path;
use std::sync::Arc;
use std::thread::available_parallelism;
use std::time::Instant;

use lie_codegen::program::Purpose;
use lie_in_process::Work;
use lie_in_process::clock;
use lie_in_process::ensemble::Ensemble;
use lie_in_process::memory::Exceeded;
use lie_in_process::message::Fault;
use lie_in_process::report::signs;
use lie_in_process::request::{Asked, Drawing, cast, seed};
use lie_in_process::share::{Record, Share};
use lie_in_process::words::counted;
use lie_program::protocol::{Obstacle, Start};
use lie_syntax::diagnostic::Kind;

use super::args::{self, Reduce};
use super::events::{self, Columns};
use super::files::Inputs;
use super::fold::folded;
use super::run::bar::Bar;
use super::run::outputs::writing_failed;
use super::run::said::of_projection;
use crate::build::talk::{Outcome, fault, talk_here};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, STOPPED, keep_refused, step_refused};
use crate::render;
use beside::Beside;
use gathering::{Gathering, Taking};
use record::record;
use table::Table;

/// So many of the members that ended early are named.
const NAMED: usize = 3;

/// Runs an ensemble.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(flags: &args::Ensemble) -> Result<u8, Failure> {
    let spec = compiler::load(&flags.spec)?;
    let share = shard::of(flags.shard.as_deref())?;
    check(flags)?;
    let asked = asked(&spec, flags)?;
    let quantiles = reductions::quantiles(flags)?;
    let bins = reductions::bins(flags)?;
    if !flags.quiet {
        render::print(&spec.warnings());
        if let Some(note) = note(&spec, &asked) {
            eprintln!("{}", folded(&format!("note: {note}")));
        }
    }
    let (mut record, places) = record(&spec, flags, &asked, share, quantiles)?;
    let inputs = Inputs::of_request(&flags.spec, &spec, &flags.request);
    let table = table(&spec, flags, &inputs)?;
    let beside = Beside::open(&flags.out, &inputs, &record)?;
    let interrupt = Interrupt::install();
    let methods = std::slice::from_ref(&asked.plan.method);
    let work = Work::new(&spec.model, methods, Purpose::Run, clock::processor);
    let work = Arc::new(work.ok_or_else(|| not_here(&spec))?);
    if flags.reduce.contains(&Reduce::Histogram) {
        record.histogram = Some(reductions::bins_of(&work, &asked.cast, bins));
    }
    let (title, kept) = (title(&spec, &asked), of_projection(&spec, &asked.plan));
    let threads = flags.threads.or_else(|| available_parallelism().ok());
    let ensemble = Ensemble {
        ends: !record.rows,
        some: share.members(record.members),
        threads: threads.map_or(1, Into::into),
        events: table.is_some(),
        plan: asked.plan,
        cast: asked.cast,
    };
    let (clock, some) = (Instant::now(), ensemble.some.clone());
    let bar = Bar::for_members(!flags.quiet);
    let taking = Taking {
        places,
        stops: stopping(&spec),
        table,
    };
    let mut gathering = Gathering::begin(beside, record, taking)?;
    let talked = talk_here(
        &work,
        ensemble,
        &interrupt,
        &mut |found| gathering.take(found?),
        &mut |progress| bar.show(progress.done, progress.all),
    );
    bar.clear();
    let outcome = talked.map_err(|error| Failure::surroundings(fault(&error.to_string())))?;
    let lost = |error| writing_failed(Some(&flags.out), &error);
    match outcome {
        Outcome::Done => {}
        Outcome::Interrupted(code) => {
            let kept = gathering.abandon().map_err(lost)?;
            if !flags.quiet {
                let all = counted(some.len() as u64, "member");
                render::say(&format!("Interrupted: {kept} of {all} are written."));
            }
            return Ok(code);
        }
        Outcome::NotTaken(error) => return Err(not_taken(&flags.out, error)),
        Outcome::Refused(Obstacle::Option, why) => {
            return Err(step_refused(why).into());
        }
        Outcome::Refused(Obstacle::Keep, why) => {
            return Err(keep_refused(why).into());
        }
        other => return Err(Failure::surroundings(fault(&format!("{other:?}")))),
    }
    let record = gathering.end(&flags.out)?;
    if !flags.quiet {
        let count = counted(record.share.members(record.members).len() as u64, "member");
        let of = match record.share {
            Share::WHOLE => String::new(),
            Share { number, of } => format!(", share {number} of {of}"),
        };
        if let Some(kept) = kept {
            render::say(&folded(&kept));
        }
        let time = clock.elapsed().as_secs_f64();
        render::say(&folded(&format!("{title}: {count}{of}, in {time:.2} s")));
        for line in stops::said(&record) {
            render::say(&folded(&line));
        }
    }
    Ok(failed(&record))
}

/// Says which members ended early; answers the exit code.
fn failed(record: &Record) -> u8 {
    let failures = &record.failures;
    let Some(first) = failures.first() else {
        return 0;
    };
    let lines = failures.iter().take(NAMED).map(|failed| {
        let lie_in_process::share::Failed { member, time, why } = failed;
        format!("\nmember {member}, at t = {time:?}: {why}")
    });
    let lines: String = lines.collect();
    let more = match failures.len() - failures.len().min(NAMED) {
        0 => String::new(),
        more => format!("\nand {more} more"),
    };
    let text = format!(
        "{} ended early, and what they did not reach is not a number{lines}{more}",
        counted(failures.len() as u64, "member")
    );
    let help = format!(
        "take a smaller step, or look at member {} alone by `lie run`",
        first.member
    );
    render::stopped(&folded(&text), &help);
    STOPPED
}

/// What an ensemble does not take.
fn check(flags: &args::Ensemble) -> Result<(), Failure> {
    let mut mistakes = Vec::new();
    if flags
        .out
        .extension()
        .is_none_or(|end| !end.eq_ignore_ascii_case("npy"))
    {
        let text = format!(
            "members are written as an array of NumPy, and `{}` is no name of one",
            flags.out.display()
        );
        let name = flags.out.with_extension("npy");
        mistakes.push(Message::option("--out", text).help(format!("write `{}`", name.display())));
    }
    if flags.request.group.is_some() {
        let text = "of the group element of members nothing is kept";
        let help = "leave it out, or follow the members one by one with `lie run`";
        mistakes.push(Message::option("--group", text).help(help));
    }
    if flags.request.assess {
        let text = "the errors of members are not assessed";
        let help = "leave it out, or run some members by `lie run --assess`";
        mistakes.push(Message::option("--assess", text).help(help));
    }
    if flags.quantiles.is_some() && !flags.reduce.contains(&Reduce::Quantiles) {
        let message = Message::option("--quantiles", "no quantiles are computed");
        mistakes.push(message.help("ask for them by `--reduce quantiles`"));
    }
    if flags.bins.is_some() && !flags.reduce.contains(&Reduce::Histogram) {
        let message = Message::option("--bins", "no histogram is computed");
        mistakes.push(message.help("ask for it by `--reduce histogram`"));
    }
    if let Some(path) = &flags.events
        && flags.shard.is_some()
        && path.parent() != flags.out.parent()
    {
        let text = "the table of a share stands beside its members, where `lie merge` looks for it";
        let name = path.file_name().unwrap_or_default();
        let help = format!("write `{}`", flags.out.with_file_name(name).display());
        mistakes.push(Message::option("--events", text).help(help));
    }
    match mistakes.is_empty() {
        true => Ok(()),
        false => Err(Failure::invalid(mistakes)),
    }
}

/// Which of the declared events end members.
fn stopping(spec: &Spec) -> Vec<usize> {
    let events = spec.model.events.iter().enumerate();
    let stops = events.filter(|(_, event)| event.rule.stops);
    stops.map(|(place, _)| place).collect()
}

/// Opens the table of events, if it is asked for.
fn table(spec: &Spec, flags: &args::Ensemble, inputs: &Inputs) -> Result<Option<Table>, Failure> {
    let Some(path) = &flags.events else {
        return Ok(None);
    };
    let destination = events::open(path, &spec.model, inputs)?;
    let columns = Columns::new(&spec.model, Some("member"));
    Ok(Some(Table::new(path, destination, Some(columns))))
}

/// The ensemble that is asked for.
fn asked(spec: &Spec, flags: &args::Ensemble) -> Result<Asked, Failure> {
    let drawing = Drawing {
        members: flags.members.as_ref(),
        seed: match flags.request.seed {
            Some(_) => {
                Some(seed(&flags.request).map_err(|mistake| Failure::invalid(vec![mistake]))?)
            }
            None => None,
        },
        spread: flags.spread.as_ref(),
    };
    cast(spec, &flags.request, drawing).map_err(Failure::invalid)
}

/// What is to be noted of the initial states.
fn note(spec: &Spec, asked: &Asked) -> Option<String> {
    let names = spec.model.parameters.iter().map(|p| &p.name);
    let rows = asked.cast.parameters.iter().cycle().zip(&asked.cast.starts);
    let starts = rows.map(|(values, state)| Start {
        parameters: names.clone().cloned().zip(values.iter().copied()).collect(),
        initial: state.clone(),
    });
    signs::note(&spec.model, starts.collect::<Vec<_>>().iter())
}

fn title(spec: &Spec, asked: &Asked) -> String {
    let (name, plan) = (&spec.model.name, &asked.plan);
    let what = match plan.pace.0 {
        lie_runtime::driver::Pace::Step(_) => "step",
        lie_runtime::driver::Pace::Tolerance(_) => "tolerance",
    };
    format!(
        "{name}, {}, {what} {}",
        plan.method.title(),
        plan.pace.1.trim()
    )
}

/// The answer where members would need a built program.
fn not_here(spec: &Spec) -> Failure {
    let text = format!(
        "members of {} would need a program that cargo builds: H calls functions of Rust",
        spec.model.name
    );
    let message = Message::new(Kind::Method, text).at_option("SPEC");
    message
        .help("run them by `lie run --initial-file`, which builds one")
        .into()
}

/// Members that were not taken: there is no memory for them, or they cannot be written.
fn not_taken(out: &Path, error: std::io::Error) -> Failure {
    let inner = error.get_ref();
    if let Some(exceeded) = inner.and_then(|inner| inner.downcast_ref::<Exceeded>()) {
        return Failure::invalid(vec![no_room(exceeded)]);
    }
    if error.kind() == std::io::ErrorKind::InvalidData {
        return Failure::surroundings(fault(&error.to_string()));
    }
    writing_failed(Some(out), &error)
}

/// Rows for which there is no memory.
fn no_room(exceeded: &Exceeded) -> Message {
    let message = Message::new(Kind::Limit, exceeded.to_string()).with_fault(Fault::Memory);
    let help = "keep fewer rows by `--every` or `--at`, or take fewer `--threads`";
    message.help(help)
}
