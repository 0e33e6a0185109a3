//! `lie expand --project`: a cargo package of its own, with the runtime beside it.

use std::fs;
use std::io;
use std::path::Path;

use super::runtime;

/// The crates of the runtime, in the folder of that name.
const RUNTIME: [&str; 2] = ["lie-core", "lie-runtime"];

/// Writes a package into a folder, which is made, or is empty.
///
/// # Errors
/// `DirectoryNotEmpty` where something is there; what the file system says.
pub fn write(folder: &Path, name: &str, main: &str, system: &str) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    if fs::read_dir(folder)?.next().is_some() {
        return Err(io::ErrorKind::DirectoryNotEmpty.into());
    }
    for (path, text) in runtime::files() {
        if RUNTIME.iter().any(|package| path.starts_with(package)) {
            file(&folder.join("runtime").join(path), text)?;
        }
    }
    let manifest = include_str!("template/project.toml").replace("NAME", name);
    file(&folder.join("src/system.rs"), system)?;
    file(&folder.join("src/main.rs"), main)?;
    file(&folder.join("Cargo.toml"), &manifest)
}

fn file(path: &Path, text: &str) -> io::Result<()> {
    if let Some(parent) = path.parent() {
        fs::create_dir_all(parent)?;
    }
    fs::write(path, text)
}
