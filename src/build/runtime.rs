//! Unpacks the runtime's sources, which are part of this program, into the cache.

use std::io;
use std::path::{Path, PathBuf};

use lie_runtime::sources::{FILES, MANIFEST};

use super::key::Key;

/// Identifies the runtime: its version for people, its content for certainty.
pub fn identity() -> String {
    let key = FILES
        .iter()
        .fold(Key::new().with(MANIFEST), |key, (path, text)| {
            key.with(path).with(text)
        });
    format!("{}-{}", env!("CARGO_PKG_VERSION"), key.hex())
}

/// The folder of the unpacked runtime inside the cache folder.
pub fn folder(cache: &Path) -> PathBuf {
    cache.join("runtime").join(identity())
}

/// Whether every file is what it was.
fn is_whole(folder: &Path) -> bool {
    let same = |path: PathBuf, text: &str| std::fs::read(path).is_ok_and(|t| t == text.as_bytes());
    same(folder.join("Cargo.toml"), MANIFEST)
        && FILES
            .iter()
            .all(|(path, text)| same(folder.join("src").join(path), text))
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
    std::fs::write(draft.path().join("Cargo.toml"), MANIFEST)?;
    for (path, text) in FILES {
        let path = draft.path().join("src").join(path);
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
