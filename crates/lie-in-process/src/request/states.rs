//! Initial states from a file: CSV, or an array of NumPy.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lie_syntax::diagnostic::Kind;
use lie_syntax::front::npy;

use super::constant;
use super::several::MOST;
use crate::memory;
use crate::message::{Fault, Message, Place, Source};
use crate::spec::Spec;
use crate::words::counted;

/// Initial states from a file.
pub(super) struct States {
    /// The numbers of each.
    pub(super) all: Vec<Vec<f64>>,
    places: Places,
}

/// Where the states stand.
enum Places {
    /// In the rows of an array.
    Rows(PathBuf),
    /// In a text, each within a line.
    Lines(Arc<Source>, Vec<Range<usize>>),
}

impl States {
    /// Where one of them stands.
    pub(super) fn place(&self, state: usize) -> Place {
        match &self.places {
            Places::Rows(path) => Place::File(format!("{}, row {state}", path.display())),
            Places::Lines(source, lines) => Place::Text(Arc::clone(source), lines[state].clone()),
        }
    }
}

/// Reads them.
///
/// # Errors
/// What is wrong with the file.
pub(super) fn states(spec: &Spec, path: &Path) -> Result<States, Message> {
    let unread = |text: String, help: &str| Message::io(path, text).help(help);
    let bytes = memory::read(path).map_err(|error| {
        let message = unread(
            format!("it cannot be read: {error}"),
            "give a file of initial states, CSV or NPY",
        );
        match error.kind() {
            std::io::ErrorKind::OutOfMemory => message.with_fault(Fault::Memory),
            _ => message,
        }
    })?;
    let states = if bytes.starts_with(b"\x93NUMPY") {
        array(&bytes, path)?
    } else {
        let text = String::from_utf8(bytes).map_err(|_| {
            let help = "write a state in each line, or save an array by `numpy.save`";
            unread("it is neither text nor an array of NumPy".to_owned(), help)
        })?;
        // Excel marks the order of bytes, which UTF-8 does not have
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        lines(spec, text.to_owned(), path)?
    };
    match states.all.len() {
        0 => Err(unread(
            "it has no state".to_owned(),
            "write a state in each line",
        )),
        1..=MOST => Ok(states),
        more => {
            let text = format!("it has {more} states, and {MOST} runs can be made at once");
            Err(unread(text, "split the file"))
        }
    }
}

/// The rows of an array.
fn array(bytes: &[u8], path: &Path) -> Result<States, Message> {
    let array =
        npy::parse(bytes).map_err(|fault| Message::io(path, fault.text).help(fault.help))?;
    let width = match array.shape.as_slice() {
        [_, width] => *width,
        shape => {
            let text = format!("its shape is {shape:?}");
            let help = "write an array with two axes, a row for each state";
            return Err(Message::io(path, text).help(help));
        }
    };
    let rows = array.values.chunks_exact(width.max(1));
    Ok(States {
        all: rows.map(<[f64]>::to_vec).collect(),
        places: Places::Rows(path.to_path_buf()),
    })
}

/// The lines of a table, below the names of the coordinates or without them.
fn lines(spec: &Spec, text: String, path: &Path) -> Result<States, Message> {
    let source = Arc::new(Source {
        path: path.display().to_string(),
        text,
    });
    let shown = spec.model.shown_coordinates().into_iter();
    let names: Vec<&str> = shown
        .map(|i| spec.model.coordinates[i].text.as_str())
        .collect();
    let mut order: Option<Vec<usize>> = None;
    let (mut all, mut places) = (Vec::new(), Vec::new());
    let (mut at, mut first) = (0, true);
    for line in source.text.split_inclusive('\n') {
        let start = at;
        at += line.len();
        let content = line.trim();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let from = start + line.find(content).unwrap_or(0);
        let range = from..from + content.len();
        let place = Place::Text(Arc::clone(&source), range.clone());
        let fields: Vec<&str> = content.split(',').map(str::trim).collect();
        let number = constant(fields[0]).is_ok();
        let header = std::mem::take(&mut first) && !number;
        if header {
            order = Some(permutation(&fields, &names, &place)?);
            continue;
        }
        let mut values = numbers(&fields, &place)?;
        if let Some(order) = &order {
            if values.len() != order.len() {
                let text = format!(
                    "{} below {}",
                    counted(values.len() as u64, "value"),
                    counted(order.len() as u64, "name")
                );
                let message = Message::new(Kind::StateLength, text).at_place(place);
                return Err(message.help("give each line a value for each name"));
            }
            values = order.iter().map(|&k| values[k]).collect();
        }
        all.push(values);
        places.push(range);
    }
    let places = Places::Lines(source, places);
    Ok(States { all, places })
}

/// Where the value of each coordinate stands in a line.
fn permutation(fields: &[&str], names: &[&str], place: &Place) -> Result<Vec<usize>, Message> {
    let find = |name: &&str| fields.iter().position(|field| field == name);
    let order: Option<Vec<usize>> = names.iter().map(find).collect();
    order
        .filter(|order| order.len() == fields.len())
        .ok_or_else(|| {
            if matches!(fields, [line] if without_commas(line)) {
                let text = "no commas stand between these numbers".to_owned();
                let message = Message::new(Kind::Option, text).at_place(place.clone());
                return message.help("write a state in each line, such as `0.1,0.2,0.3`");
            }
            let odd = fields.iter().find(|field| !names.contains(field));
            let text = match odd {
                Some(odd) => format!("`{odd}` is not the name of a coordinate"),
                None => "these are not the names of the coordinates".to_owned(),
            };
            let message = Message::new(Kind::Option, text).at_place(place.clone());
            message.help(format!("write `{}`, in any order", names.join(",")))
        })
}

/// Whether a text consists of several numbers, with something other than commas between them.
pub(super) fn without_commas(text: &str) -> bool {
    let parts = text.split([';', '\t', ' ']);
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    let number = |part: &&str| constant(part).is_ok();
    parts.len() > 1 && parts.iter().all(number)
}

fn numbers(fields: &[&str], place: &Place) -> Result<Vec<f64>, Message> {
    let number = |field: &&str| {
        let value = constant(field).ok();
        value.filter(|value| value.is_finite()).ok_or_else(|| {
            let text = format!("`{field}` is not a finite number");
            let message = Message::new(Kind::Option, text).at_place(place.clone());
            message.help("give numbers such as 0.01 or 1/7, with commas between them")
        })
    };
    fields.iter().map(number).collect()
}
