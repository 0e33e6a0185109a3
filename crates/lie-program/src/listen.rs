//! The side of the command: messages as they come.

use crate::protocol::Message;
use serde::de::DeserializeOwned;
use std::io::{self, BufRead, ErrorKind, Read as _};

/// Numbers that are handed on at once, at most: whole rows, but at least one.
const CHUNK: usize = 1 << 13;

/// Takes a message, and what follows it on the output.
pub type Take<'a, R> = dyn FnMut(Message<R>, &mut dyn BufRead) -> io::Result<()> + 'a;

/// Hands on every message until the output of the program ends; a line that a killed program did not finish is dropped.
/// What follows a message, `take` reads from the output.
///
/// # Errors
/// The output cannot be read, a line is no message, or `take` does not go on.
pub fn listen<R: DeserializeOwned>(
    output: &mut dyn BufRead,
    take: &mut Take<'_, R>,
) -> io::Result<()> {
    let mut line = Vec::new();
    loop {
        line.clear();
        output.read_until(b'\n', &mut line)?;
        if line.pop() != Some(b'\n') {
            return Ok(());
        }
        let message = serde_json::from_slice(&line).map_err(|error| {
            let line = String::from_utf8_lossy(&line).chars().take(200).collect();
            let text: String = line;
            io::Error::new(ErrorKind::InvalidData, format!("{error}: {text}"))
        })?;
        take(message, output)?;
    }
}

/// Reads rows of so many numbers each, and hands them on as they come; half a row at the end of a killed program is
/// dropped.
///
/// # Errors
/// The output cannot be read, or `take` does not go on.
pub fn rows(
    output: &mut dyn BufRead,
    width: usize,
    count: u64,
    take: &mut dyn FnMut(&[f64]) -> io::Result<()>,
) -> io::Result<()> {
    let (mut bytes, mut numbers) = (Vec::new(), Vec::new());
    let mut left = count;
    while left > 0 {
        let now = left.min((CHUNK / width).max(1) as u64);
        bytes.clear();
        let wanted = now * width as u64 * 8;
        let read = output.take(wanted).read_to_end(&mut bytes)?;
        numbers.clear();
        let whole = bytes.chunks_exact(8).take(read / (width * 8) * width);
        let eights = whole.filter_map(|eight| eight.try_into().ok());
        numbers.extend(eights.map(f64::from_le_bytes));
        if !numbers.is_empty() {
            take(&numbers)?;
        }
        if (read as u64) < wanted {
            break;
        }
        left -= now;
    }
    Ok(())
}
