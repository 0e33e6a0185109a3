//! Unpacks the runtime's sources, which are part of this program, into the cache.

use std::io;
use std::path::{Path, PathBuf};

use lie_runtime::sources::CRATES;

use super::key::Key;

/// Identifies the runtime: its version for people, its content for certainty.
pub fn identity() -> String {
    let key = files().fold(Key::new(), |key, (path, text)| {
        key.with(&path.to_string_lossy()).with(text)
    });
    format!("{}-{}", env!("CARGO_PKG_VERSION"), key.hex())
}

/// All files by their places in the folder of the unpacked runtime.
fn files() -> impl Iterator<Item = (PathBuf, &'static str)> {
    CRATES.iter().flat_map(|(name, manifest, files)| {
        let manifest = (Path::new(name).join("Cargo.toml"), *manifest);
        let below = Path::new(name).join("src");
        let files = files
            .iter()
            .map(move |(path, text)| (below.join(path), *text));
        std::iter::once(manifest).chain(files)
    })
}

/// The folder of the unpacked runtime inside the cache folder.
pub fn folder(cache: &Path) -> PathBuf {
    cache.join("runtime").join(identity())
}

/// Whether every file is what it was.
fn is_whole(folder: &Path) -> bool {
    files().all(|(path, text)| {
        std::fs::read(folder.join(path)).is_ok_and(|there| there == text.as_bytes())
    })
}

/// Writes the runtime's sources, unless they are there as they should be.
///
/// They are written beside their place and renamed, so that a folder that exists was complete once.
/// The caller holds the lock of the cache.
///
/// # Errors
/// What the file system says.
pub fn unpack(cache: &Path) -> io::Result<PathBuf> {
    let folder = folder(cache);
    if is_whole(&folder) {
        return Ok(folder);
    }
    if folder.is_dir() {
        std::fs::remove_dir_all(&folder)?;
    }
    let parent = cache.join("runtime");
    std::fs::create_dir_all(&parent)?;
    let draft = tempfile::tempdir_in(&parent)?;
    for (path, text) in files() {
        let path = draft.path().join(path);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent)?;
        }
        std::fs::write(path, text)?;
    }
    match std::fs::rename(draft.path(), &folder) {
        Ok(()) => {
            // The folder has moved away from under its guard.
            let _ = draft.keep();
            Ok(folder)
        }
        // Another process was faster.
        Err(_) if folder.is_dir() => Ok(folder),
        Err(error) => Err(error),
    }
}
