//! Golden files: generated code kept in a repository, compared whenever the tests run.
//!
//! ```no_run
//! # use lie_codegen::golden::Golden;
//! // in tests/golden.rs of a crate that keeps its systems in specs/
//! let mut golden = Golden::new("tests/golden");
//! golden.spec("specs/heavy_top.json", &["lie-midpoint", "gauss4"]);
//! golden.source("src/bodies.rs"); // every `lie_poisson! { … }` in it
//! golden.check().unwrap();
//! ```
//!
//! With the environment variable `LIE_UPDATE_GOLDEN=1` the files are written instead; the change
//! is then seen in the version control. A file of the folder that no system claims any more is an
//! error, and so is a file that is missing.

mod source;

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use crate::compile::{compile_spec, declared_choices, expand_on, with_options};
use crate::methods::Choice;
use crate::plan::plan;
use crate::print::Surface;
use crate::structure::Structure;
use lie_syntax::ast::Runtime;
use lie_syntax::characters::visible;
use lie_syntax::diagnostic::{Diagnostic, MOST_SHOWN, Origin, not_shown};
use lie_syntax::front::line_column;
use source::Declared;

/// The environment variable that makes [`Golden::check`] write instead of compare.
pub const UPDATE: &str = "LIE_UPDATE_GOLDEN";

/// A folder of golden files and what should be in it.
#[derive(Debug)]
pub struct Golden {
    folder: PathBuf,
    files: BTreeMap<String, String>,
    problems: Vec<String>,
    runtime: Runtime,
}

/// What is wrong with a folder of golden files.
#[derive(Clone, PartialEq, Eq)]
pub struct Stale(pub Vec<String>);

/// What stands before the remedy of a problem that has one of its own.
const REMEDY: &str = "\nhelp: ";

/// What `unwrap` prints: as for people, with the remedy.
impl fmt::Debug for Stale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the golden files are stale\n{self}")
    }
}

impl fmt::Display for Stale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.0.join("\n"))?;
        // A spec that is refused brings its own remedy, and nothing is written before it is mended.
        if self.0.iter().any(|problem| problem.contains(REMEDY)) {
            return f.write_str("help: mend what is refused first; no file is written before");
        }
        write!(
            f,
            "help: set {UPDATE}=1 to write the files anew, then read the change before you commit it"
        )
    }
}

impl std::error::Error for Stale {}

impl Golden {
    /// The golden files of a folder (relative to the working directory of the test).
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
            files: BTreeMap::new(),
            problems: Vec::new(),
            runtime: Runtime::default(),
        }
    }

    /// The path at which the generated code of the systems that follow finds the runtime, such as
    /// `my_crate::lie_runtime`, where it is not `::lie_runtime`.
    pub fn runtime(&mut self, path: &str) -> &mut Self {
        match Runtime::parse(path) {
            Ok(runtime) => self.runtime = runtime,
            Err(no_path) => self.problems.push(format!(
                "{no_path}{REMEDY}write the path at which the runtime is re-exported, such as my_crate::lie_runtime"
            )),
        }
        self
    }

    /// Adds the generated code of a spec file with fused code for the methods (every option of an
    /// id that applies). The golden file bears the name of the spec.
    pub fn spec(&mut self, path: impl AsRef<Path>, methods: &[&str]) -> &mut Self {
        let runtime = self.runtime.clone();
        self.of_spec(path.as_ref(), Some(methods), "rs", |structure, choices| {
            code(structure, choices, runtime)
        })
    }

    /// Adds the generated code of every `lie_poisson! { … }` of a Rust source file, with the methods that each declares. The
    /// golden file bears the name of the system, or that of the spec which the macro names.
    pub fn source(&mut self, path: impl AsRef<Path>) -> &mut Self {
        match source::declarations(path.as_ref()) {
            Ok(declared) => {
                for declared in declared {
                    match declared {
                        Declared::Code(name, code) => self.text(&format!("{name}.rs"), code),
                        Declared::Spec(path) => {
                            let runtime = self.runtime.clone();
                            self.of_spec(Path::new(&path), None, "rs", |structure, choices| {
                                code(structure, choices, runtime)
                            })
                        }
                    };
                }
            }
            Err(problem) => self.problems.push(problem),
        }
        self
    }

    /// Adds the plan of that code: formulas, operation counts and a digest of each kernel, which changes with its
    /// operations. It is short enough to be reviewed; the file ends in `.plan`.
    pub fn plan(&mut self, path: impl AsRef<Path>, methods: &[&str]) -> &mut Self {
        self.of_spec(
            path.as_ref(),
            Some(methods),
            "plan",
            |structure, choices| plan(structure, choices).to_string(),
        )
    }

    fn of_spec(
        &mut self,
        path: &Path,
        methods: Option<&[&str]>,
        extension: &str,
        write: impl FnOnce(&Structure, &[Choice]) -> String,
    ) -> &mut Self {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        match read(path, methods) {
            Ok((structure, choices)) => {
                self.text(&format!("{stem}.{extension}"), write(&structure, &choices))
            }
            Err(problem) => {
                self.problems.push(problem);
                self
            }
        }
    }

    /// Adds any text under a file name.
    pub fn text(&mut self, file: &str, text: String) -> &mut Self {
        if self.files.insert(file.to_string(), text).is_some() {
            self.problems
                .push(format!("{file}: two systems claim this file"));
        }
        self
    }

    /// Compares the folder with what was added, or writes it if the update switch is set.
    ///
    /// # Errors
    /// Every file that differs (with its first differing line), is missing, or is left over.
    pub fn check(&self) -> Result<(), Stale> {
        self.run(std::env::var_os(UPDATE).is_some_and(|value| value == "1"))
    }

    fn run(&self, update: bool) -> Result<(), Stale> {
        let mut problems = self.problems.clone();
        if update && problems.is_empty() {
            if let Err(error) = self.write() {
                problems.push(format!("{}: {error}", self.folder.display()));
            }
        } else {
            problems.extend(self.compare());
        }
        if problems.is_empty() {
            Ok(())
        } else {
            Err(Stale(problems))
        }
    }

    fn write(&self) -> std::io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        for stale in self.left_over() {
            std::fs::remove_file(self.folder.join(stale))?;
        }
        for (file, text) in &self.files {
            std::fs::write(self.folder.join(file), text)?;
        }
        Ok(())
    }

    fn compare(&self) -> Vec<String> {
        let mut problems = Vec::new();
        for (file, text) in &self.files {
            let path = self.folder.join(file);
            match std::fs::read_to_string(&path) {
                Err(error) => problems.push(format!("{}: {error}", path.display())),
                Ok(golden) if golden != *text => problems.push(difference(&path, &golden, text)),
                Ok(_) => {}
            }
        }
        problems.extend(self.left_over().into_iter().map(|file| {
            format!(
                "{}: no system claims this file any more",
                self.folder.join(file).display()
            )
        }));
        problems
    }

    fn left_over(&self) -> Vec<String> {
        let Ok(entries) = std::fs::read_dir(&self.folder) else {
            return Vec::new();
        };
        let mut names: Vec<String> = entries
            .filter_map(Result::ok)
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .filter(|name| {
                let golden = name.ends_with(".rs") || name.ends_with(".plan");
                golden && name != "mod.rs" && !self.files.contains_key(name)
            })
            .collect();
        names.sort();
        names
    }
}

