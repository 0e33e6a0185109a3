//! `lie run`: integrates a spec with its generated, compiled code.

pub mod bar;
pub mod checkpoint;
mod events;
mod keeper;
pub mod layout;
pub mod outputs;
mod picked;
pub mod picture;
mod reception;
pub mod said;
mod session;
mod summary;
mod tally;

use std::sync::Arc;

use lie_codegen::methods::Choice;
use lie_codegen::program::{Purpose, program};
use lie_in_process::report::signs;
use lie_in_process::request::{Member, Plan, Several, several};
use lie_runtime::driver::Pace;
use lie_syntax::diagnostic::Kind;

use super::args;
use super::files::Inputs;
use super::fold::folded;
use crate::build::talk::Worker;
use crate::build::{self, Processor, Request};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};
use crate::render;
use checkpoint::Checkpoint;
use keeper::Keeper;
use layout::Layout;
use lie_output::{Header, Rows};
use outputs::Outputs;
use picture::Picture;
use session::Session;

/// Runs a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(flags: &args::Run) -> Result<u8, Failure> {
    go(flags, None)
}

/// Runs a spec, from a checkpoint if there is one.
///
/// # Errors
/// As [`run`].
pub fn go(flags: &args::Run, taken_up: Option<Checkpoint>) -> Result<u8, Failure> {
    let [path] = flags.specs.as_slice() else {
        let text = format!("{} specs are given, `lie run` takes one", flags.specs.len());
        let help = "run them one after the other; `lie check` takes several";
        return Err(Message::option("SPEC", text).help(help).into());
    };
    Processor::from_options(flags.cpu.unwrap_or_default(), flags.fma)?;
    let spec = compiler::load(path)?;
    let several = several(&spec, &flags.request).map_err(Failure::invalid)?;
    if flags.checkpoint.is_some() {
        keeper::check(flags, &several)?;
    }
    let layout = layout(&spec, &several)?;
    let format = outputs::format(flags)?;
    let kind = picture::kind(&spec, flags, &several, &layout)?;
    if !flags.quiet {
        render::print(&spec.warnings());
        // each method starts from the same states
        let first = several.members.iter().filter(|member| member.plan == 0);
        if let Some(note) = signs::note(&spec.model, first.map(|member| &member.start)) {
            eprintln!("{}", folded(&format!("note: {note}")));
        }
    }
    let inputs = Inputs::of_request(path, &spec, &flags.request);
    let outputs = Outputs::open(flags, &inputs)?;
    let events = events::Table::open(flags, &spec.model, &inputs, several.labels.is_some())?;
    let keeper = match &flags.checkpoint {
        Some(path) => Some(Keeper::new(flags, path, &spec, &inputs, taken_up)?),
        None => None,
    };
    if let Some(place) = keeper
        .as_ref()
        .and_then(Keeper::place)
        .filter(|_| !flags.quiet)
    {
        let (step, time) = (place.milestone.index, place.milestone.time);
        render::say(&format!(
            "{}: goes on from step {step}, t = {time:?}",
            spec.model.name
        ));
    }
    let interrupt = Interrupt::install();
    let workers = workers(&spec, &several.plans, flags, &interrupt)?;
    let header = Header {
        system: spec.model.name.clone(),
        columns: layout.columns.clone(),
        events: (!spec.model.events.is_empty()).then(|| spec.model.shown_coordinates()),
        labels: several.labels.clone(),
    };
    let picture = kind.zip(outputs.plot).map(|(kind, (form, destination))| {
        let picture = Picture::new(&spec, layout, kind, &several);
        (picture, form, destination)
    });
    let rows = Rows::new(outputs.rows, format, header);
    let rows = match picture {
        // it is wanted also where `| head` has seen enough of the rows
        Some(_) => rows.outliving_readers(),
        None => rows,
    };
    Session {
        spec: &spec,
        several: &several,
        flags,
        workers: &workers,
        interrupt: &interrupt,
    }
    .run_all(rows, (picture, events), keeper)
}

/// The columns, which all runs have in common.
fn layout(spec: &Spec, several: &Several) -> Result<Layout, Failure> {
    let of = |member: &Member| {
        let chart = several.plans[member.plan].chart;
        Layout::new(&spec.model, chart, &member.start.parameters)
    };
    let first = of(&several.members[0]);
    let members = match spec.model.family {
        Some(_) => &several.members[1..],
        None => &[],
    };
    if members
        .iter()
        .any(|member| of(member).columns != first.columns)
    {
        let text = "the runs have different numbers of sites, and so different columns";
        let help = "make a run of its own for each number of sites";
        return Err(Message::option("--param", text).help(help).into());
    }
    Ok(first)
}

/// What runs each of the methods: this program, or one that is built where that is asked for or has to be.
pub fn workers(
    spec: &Spec,
    plans: &[Plan],
    flags: &args::Run,
    interrupt: &Interrupt,
) -> Result<Vec<Arc<Worker>>, Failure> {
    let processor = Processor::from_options(flags.cpu.unwrap_or_default(), flags.fma)?;
    let chart = plans.first().and_then(|plan| plan.chart);
    let purpose = chart.map_or(Purpose::Run, Purpose::OnGroup);
    let compiled = flags.compile || flags.fma || flags.cpu.is_some();
    let here = plans.iter().map(|plan| {
        let methods = std::slice::from_ref(&plan.method);
        (!compiled).then(|| build::in_process_worker(&spec.model, methods, purpose))?
    });
    let here: Vec<Option<Arc<Worker>>> = here.map(|worker| worker.map(Arc::new)).collect();
    let rest = plans.iter().zip(&here).filter(|(_, here)| here.is_none());
    let methods: Vec<Choice> = rest.map(|(plan, _)| plan.method.clone()).collect();
    if methods.is_empty() {
        return Ok(here.into_iter().flatten().collect());
    }
    let request = Request {
        name: &spec.model.name,
        source: &program(&spec.model, &methods, purpose),
        processor,
        quiet: flags.quiet,
        purpose,
    };
    let built = Arc::new(Worker::Program(build::program(&request, interrupt)?));
    let worker = |here: Option<Arc<Worker>>| here.unwrap_or_else(|| built.clone());
    Ok(here.into_iter().map(worker).collect())
}

/// A parameter with a value of which no system can be made.
pub fn impossible(name: &str, why: &str) -> Failure {
    let message = Message::new(Kind::Domain, format!("parameter {name}: {why}"));
    let help = format!("give {name} another value with `--param {name}=VALUE`");
    message.at_option("--param").help(help).into()
}

/// The second run of a tolerance with so few steps takes no time beside the start of the program, and tells orbits on which errors
/// grow.
const SHORT: u64 = 1000;

/// Up to how many steps the error at the end is told.
fn assessed_up_to(plan: &Plan) -> u64 {
    match plan.pace.0 {
        _ if plan.assess => u64::MAX,
        Pace::Tolerance(_) => SHORT,
        Pace::Step(_) => 0,
    }
}
