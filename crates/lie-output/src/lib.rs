//! Writes rows as they come, in constant memory: csv, json, jsonl, npy; to a file or to stdout.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod destination;
mod form;
mod identity;
mod lines;
mod names;
pub mod npy;
mod written;

use std::collections::VecDeque;
use std::io;

pub use destination::Destination;
use form::{Csv, Form, Json, JsonLines};
pub use form::{Header, Run};
pub use identity::Identity;
pub use lines::Lines;
pub use names::Names;
use npy::Npy;
pub use written::is_in;

use lie_program::protocol::Event;

/// How rows are written, `--format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Format {
    /// A header line, then one line per row
    Csv,
    /// One object with columns and rows, which is whole when the command has ended by itself
    Json,
    /// One object a line for each row, which can be read whatever ends the command
    #[cfg_attr(feature = "clap", value(alias = "ndjson"))]
    Jsonl,
    /// A numpy array of float64, one row per time
    Npy,
}

/// The rows of runs on their way out.
///
/// A kill interrupts a call of the system between two pages of a file. So every call writes whole
/// rows within one page; the row across the end of a page goes alone, and only a kill in the
/// nanoseconds between its two parts (longer where a busy disk makes the kernel hold the writer back there) leaves a
/// part of it. A count at the start of the file is brought
/// up to date after the rows that it counts, in one call: whenever the kill comes, those are there.
///
/// Where the disk is full, the file is cut back to whole rows, and ends as it does otherwise.
pub struct Rows {
    destination: Destination,
    form: Box<dyn Form>,
    header: Header,
    /// Numbers in a row.
    width: usize,
    /// Whether the destination was emptied, and what stands before all rows is on its way.
    begun: bool,
    /// Whether a failure has ended it.
    settled: bool,
    buffer: Vec<u8>,
    /// Rows in the buffer, and rows that have arrived.
    waiting: u64,
    arrived: u64,
    /// Where the last rows end; the end of the whole goes over some of them where there is no room for it.
    ends: VecDeque<u64>,
}

/// More rows than a page holds.
const SPARE: usize = 1024;

impl Rows {
    /// Rows of such a form; nothing is written before the first run is opened.
    pub fn new(destination: Destination, format: Format, header: Header) -> Self {
        let form: Box<dyn Form> = match format {
            Format::Csv => Box::new(Csv::default()),
            Format::Json => Box::new(Json::default()),
            Format::Jsonl => Box::new(JsonLines::default()),
            Format::Npy => Box::new(Npy::new(&header)),
        };
        let width = header.columns.len();
        Self::of_form(destination, form, header, width)
    }

    /// An array of such a shape behind its first axis, along which it grows.
    pub fn of_array(destination: Destination, shape: Vec<usize>) -> Self {
        let width = shape.iter().product();
        let form = Box::new(Npy::of_shape(shape));
        Self::of_form(destination, form, Header::default(), width)
    }

    fn of_form(
        destination: Destination,
        form: Box<dyn Form>,
        header: Header,
        width: usize,
    ) -> Self {
        Self {
            destination,
            form,
            header,
            width,
            begun: false,
            settled: false,
            buffer: Vec::new(),
            waiting: 0,
            arrived: 0,
            ends: VecDeque::new(),
        }
    }

    /// Whether anything was written.
    pub fn have_begun(&self) -> bool {
        self.begun
    }

    /// Where a reader has gone away, the rest is dropped, and the end tells.
    #[must_use]
    pub fn outliving_readers(mut self) -> Self {
        self.destination.outlives_readers();
        self
    }

    fn begin(&mut self) -> io::Result<()> {
        if !std::mem::replace(&mut self.begun, true) {
            self.destination.begin(self.form.patches_its_start())?;
            self.form.begin(&self.header, &mut self.buffer);
        }
        Ok(())
    }

