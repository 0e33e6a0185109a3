//! `lie expand`: prints the generated code of a spec, or the plan of it.

use lie_codegen::compile;
use lie_codegen::plan::plan;
use lie_codegen::print::Surface;
use lie_in_process::request::{Front, method};
use lie_syntax::ast::Runtime;

use super::{args, print};
use crate::compiler;
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
