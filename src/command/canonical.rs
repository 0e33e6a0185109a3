//! `lie canonical`: writes a spec in coordinates in which the bracket is constant.

use std::fs::OpenOptions;
use std::io::Write as _;

use lie_in_process::canonical::Canonical;

use super::{args, print, shell};
use crate::compiler;
use crate::message::{Failure, Message};
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
    let file = OpenOptions::new().write(true).create_new(true).open(path);
    let written = file.and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| {
        let message = Message::io(
            path,
            format!("{} cannot be written: {error}", path.display()),
        );
        Failure::surroundings(message.help(match error.kind() {
            std::io::ErrorKind::AlreadyExists => "choose another name, or remove the file first",
            _ => "choose a folder that can be written",
        }))
    })?;
    let path = path.display().to_string();
    print(&format!(
        "{path}: {sentence}\nnext: lie run {} --method gauss10\n",
        shell::word(&path)
    ))?;
    Ok(0)
}
