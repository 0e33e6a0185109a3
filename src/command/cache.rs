//! `lie cache`: where built programs are kept, how much they take, and how they are removed.

use std::path::Path;

use super::{args, print};
use crate::build::{cache_failure, cache_root};
use crate::message::Failure;

/// What is in the cache beside the programs: all of it can be made again.
const FOLDERS: [&str; 3] = ["programs", "target", "runtime"];

/// Shows the cache, or empties it.
///
/// # Errors
/// `io`: there is no folder for it, or something in it cannot be removed.
pub fn run(arguments: &args::Cache) -> Result<u8, Failure> {
    let root = cache_root()?;
    let (size, programs) = (size(&root), programs(&root));
    let place = root.display();
    if !arguments.clear {
        let text = format!(
            "{place}\n{programs} programs, {:.1} MB in all\n\
             LIE_CACHE_DIR chooses another folder; `lie cache --clear` empties it: what is needed is built again\n",
            megabytes(size)
        );
        print(&text)?;
        return Ok(0);
    }
    for folder in FOLDERS.map(|folder| root.join(folder)) {
        if folder.exists() {
            std::fs::remove_dir_all(&folder).map_err(|error| cache_failure(&folder, &error))?;
        }
    }
    print(&format!(
        "{place}: {programs} programs removed, {:.1} MB\n",
        megabytes(size)
    ))?;
    Ok(0)
}

fn megabytes(bytes: u64) -> f64 {
    bytes as f64 / 1e6
}

/// Built programs, one in each folder.
fn programs(root: &Path) -> usize {
    let folders = std::fs::read_dir(root.join("programs"))
        .into_iter()
        .flatten();
    folders
        .flatten()
        .filter(|entry| entry.path().is_dir())
        .count()
}

/// The bytes of all files below a folder; links are not followed.
fn size(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let sizes = entries.map(|entry| match entry.metadata() {
        Ok(found) if found.is_dir() => size(&entry.path()),
        Ok(found) => found.len(),
        Err(_) => 0,
    });
    sizes.sum()
}
