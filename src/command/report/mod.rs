//! `lie report`: one page of HTML with everything that there is to say about a system.
//!
//! Every section is made by a command that stands above it, and that the reader can repeat: the command calls itself.

mod mathematics;
mod mathml;
mod page;
mod scene;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use lie_codegen::model::Model;
use lie_poisson::plot::surface::Point;

use super::args;
use super::run::outputs;
use crate::build;
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, INVALID, Message, STOPPED};
use crate::output::Destination;
use page::Page;

/// Methods that are compared where none are given: those of them that apply.
const COMPARED: [&str; 7] = [
    "lie-midpoint",
    "midpoint",
    "gauss4",
    "gauss8",
    "splitting4",
    "rk4",
    "dopri5",
];
/// Seconds that a single run of the comparison may take.
const BUDGET: &str = "0.02";

/// Writes the page.
///
/// # Errors
/// Invalid input, and a file that cannot be written; a run that stops early still has its page.
pub fn run(flags: &args::Report) -> Result<u8, Failure> {
    let spec = compiler::load(&flags.spec)?;
    let out = out(flags)?;
    let file = Destination::file(&out).map_err(|error| outputs::unwritable(&out, &error))?;
    let folder =
        tempfile::tempdir().map_err(|error| outputs::unwritable(&std::env::temp_dir(), &error))?;
    let mut report = Report {
        flags,
        spec: &spec,
        folder: folder.path(),
        interrupt: Interrupt::install(),
        page: Page::default(),
        code: 0,
    };
    report.all()?;
    let code = report.interrupt.seen().unwrap_or(report.code);
    let lead = format!(
        "A report by lie {}, made by <code>{}</code>.",
        env!("CARGO_PKG_VERSION"),
        page::escaped(&command_line(flags, &out))
    );
    let page = report.page.finish(&spec.model.name, &lead);
    file.replace(page.as_bytes())
        .map_err(|error| outputs::unwritable(&out, &error))?;
    if !flags.quiet {
        eprintln!("{}: {:.1} kB", out.display(), page.len() as f64 / 1e3);
    }
    Ok(code)
}

/// Where the page goes: beside nothing that it would overwrite.
fn out(flags: &args::Report) -> Result<PathBuf, Failure> {
    let stem = flags.spec.file_stem().unwrap_or_default();
    let default = || PathBuf::from(stem).with_extension("html");
    let out = flags.out.clone().unwrap_or_else(default);
    let extension = out.extension().unwrap_or_default();
    if !extension.eq_ignore_ascii_case("html") && !extension.eq_ignore_ascii_case("htm") {
        let text = format!("`{}` is not the name of an HTML file", out.display());
        let help = format!("write `{}`", out.with_extension("html").display());
        return Err(Message::option("--out", text).help(help).into());
    }
    Ok(out)
}

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

fn command_line(flags: &args::Report, out: &Path) -> String {
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
    shown(&words)
}

/// What the level surface of the Casimir of a three-dimensional system is called.
fn leaf(model: &Model) -> &'static str {
    match model.bracket.algebra() {
        Some(_) => "coadjoint orbit",
        None => "symplectic leaf",
    }
}

/// A command line as a shell takes it.
fn shown(words: &[String]) -> String {
    let quoted = words.iter().map(|word| {
        match word
            .chars()
            .all(|c| c.is_alphanumeric() || "-_./,=:+".contains(c))
        {
            true if !word.is_empty() => word.clone(),
            _ => format!("'{}'", word.replace('\'', r"'\''")),
        }
    });
    format!("lie {}", quoted.collect::<Vec<_>>().join(" "))
}

/// What a command said.
struct Said {
    code: u8,
    out: String,
    error: String,
}

struct Report<'a> {
    flags: &'a args::Report,
    spec: &'a Spec,
    folder: &'a Path,
    interrupt: Interrupt,
    page: Page,
    code: u8,
}

