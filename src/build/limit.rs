//! What the cache may take, and what goes first where it takes more.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use lie_syntax::diagnostic::Kind;

use crate::message::{Failure, Message};

/// The limit where `LIE_CACHE_MB` says nothing: about a hundred programs beside the packages that they share.
const MEGABYTES: u64 = 2000;

/// How many bytes the cache may take: `$LIE_CACHE_MB` megabytes, else 2000.
///
/// # Errors
/// `option`: the variable is not a whole number.
pub fn limit() -> Result<u64, Failure> {
    let Some(value) = std::env::var_os("LIE_CACHE_MB").filter(|value| !value.is_empty()) else {
        return Ok(MEGABYTES * 1_000_000);
    };
    let value = value.to_string_lossy();
    let bytes = value
        .parse::<u64>()
        .ok()
        .and_then(|m| m.checked_mul(1_000_000));
    bytes.ok_or_else(|| {
        let text = format!("LIE_CACHE_MB is `{value}`, which is not a whole number of megabytes");
        let help = format!("set it to a number such as {MEGABYTES}, or unset it");
        Failure::invalid(vec![Message::new(Kind::Option, text).help(help)])
    })
}

/// The bytes of all files below a folder; links are not followed.
pub fn size(folder: &Path) -> u64 {
    let sizes = entries(folder).map(|entry| match entry.metadata() {
        Ok(found) if found.is_dir() => size(&entry.path()),
        Ok(found) => found.len(),
        Err(_) => 0,
    });
    sizes.sum()
}

/// The folders of built programs.
pub fn programs(cache: &Path) -> Vec<PathBuf> {
    let paths = entries(&cache.join("programs")).map(|entry| entry.path());
    paths.filter(|path| path.is_dir()).collect()
}

fn entries(folder: &Path) -> impl Iterator<Item = fs::DirEntry> + use<> {
    fs::read_dir(folder).into_iter().flatten().flatten()
}

/// Removes cargo's own copies of a built program, which is kept elsewhere; `name` is that of its package.
pub fn forget(built: &Path, name: &str) {
    let Some(folder) = built.parent() else { return };
    let names = [name.to_owned(), name.replace('-', "_")];
    for folder in ["", "deps", ".fingerprint"].map(|part| folder.join(part)) {
        for entry in entries(&folder) {
            let found = entry.file_name();
            let found = found.to_string_lossy();
            if names.iter().any(|name| found.starts_with(name.as_str())) {
                let _ = fs::remove_file(entry.path()).or_else(|_| fs::remove_dir_all(entry.path()));
            }
        }
    }
}

/// Removes what can be made again until the cache fits: sources of other versions, then programs, the one that was not
/// used for longest first, then the packages. The program `keep` and the sources `version` stay. What cannot be removed
/// stays as well: a cache that is too large fails no run.
pub fn trim(cache: &Path, limit: u64, keep: &Path, version: &str) {
    let mut total = size(cache);
    let old = entries(&cache.join("runtime")).filter(|entry| entry.file_name() != version);
    let old = old.map(|entry| entry.path());
    let mut programs = programs(cache);
    programs.retain(|folder| folder != keep);
    programs.sort_by_cached_key(|folder| last_use(folder));
    for path in old.chain(programs).chain([cache.join("target")]) {
        if total <= limit {
            return;
        }
        let freed = size(&path);
        if fs::remove_dir_all(&path).is_ok() {
            total = total.saturating_sub(freed);
        }
    }
}

/// The file of a program whose time is that of its last use.
const USED: &str = "sum";

/// Notes that a program is used now.
pub fn used(folder: &Path) {
    let file = fs::File::options().append(true).open(folder.join(USED));
    // a cache that can only be read is used as well
    let _ = file.and_then(|file| file.set_modified(SystemTime::now()));
}

fn last_use(folder: &Path) -> SystemTime {
    let time = fs::metadata(folder.join(USED)).and_then(|found| found.modified());
    time.unwrap_or(SystemTime::UNIX_EPOCH)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// A cache of three programs, the first used last, of sources of two versions and of packages; 100 bytes each.
    fn cache() -> tempfile::TempDir {
        let cache = tempfile::tempdir().expect("a folder");
        for part in [
            "programs/a",
            "programs/b",
            "programs/c",
            "runtime/old",
            "runtime/new",
            "target/release",
        ] {
            let folder = cache.path().join(part);
            fs::create_dir_all(&folder).expect("a folder");
            fs::write(folder.join(USED), [0; 100]).expect("a file");
        }
        for (name, seconds) in [("a", 30), ("b", 10), ("c", 20)] {
            let path = cache.path().join("programs").join(name).join(USED);
            let file = fs::File::options()
                .append(true)
                .open(path)
                .expect("the file");
            let time = SystemTime::UNIX_EPOCH + Duration::from_secs(seconds);
            file.set_modified(time).expect("its time");
        }
        cache
    }

    /// What is left of a cache under a limit; program c was just built.
    fn left(cache: &Path, limit: u64) -> Vec<&'static str> {
        trim(cache, limit, &cache.join("programs/c"), "new");
        let parts = [
            "programs/a",
            "programs/b",
            "programs/c",
            "runtime/old",
            "runtime/new",
            "target",
        ];
        parts
            .into_iter()
            .filter(|part| cache.join(part).exists())
            .collect()
    }

    #[test]
    fn what_was_not_used_for_longest_goes_first() {
        let all = [
            "programs/a",
            "programs/b",
            "programs/c",
            "runtime/old",
            "runtime/new",
            "target",
        ];
        assert_eq!(left(cache().path(), 600), all);
        assert_eq!(
            left(cache().path(), 599),
            [
                "programs/a",
                "programs/b",
                "programs/c",
                "runtime/new",
                "target"
            ]
        );
        assert_eq!(
            left(cache().path(), 400),
            ["programs/a", "programs/c", "runtime/new", "target"]
        );
        assert_eq!(
            left(cache().path(), 300),
            ["programs/c", "runtime/new", "target"]
        );
        assert_eq!(left(cache().path(), 0), ["programs/c", "runtime/new"]);
    }

    #[test]
    fn a_use_is_noted() {
        let cache = cache();
        used(&cache.path().join("programs/b"));
        assert_eq!(
            left(cache.path(), 400),
            ["programs/b", "programs/c", "runtime/new", "target"]
        );
    }

    #[test]
    fn the_copies_of_cargo_go() {
        let folder = tempfile::tempdir().expect("a folder");
        for file in [
            "lie-k",
            "lie-k.d",
            "deps/lie_k-1",
            "deps/lie_core-2",
            ".fingerprint/lie-k-1/x",
        ] {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            fs::write(path, "").expect("a file");
        }
        forget(&folder.path().join("lie-k"), "lie-k");
        let there = |file: &str| folder.path().join(file).exists();
        assert!(!there("lie-k") && !there("deps/lie_k-1") && !there(".fingerprint/lie-k-1"));
        assert!(there("deps/lie_core-2"));
    }
}
