//! The command calls itself, and shows what it called.

use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

use lie_syntax::diagnostic::Kind;

use super::Report;
use crate::command::{args, shell};
use crate::message::{Failure, INVALID, Message, SURROUNDINGS};
use crate::render;

/// The options of a run that were given.
fn of_run(flags: &args::Report) -> Vec<String> {
    let mut words = Vec::new();
    let single = [
        ("--step", &flags.step),
        ("--tol", &flags.tol),
        ("--until", &flags.until),
        ("--initial", &flags.initial),
    ];
    for (flag, value) in single {
        words.extend(
            value
                .iter()
                .flat_map(|value| [flag.to_owned(), value.clone()]),
        );
    }
    for value in &flags.param {
        words.extend(["--param".to_owned(), value.clone()]);
    }
    words
}

/// The command that makes the page.
pub(super) fn command_line(flags: &args::Report, out: &Path) -> String {
    let mut words = vec!["report".to_owned(), flags.spec.display().to_string()];
    words.extend(
        flags
            .method
            .iter()
            .flat_map(|method| ["--method".to_owned(), method.clone()]),
    );
    words.extend(of_run(flags));
    words.extend(flags.no_bench.then(|| "--no-bench".to_owned()));
    words.extend(["--out".to_owned(), out.display().to_string()]);
    shell::line(&words)
}

/// What a command said.
pub(super) struct CommandOutput {
    pub(super) code: u8,
    pub(super) out: String,
    pub(super) error: String,
}

impl Report<'_> {
    /// Calls the command with these words. None where a signal has ended the report.
    ///
    /// # Errors
    /// Invalid input, which the called command has told of.
    pub(super) fn call(
        &mut self,
        words: &[String],
        files: &[(&str, &str)],
    ) -> Result<Option<(String, CommandOutput)>, Failure> {
        let called = self.attempt(words, files)?;
        if let Some((_, said)) = &called
            && said.code == INVALID
        {
            render::say(&said.error);
            return Err(Failure {
                messages: Vec::new(),
                code: INVALID,
            });
        }
        Ok(called)
    }

    /// The same, whatever the command says. Files that the words name are in the folder of the report, and are shown by their names.
    pub(super) fn attempt(
        &mut self,
        words: &[String],
        files: &[(&str, &str)],
    ) -> Result<Option<(String, CommandOutput)>, Failure> {
        if self.interrupt.seen().is_some() {
            return Ok(None);
        }
        let mut all: Vec<OsString> = words.iter().map(OsString::from).collect();
        let mut line = words.to_vec();
        for (flag, file) in files {
            all.extend([
                OsString::from(flag),
                self.folder.join(file).into_os_string(),
            ]);
            line.extend([(*flag).to_owned(), (*file).to_owned()]);
        }
        let failed = |error: &std::io::Error| {
            let text = format!("`{}` cannot be started: {error}", shell::line(&line));
            Failure::surroundings(Message::new(Kind::Io, text).help("start it by its full path"))
        };
        let own = std::env::current_exe().map_err(|error| failed(&error))?;
        let output = self
            .interrupt
            .build(Command::new(own).args(&all))
            .map_err(|error| failed(&error))?;
        if self.interrupt.seen().is_some() {
            return Ok(None);
        }
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let code = output
            .status
            .code()
            .and_then(|code| u8::try_from(code).ok());
        let said = CommandOutput {
            code: code.unwrap_or(SURROUNDINGS),
            out: text(&output.stdout),
            error: text(&output.stderr),
        };
        Ok(Some((shell::line(&line), said)))
    }

    pub(super) fn spec_word(&self) -> String {
        self.flags.spec.display().to_string()
    }

    pub(super) fn run_words(&self, methods: &[String]) -> Vec<String> {
        let mut words = vec!["run".to_owned(), self.spec_word()];
        words.extend(
            methods
                .iter()
                .flat_map(|method| ["--method".to_owned(), method.clone()]),
        );
        words.extend(of_run(self.flags));
        words
    }
}
