//! `lie canonical`: writes a spec in coordinates in which the bracket is constant.

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
    let Canonical { text, sentence } = Canonical::of(&spec, folder)?;
    let Some(path) = &arguments.out else {
        print(&text)?;
        return Ok(0);
    };
    files::write_new(path, &text)?;
    let path = path.display().to_string();
    print(&format!(
        "{path}: {sentence}\nnext: lie run {} --method gauss10\n",
        shell::word(&path)
    ))?;
    Ok(0)
}
