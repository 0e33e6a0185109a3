//! How far long work is, for a callable of Python.

use pyo3::prelude::*;
use std::time::{Duration, Instant};

/// Between two calls.
const PAUSE: Duration = Duration::from_millis(100);

/// A callable that hears what is done, of how much, and of what; or nobody.
pub struct Progress {
    callable: Option<Py<PyAny>>,
    told: Instant,
    /// What was said last: what is done, of how much.
    last: (u64, u64),
    /// What is being done.
    what: String,
}

impl Progress {
    /// Of something that is counted.
    pub fn new(what: &str, callable: Option<Py<PyAny>>) -> Self {
        Self {
            callable,
            told: Instant::now(),
            last: (0, 0),
            what: what.to_owned(),
        }
    }

    /// Says what is being done, which is something else than before, at once.
    pub fn stage(&mut self, done: u64, all: u64, what: &str) -> PyResult<()> {
        what.clone_into(&mut self.what);
        self.say(done, all)
    }

    /// Says how far it is, if that was not just said.
    pub fn tell(&mut self, done: u64, all: u64) -> PyResult<()> {
        match self.told.elapsed() < PAUSE || self.last == (done, all) {
            true => Ok(()),
            false => self.say(done, all),
        }
    }

    /// Says that all is done.
    pub fn end(&mut self) -> PyResult<()> {
        let (done, all) = self.last;
        match done < all {
            true => self.say(all, all),
            false => Ok(()),
        }
    }

    /// Says how far it is at once.
    pub fn say(&mut self, done: u64, all: u64) -> PyResult<()> {
        (self.told, self.last) = (Instant::now(), (done, all));
        let Some(callable) = &self.callable else {
            return Ok(());
        };
        Python::attach(|py| callable.call1(py, (done, all, &self.what)).map(drop))
    }
}
