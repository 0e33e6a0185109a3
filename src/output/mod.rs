//! Writes rows as they come, in constant memory: csv, json, npy; to a file or to stdout.

mod destination;
mod form;
mod npy;

use std::collections::VecDeque;
use std::io;

pub use destination::Destination;
pub use form::Header;
use form::{Csv, Form, Json};
use npy::Npy;

use crate::command::args::Format;

/// The rows of one run on their way out.
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
    width: usize,
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
    /// Writes what stands before the rows.
    ///
    /// # Errors
    /// The destination cannot be written.
    pub fn start(destination: Destination, format: Format, header: &Header) -> io::Result<Self> {
        let width = header.columns.len();
        let form: Box<dyn Form> = match format {
            Format::Csv => Box::new(Csv),
            Format::Json => Box::new(Json::default()),
            Format::Npy => Box::new(Npy::new(width)),
        };
        let mut rows = Self {
            destination,
            form,
            width,
            buffer: Vec::new(),
            waiting: 0,
            arrived: 0,
            ends: VecDeque::new(),
        };
        rows.destination.begin(rows.form.patches_its_start())?;
        rows.form.begin(header, &mut rows.buffer);
        rows.send(None)?;
        rows.ends.push_back(rows.destination.length());
        Ok(rows)
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
        self.form.end("failed", &mut end);
        let length = self.destination.length();
        let fits = |from: &&u64| **from + end.len() as u64 <= length;
        if !end.is_empty()
            && let Some(from) = self.ends.iter().rev().find(fits)
        {
            self.destination.close(*from, &end)?;
        }
        self.destination.finish()
    }

    /// Writes what stands behind the rows; `status` is a word about how the run ended.
    ///
    /// # Errors
    /// The destination cannot be written; the rows are kept.
    pub fn finish(mut self, status: &str) -> io::Result<()> {
        self.form.end(status, &mut self.buffer);
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
