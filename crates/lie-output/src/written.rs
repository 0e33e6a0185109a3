//! What of the output is on the disk, and going on behind it.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::Path;

use lie_in_process::checkpoint::Written;
use lie_in_process::key::Key;

use super::{Rows, Run};

/// So many of the last bytes tell the file from another one.
const TAIL: u64 = 4096;

/// Whether a file holds what was written; why not.
///
/// # Errors
/// It does not.
pub fn is_in(written: &Written, path: &Path) -> Result<(), String> {
    let found = path.metadata().map_err(|error| error.to_string())?;
    if !found.is_file() || found.len() < written.length {
        let (there, expected) = (found.len(), written.length);
        return Err(format!("it has {there} bytes of the {expected} written"));
    }
    match tail(path, written.start, written.length) {
        Ok(tail) if tail == written.tail => Ok(()),
        Ok(_) => Err("it was changed".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

/// A digest of the last bytes among the first ones of a file.
fn tail(path: &Path, start: u64, length: u64) -> io::Result<String> {
    let from = length.saturating_sub(TAIL).max(start).min(length);
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(from))?;
    let mut bytes = Vec::new();
    file.take(length - from).read_to_end(&mut bytes)?;
    Ok(Key::digest(&bytes))
}

impl Rows {
    /// Brings everything so far to the disk, where it stays whatever happens: to the file at a path. None before there is
    /// something.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn written(&mut self, path: &Path) -> io::Result<Option<Written>> {
        if !self.begun {
            return Ok(None);
        }
        self.destination.sync()?;
        let length = self.destination.length();
        let start = self.form.start(self.arrived).map_or(0, |start| start.len()) as u64;
        // the end of a file on a full disk does not go over these rows
        self.ends = VecDeque::from([length]);
        Ok(Some(Written {
            start,
            length,
            rows: self.arrived,
            tail: tail(path, start, length)?,
        }))
    }

    /// Goes on with a run behind what is written of it; what stands there goes.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn take_up(&mut self, run: &Run, written: &Written) -> io::Result<()> {
        let mut known = Vec::new();
        self.form.begin(&self.header, &mut known);
        self.form.open(&self.header, run, &mut known);
        if written.rows > 0 {
            let row = vec![0.0; self.width];
            self.form.row(&row, &mut known);
        }
        self.begun = true;
        self.arrived = written.rows;
        self.ends = VecDeque::from([written.length]);
        // a kill in between leaves a count of fewer rows than there are
        self.count()?;
        self.destination.take_up(written.length)
    }
}
