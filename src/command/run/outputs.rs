//! Where a run writes.

use std::io::{self, IsTerminal as _};
use std::path::Path;

use crate::command::args::{self, Format};
use crate::message::{Failure, Message};
use crate::output::Destination;

/// The form of the output, and whether the files make sense.
///
/// # Errors
/// `option` for files that would overwrite one another, and for npy on a terminal.
pub fn format(flags: &args::Run, spec: &Path) -> Result<Format, Failure> {
    let same = |a: &Path, b: &Path| {
        a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
    };
    for (flag, path) in [("--out", &flags.out), ("--plot", &flags.plot)] {
        if path.as_deref().is_some_and(|path| same(path, spec)) {
            let message = Message::option(flag, "this is the spec, which would be overwritten");
            return Err(message.help("give another file").into());
        }
    }
    if let (Some(out), Some(plot)) = (&flags.out, &flags.plot)
        && same(out, plot)
    {
        let message = Message::option("--plot", "rows and picture cannot go to the same file");
        return Err(message.help("give another file").into());
    }
    picture("--plot", flags.plot.as_deref())?;
    let by_name = |path: &Path| match path.extension()?.to_str()? {
        "json" => Some(Format::Json),
        "npy" => Some(Format::Npy),
        _ => None,
    };
    let format = flags
        .format
        .or_else(|| by_name(flags.out.as_deref()?))
        .unwrap_or(Format::Csv);
    if format == Format::Npy && flags.out.is_none() && io::stdout().is_terminal() {
        let message = Message::option(
            "--format",
            "npy is binary and does not belong on a terminal",
        );
        return Err(message
            .help("add `--out FILE.npy`, or redirect the output")
            .into());
    }
    Ok(format)
}

/// Pictures are SVG, whatever the name says.
///
/// # Errors
/// `option` for a name of another format.
pub fn picture(flag: &str, path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    match path.extension() {
        Some(extension) if !extension.eq_ignore_ascii_case("svg") => {
            let text = format!(
                "`{}` names no SVG file, and pictures are SVG",
                path.display()
            );
            let name = path.with_extension("svg");
            let message = Message::option(flag, text);
            Err(message.help(format!("write `{}`", name.display())).into())
        }
        _ => Ok(()),
    }
}

/// Opened before anything runs, so that a long run does not end in front of a closed door.
pub struct Outputs {
    /// Takes the rows.
    pub rows: Destination,
    /// Takes the picture.
    pub plot: Option<Destination>,
}

impl Outputs {
    /// Opens what the flags name.
    ///
    /// # Errors
    /// `io`, with exit code 1.
    pub fn open(flags: &args::Run) -> Result<Self, Failure> {
        let open = |path: &Path| Destination::file(path).map_err(|error| unwritable(path, &error));
        let rows = match &flags.out {
            Some(path) => open(path)?,
            None => Destination::stdout(),
        };
        match flags.plot.as_deref().map(open).transpose() {
            Ok(plot) => Ok(Self { rows, plot }),
            Err(failure) => {
                rows.discard();
                Err(failure)
            }
        }
    }

    /// Leaves everything as it was.
    pub fn discard(self) {
        self.rows.discard();
        if let Some(plot) = self.plot {
            plot.discard();
        }
    }
}

fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let message = Message::io(path, format!("cannot be written: {error}"));
    Failure::surroundings(message.help("give a file in a folder that exists and can be written"))
}
