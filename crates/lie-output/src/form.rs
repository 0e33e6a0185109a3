//! The forms of the output that are text.

use std::borrow::Cow;
use std::io::Write as _;

use lie_in_process::request::Labels;
use lie_program::protocol::Event;
use lie_runtime::driver::Density;

use super::Names;

/// What the rows of all runs have in common.
#[derive(Clone, Debug, Default)]
pub struct Header {
    /// Name of the system.
    pub system: String,
    /// `t`, the state, `energy`, the Casimirs.
    pub columns: Names,
    /// The coordinates that events show; nothing where none are declared.
    pub events: Option<Vec<usize>>,
    /// What tells runs apart; nothing for one run alone.
    pub labels: Option<Labels>,
}

/// One run.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Its number, from 0 on.
    pub number: usize,
    /// The method with its options.
    pub method: String,
    /// Step size.
    pub step: f64,
    /// Whether the steps follow the motion.
    pub density: Density,
    /// The seed of its noise, where there is some.
    pub seed: Option<u64>,
    /// The values of the parameters that have several.
    pub parameters: Vec<f64>,
    /// The names of what a projection behind each step keeps.
    pub kept: Vec<String>,
}

/// One form of output; it appends to a buffer, which takes everything.
pub trait Form {
    /// What stands before all rows.
    fn begin(&mut self, header: &Header, out: &mut Vec<u8>);
    /// What stands before the rows of a run.
    fn open(&mut self, header: &Header, run: &Run, out: &mut Vec<u8>);
    /// One row.
    fn row(&mut self, row: &[f64], out: &mut Vec<u8>);
    /// What stands behind the rows of a run; `status` is a word about how it ended.
    fn close(&mut self, _header: &Header, _status: &str, _events: &[Event], _out: &mut Vec<u8>) {}
    /// What stands behind all rows.
    fn end(&mut self, _out: &mut Vec<u8>) {}
    /// The first bytes of a file with so many rows, where they depend on it.
    fn start(&self, _rows: u64) -> Option<Vec<u8>> {
        None
    }
    /// Whether `start` answers.
    fn patches_its_start(&self) -> bool {
        false
    }
}

/// A header line, then one line per row. Names are identifiers, and methods have no comma: nothing needs quotes.
#[derive(Default)]
pub struct Csv {
    /// What tells the run apart, with a comma behind each.
    prefix: Vec<u8>,
}

impl Form for Csv {
    fn begin(&mut self, header: &Header, out: &mut Vec<u8>) {
        if let Some(labels) = &header.labels {
            let method = labels.method.iter();
            for name in std::iter::once(&labels.run)
                .chain(method)
                .chain(&labels.parameters)
            {
                let _ = write!(out, "{name},");
            }
        }
        for (place, name) in header.columns.iter().enumerate() {
            out.extend_from_slice(if place > 0 { b"," } else { b"" });
            out.extend_from_slice(name.as_bytes());
        }
        out.push(b'\n');
    }

    fn open(&mut self, header: &Header, run: &Run, _out: &mut Vec<u8>) {
        self.prefix.clear();
        let Some(labels) = &header.labels else { return };
        let _ = write!(self.prefix, "{},", run.number);
        if labels.method.is_some() {
            let _ = write!(self.prefix, "{},", run.method);
        }
        for value in &run.parameters {
            number(*value, &mut self.prefix);
            self.prefix.push(b',');
        }
    }

    fn row(&mut self, row: &[f64], out: &mut Vec<u8>) {
        out.extend_from_slice(&self.prefix);
        numbers(row, false, out);
        out.push(b'\n');
    }
}

/// One object, of several runs with a list of them; non-finite numbers are null, since JSON has none.
#[derive(Default)]
pub struct Json {
    /// Whether there are several runs, and one was opened.
    several: bool,
    opened: bool,
    /// Whether the run has a row.
    started: bool,
}

impl Json {
    fn text(text: &str) -> String {
        serde_json::Value::from(text).to_string()
    }

    /// The names of columns as a list.
    fn list(names: &Names, out: &mut Vec<u8>) {
        out.push(b'[');
        for (place, name) in names.iter().enumerate() {
            let comma = if place > 0 { "," } else { "" };
            let _ = write!(out, "{comma}{}", Self::text(&name));
        }
        out.push(b']');
    }
}

impl Form for Json {
    fn begin(&mut self, header: &Header, out: &mut Vec<u8>) {
        let _ = write!(out, "{{\"system\":{},", Self::text(&header.system));
        self.several = header.labels.is_some();
        if self.several {
            out.extend_from_slice(b"\"columns\":");
            Self::list(&header.columns, out);
            out.extend_from_slice(b",\"runs\":[");
        }
    }

