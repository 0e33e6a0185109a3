//! `lie cache`: where built programs are kept, how much they take, and how they are removed.

use lie_in_process::words::counted;

use super::fold::folded;
use super::{args, print};
use crate::build::{cache_failure, cache_limit, cache_place, cache_programs, cache_size};
use crate::message::Failure;

/// What is in the cache beside the programs: all of it can be made again.
const FOLDERS: [&str; 3] = ["programs", "target", "runtime"];

/// Shows the cache, or empties it.
///
/// # Errors
/// `io`: there is no folder for it, or something in it cannot be removed.
pub fn run(arguments: &args::Cache) -> Result<u8, Failure> {
    let root = cache_place()?;
    let size = cache_size(&root);
    let programs = counted(cache_programs(&root).len() as u64, "program");
    let place = root.display();
    if !arguments.clear {
        let text = format!(
            "{place}\n{programs}, {:.1} MB in total, of at most {:.0} MB\n\
             LIE_CACHE_DIR chooses another folder, LIE_CACHE_MB another limit: beyond it, the programs that were unused for \
             the longest time are removed\n`lie cache --clear` empties it: what is needed is built again\n",
            megabytes(size),
            megabytes(cache_limit()?)
        );
        print(&folded(&text))?;
        return Ok(0);
    }
    for folder in FOLDERS.map(|folder| root.join(folder)) {
        if folder.exists() {
            std::fs::remove_dir_all(&folder).map_err(|error| cache_failure(&folder, &error))?;
        }
    }
    print(&format!(
        "{place}: {programs} removed, {:.1} MB\n",
        megabytes(size)
    ))?;
    Ok(0)
}

fn megabytes(bytes: u64) -> f64 {
    bytes as f64 / 1e6
}