impl Report<'_> {
    fn all(&mut self) -> Result<(), Failure> {
        self.mathematics()?;
        self.trajectory()?;
        if self.flags.method.len() > 1 {
            self.comparison()?;
        }
        if !self.flags.no_bench {
            self.bench()?;
        }
        self.code()
    }

    /// Calls the command with these words; files that they name are in the folder of the report, and are shown by their
    /// names. None where a signal has ended the report.
    fn call(
        &mut self,
        words: &[String],
        files: &[(&str, &str)],
    ) -> Result<Option<(String, Said)>, Failure> {
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
            let text = format!("`{}` cannot be started: {error}", shown(&line));
            Failure::surroundings(
                Message::new(lie_codegen::diagnostic::Kind::Io, text)
                    .help("start it by its full path"),
            )
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
        let said = Said {
            code: code.unwrap_or(crate::message::SURROUNDINGS),
            out: text(&output.stdout),
            error: text(&output.stderr),
        };
        if said.code == INVALID {
            // the command has said what is wrong with the input
            eprint!("{}", said.error);
            return Err(Failure {
                messages: Vec::new(),
                code: INVALID,
            });
        }
        Ok(Some((shown(&line), said)))
    }

    fn spec_word(&self) -> String {
        self.flags.spec.display().to_string()
    }

    fn mathematics(&mut self) -> Result<(), Failure> {
        let words = ["check".to_owned(), self.spec_word()];
        let Some((line, said)) = self.call(&words, &[])? else {
            return Ok(());
        };
        self.page.section("The system");
        let model = &self.spec.model;
        for (title, formulas) in mathematics::of(model) {
            self.page.text(title);
            self.page.formulas(&formulas);
        }
        let text = std::fs::read_to_string(&self.flags.spec).unwrap_or_default();
        self.page.folded("The declaration", &text);
        self.page.section("What is known of it");
        self.page.command(&line);
        // methods and operations are long, and stand at the end
        let (known, rest) = said
            .out
            .split_once("  operations ")
            .unwrap_or((&said.out, ""));
        self.page.preformatted(known);
        self.page.preformatted(&said.error);
        if !rest.is_empty() {
            self.page.folded(
                "Operations of its kernels, and the methods that apply",
                &format!("  operations {rest}"),
            );
        }
        Ok(())
    }

    fn run_words(&self, methods: &[String]) -> Vec<String> {
        let mut words = vec!["run".to_owned(), self.spec_word()];
        words.extend(
            methods
                .iter()
                .flat_map(|method| ["--method".to_owned(), method.clone()]),
        );
        words.extend(of_run(self.flags));
        words
    }

    /// Its rows, components over time, and where it moves.
    fn trajectory(&mut self) -> Result<(), Failure> {
        let methods: Vec<String> = self.flags.method.first().into_iter().cloned().collect();
        let words = self.run_words(&methods);
        let files = [("--out", "rows.csv"), ("--plot", "components.svg")];
        let Some((line, said)) = self.call(&words, &files)? else {
            return Ok(());
        };
        self.page.section("A trajectory");
        self.page.command(&line);
        self.ended(&said);
        self.figure("components.svg");
        self.space(&words)
    }

    /// What a run said, and whether it stopped early.
    fn ended(&mut self, said: &Said) {
        match said.code {
            0 => self.page.preformatted(&said.error),
            code => {
                self.code = self.code.max(code);
                let text = if code == STOPPED {
                    "The run stopped early; what was computed before is shown."
                } else {
                    "The run failed."
                };
                self.page.text(text);
                self.page.stopped(&said.error);
            }
        }
    }

    fn figure(&mut self, file: &str) {
        if let Ok(svg) = std::fs::read_to_string(self.folder.join(file))
            && svg.contains("<svg")
        {
            self.page.picture(&svg);
        }
    }

    /// The orbit of a three-dimensional algebra, the phase portrait of a plane.
    fn space(&mut self, words: &[String]) -> Result<(), Failure> {
        let model = &self.spec.model;
        match model.dimension() {
            3 if model.family.is_none() => {
                if let Some(scene) = self.scene() {
                    let surface = leaf(model);
                    self.page.section(&format!("On its {surface}"));
                    self.page
                        .scene(&scene, &format!("The trajectory on its {surface}"));
                    let cut = if scene["closed"] == true {
                        ""
                    } else {
                        "; it is cut off around the trajectory"
                    };
                    self.page.note(&format!(
                        "The surface is the {surface}, on which the Casimir has the value of the start{cut}. Grey: level \
                         curves of the energy. The dot is where the trajectory starts; what is turned away is pale."
                    ));
                }
                Ok(())
            }
            2 if model.family.is_none() => {
                let picture = [words, &["--picture".to_owned(), "phase".to_owned()]].concat();
                let Some((line, _)) =
                    self.call(&picture, &[("--out", "phase.csv"), ("--plot", "phase.svg")])?
                else {
                    return Ok(());
                };
                self.page.section("Its phase portrait");
                self.page.command(&line);
                self.figure("phase.svg");
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn scene(&self) -> Option<serde_json::Value> {
        let text = std::fs::read_to_string(self.folder.join("rows.csv")).ok()?;
        let mut lines = text.lines();
        let names: Vec<String> = lines
            .next()?
            .split(',')
            .skip(1)
            .take(3)
            .map(str::to_owned)
            .collect();
        let states = lines.map_while(|line| {
            let mut entries = line
                .split(',')
                .skip(1)
                .map(|entry| entry.parse::<f64>().ok().filter(|x| x.is_finite()));
            Some([entries.next()??, entries.next()??, entries.next()??])
        });
        let states: Vec<Point> = states.collect();
        let values = self.spec.model.parameters.iter().map(|parameter| {
            let given = self.flags.param.iter().rev().find_map(|given| {
                let (name, value) = given.split_once('=')?;
                (name.trim() == parameter.name).then(|| {
                    super::run::values::Given::flag("--param", value)
                        .number()
                        .ok()
                })?
            });
            given.unwrap_or(parameter.default_value)
        });
        let values: Vec<f64> = values.collect();
        let system = build::declared(&self.spec.model)?.system(&values).ok()?;
        scene::scene(&system, &names, &states)
    }

    fn comparison(&mut self) -> Result<(), Failure> {
        let words = self.run_words(&self.flags.method);
        let files = [("--out", "runs.csv"), ("--plot", "compare.svg")];
        let Some((line, said)) = self.call(&words, &files)? else {
            return Ok(());
        };
        self.page.section("The methods side by side");
        self.page.command(&line);
        self.ended(&said);
        self.figure("compare.svg");
        Ok(())
    }

    fn bench(&mut self) -> Result<(), Failure> {
        let methods = match self.flags.method.as_slice() {
            [] | [_] => {
                let apply = COMPARED.iter().map(|id| (*id).to_owned());
                let apply = apply.filter(|id| {
                    super::method::find(id).is_ok_and(|choice| {
                        super::method::applies(choice, &self.spec.model).is_ok()
                    })
                });
                let own = self
                    .flags
                    .method
                    .iter()
                    .filter(|own| !COMPARED.contains(&own.as_str()))
                    .cloned();
                apply.chain(own).collect::<Vec<_>>()
            }
            several => several.to_vec(),
        };
        let mut words = vec![
            "bench".to_owned(),
            self.spec_word(),
            "--methods".to_owned(),
            methods.join(","),
        ];
        words.extend(["--budget".to_owned(), BUDGET.to_owned()]);
        for (flag, value) in [
            ("--until", &self.flags.until),
            ("--initial", &self.flags.initial),
        ] {
            words.extend(
                value
                    .iter()
                    .flat_map(|value| [flag.to_owned(), value.clone()]),
            );
        }
        words.extend(
            self.flags
                .param
                .iter()
                .flat_map(|value| ["--param".to_owned(), value.clone()]),
        );
        let Some((line, said)) = self.call(&words, &[("--plot", "bench.svg")])? else {
            return Ok(());
        };
        self.page.section("Error against run time");
        self.page.command(&line);
        self.figure("bench.svg");
        match said.code {
            0 => self.page.folded("The measured values", &said.out),
            _ => self.page.stopped(&said.error),
        }
        Ok(())
    }

    fn code(&mut self) -> Result<(), Failure> {
        let mut words = vec!["expand".to_owned(), self.spec_word()];
        words.extend(
            self.flags
                .method
                .first()
                .into_iter()
                .flat_map(|method| ["--method".to_owned(), method.clone()]),
        );
        let Some((line, said)) = self.call(&words, &[])? else {
            return Ok(());
        };
        self.page.section("The generated code");
        self.page.command(&line);
        match said.code {
            0 => self.page.folded(
                &format!("{} lines of Rust", said.out.lines().count()),
                &said.out,
            ),
            _ => self.page.stopped(&said.error),
        }
        Ok(())
    }
}
