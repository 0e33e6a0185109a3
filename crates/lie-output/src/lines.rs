//! Lines of text as they come, in constant memory.

use std::io;

use super::Destination;

/// Lines on their way out. What was there stays until the first are written.
pub struct Lines {
    destination: Destination,
    begun: bool,
}

impl Lines {
    /// Of nothing yet.
    pub fn new(destination: Destination) -> Self {
        Self {
            destination,
            begun: false,
        }
    }

    /// Writes whole lines, all of them or none.
    ///
    /// # Errors
    /// They cannot be written; those before are kept.
    pub fn push(&mut self, lines: &[u8]) -> io::Result<()> {
        if !std::mem::replace(&mut self.begun, true) {
            self.destination.begin(false)?;
        }
        let before = self.destination.length();
        let sent = self.destination.send(lines);
        if sent.is_err() {
            self.destination.cut(before);
        }
        sent
    }
}
