//! The side of the command: messages as they come.

use crate::protocol::{Message, Wire};
use std::io::{self, BufRead, ErrorKind, Read as _};

/// Takes a message.
pub type Sink<'a, R> = dyn FnMut(Message<R>) -> io::Result<()> + 'a;

/// Hands on every message until the output of the program ends; a line that a killed program did not finish is dropped.
///
/// # Errors
/// The output cannot be read, a line is no message, or `take` does not go on.
pub fn listen<R: Wire>(output: &mut dyn BufRead, take: &mut Sink<'_, R>) -> io::Result<()> {
    let mut line = Vec::new();
    loop {
        line.clear();
        output.read_until(b'\n', &mut line)?;
        if line.pop() != Some(b'\n') {
            return Ok(());
        }
        let mut message = serde_json::from_slice(&line).map_err(|error| {
            let line = String::from_utf8_lossy(&line).chars().take(200).collect();
            let text: String = line;
            io::Error::new(ErrorKind::InvalidData, format!("{error}: {text}"))
        })?;
        if let Message::Found(found) = &mut message {
            R::read_numbers(found, output)?;
        }
        take(message)?;
    }
}

/// Reads rows of so many numbers each; half a row at the end of a killed program is dropped.
pub(crate) fn rows(output: &mut dyn BufRead, width: usize, count: u64) -> io::Result<Vec<f64>> {
    let mut bytes = Vec::new();
    let row = width.saturating_mul(8);
    output
        .take(count.saturating_mul(row as u64))
        .read_to_end(&mut bytes)?;
    bytes.truncate(bytes.len() - bytes.len() % row.max(1));
    let eights = bytes.chunks_exact(8);
    let eights = eights.filter_map(|eight| eight.try_into().ok());
    Ok(eights.map(f64::from_le_bytes).collect())
}
