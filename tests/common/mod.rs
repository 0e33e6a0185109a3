//! Runs the `lie` command as a user would.

// Each test file uses its own part of this.
#![allow(dead_code)]

pub mod callgrind;
pub mod catalogue;
pub mod markdown;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// What a call of `lie` did.
#[derive(Debug)]
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }
}

impl Run {
    /// Fails unless the call succeeded.
    #[track_caller]
    pub fn ok(self) -> Self {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
        self
    }

    /// Fails unless there is an error of this kind at this place, with help and exit code 2.
    #[track_caller]
    pub fn error(self, kind: &str, place: &str) -> Self {
        assert_eq!(self.code, Some(2), "{}", self.stderr);
        self.says(kind, place)
    }

    /// Fails unless there is an error of this kind at this place, with help.
    #[track_caller]
    pub fn says(self, kind: &str, place: &str) -> Self {
        let title = format!("error[{kind}]: ");
        assert!(
            self.stderr.lines().any(|line| line.starts_with(&title)),
            "no {title}\n{}",
            self.stderr
        );
        let arrow = format!("--> {place}");
        let found = self
            .stderr
            .lines()
            .any(|line| line.trim_start().starts_with(&arrow));
        assert!(found, "no {arrow}\n{}", self.stderr);
        assert!(
            self.stderr.lines().any(|line| line.starts_with("help: ")),
            "no help\n{}",
            self.stderr
        );
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        self
    }

    /// The header and the numbers of a CSV.
    #[track_caller]
    pub fn csv(&self) -> (Vec<String>, Vec<Vec<f64>>) {
        csv(&self.stdout)
    }
}

/// The header and the numbers of a CSV.
#[track_caller]
pub fn csv(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let header = lines
        .next()
        .unwrap_or_default()
        .split(',')
        .map(str::to_owned)
        .collect();
    let number = |field: &str| {
        field
            .parse::<f64>()
            .unwrap_or_else(|_| panic!("`{field}` in {text}"))
    };
    (
        header,
        lines
            .map(|line| line.split(',').map(number).collect())
            .collect(),
    )
}

/// The cache of built programs that the tests of this target folder share.
pub fn cache() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("lie-cache")
}

/// A call of `lie` in the root of the repository.
pub fn command<I: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = I>) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lie"));
    command
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::null());
    command.env("LIE_CACHE_DIR", cache());
    command
}

/// Calls `lie` with arguments that are separated by blanks.
#[track_caller]
pub fn lie(arguments: &str) -> Run {
    command(arguments.split_whitespace())
        .output()
        .expect("lie starts")
        .into()
}

/// A folder that vanishes.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Writes a spec of the free rigid body, with changes to its JSON, and returns its path.
pub fn spec(folder: &Path, changes: impl FnOnce(&mut serde_json::Value)) -> PathBuf {
    let mut spec = serde_json::json!({
        "format": 1,
        "name": "Body",
        "algebra": { "basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"] },
        "state": ["x", "y", "z"],
        "parameters": { "I1": 2, "I2": 1, "I3": "2/3" },
        "hamiltonian": "x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)",
        "casimirs": ["C = x^2 + y^2 + z^2"],
        "initial": ["cos(11/10)", "3/10", "sin(11/10)"],
    });
    changes(&mut spec);
    let path = folder.join("body.json");
    std::fs::write(&path, format!("{spec:#}")).expect("the spec is written");
    path
}
