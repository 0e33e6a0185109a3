//! `lie ensemble`: many trajectories of one spec, as an array.

mod beside;
mod gathering;
pub mod merge;
mod reductions;
mod shard;

use std::path::Path;
use std::sync::Arc;
use std::thread::available_parallelism;
use std::time::Instant;

use lie_codegen::program::Purpose;
use lie_in_process::Work;
use lie_in_process::clock;
use lie_in_process::ensemble::{self, Ensemble};
use lie_in_process::memory::Exceeded;
use lie_in_process::message::Fault;
use lie_in_process::report::signs;
use lie_in_process::request::{Asked, Drawing, Value, cast, seed};
use lie_in_process::share::{Record, Share};
use lie_in_process::words::counted;
use lie_program::protocol::{Obstacle, Start};
use lie_syntax::diagnostic::Kind;
use lie_syntax::front::spec::files;
use serde_json::Map;

use super::args::{self, Reduce};
use super::files::Inputs;
use super::fold::folded;
use super::run::bar::Bar;
use super::run::layout::Layout;
use super::run::outputs::writing_failed;
use super::run::said::of_projection;
use crate::build::talk::{Outcome, fault, talk_here};
use crate::build::{self, Key};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, STOPPED, keep_refused, step_refused};
use crate::render;
use beside::Beside;
use gathering::Gathering;

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
        plan: asked.plan,
        cast: asked.cast,
    };
    let (clock, some) = (Instant::now(), ensemble.some.clone());
    let bar = Bar::for_members(!flags.quiet);
    let mut gathering = Gathering::begin(beside, record, places)?;
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
    match mistakes.is_empty() {
        true => Ok(()),
        false => Err(Failure::invalid(mistakes)),
    }
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

/// What the file is to say of itself, and the places of its columns in a state.
fn record(
    spec: &Spec,
    flags: &args::Ensemble,
    asked: &Asked,
    share: Share,
    quantiles: Vec<f64>,
) -> Result<(Record, Vec<usize>), Failure> {
    let model = &spec.model;
    let parameters = asked.cast.parameters.first().cloned().unwrap_or_default();
    let named = model
        .parameters
        .iter()
        .map(|p| p.name.clone())
        .zip(parameters);
    let layout = Layout::new(model, None, &named.collect());
    let places = match &model.family {
        Some(_) => (0..layout.states).collect(),
        None => model.shown_coordinates(),
    };
    let members = asked.cast.count();
    if asked
        .cast
        .starts
        .iter()
        .any(|start| start.len() != asked.cast.starts[0].len())
    {
        let text = "the members have different numbers of sites";
        let help = "make an ensemble of its own for each number of sites";
        return Err(Message::option("--param", text).help(help).into());
    }
    let reduce = {
        let mut reduce = flags.reduce.clone();
        reduce.sort_unstable();
        reduce.dedup();
        reduce.into_iter().map(|one| beside::name(one).to_owned())
    };
    let ends = asked.ends;
    let record = Record {
        format: Record::FORMAT,
        lie: build::version().to_owned(),
        complete: false,
        system: model.name.clone(),
        method: asked.plan.method.label(),
        kept: asked.plan.kept(spec),
        spec: digest_of_spec(&flags.spec, spec)?,
        asked: options(flags, asked)?,
        members,
        share,
        parameters: asked.swept.clone(),
        columns: layout.coordinates(),
        times: ensemble::times(&asked.plan, ends),
        rows: !ends,
        reduce: reduce.collect(),
        quantiles,
        histogram: None,
        failures: Vec::new(),
        numbers: None,
    };
    Ok((record, places))
}

/// A digest of the spec and of the files that it reads.
fn digest_of_spec(path: &Path, spec: &Spec) -> Result<String, Failure> {
    let text = &spec.source.text;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut key = Key::new().update(text);
    for file in files(text) {
        key = key.update(&digest(&folder.join(file))?);
    }
    Ok(key.hex())
}

fn digest(path: &Path) -> Result<String, Failure> {
    let bytes = std::fs::read(path).map_err(|error| {
        let message = Message::io(path, format!("it cannot be read: {error}"));
        Failure::surroundings(message.help("check that it is still there"))
    })?;
    Ok(Key::digest(&bytes))
}

/// What was asked for, by option; of files their digests.
fn options(
    flags: &args::Ensemble,
    asked: &Asked,
) -> Result<Map<String, serde_json::Value>, Failure> {
    let request = serde_json::to_value(&flags.request).unwrap_or_default();
    let mut options = match request {
        serde_json::Value::Object(options) => options,
        _ => Map::new(),
    };
    options
        .retain(|_, value| !value.is_null() && value.as_array().is_none_or(|all| !all.is_empty()));
    if let Some(path) = &flags.request.initial_file {
        options.insert("initial-file".to_owned(), digest(path)?.into());
    }
    let tables = flags.request.input.iter();
    let tables = tables.filter_map(|written| written.split_once('='));
    let tables: Vec<String> = tables
        .map(|(name, path)| {
            Ok(format!(
                "{}={}",
                name.trim(),
                digest(Path::new(path.trim()))?
            ))
        })
        .collect::<Result<_, Failure>>()?;
    if !tables.is_empty() {
        options.insert("input".to_owned(), tables.into());
    }
    if let Some(draw) = asked.cast.drawn.as_ref().map(|drawn| drawn.draw) {
        options.insert("members".to_owned(), draw.count.into());
        options.insert("seed".to_owned(), draw.seed.into());
        let spread = flags.spread.clone().unwrap_or(Value::Number(0.1));
        options.insert(
            "spread".to_owned(),
            serde_json::to_value(spread).unwrap_or_default(),
        );
    }
    Ok(options)
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
        let message = Message::new(Kind::Limit, exceeded.to_string()).with_fault(Fault::Memory);
        let help = "keep fewer rows by `--every` or `--at`, or take fewer `--threads`";
        return Failure::invalid(vec![message.help(help)]);
    }
    if error.kind() == std::io::ErrorKind::InvalidData {
        return Failure::surroundings(fault(&error.to_string()));
    }
    writing_failed(Some(out), &error)
}
