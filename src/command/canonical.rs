//! `lie canonical`: writes a spec in coordinates in which the bracket is constant, or has no cocycle.

use lie_in_process::canonical::Canonical;

use super::{args, files, print, shell};
use crate::compiler;
use crate::message::Failure;
use crate::render;

/// Writes the spec.
///
/// # Errors
/// Invalid input, a bracket or a key that such coordinates do not have, and a file that cannot be written.
pub fn run(arguments: &args::Canonical) -> Result<u8, Failure> {
    let spec = compiler::load(&arguments.spec)?;
    let path = arguments.out.as_ref().unwrap_or(&arguments.spec);
    let folder = path.parent();
    render::print(&spec.warnings());
    let Canonical {
        text,
        sentence,
        is_constant,
    } = Canonical::of(&spec, folder)?;
    let Some(path) = &arguments.out else {
        print(&text)?;
        return Ok(0);
    };
    files::write_new(path, &text)?;
    let path = path.display().to_string();
    let file = shell::word(&path);
    let next = match is_constant {
        true => format!("run {file} --method gauss10"),
        false => format!("check {file}"),
    };
    print(&format!("{path}: {sentence}\nnext: lie {next}\n"))?;
    Ok(0)
}
