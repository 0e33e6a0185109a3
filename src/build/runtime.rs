//! Unpacks the sources that programs are built of, which are part of this program, into the cache.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use include_dir::{Dir, DirEntry};

use super::Key;

/// The crates that a generated program can depend on, with their folders `src`.
const CRATES: [(&str, &Dir<'_>); 4] = [
    ("lie-core", &lie_core::sources::FILES),
    ("lie-runtime", &lie_runtime::sources::FILES),
    ("lie-program", &lie_program::sources::FILES),
    ("lie-measure", &lie_measure::sources::FILES),
];

/// The manifest of a crate among its sources.
const MANIFEST: &str = "standalone.toml";

/// Identifies the sources: their version for people, their content for certainty.
pub fn identity() -> &'static str {
    static IDENTITY: OnceLock<String> = OnceLock::new();
    IDENTITY.get_or_init(|| {
        let key = files().into_iter().fold(Key::new(), |key, (path, text)| {
            key.update(&path.to_string_lossy()).long(text)
        });
        format!("{}-{}", env!("CARGO_PKG_VERSION"), key.hex())
    })
}

/// All files by their places in the folder of the unpacked sources.
pub fn files() -> Vec<(PathBuf, &'static str)> {
    let mut files = Vec::new();
    for (name, sources) in CRATES {
        let mut folders = vec![sources];
        while let Some(folder) = folders.pop() {
            for entry in folder.entries() {
                match entry {
                    DirEntry::Dir(folder) => folders.push(folder),
                    DirEntry::File(file) if file.path() == Path::new(MANIFEST) => {
                        let place = Path::new(name).join("Cargo.toml");
                        files.extend(file.contents_utf8().map(|text| (place, text)));
                    }
                    DirEntry::File(file) => {
                        let place = Path::new(name).join("src").join(file.path());
                        files.extend(file.contents_utf8().map(|text| (place, text)));
                    }
                }
            }
        }
    }
    files.sort();
    files
}

/// The folder of the unpacked sources inside the cache folder.
pub fn folder(cache: &Path) -> PathBuf {
    cache.join("runtime").join(identity())
}

/// Whether every file is what it was.
fn is_whole(folder: &Path) -> bool {
    files().into_iter().all(|(path, text)| {
        std::fs::read(folder.join(path)).is_ok_and(|there| there == text.as_bytes())
    })
}

/// Writes the sources, unless they are there as they should be.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn read(path: &str) -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        std::fs::read_to_string(path).expect("a file of the repository")
    }

    /// The requirement of a package, without what belongs to the manifest alone.
    fn requirement(manifest: &str, package: &str) -> Option<String> {
        let prefix = format!("{package} = ");
        let line = manifest
            .lines()
            .find(|line| line.starts_with(&prefix) && !line.contains("dep:"))?;
        Some(line.replace(", optional = true", ""))
    }

    #[test]
    fn each_crate_has_its_sources_and_a_manifest() {
        let files = files();
        for (name, _) in CRATES {
            for file in ["Cargo.toml", "src/lib.rs", "src/sources.rs"] {
                let place = Path::new(name).join(file);
                assert!(files.iter().any(|(path, _)| *path == place), "{place:?}");
            }
        }
        let nested = Path::new("lie-core/src/newton/solver.rs");
        let found = files.iter().find(|(path, _)| path == nested);
        assert_eq!(
            found.map(|(_, text)| *text),
            Some(&*read("crates/lie-core/src/newton/solver.rs"))
        );
    }

    /// Versions and requirements are those of the workspace.
    #[test]
    fn the_manifests_agree_with_the_workspace() {
        let workspace = read("Cargo.toml");
        let mut compared = 0;
        for (name, sources) in CRATES {
            let manifest = sources
                .get_file(MANIFEST)
                .and_then(|file| file.contents_utf8());
            let manifest = manifest.expect("a manifest");
            for key in ["version", "rust-version", "edition", "license"] {
                let value = requirement(manifest, key);
                assert!(value.is_some(), "{name}: {key}");
                assert_eq!(value, requirement(&workspace, key), "{name}");
            }
            let packages = manifest
                .split("\n[dependencies]\n")
                .nth(1)
                .unwrap_or_default();
            let packages = packages.split("\n[").next().unwrap_or_default();
            for line in packages.lines().filter(|line| !line.starts_with("lie-")) {
                let Some((package, _)) = line.split_once(" = ") else {
                    continue;
                };
                let wanted = requirement(&workspace, package);
                let wanted = wanted.map(|line| line.replace(", \"raw_value\"", ""));
                assert_eq!(requirement(manifest, package), wanted, "{name}");
                compared += 1;
            }
        }
        assert!(compared > 8, "{compared}");
    }
}
