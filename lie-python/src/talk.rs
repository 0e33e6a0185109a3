//! Requests to the measurements, which are served by a thread.

use crate::errors::method_error;
use lie_program::listen::listen;
use lie_program::protocol::{End, Message};
use lie_program::session::serve;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::{self, BufReader, BufWriter, PipeWriter, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Tells that a thread is over, however it ends.
struct Ended<'a>(&'a AtomicBool);

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// How a conversation ended.
pub struct Outcome {
    end: Option<End>,
    /// The exception of Ctrl-C.
    pub interrupted: Option<PyErr>,
}

impl Outcome {
    /// What it means for the caller, apart from interruptions.
    pub fn checked(&self, what: &str) -> PyResult<()> {
        match &self.end {
            Some(End::Done) => Ok(()),
            _ if self.interrupted.is_some() => Ok(()),
            Some(End::Refused { why, .. }) => Err(PyValueError::new_err(why.clone())),
            Some(End::Parameter { name, why }) => Err(PyValueError::new_err(format!(
                "the parameter {name}: {why}"
            ))),
            other => Err(PyRuntimeError::new_err(format!(
                "the {what} ended early: {other:?}"
            ))),
        }
    }
}

/// The answer where a measurement would need a built program.
pub fn not_here(py: Python<'_>, command: &str) -> PyErr {
    let text = "not all of this runs in Python yet: a method or the kind of system";
    let help = format!("`{command}` has it: write the declaration to a file");
    method_error(py, text, &help)
}

/// Has a request served by a thread, and looks for Ctrl-C meanwhile: closing the input ends the work. `take` gets what is found.
pub fn talk<O: Serialize, F: DeserializeOwned + Send>(
    py: Python<'_>,
    work: &lie_in_process::Work,
    request: &lie_measure::Request<O>,
    take: impl FnMut(F) + Send,
) -> PyResult<Outcome> {
    let mut line =
        serde_json::to_vec(request).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    line.push(b'\n');
    py.detach(|| converse(work, &line, take))
}

fn converse<F: DeserializeOwned + Send>(
    work: &lie_in_process::Work,
    line: &[u8],
    mut take: impl FnMut(F) + Send,
) -> PyResult<Outcome> {
    let (questions, mut asks) = io::pipe()?;
    let (answers, says) = io::pipe()?;
    asks.write_all(line)?;
    let asks: Mutex<Option<PipeWriter>> = Mutex::new(Some(asks));
    let over = AtomicBool::new(false);
    let ended = Ended(&over);
    let outcome = std::thread::scope(|scope| {
        scope.spawn(move || {
            let mut output = BufWriter::new(says);
            serve(None, Box::new(BufReader::new(questions)), &mut output, work)
        });
        let heard = scope.spawn(move || {
            let _ended = ended;
            let mut end = None;
            let heard = listen(&mut BufReader::new(answers), &mut |message, _| {
                match message {
                    Message::Found(found) => take(found),
                    Message::Progress(_) => {}
                    Message::End(last) => end = Some(last),
                }
                Ok(())
            });
            heard.map(|()| end)
        });
        let mut interrupted = None;
        while !over.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(5));
            if interrupted.is_none() {
                interrupted = Python::attach(|py| py.check_signals()).err();
                if interrupted.is_some() {
                    drop(asks.lock().unwrap_or_else(PoisonError::into_inner).take());
                }
            }
        }
        let heard = heard
            .join()
            .unwrap_or_else(|_| Err(io::Error::other("a thread failed")));
        heard.map(|end| Outcome { end, interrupted })
    })?;
    Ok(outcome)
}
