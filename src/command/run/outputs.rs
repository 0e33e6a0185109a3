//! Where a run writes.

use std::io::{self, IsTerminal as _};
use std::path::Path;

use clap::ValueEnum as _;

use super::picture::Form;
use crate::command::args;
use crate::command::files::Inputs;
use crate::message::{Failure, Message};
use lie_output::{Destination, Format};

/// The form of the output, and whether the names of files make sense.
///
/// # Errors
/// `option` for an extension of another form, and npy on a terminal.
pub fn format(flags: &args::Run) -> Result<Format, Failure> {
    if let Some(plot) = &flags.plot {
        super::picture::form("--plot", plot)?;
    }
    let format = match (flags.format, flags.out.as_deref()) {
        (Some(format), _) => format,
        (None, Some(out)) => by_name(out)?,
        (None, None) => Format::Csv,
    };
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

/// The form that the extension names; CSV where there is none.
fn by_name(path: &Path) -> Result<Format, Failure> {
    let Some(extension) = path.extension() else {
        return Ok(Format::Csv);
    };
    let named = extension.to_str().and_then(|text| {
        let forms = Format::value_variants().iter();
        forms.copied().find(|form| {
            form.to_possible_value()
                .is_some_and(|value| value.matches(text, true))
        })
    });
    named.ok_or_else(|| {
        let text = format!("rows cannot be written in the form `.{}`", extension.display());
        let help = "name the file .csv, .json, .jsonl or .npy, or say which of them it holds, such as `--format csv`";
        Message::option("--out", text).help(help).into()
    })
}

/// Tables of measurements are CSV.
///
/// # Errors
/// `option` for a name of another form.
pub fn table(flag: &str, path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    match path.extension() {
        Some(extension) if !extension.eq_ignore_ascii_case("csv") => {
            let text = format!(
                "`{}` is not the name of a CSV file, and the table is CSV",
                path.display()
            );
            let name = path.with_extension("csv");
            let message = Message::option(flag, text);
            Err(message.help(format!("write `{}`", name.display())).into())
        }
        _ => Ok(()),
    }
}

/// Pictures of measurements are SVG, whatever the name says.
///
/// # Errors
/// `option` for a name of another format.
pub fn picture(flag: &str, path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    match path.extension() {
        Some(extension) if !extension.eq_ignore_ascii_case("svg") => {
            let text = format!(
                "`{}` is not the name of an SVG file, and pictures are SVG",
                path.display()
            );
            let name = path.with_extension("svg");
            let message = Message::option(flag, text);
            Err(message.help(format!("write `{}`", name.display())).into())
        }
        _ => Ok(()),
    }
}

/// Opened before anything runs. Where nothing runs, everything is left as it was.
pub struct Outputs {
    /// Takes the rows.
    pub rows: Destination,
    /// Takes the picture.
    pub plot: Option<(Form, Destination)>,
}

impl Outputs {
    /// Opens what the flags name.
    ///
    /// # Errors
    /// `option` for an input, with exit code 2; `io`, with exit code 1.
    pub fn open(flags: &args::Run, inputs: &Inputs) -> Result<Self, Failure> {
        let (out, plot) = (flags.out.as_deref(), flags.plot.as_deref());
        if out.is_none() {
            inputs.spare_from_stdout()?;
        }
        let form = plot.map(|plot| super::picture::form("--plot", plot));
        let form = form.transpose()?;
        let [rows, plot] = inputs.open_both(out, plot)?;
        let device = rows.as_ref().filter(|rows| !rows.is_regular());
        if let (Some(path), Some(_), Some(_)) = (out, device, &flags.checkpoint) {
            let text = format!("`{}` is no file that could be gone on with", path.display());
            let message = Message::option("--checkpoint", text);
            return Err(message.help("give `--out` the name of a file").into());
        }
        Ok(Self {
            rows: rows.unwrap_or_else(Destination::stdout),
            plot: form.zip(plot),
        })
    }
}

/// Rows that cannot be written any more.
pub fn writing_failed(path: Option<&Path>, error: &io::Error) -> Failure {
    let what = match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "make room",
        io::ErrorKind::FileTooLarge => "raise the limit on the size of files (`ulimit -f`)",
        _ => "check that the disk is still there",
    };
    let (path, help) = match path {
        Some(path) => {
            let help = format!("{what}, or give another file; it holds the whole rows so far");
            (path, help)
        }
        None => (
            Path::new("stdout"),
            format!("{what}, or write to a file with `--out`"),
        ),
    };
    Failure::surroundings(Message::io(path, format!("writing failed: {error}")).help(help))
}
