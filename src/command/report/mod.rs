//! `lie report`: one page of HTML with everything that there is to say about a system.
//!
//! Every section is made by a command that stands above it, and that the reader can repeat: the command calls itself.

mod call;
mod mathematics;
mod mathml;
mod page;
mod scene;
mod sections;

use std::path::{Path, PathBuf};

use lie_in_process::request::{self, Parameter, Point, Request, Value};

use super::args;
use super::files::{Inputs, unwritable};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};
use crate::render;
use call::command_line;
use page::Page;

/// Writes the page.
///
/// # Errors
/// Invalid input, and a file that cannot be written; a run that stops early still has its page.
pub fn run(flags: &args::Report) -> Result<u8, Failure> {
    let spec = compiler::load(&flags.spec)?;
    let parameters = flags.param.iter().cloned().map(Parameter::Written);
    let start = Request {
        param: parameters.collect(),
        initial: flags.initial.clone().map(Value::Text),
        ..Request::default()
    };
    let start = request::start(&spec, &start).map_err(Failure::invalid)?;
    let out = out(flags)?;
    let inputs = Inputs::of_spec(&flags.spec, &spec);
    let file = inputs.open("--out", &out)?;
    let folder = tempfile::tempdir().map_err(|error| unwritable(&std::env::temp_dir(), &error))?;
    let mut report = Report {
        flags,
        spec: &spec,
        start,
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
        .map_err(|error| unwritable(&out, &error))?;
    if !flags.quiet {
        let size = page.len() as f64 / 1e3;
        render::say(&format!("{}: {size:.1} kB", out.display()));
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

struct Report<'a> {
    flags: &'a args::Report,
    spec: &'a Spec,
    start: Point,
    folder: &'a Path,
    interrupt: Interrupt,
    page: Page,
    code: u8,
}

impl Report<'_> {
    /// All sections, in their order.
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
}