/// The generated code of a system that finds the runtime in some place.
fn code(structure: &Structure, choices: &[Choice], runtime: Runtime) -> String {
    let surface = Surface {
        runtime,
        ..Surface::new(structure)
    };
    expand_on(structure, choices, &surface)
}

/// A diagnostic with its remedy.
fn message(place: &str, d: &Diagnostic) -> String {
    let help = d.help.as_deref().unwrap_or("correct the declaration");
    let text = format!("{place}: error[{}]: {}{REMEDY}{help}", d.kind, d.message);
    visible(&text).into_owned()
}

/// The checked system of a spec file, and the methods with every option that applies; by default those that it declares.
fn read(path: &Path, methods: Option<&[&str]>) -> Result<(Structure, Vec<Choice>), String> {
    let place = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| format!("{place}: {error}"))?;
    let structure = compile_spec(&text).map_err(|diagnostics| {
        let errors = diagnostics.iter().filter(|d| !d.warning);
        let rest = not_shown(errors.clone().count());
        let messages: Vec<String> = errors
            .take(MOST_SHOWN)
            .map(|d| {
                let place = match d.origin {
                    Some(Origin::Text { start, .. }) => {
                        let (line, column) = line_column(&text, start);
                        format!("{place}:{line}:{column}")
                    }
                    _ => place.to_string(),
                };
                message(&place, d)
            })
            .chain(rest)
            .collect();
        messages.join("\n")
    })?;
    let Some(methods) = methods else {
        let choices = declared_choices(&structure);
        return Ok((structure, choices));
    };
    let choices = methods.iter().map(|id| {
        Choice::from_id(id)
            .map_err(|unusable| format!("{place}: {}{REMEDY}{}", unusable.message, unusable.help))
    });
    let choices: Vec<Choice> = choices.collect::<Result<_, _>>()?;
    let choices = with_options(&structure, &choices);
    Ok((structure, choices))
}

fn difference(path: &Path, golden: &str, new: &str) -> String {
    let mut lines = golden.lines().zip(new.lines()).enumerate();
    let (number, was, is) = match lines.find(|(_, (a, b))| a != b) {
        Some((number, (a, b))) => (number + 1, a, b),
        None => {
            let number = golden.lines().count().min(new.lines().count());
            let at = |text: &'_ str| -> String {
                text.lines()
                    .nth(number)
                    .unwrap_or("(end of file)")
                    .to_string()
            };
            return format!(
                "{}:{}: was `{}`, is `{}`",
                path.display(),
                number + 1,
                at(golden),
                at(new)
            );
        }
    };
    format!(
        "{}:{number}: was `{}`, is `{}`",
        path.display(),
        was.trim(),
        is.trim()
    )
}

#[cfg(test)]
mod tests;
