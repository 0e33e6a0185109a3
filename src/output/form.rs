//! The forms of the output that are text.

use std::io::Write as _;

/// What stands before the rows.
#[derive(Clone, Debug, Default)]
pub struct Header {
    /// Name of the system.
    pub system: String,
    /// Id of the method.
    pub method: String,
    /// Step size.
    pub step: f64,
    /// `t`, the state, `energy`, the Casimirs.
    pub columns: Vec<String>,
}

/// One form of output; it appends to a buffer, which takes everything.
pub trait Form {
    /// What stands before the rows.
    fn begin(&mut self, header: &Header, out: &mut Vec<u8>);
    /// One row.
    fn row(&mut self, row: &[f64], out: &mut Vec<u8>);
    /// What stands behind the rows.
    fn end(&mut self, _status: &str, _out: &mut Vec<u8>) {}
    /// The first bytes of a file with so many rows, where they depend on it.
    fn start(&self, _rows: u64) -> Option<Vec<u8>> {
        None
    }
    /// Whether `start` answers.
    fn patches_its_start(&self) -> bool {
        false
    }
}

/// A header line, then one line per row. Names are identifiers: nothing needs quotes.
pub struct Csv;

impl Form for Csv {
    fn begin(&mut self, header: &Header, out: &mut Vec<u8>) {
        out.extend_from_slice(header.columns.join(",").as_bytes());
        out.push(b'\n');
    }

    fn row(&mut self, row: &[f64], out: &mut Vec<u8>) {
        for (index, value) in row.iter().enumerate() {
            if index > 0 {
                out.push(b',');
            }
            number(*value, out);
        }
        out.push(b'\n');
    }
}

/// One object; non-finite numbers are null, since JSON has none.
#[derive(Default)]
pub struct Json {
    started: bool,
}

impl Form for Json {
    fn begin(&mut self, header: &Header, out: &mut Vec<u8>) {
        let text = |text: &str| serde_json::Value::from(text).to_string();
        let columns = serde_json::Value::from(header.columns.clone());
        let (system, method) = (text(&header.system), text(&header.method));
        let _ = write!(out, "{{\"system\":{system},\"method\":{method},\"step\":");
        if header.step.is_finite() {
            number(header.step, out);
        } else {
            out.extend_from_slice(b"null");
        }
        let _ = write!(out, ",\"columns\":{columns},\"rows\":[");
    }

    fn row(&mut self, row: &[f64], out: &mut Vec<u8>) {
        out.extend_from_slice(if self.started { b",\n[" } else { b"\n[" });
        self.started = true;
        for (index, value) in row.iter().enumerate() {
            if index > 0 {
                out.push(b',');
            }
            if value.is_finite() {
                number(*value, out);
            } else {
                out.extend_from_slice(b"null");
            }
        }
        out.push(b']');
    }

    fn end(&mut self, status: &str, out: &mut Vec<u8>) {
        let _ = writeln!(out, "\n],\"status\":{}}}", serde_json::Value::from(status));
    }
}

/// The shortest decimal that reads back as the same number.
fn number(value: f64, out: &mut Vec<u8>) {
    // Writing to memory does not fail.
    let _ = write!(out, "{value:?}");
}