    /// Writes what stands before the rows of a run.
    ///
    /// # Errors
    /// The destination cannot be written; the rows before these are kept.
    pub fn open(&mut self, run: &Run) -> io::Result<()> {
        self.begin()?;
        self.form.open(&self.header, run, &mut self.buffer);
        self.sent_or_settled()?;
        self.ends.push_back(self.destination.length());
        Ok(())
    }

    /// Writes what stands behind the rows of a run; `status` is a word about how it ended.
    ///
    /// # Errors
    /// The destination cannot be written; the rows are kept.
    pub fn close(&mut self, status: &str, events: &[Event]) -> io::Result<()> {
        self.form
            .close(&self.header, status, events, &mut self.buffer);
        // of one run alone, the end of the file goes with it
        match self.header.labels {
            Some(_) => self.sent_or_settled(),
            None => Ok(()),
        }
    }

    fn sent_or_settled(&mut self) -> io::Result<()> {
        let sent = self.send(None);
        if sent.is_err() {
            let _ = self.settle();
        }
        sent
    }

    /// Writes rows that lie one behind the other.
    ///
    /// # Errors
    /// The destination cannot be written; the rows before these are kept, and the file has been ended.
    pub fn push(&mut self, numbers: &[f64]) -> io::Result<()> {
        let pushed = self.try_push(numbers);
        if pushed.is_err() {
            // There is an error to report already.
            let _ = self.settle();
        }
        pushed
    }

    fn try_push(&mut self, numbers: &[f64]) -> io::Result<()> {
        for row in numbers.chunks_exact(self.width) {
            let whole = self.buffer.len();
            self.form.row(row, &mut self.buffer);
            if whole > 0 && self.destination.room_in_page() < self.buffer.len() {
                self.send(Some(whole))?;
            }
            self.waiting += 1;
            if self.ends.len() > SPARE {
                self.ends.pop_front();
            }
            let end = self.destination.length() + self.buffer.len() as u64;
            self.ends.push_back(end);
        }
        self.send(None)?;
        self.count()
    }

    /// Ends what a failure has cut short: the count, what stands behind the rows, and the spool.
    fn settle(&mut self) -> io::Result<()> {
        self.settled = true;
        self.buffer.clear();
        // Of what was sent last, the first rows may have arrived.
        let (good, arrived) = (self.destination.length(), self.destination.arrived());
        let came = |end: &&u64| (good + 1..=arrived).contains(*end);
        let mut more = self.ends.iter().filter(came);
        self.arrived += more.clone().count() as u64;
        let whole = more.next_back().copied();
        self.destination.cut(whole.unwrap_or(good));
        self.count()?;
        let mut end = Vec::new();
        self.form.close(&self.header, "failed", &[], &mut end);
        self.form.end(&mut end);
        let length = self.destination.length();
        let fits = |from: &&u64| **from + end.len() as u64 <= length;
        if !end.is_empty()
            && let Some(from) = self.ends.iter().rev().find(fits)
        {
            self.destination.close(*from, &end)?;
        }
        self.destination.finish()
    }

    /// Writes what stands behind all rows, unless a failure has done so.
    ///
    /// # Errors
    /// The destination cannot be written; the rows are kept.
    pub fn finish(mut self) -> io::Result<()> {
        if self.settled {
            return Ok(());
        }
        self.begin()?;
        self.form.end(&mut self.buffer);
        let finished = self
            .send(None)
            .and_then(|()| self.count())
            .and_then(|()| self.destination.finish());
        if finished.is_err() {
            let _ = self.settle();
        }
        finished
    }

    /// Brings a count at the start up to date.
    fn count(&mut self) -> io::Result<()> {
        match self.form.start(self.arrived) {
            Some(start) => self.destination.patch(&start),
            None => Ok(()),
        }
    }

    /// Sends so much of the buffer, which are whole rows, or all of it.
    fn send(&mut self, length: Option<usize>) -> io::Result<()> {
        let length = length.unwrap_or(self.buffer.len());
        self.destination.send(&self.buffer[..length])?;
        self.buffer.drain(..length);
        self.arrived += std::mem::take(&mut self.waiting);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
