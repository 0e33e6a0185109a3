//! The events of members as a table, in order of the members.

use std::io;
use std::path::{Path, PathBuf};

use lie_in_process::key::Key;
use lie_program::protocol::Event;

use crate::command::events::Columns;
use crate::command::files::unwritable;
use crate::message::Failure;
use lie_output::{Destination, Lines};

/// The table on its way into its file.
pub struct Table {
    path: PathBuf,
    lines: Lines,
    /// Nothing where lines come as they are.
    columns: Option<Columns>,
    text: String,
    key: Key,
}

impl Table {
    /// Of members that come with their events, or without columns of lines that were written before.
    pub fn new(path: &Path, destination: Destination, columns: Option<Columns>) -> Self {
        Self {
            path: path.to_owned(),
            lines: Lines::new(destination),
            text: columns.as_ref().map_or_else(String::new, Columns::header),
            columns,
            key: Key::new(),
        }
    }

    /// Writes the first line.
    ///
    /// # Errors
    /// `io`.
    pub fn begin(&mut self) -> Result<(), Failure> {
        let text = std::mem::take(&mut self.text);
        self.key = std::mem::take(&mut self.key).bytes(text.as_bytes());
        let begun = self.lines.push(text.as_bytes());
        begun.map_err(|error| unwritable(&self.path, &error))
    }

    /// Adds the events of a member, which are written by the next [`Self::send`].
    pub fn add(&mut self, member: usize, events: &[Event]) {
        if let Some(columns) = &self.columns {
            columns.add(&mut self.text, member, events);
        }
    }

    /// Writes what was added.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn send(&mut self) -> io::Result<()> {
        let text = std::mem::take(&mut self.text);
        self.push(text.as_bytes())
    }

    /// Writes lines.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn push(&mut self, lines: &[u8]) -> io::Result<()> {
        self.key = std::mem::take(&mut self.key).bytes(lines);
        let pushed = self.lines.push(lines);
        pushed.map_err(|error| {
            io::Error::new(error.kind(), format!("{}: {error}", self.path.display()))
        })
    }

    /// A digest of all lines.
    pub fn digest(&self) -> String {
        self.key.hex()
    }
}
