//! `lie expand`: prints the generated code of a spec, or the plan of it.

use std::path::Path;

use lie_codegen::compile;
use lie_codegen::methods::Choice;
use lie_codegen::plan::plan;
use lie_codegen::print::Surface;
use lie_codegen::program;
use lie_in_process::request::{self, Front, Request, method};
use lie_runtime::driver::{Density, Pace};
use lie_syntax::ast::Runtime;

use super::{args, print, shell};
use crate::build;
use crate::compiler::{self, Spec};
use crate::message::{Failure, Message};
use crate::render;

/// Prints it, formatted.
///
/// # Errors
/// Invalid input.
pub fn run(arguments: &args::Expand) -> Result<u8, Failure> {
    let spec = compiler::load(&arguments.spec)?;
    let mut runtime = Runtime::default();
    let mut choices = Vec::new();
    let mut mistakes: Vec<Message> = Vec::new();
    if let Some(path) = &arguments.runtime {
        match Runtime::parse(path) {
            Ok(found) => runtime = found,
            Err(no_path) => mistakes.push(
                Message::option("--crate", no_path.to_string())
                    .help("write the path at which the runtime is re-exported, as in `--crate my_crate::lie_runtime`"),
            ),
        }
    }
    for id in &arguments.method {
        match method::expand(id, &spec.model, Front::Command) {
            Ok(found) => {
                for choice in found {
                    if !choices.contains(&choice) {
                        choices.push(choice);
                    }
                }
            }
            Err(message) => mistakes.push(message.at_option("--method")),
        }
    }
    if !mistakes.is_empty() {
        return Err(Failure::invalid(mistakes));
    }
    render::print(&spec.warnings());
    if arguments.method.is_empty() {
        choices = compile::declared_choices(&spec.model);
    }
    if let Some(folder) = &arguments.project {
        return project(&spec, arguments, folder, choices);
    }
    if arguments.plan {
        print(&plan(&spec.model, &choices).to_string())?;
    } else {
        let surface = Surface {
            runtime,
            ..Surface::new(&spec.model)
        };
        print(&compile::expand_on(&spec.model, &choices, &surface))?;
    }
    Ok(0)
}

/// Writes a package that integrates the system as the `run` of the spec says, or by the first of the methods.
fn project(
    spec: &Spec,
    arguments: &args::Expand,
    folder: &Path,
    mut choices: Vec<Choice>,
) -> Result<u8, Failure> {
    let request = Request {
        method: arguments.method.iter().take(1).cloned().collect(),
        ..Request::default()
    };
    let plan = request::plan(spec, &request).map_err(Failure::invalid)?;
    let start = request::start(spec, &request).map_err(Failure::invalid)?;
    if !choices.contains(&plan.method) {
        choices.push(plan.method.clone());
    }
    let (Pace::Step(number) | Pace::Tolerance(number)) = plan.pace.0;
    let numbers = program::Numbers {
        parameters: &start.parameters,
        initial: &start.initial,
        span: (plan.from, plan.end()),
        pace: number,
        by_tolerance: matches!(plan.pace.0, Pace::Tolerance(_)),
        tolerances: plan.tolerances,
        keep: plan.keep,
        reversible: plan.density == Density::Reversible,
    };
    let main = program::integrates(&spec.model, &plan.method, &numbers);
    let system = compile::expand(&spec.model, &choices);
    let name = spec.model.name.to_lowercase();
    let written = build::project::write(folder, &name, &main, &system);
    written.map_err(|error| {
        let text = format!("{} cannot be written: {error}", folder.display());
        let help = "choose a folder that is new or empty, where you may write";
        Failure::surroundings(Message::io(folder, text).help(help))
    })?;
    let path = folder.display().to_string();
    print(&format!(
        "{path}: {} by {}, with its runtime\nnext: cd {} && cargo run --release\n",
        spec.model.name,
        plan.method.title(),
        shell::word(&path)
    ))?;
    Ok(0)
}
