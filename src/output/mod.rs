//! Writes rows as they come, in constant memory: csv, json, npy; to a file or to stdout.

mod destination;
mod form;
mod npy;

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
/// nanoseconds between its two parts leaves a part of it. Where the disk is full, the file is cut
/// back to whole rows.
pub struct Rows {
    destination: Destination,
    form: Box<dyn Form>,
    width: usize,
    buffer: Vec<u8>,
    count: u64,
}

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
            count: 0,
        };
        rows.destination.begin(rows.form.patches_its_start())?;
        rows.form.begin(header, &mut rows.buffer);
        rows.send()?;
        Ok(rows)
    }

    /// Writes rows that lie one behind the other.
    ///
    /// # Errors
    /// The destination cannot be written; the rows before these are kept.
    pub fn push(&mut self, numbers: &[f64]) -> io::Result<()> {
        for row in numbers.chunks_exact(self.width) {
            let whole = self.buffer.len();
            self.form.row(row, &mut self.buffer);
            if whole > 0 && self.destination.room_in_page() < self.buffer.len() {
                self.destination.send(&self.buffer[..whole])?;
                self.buffer.drain(..whole);
            }
            self.count += 1;
        }
        self.send()?;
        match self.form.start(self.count) {
            Some(start) => self.destination.patch(&start, false),
            None => Ok(()),
        }
    }

    /// Writes what stands behind the rows; `status` is a word about how the run ended.
    ///
    /// # Errors
    /// The destination cannot be written.
    pub fn finish(mut self, status: &str) -> io::Result<()> {
        self.form.end(status, &mut self.buffer);
        self.send()?;
        if let Some(start) = self.form.start(self.count) {
            self.destination.patch(&start, true)?;
        }
        self.destination.finish()
    }

    fn send(&mut self) -> io::Result<()> {
        let sent = self.destination.send(&self.buffer);
        self.buffer.clear();
        sent
    }
}

#[cfg(test)]
mod tests;
