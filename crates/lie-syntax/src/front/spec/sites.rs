//! The coefficients of a family that have a value for each site.

use std::path::Path;

use super::quantity;
use crate::ast::{Expr, Name, SiteData, SiteValues};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::declaration::family;
use crate::front::json::{Type, Value};
use crate::front::object::{Object, list, string};
use crate::front::schema::PerSite;
use crate::front::{file, npy, prose};
use lie_core::lattice::AXES;

/// The values and how many there are along each axis.
type Read = (SiteValues, Vec<usize>);

/// The names of the columns of bonds, which may stand above them.
const BOND: [&str; 3] = ["i", "j", "value"];

/// What to do about a file that cannot be read, one without numbers, and a number that is not finite.
struct Help {
    list: &'static str,
    lines: &'static str,
    finite: &'static str,
}

const OF_SITES: Help = Help {
    list: "give the values as a list, `{\"values\": [1, 2, 3]}`; only the command `lie` and the macro read files",
    lines: "write a number in each line, of a lattice a row of numbers with commas, the rows of one layer after those of another",
    finite: "give each site a finite number",
};

const OF_BONDS: Help = Help {
    list: "give rows, `[[0, 1, 1], [1, 5, \"1/2\"]]`; only the command `lie` and the macro read files",
    lines: "write `i,j,value` in each line",
    finite: "give each bond two sites and a finite number",
};

/// What to write.
const FORMS: &str = "write a value for each site, `{\"values\": [1, 2, 3]}`, or name a file, `{\"file\": \"B.npy\"}`";

/// Whether a parameter has a value for each site.
pub fn is_list(value: Value<'_>) -> bool {
    let mut ignored = Report::new();
    let found = match value.kind() {
        Type::Array => true,
        Type::Object => value.members(&mut ignored).iter().any(|member| {
            let of_many = ["values", "file"].contains(&&*member.key.text);
            of_many || member.value.kind() == Type::Array
        }),
        _ => false,
    };
    ignored.ignore("the value is read again");
    found
}

/// Reads `[1, 2]`, `{"values": [1, 2]}` or `{"file": "B.npy"}`, the path relative to a folder.
pub fn read(
    value: Value<'_>,
    what: &str,
    name: Option<Name>,
    folder: Option<&Path>,
    report: &mut Report,
) -> Option<SiteData> {
    if value.kind() == Type::Array {
        let (values, shape) = written(value, what, report)?;
        return Some(SiteData {
            name: name?,
            values,
            shape,
            origin: value.head(),
            unit: None,
            description: None,
        });
    }
    let object = Object::read(value, what, PerSite::KEYS, report)?;
    object.require(what, PerSite::REQUIRED, report);
    let mut text = |key: &str, place: &str| string(object.get(key)?, place, report);
    let (unit, description) = (text("unit", "`unit`"), text("description", "`description`"));
    let unit = unit.map(|text| prose::inline(&text, "the unit", report));
    let description = description.map(|text| prose::paragraph(&text, "the description", report));
    let (origin, (values, shape)) = match (object.get("values"), object.get("file")) {
        (Some(values), None) => (values.head(), written(values, what, report)?),
        (None, Some(path)) => {
            let text = string(path, "`file`", report)?;
            let read = of_file(&text.text, text.extent(), folder, &OF_SITES);
            let read = read.map_err(|mistake| report.push(mistake)).ok()?;
            (text.extent(), read)
        }
        (one, other) => {
            let message = match one.and(other) {
                Some(_) => format!("{what} has both `values` and `file`"),
                None => format!("{what} has a list, and neither `values` nor `file`"),
            };
            report.push(Diagnostic::new(Kind::Schema, value.head(), message).help(FORMS));
            return None;
        }
    };
    Some(SiteData {
        name: name?,
        values,
        shape,
        origin,
        unit,
        description,
    })
}

/// Reads bonds: `"FILE.csv"`, the path relative to a folder, or `[[0, 1, "1/2"]]`.
pub fn bonds(value: Value<'_>, folder: Option<&Path>, report: &mut Report) -> Option<SiteData> {
    let what = "`bonds`";
    let (origin, (values, shape)) = match value.kind() {
        Type::String => {
            let text = string(value, what, report)?;
            let read = of_file(&text.text, text.extent(), folder, &OF_BONDS);
            (
                text.extent(),
                read.map_err(|mistake| report.push(mistake)).ok()?,
            )
        }
        _ => (value.head(), written(value, what, report)?),
    };
    family::bonds(values, shape, origin, report)
}

/// A list, or of a lattice a list of rows of one length, or of layers of such rows.
fn written(value: Value<'_>, what: &str, report: &mut Report) -> Option<Read> {
    let (mut all, elements) = (Vec::new(), list(value, what, report)?);
    let shape = nested(elements, what, AXES, &mut all, report)?;
    Some((SiteValues::Written(all), shape))
}

/// Adds the values of lists within lists, at most so deep; how many there are along each axis.
fn nested(
    elements: Vec<Value<'_>>,
    what: &str,
    depth: usize,
    all: &mut Vec<Expr>,
    report: &mut Report,
) -> Option<Vec<usize>> {
    let count = elements.len();
    let is_list = |element: &Value<'_>| element.kind() == Type::Array;
    if depth == 1 || !elements.iter().any(is_list) {
        all.extend(entries(elements, what, report)?);
        return Some(vec![count]);
    }
    let mut shape = Vec::new();
    for row in elements {
        let of_row = list(row, &format!("a row of {what}"), report)?;
        let of_row = nested(of_row, what, depth - 1, all, report)?;
        if shape.is_empty() {
            shape.clone_from(&of_row);
        }
        if shape != of_row {
            let (message, help) = family::ragged(what, [&shape, &of_row]);
            report.push(Diagnostic::new(Kind::Schema, row.head(), message).help(help));
            return None;
        }
    }
    shape.insert(0, count);
    Some(shape)
}