    fn open(&mut self, header: &Header, run: &Run, out: &mut Vec<u8>) {
        self.started = false;
        if self.several {
            out.extend_from_slice(if self.opened { b",\n{" } else { b"\n{" });
            let _ = write!(out, "\"run\":{},", run.number);
        }
        self.opened = true;
        let _ = write!(out, "\"method\":{},\"step\":", Self::text(&run.method));
        json_number(run.step, out);
        if !run.kept.is_empty() {
            let _ = write!(out, ",\"kept\":{}", serde_json::json!(run.kept));
        }
        if run.density == Density::Reversible {
            out.extend_from_slice(b",\"density\":\"reversible\"");
        }
        if let Some(seed) = run.seed {
            let _ = write!(out, ",\"seed\":{seed}");
        }
        match &header.labels {
            Some(labels) => {
                out.extend_from_slice(b",\"parameters\":{");
                for (k, (name, value)) in labels.parameters.iter().zip(&run.parameters).enumerate()
                {
                    let comma = if k > 0 { "," } else { "" };
                    let _ = write!(out, "{comma}{}:", Self::text(name));
                    json_number(*value, out);
                }
                out.push(b'}');
            }
            None => {
                out.extend_from_slice(b",\"columns\":");
                Self::list(&header.columns, out);
            }
        }
        out.extend_from_slice(b",\"rows\":[");
    }

    fn row(&mut self, row: &[f64], out: &mut Vec<u8>) {
        out.extend_from_slice(if self.started { b",\n[" } else { b"\n[" });
        self.started = true;
        numbers(row, true, out);
        out.push(b']');
    }

    fn close(&mut self, header: &Header, status: &str, events: &[Event], out: &mut Vec<u8>) {
        out.extend_from_slice(b"\n]");
        if let Some(shown) = &header.events {
            out.extend_from_slice(b",\"events\":[");
            for (place, event) in events.iter().enumerate() {
                let comma = if place > 0 { "," } else { "" };
                let _ = write!(
                    out,
                    "{comma}\n{{\"event\":{},\"t\":",
                    Self::text(&event.name)
                );
                json_number(event.time, out);
                out.extend_from_slice(b",\"mu\":[");
                let state: Vec<f64> = shown.iter().map(|&entry| event.state[entry]).collect();
                numbers(&state, true, out);
                out.extend_from_slice(b"]}");
            }
            out.extend_from_slice(b"\n]");
        }
        let _ = write!(out, ",\"status\":{}}}", Self::text(status));
        if !self.several {
            out.push(b'\n');
        }
    }

    fn end(&mut self, out: &mut Vec<u8>) {
        if self.several {
            out.extend_from_slice(b"\n]}\n");
        }
    }
}

/// One object a line for each row, by the names of the columns; whatever ends the run, whole lines can be read.
#[derive(Default)]
pub struct JsonLines {
    /// What stands before each number of a row.
    keys: Vec<String>,
    /// What tells the run apart, with a comma behind it.
    prefix: Vec<u8>,
}

impl Form for JsonLines {
    fn begin(&mut self, header: &Header, _out: &mut Vec<u8>) {
        let key = |name: Cow<'_, str>| format!("{}:", Json::text(&name));
        self.keys = header.columns.iter().map(key).collect();
    }

    fn open(&mut self, header: &Header, run: &Run, _out: &mut Vec<u8>) {
        self.prefix.clear();
        let Some(labels) = &header.labels else { return };
        let _ = write!(self.prefix, "{}:{},", Json::text(&labels.run), run.number);
        if let Some(method) = &labels.method {
            let (key, label) = (Json::text(method), Json::text(&run.method));
            let _ = write!(self.prefix, "{key}:{label},");
        }
        for (name, value) in labels.parameters.iter().zip(&run.parameters) {
            let _ = write!(self.prefix, "{}:", Json::text(name));
            json_number(*value, &mut self.prefix);
            self.prefix.push(b',');
        }
    }

    fn row(&mut self, row: &[f64], out: &mut Vec<u8>) {
        out.push(b'{');
        out.extend_from_slice(&self.prefix);
        for (index, (key, value)) in self.keys.iter().zip(row).enumerate() {
            out.extend_from_slice(if index > 0 { b"," } else { b"" });
            out.extend_from_slice(key.as_bytes());
            json_number(*value, out);
        }
        out.extend_from_slice(b"}\n");
    }
}

/// Numbers between commas.
fn numbers(row: &[f64], json: bool, out: &mut Vec<u8>) {
    for (index, value) in row.iter().enumerate() {
        if index > 0 {
            out.push(b',');
        }
        if json {
            json_number(*value, out);
        } else {
            number(*value, out);
        }
    }
}

fn json_number(value: f64, out: &mut Vec<u8>) {
    if value.is_finite() {
        number(value, out);
    } else {
        out.extend_from_slice(b"null");
    }
}

/// The shortest decimal that reads back as the same number.
fn number(value: f64, out: &mut Vec<u8>) {
    out.extend_from_slice(zmij::Buffer::new().format(value).as_bytes());
}
