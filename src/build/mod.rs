//! Builds the program of a system: source in, path of a compiled program out.
//!
//! ```text
//! CACHE/runtime/VERSION-HASH/     the sources of the runtime and of what stands on it, unpacked once
//! CACHE/programs/KEY/             manifest, lock file, main.rs, the finished program and its sum
//! CACHE/target/                   cargo's folder, shared so that packages compile once
//! CACHE/lock                      held while cargo runs
//! ```
//!
//! What is beyond the limit (`limit`) is removed after a build.

mod cache;
mod cause;
mod entry;
mod in_process;
mod limit;
mod processor;
pub mod project;
mod runtime;
pub mod talk;
mod toolchain;

use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::Instant;

use lie_codegen::program::Purpose;
use lie_syntax::diagnostic::Kind;

use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};
use crate::render;
pub use cache::{failure as cache_failure, place as cache_place};
use cause::Cause;
use entry::Entry;
pub use in_process::in_process_worker;
pub use lie_in_process::declared;
pub use lie_in_process::key::Key;
pub use limit::{limit as cache_limit, programs as cache_programs, size as cache_size};
pub use processor::Processor;
pub use runtime::identity as version;
use toolchain::Toolchain;

/// The files of a program beside its `main.rs`.
struct Template {
    manifest: &'static str,
    lock: &'static str,
    modules: &'static [(&'static str, &'static str)],
}

const PLAIN: Template = Template {
    manifest: include_str!("template/manifest.toml"),
    lock: include_str!("template/Cargo.lock"),
    modules: &[],
};
/// With the measurements.
const MEASURE: Template = Template {
    manifest: include_str!("template/measure/manifest.toml"),
    lock: include_str!("template/measure/Cargo.lock"),
    modules: &[],
};
/// With the clock of `lie bench`, and the methods from elsewhere that it compares with: only its programs depend on
/// them.
const BENCH: Template = Template {
    manifest: include_str!("template/bench/manifest.toml"),
    lock: include_str!("template/bench/Cargo.lock"),
    modules: &[
        ("clock.rs", lie_in_process::CLOCK),
        ("controls.rs", include_str!("template/bench/controls.rs")),
    ],
};

impl Template {
    fn of(purpose: Purpose) -> &'static Self {
        match purpose {
            Purpose::Bench => &BENCH,
            Purpose::Verify | Purpose::Stress => &MEASURE,
            Purpose::Run | Purpose::OnGroup(_) => &PLAIN,
        }
    }
}

/// What is built.
pub struct Request<'a> {
    /// Name of the system, for people.
    pub name: &'a str,
    /// The generated `main.rs`.
    pub source: &'a str,
    /// Which instructions it may use.
    pub processor: Processor,
    /// Whether to say nothing.
    pub quiet: bool,
    /// What the program is for.
    pub purpose: Purpose,
}

/// The path of the compiled program, built if it is not in the cache.
///
/// # Errors
/// `io` for the cache folder, `toolchain` for everything that cargo cannot do; a signal.
pub fn program(request: &Request<'_>, interrupt: &Interrupt) -> Result<PathBuf, Failure> {
    let cache = cache::root()?;
    let limit = limit::limit()?;
    let toolchain = Toolchain::find(&cache, request.processor)?;
    let template = Template::of(request.purpose);
    let modules = template.modules.iter();
    let key = modules
        .fold(Key::new().update(request.source), |key, (_, text)| {
            key.update(text)
        })
        .update(&toolchain.identity)
        .update(runtime::identity())
        .update(template.manifest)
        .update(template.lock)
        .update(request.processor.name())
        .hex();
    let entry = Entry::new(&cache, &key);
    if entry.is_whole(request.source) {
        limit::used(&entry.folder);
        return Ok(entry.program);
    }
    let _lock = lock(&cache, request.quiet)?;
    if entry.is_whole(request.source) {
        return Ok(entry.program);
    }
    let built = build(request, &toolchain, &cache, &entry.folder, &key, interrupt)?;
    let installed = entry.install(&built);
    installed.map_err(|error| cache::failure(&entry.program, &error))?;
    limit::forget(&built, &package(&key));
    limit::trim(&cache, limit, &entry.folder, runtime::identity());
    Ok(entry.program)
}

/// A built program that does what it should not.
pub fn broken(program: &Path, how: &str) -> Failure {
    let message = Message::new(Kind::Toolchain, format!("the built program failed: {how}"));
    let folder = program.parent().unwrap_or(program).display();
    Failure::surroundings(message.help(format!(
        "delete its folder {folder} and try again; if the failure remains, report it"
    )))
}

/// A built program that the system does not start.
pub fn not_started(program: &Path, error: &std::io::Error) -> Failure {
    let text = format!(
        "the built program {} cannot be started: {error}",
        program.display()
    );
    let message = Message::new(Kind::Toolchain, text);
    if error.kind() == std::io::ErrorKind::PermissionDenied {
        let help = "set LIE_CACHE_DIR to a folder from which programs may run";
        return Failure::surroundings(message.help(help));
    }
    let folder = program.parent().unwrap_or(program).display();
    Failure::surroundings(message.help(format!("delete its folder {folder} and try again")))
}