fn entries(elements: Vec<Value<'_>>, what: &str, report: &mut Report) -> Option<Vec<Expr>> {
    let what = format!("a value of {what}");
    let entries = elements
        .into_iter()
        .map(|value| quantity(value, &what, None, report));
    entries.collect::<Vec<_>>().into_iter().collect()
}

/// The numbers of a file in NumPy's format, or of one with a number in each line, of a lattice a row, layer after layer.
fn of_file(
    path: &str,
    origin: Origin,
    folder: Option<&Path>,
    help: &Help,
) -> Result<Read, Diagnostic> {
    let shown = path.escape_debug();
    let refuse = |kind, message: String, help: &str| {
        Err(Diagnostic::new(kind, origin, message).help(help.to_owned()))
    };
    let Some(folder) = folder else {
        let message = format!("`{shown}` cannot be read here");
        return refuse(Kind::Io, message, help.list);
    };
    let bytes = match file::read(&folder.join(path)) {
        Ok(bytes) => bytes,
        Err(error) => {
            let message = format!("the values `{shown}` cannot be read: {error}");
            let help = "give the path of a file, relative to the folder of the spec";
            return refuse(Kind::Io, message, help);
        }
    };
    if bytes.len() > file::MAX_BYTES {
        let message = format!("{shown} has more than {} MB", file::MAX_BYTES >> 20);
        return refuse(Kind::Limit, message, "take fewer sites");
    }
    let ends = |end: &str| {
        let given = Path::new(path).extension();
        given.is_some_and(|given| given.eq_ignore_ascii_case(end))
    };
    let (values, shape) = if ends("npy") {
        match npy::parse(&bytes) {
            Ok(array) => (array.values, array.shape),
            Err(fault) => return refuse(Kind::Io, format!("{shown}: {}", fault.text), fault.help),
        }
    } else if ends("csv") || ends("txt") {
        match lines(&bytes) {
            Ok(found) => found,
            Err(wrong) => {
                return refuse(Kind::Schema, format!("{shown}: {wrong}"), help.lines);
            }
        }
    } else {
        let message = format!("`{shown}` is no file of numbers by its name");
        let help = "write the values by `numpy.save(\"B.npy\", B)`, or a number in each line of a file whose name ends in .csv";
        return refuse(Kind::Schema, message, help);
    };
    if let Some(at) = values.iter().position(|value| !value.is_finite()) {
        let message = format!("{shown}: number {at} is {}", values[at]);
        return refuse(Kind::Number, message, help.finite);
    }
    Ok((SiteValues::Read(values), shape))
}

/// The numbers of lines; blank ones and those that begin with `#` do not count.
fn lines(bytes: &[u8]) -> Result<(Vec<f64>, Vec<usize>), String> {
    let text = str::from_utf8(bytes).map_err(|_| "it is not UTF-8".to_owned())?;
    let text = text.trim_start_matches('\u{feff}');
    let (mut values, mut rows, mut width) = (Vec::new(), 0, None);
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if rows == 0 && BOND.iter().copied().eq(line.split(',').map(str::trim)) {
            continue;
        }
        let before = values.len();
        let parts: Vec<&str> = match (line.contains(','), line.contains(';')) {
            (true, true) => {
                return Err(format!("line {} has commas and semicolons", number + 1));
            }
            (true, false) => line.split(',').map(str::trim).collect(),
            (false, true) => line.split(';').map(str::trim).collect(),
            (false, false) => line.split_whitespace().collect(),
        };
        for part in parts {
            let value = part.parse::<f64>();
            values.push(value.map_err(|_| {
                let part = part.escape_debug();
                format!("line {}: `{part}` is no number", number + 1)
            })?);
        }
        let count = values.len() - before;
        if *width.get_or_insert(count) != count {
            return Err(format!(
                "line {} has {count} numbers, others have not",
                number + 1
            ));
        }
        rows += 1;
    }
    let shape = vec![rows, width.unwrap_or_default()];
    Ok((values, shape))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_numbers_or_rows() {
        let read = |text: &str| lines(text.as_bytes());
        let column = Ok((vec![1.0, 2.0, -3e-1], vec![3, 1]));
        assert_eq!(read("# B\n1\n\n2\r\n-3e-1\n"), column);
        let row = Ok((vec![1.0, 2.0, -3e-1], vec![1, 3]));
        assert_eq!(read("1, 2, -0.3"), row);
        assert_eq!(read("1; 2;-0.3"), row);
        let rows = Ok((vec![1.0, 2.0, 3.0, 4.0], vec![2, 2]));
        assert_eq!(read("1,2\n3 4\n"), rows);
        assert_eq!(read("# none"), Ok((vec![], vec![0, 0])));
        let bond = Ok((vec![0.0, 3.0, 0.5], vec![1, 3]));
        assert_eq!(read("i, j,value\n0,3,0.5\n"), bond);
        for wrong in [
            "1,2\n3\n", "B\n1\n", "1\n2,x\n", "1,2,,3", "1,2,", "1,5;2,5",
        ] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
