//! `lie run`: integrates a spec with its generated, compiled code.

pub mod bar;
mod layout;
pub mod outputs;
pub mod plan;
mod summary;
pub mod values;

use std::io::{self, IsTerminal as _};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use lie_codegen::diagnostic::Kind;
use lie_codegen::program::{Purpose, program};
use lie_poisson::plot::Plot;

use super::args::{self, Cpu, Format};
use crate::build::protocol::{self, End, Job, Stop, Times};
use crate::build::{self, Request};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, STOPPED};
use crate::output::{Header, Rows};
use crate::render;
use bar::Bar;
use layout::Layout;
use outputs::Outputs;
use plan::Plan;
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
    let spec = compiler::load(path)?;
    let plan = plan::plan(&spec, flags).map_err(Failure::invalid)?;
    let format = outputs::format(flags, path)?;
    if !flags.quiet {
        render::print(&spec.warnings());
    }
    let outputs = Outputs::open(flags)?;
    let interrupt = Interrupt::install();
    let purpose = plan.chart.map_or(Purpose::Run, Purpose::OnGroup);
    let request = Request {
        name: &spec.model.name,
        source: &program(&spec.model, std::slice::from_ref(&plan.method), purpose),
        native: flags.cpu == Some(Cpu::Native),
        quiet: flags.quiet,
        purpose,
    };
    let program = build::program(&request, &interrupt)?;
    integrate(&spec, &plan, flags, format, outputs, &program, &interrupt)
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
    let layout = Layout::new(model, plan.chart);
    let columns = layout.columns(model);
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
        hidden = columns.len();
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
        (_, out) => outputs::writing_failed(out.as_deref(), &error),
    };
    let mut rows = Rows::start(outputs.rows, format, &header).map_err(lost)?;
    let mut plot = outputs.plot.as_ref().map(|_| {
        let subtitle = format!("{}, h = {}", plan.method.title(), plan.step.1.trim());
        let (own, element) = columns.split_at(layout.invariants.end);
        let span = (0.0, plan.end());
        Plot::new(&*model.name, own, layout.states.len(), span)
            .subtitle(subtitle)
            .element(element)
    });
    let mut drift = Drift::new(&columns[layout.invariants.clone()]);
    for casimir in model.casimirs.iter().filter(|c| c.multivalued) {
        drift.leave_out(&casimir.name);
    }
    // Rows that scroll by on the same terminal say enough.
    let scrolls = flags.out.is_none() && io::stdout().is_terminal();
    let bar = Bar::new(!flags.quiet && !scrolls);
    let start = Instant::now();
    let mut refused = None;
    let end = protocol::run(
        Command::new(program),
        &job,
        layout.width,
        interrupt,
        &mut |numbers| {
            let numbers = layout.shown(numbers);
            for row in numbers.chunks_exact(columns.len()) {
                drift.push(&row[..layout.invariants.end], layout.invariants.start);
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
    let end = match end {
        Ok(end) => end,
        Err(error) => {
            rows.finish("failed").map_err(lost)?;
            return Err(build::not_started(program, &error));
        }
    };
    rows.finish(word(&end)).map_err(lost)?;
    if let (Some(plot), Some(destination), Some(path)) = (plot, outputs.plot, &flags.plot) {
        destination
            .replace(plot.to_svg().as_bytes())
            .map_err(|error| outputs::unwritable(path, &error))?;
    }
    if !flags.quiet
        && let End::Done(counts) = &end
    {
        let title = format!(
            "{}, {}, step {}",
            model.name,
            plan.method.title(),
            plan.step.1.trim()
        );
        eprint!(
            "{}",
            summary::text(
                &title,
                counts,
                plan.method.is_adaptive(),
                &drift,
                start.elapsed()
            )
        );
    }
    Ok(match end {
        End::Done(_) => 0,
        End::Interrupted(code) => {
            if !flags.quiet {
                eprintln!(
                    "Interrupted at t = {:?}; the rows so far are written.",
                    drift.time()
                );
            }
            code
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
        End::Broken(how) => return Err(build::broken(program, &how)),
    })
}

/// How the run ended, for the output.
fn word(end: &End) -> &'static str {
    match end {
        End::Done(_) => "done",
        End::Interrupted(_) => "interrupted",
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