/// Waits until no other `lie` builds.
fn lock(cache: &Path, quiet: bool) -> Result<File, Failure> {
    let path = cache.join("lock");
    let failure = |error| cache::failure(&path, &error);
    let file = File::options()
        .create(true)
        .append(true)
        .open(&path)
        .map_err(failure)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => {
            if !quiet {
                render::say("Waiting for another `lie` that is building…");
            }
            file.lock().map_err(failure)?;
            Ok(file)
        }
        // A file system without locks: cargo's own lock on the target folder still holds.
        Err(TryLockError::Error(_)) => Ok(file),
    }
}

fn build(
    request: &Request<'_>,
    toolchain: &Toolchain,
    cache: &Path,
    folder: &Path,
    key: &str,
    interrupt: &Interrupt,
) -> Result<PathBuf, Failure> {
    runtime::unpack(cache).map_err(|error| cache::failure(cache, &error))?;
    let name = package(key);
    let template = Template::of(request.purpose);
    let manifest = manifest(template, &name);
    let write = |file: &str, content: &str| {
        let path = folder.join(file);
        cache::write(&path, content.as_bytes()).map_err(|error| cache::failure(&path, &error))
    };
    std::fs::create_dir_all(folder).map_err(|error| cache::failure(folder, &error))?;
    write("Cargo.toml", &manifest)?;
    write("Cargo.lock", template.lock)?;
    for (file, text) in template.modules {
        write(file, text)?;
    }
    write("main.rs", request.source)?;

    let say = |text: &str| {
        if !request.quiet {
            render::say(text);
        }
    };
    let start = Instant::now();
    say(&format!(
        "Building the program of {} (once, then it is kept)…",
        request.name
    ));
    let target = cache.join("target");
    let cargo = |offline| {
        let built = toolchain.build(folder, &target, offline, interrupt);
        let output = built.map_err(|error| no_cargo(&error))?;
        match interrupt.seen() {
            Some(code) => Err(Failure::interrupted(code)),
            None => Ok(output),
        }
    };
    let mut output = cargo(true)?;
    if !output.status.success() && Cause::from_output(&output).is_for_want_of_packages() {
        say("Packages are missing from cargo's cache; trying again with the network…");
        output = cargo(false)?;
    }
    let failed = || cause::failed(&output, cache, folder);
    if !output.status.success() {
        return Err(failed());
    }
    let executable = executable(&output.stdout, &name).ok_or_else(failed)?;
    say(&format!("Built in {:.1} s.", start.elapsed().as_secs_f64()));
    Ok(executable)
}

/// The name of the package of a program.
fn package(key: &str) -> String {
    format!("lie-{key}")
}

/// The manifest of a program.
fn manifest(template: &Template, name: &str) -> String {
    // Relative, so that no character of the cache's path can break it.
    let sources = format!("../../runtime/{}", runtime::identity());
    template
        .manifest
        .replace("PROGRAM", name)
        .replace("SOURCES", &sources)
}

fn no_cargo(error: &std::io::Error) -> Failure {
    let cargo = toolchain::cargo_name();
    let text = format!("`{}` cannot be started: {error}", cargo.to_string_lossy());
    Failure::surroundings(Message::new(Kind::Toolchain, text).help(
        "`lie run` compiles the system with cargo: install Rust from https://rustup.rs, or set CARGO",
    ))
}

/// The path of the program, from cargo's messages: its folder depends on the configuration.
fn executable(messages: &[u8], name: &str) -> Option<PathBuf> {
    String::from_utf8_lossy(messages)
        .lines()
        .rev()
        .find_map(|line| {
            let message: serde_json::Value = serde_json::from_str(line).ok()?;
            (message["target"]["name"] == name)
                .then(|| message["executable"].as_str().map(PathBuf::from))?
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lock files fit the manifests, and nothing in them is superfluous. After a change of the
    /// dependencies, `LIE_UPDATE_LOCK=1 cargo test -p lie-poisson lock_file` writes them anew. What cargo's
    /// cache does not hold, as `ode_solvers` on a fresh machine, is fetched.
    #[test]
    fn the_lock_files_fit_the_manifests() {
        check_lock(&PLAIN, "src/build/template/Cargo.lock");
        check_lock(&MEASURE, "src/build/template/measure/Cargo.lock");
        check_lock(&BENCH, "src/build/template/bench/Cargo.lock");
    }

    fn check_lock(template: &Template, path: &str) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let update = std::env::var_os("LIE_UPDATE_LOCK").is_some();
        let cache = tempfile::tempdir().unwrap();
        runtime::unpack(cache.path()).unwrap();
        let folder = cache.path().join("programs").join("key");
        std::fs::create_dir_all(&folder).unwrap();
        let write = |file: &str, text: &str| std::fs::write(folder.join(file), text).unwrap();
        write("Cargo.toml", &manifest(template, "lie-key"));
        write("main.rs", "fn main() {}");
        if update {
            write(
                "Cargo.lock",
                &std::fs::read_to_string(root.join("Cargo.lock")).unwrap(),
            );
        } else {
            write("Cargo.lock", template.lock);
        }
        let mut cargo = std::process::Command::new(toolchain::cargo_name());
        cargo
            .args(["metadata", "--format-version", "1"])
            .current_dir(&folder);
        if !update {
            cargo.arg("--locked");
        }
        let output = cargo.output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        if update {
            std::fs::copy(folder.join("Cargo.lock"), root.join(path)).unwrap();
        }
    }
}
