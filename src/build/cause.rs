//! Why cargo failed, from what it said, and what helps.

use std::path::Path;
use std::process::Output;

use lie_syntax::diagnostic::Kind;

use crate::message::{Failure, Message};

/// Writes the table of causes as an enum, what cargo and the compiler say of each, and what helps.
macro_rules! causes {
    ($($(#[doc = $what:literal])* $cause:ident [$($sign:literal),*] $help:literal;)*) => {
        /// Kinds of failures that need different remedies.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Cause {
            $($(#[doc = $what])* $cause,)*
        }

        const SIGNS: &[(Cause, &[&str])] = &[$((Cause::$cause, &[$($sign),*]),)*];

        impl Cause {
            /// What to do, with places for the cache, the manifest of the program and the version of Rust.
            fn form(self) -> &'static str {
                match self {
                    $(Self::$cause => $help,)*
                }
            }
        }
    };
}

// The most telling first.
causes! {
    /// No room on the disk.
    Space ["No space left on device", "Disk quota exceeded", "os error 112"]
        "make room for the cache {cache}, or set LIE_CACHE_DIR to a folder on another disk";
    /// The system ended cargo or the compiler.
    Killed ["signal: 9", "SIGKILL"]
        "the system may have run out of memory: close other programs and try again";
    /// A compiled package of the cache is damaged.
    Damage ["error[E0786]", "found invalid metadata files", "failed to parse rlib"]
        "delete the cache folder {cache} and try again";
    /// The compiler has no standard library for this machine.
    Library ["can't find crate for `core`", "can't find crate for `std`", "target may not be installed"]
        "install the standard library of this target: `rustup target add` with the name above, or \
         the package of your system";
    /// There is no linker, or it fails.
    Linker ["linker `", "linking with `", "link.exe` not found"]
        "install a linker and the C library's development files: a package such as build-essential, \
         gcc or clang, or Xcode's command line tools";
    /// The compiler or cargo is too old for the packages.
    Version ["requires rustc", "is not supported by the following package", "lock file version", "edition2024"]
        "update Rust (`rustup update`): version {version} or later is needed";
    /// The cache, or cargo's own folder, cannot be written.
    Permission ["Permission denied", "Read-only file system", "Access is denied"]
        "check that {cache} and cargo's folder (CARGO_HOME) can be written, or set LIE_CACHE_DIR to another folder";
    /// Something does not compile.
    Code ["could not compile", "failed to run custom build command"]
        "repeat the build with `cargo build --release --manifest-path {manifest}`; where that works, delete the \
         cache folder {cache}; if the failure remains, report it";
    /// Packages are missing and cannot be had.
    Packages [
        "no matching package", "failed to download", "failed to get `", "failed to fetch", "failed to query",
        "Could not resolve", "Could not connect", "Couldn't connect", "network", "--offline", "registry"
    ]
        "where there is a network, run `cargo fetch --locked --manifest-path {manifest}`, then try again";
    /// Something else, before anything was compiled.
    Other []
        "repeat the build with `cargo build --release --manifest-path {manifest}`; where that works, delete the \
         cache folder {cache}; where packages are missing, run `cargo fetch --locked --manifest-path {manifest}`";
}

impl Cause {
    /// The cause, from what stands on stderr.
    pub fn from_output(output: &Output) -> Self {
        let text = String::from_utf8_lossy(&output.stderr);
        let known = |(_, signs): &&(Self, &[&str])| signs.iter().any(|sign| text.contains(sign));
        match SIGNS.iter().find(known) {
            Some((cause, _)) => *cause,
            None if output.status.code().is_none() => Self::Killed,
            None => Self::Other,
        }
    }

    /// Whether the network may help.
    pub fn is_for_want_of_packages(self) -> bool {
        matches!(self, Self::Packages | Self::Other)
    }

    /// What to do; `cache` is the cache folder, `manifest` that of the program.
    fn help(self, cache: &Path, manifest: &Path) -> String {
        self.form()
            .replace("{cache}", &cache.to_string_lossy())
            .replace("{manifest}", &manifest.to_string_lossy())
            .replace("{version}", env!("CARGO_PKG_RUST_VERSION"))
    }
}

/// What cargo said, and what helps.
pub fn failed(output: &Output, cache: &Path, folder: &Path) -> Failure {
    let text = String::from_utf8_lossy(&output.stderr);
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    let first = lines
        .iter()
        .position(|line| line.starts_with("error"))
        .unwrap_or(0);
    let mut shown = lines[first..]
        .iter()
        .take(12)
        .copied()
        .collect::<Vec<_>>()
        .join("\n");
    if shown.is_empty() {
        shown = output.status.to_string();
    }
    let help = Cause::from_output(output).help(cache, &folder.join("Cargo.toml"));
    Failure::surroundings(
        Message::new(Kind::Toolchain, format!("cargo failed:\n{shown}")).help(help),
    )
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::process::ExitStatusExt as _;

    fn output(stderr: &str, status: i32) -> Output {
        Output {
            status: std::process::ExitStatus::from_raw(status),
            stdout: Vec::new(),
            stderr: stderr.as_bytes().to_vec(),
        }
    }

    #[test]
    fn what_cargo_says_and_what_helps() {
        let of = |stderr: &str| {
            let output = output(stderr, 101 << 8);
            let failure = failed(&output, Path::new("/cache"), Path::new("/cache/programs/k"));
            let help = failure.messages[0].help.clone();
            (Cause::from_output(&output), help.unwrap_or_default())
        };
        for (stderr, cause, help) in [
            (
                "error: linker `cc` not found\nerror: could not compile `libm`",
                Cause::Linker,
                "install a linker",
            ),
            (
                "error: could not write output: No space left on device (os error 28)\nerror: could not compile `x`",
                Cause::Space,
                "make room for the cache /cache",
            ),
            (
                "error: failed to open: /cache/target/.cargo-lock\nCaused by:\n  Permission denied (os error 13)",
                Cause::Permission,
                "LIE_CACHE_DIR",
            ),
            (
                "error: rustc 1.70.0 is not supported by the following package:\n  nalgebra@0.35.0 requires rustc 1.89",
                Cause::Version,
                "rustup update",
            ),
            (
                "error: lock file version `4` was found, but this version of Cargo does not understand this lock file",
                Cause::Version,
                "or later",
            ),
            (
                "error[E0463]: can't find crate for `core`\nerror: could not compile `libm`",
                Cause::Library,
                "rustup target add",
            ),
            (
                "error: could not compile `nalgebra` (lib)\nCaused by:\n process didn't exit successfully (signal: 9, SIGKILL: kill)",
                Cause::Killed,
                "memory",
            ),
            (
                "error[E0786]: found invalid metadata files for crate `nalgebra`\nerror: could not compile `lie`",
                Cause::Damage,
                "delete the cache folder /cache",
            ),
            (
                "error[E0425]: cannot find value\nerror: could not compile `lie-1`",
                Cause::Code,
                "/cache/programs/k/Cargo.toml",
            ),
            (
                "error: no matching package named `libm` found",
                Cause::Packages,
                "cargo fetch --locked",
            ),
            (
                "error: something new",
                Cause::Other,
                "delete the cache folder /cache",
            ),
        ] {
            let (found, advice) = of(stderr);
            assert_eq!(found, cause, "{stderr}");
            assert!(advice.contains(help), "{stderr}: {advice}");
            // only what the network can mend speaks of it
            assert_eq!(
                advice.contains("network"),
                cause == Cause::Packages,
                "{advice}"
            );
        }
        assert_eq!(Cause::from_output(&output("", 9)), Cause::Killed);
    }
}
