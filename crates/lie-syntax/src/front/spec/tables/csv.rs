//! The points of a table from a CSV file: argument and value in each line, decimal numbers taken exactly.

use std::path::Path;

use crate::ast::{Expr, ExprKind};
use crate::diagnostic::{Diagnostic, Kind, Origin};
use crate::front::tables::Point;
use crate::front::{file, number};
use lie_symbolic::exact::Rational;

/// What a line should be.
const LINE: &str = "write an argument, a comma and a value in each line, such as `0.5,1.25`";

/// The points of the file at `path`, relative to `folder`. Blank lines, and those that begin with `#`, do not count; the
/// first of the others may be names of the columns.
///
/// # Errors
/// At the place of the path in the spec; mistakes in the file name it and the line.
pub fn read(path: &str, origin: Origin, folder: Option<&Path>) -> Result<Vec<Point>, Diagnostic> {
    let refuse = |kind, message: String, help: &str| {
        Err(Diagnostic::new(kind, origin, message).help(help.to_owned()))
    };
    let Some(folder) = folder else {
        let message = format!("`{}` cannot be read here", path.escape_debug());
        let help = "give the points as a list, as in `[[0, 0], [1, 0.5]]`; only the command `lie` reads tables from files";
        return refuse(Kind::Io, message, help);
    };
    if !Path::new(path)
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("csv"))
    {
        let message = format!("`{}` is no CSV file by its name", path.escape_debug());
        let help =
            "write the points to a file whose name ends in .csv, or as a list `[[0, 0], [1, 0.5]]`";
        return refuse(Kind::Schema, message, help);
    }
    let bytes = match file::read(&folder.join(path)) {
        Ok(bytes) => bytes,
        Err(error) => {
            let message = format!(
                "the table `{}` cannot be read: {error}",
                path.escape_debug()
            );
            let help = "give the path of a CSV file, relative to the folder of the spec";
            return refuse(Kind::Io, message, help);
        }
    };
    if bytes.len() > file::MAX_BYTES {
        let message = format!("{path} has more than {} MB", file::MAX_BYTES >> 20);
        return refuse(Kind::Limit, message, "leave some of its points out");
    }
    match str::from_utf8(&bytes) {
        Ok(text) => points(path, text.trim_start_matches('\u{feff}'), origin),
        Err(_) => refuse(
            Kind::Schema,
            format!("{path} is not UTF-8"),
            "save it as UTF-8",
        ),
    }
}

/// The points in the text of a file.
fn points(path: &str, text: &str, origin: Origin) -> Result<Vec<Point>, Diagnostic> {
    let mut last: Option<Rational> = None;
    let mut points = Vec::new();
    let lines = text.lines().map(str::trim).zip(1..);
    let lines = lines.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
    for (place, (line, at)) in lines.enumerate() {
        let refuse = |kind, message: &str, help: &str| {
            let message = format!("{path}:{at}: {message}");
            Err(Diagnostic::new(kind, origin, message).help(help.to_owned()))
        };
        let Some((x, y)) = line.split_once(',').filter(|(_, y)| !y.contains(',')) else {
            let count = line.split(',').count();
            let message = format!("the line has {count} columns, not two");
            return refuse(Kind::Schema, &message, LINE);
        };
        if place == 0 && is_name(x) && is_name(y) {
            continue;
        }
        let (x, y) = match (decimal(x.trim()), decimal(y.trim())) {
            (Ok(x), Ok(y)) => (x, y),
            (Err(mistake), _) | (_, Err(mistake)) => {
                return refuse(mistake.kind, &mistake.message, &mistake.help);
            }
        };
        if last.as_ref().is_some_and(|last| *last >= x) {
            let help = "sort the lines by their first number, each of which stands once";
            return refuse(Kind::Number, "the arguments do not ascend here", help);
        }
        last = Some(x.clone());
        let number = |value| Expr {
            kind: ExprKind::Number(value),
            origin,
        };
        points.push((number(x), number(y), origin));
    }
    Ok(points)
}

/// A decimal number, which may have a sign.
fn decimal(text: &str) -> Result<Rational, number::Mistake> {
    let plain = text.strip_prefix('+');
    let plain = plain.filter(|digits| !digits.starts_with('-'));
    number::decimal(plain.unwrap_or(text))
}

/// Whether it names a column. What another program takes for a number (`nan`, `inf`) does not.
fn is_name(text: &str) -> bool {
    let text = text.trim();
    text.starts_with(|c: char| c.is_alphabetic() || c == '"') && text.parse::<f64>().is_err()
}
