//! What methods claim, measured on a system.

use lie_codegen::methods::Choice;
use lie_codegen::model::Model;
use lie_codegen::program::Purpose;
use lie_codegen::structure::smoothness;
use lie_measure::verify::{Found, Options};
use lie_program::listen::listen;
use lie_program::protocol::{End, Message, Start};
use lie_program::session::serve;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::io::{self, BufReader, BufWriter, PipeWriter, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// A fact: the method, its name, what is claimed, what was measured, the bound, the verdict, a note, the step.
pub type Fact = (String, String, f64, f64, f64, String, String, f64);

/// What was found.
#[derive(Default)]
pub struct Facts {
    pub facts: Vec<Fact>,
    /// What is wrong with the measurements themselves.
    pub unsound: Vec<String>,
}

impl Facts {
    fn take(&mut self, found: Found) {
        match found {
            Found::Finding { method, finding } => {
                let verdict = serde_json::to_value(finding.verdict).unwrap_or_default();
                self.facts.push((
                    method,
                    finding.fact.to_string(),
                    finding.claim,
                    finding.measured,
                    finding.bound,
                    verdict.as_str().unwrap_or_default().to_owned(),
                    finding.note.to_string(),
                    finding.step,
                ));
            }
            Found::Broken { fact } => self.unsound.push(format!(
                "{fact}: a spoiled map passes, the measurement says nothing"
            )),
            Found::Unsound { what } => self.unsound.push(format!(
                "{what}: an equation with a known solution is not solved correctly"
            )),
            // these are for the command, which compares them with the declaration
            Found::Ground(_) | Found::Kernel(_) | Found::Reference(_) => {}
        }
    }
}

/// Has all claims of methods measured.
pub fn verify(
    py: Python<'_>,
    model: &Model,
    choices: &[Choice],
    start: Start,
    options: (Option<f64>, u64),
) -> PyResult<Facts> {
    let work = lie_in_process::work(model, choices, Purpose::Verify, || None);
    let work = work.ok_or_else(|| {
        PyValueError::new_err("not all of these methods run in Python: `lie verify` has them all")
    })?;
    let joints = smoothness::joints(model);
    let reach = (!joints.is_empty()).then(|| smoothness::reached(&joints, u32::MAX).unwrap_or(0));
    let (step, seed) = options;
    let request = lie_measure::Request {
        methods: choices.iter().map(Choice::label).collect(),
        start,
        options: Options { seed, step, reach },
    };
    let mut line =
        serde_json::to_vec(&request).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    line.push(b'\n');
    py.detach(|| talk(&work, &line))
}

/// Tells that a thread is over, however it ends.
struct Ended<'a>(&'a AtomicBool);

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Has a request served by a thread, and looks for Ctrl-C meanwhile: closing the input ends the work.
fn talk(work: &lie_in_process::Work, line: &[u8]) -> PyResult<Facts> {
    let (questions, mut asks) = io::pipe()?;
    let (answers, says) = io::pipe()?;
    asks.write_all(line)?;
    let asks: Mutex<Option<PipeWriter>> = Mutex::new(Some(asks));
    let over = AtomicBool::new(false);
    let ended = Ended(&over);
    let (facts, end, interrupted) = std::thread::scope(|scope| {
        scope.spawn(move || {
            let mut output = BufWriter::new(says);
            serve(None, Box::new(BufReader::new(questions)), &mut output, work)
        });
        let heard = scope.spawn(move || {
            let _ended = ended;
            let (mut facts, mut end) = (Facts::default(), None);
            let heard = listen(&mut BufReader::new(answers), &mut |message, _| {
                match message {
                    Message::Found(found) => facts.take(found),
                    Message::Progress(_) => {}
                    Message::End(last) => end = Some(last),
                }
                Ok(())
            });
            heard.map(|()| (facts, end))
        });
        let mut interrupted = Ok(());
        while !over.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(5));
            if interrupted.is_ok() {
                interrupted = Python::attach(|py| py.check_signals());
                if interrupted.is_err() {
                    drop(asks.lock().unwrap_or_else(PoisonError::into_inner).take());
                }
            }
        }
        let heard = heard
            .join()
            .unwrap_or_else(|_| Err(io::Error::other("a thread failed")));
        heard.map(|(facts, end)| (facts, end, interrupted))
    })?;
    interrupted?;
    match end {
        Some(End::Done) => Ok(facts),
        Some(End::Refused { why, .. }) => Err(PyValueError::new_err(why)),
        Some(End::Parameter { name, why }) => Err(PyValueError::new_err(format!(
            "the parameter {name}: {why}"
        ))),
        other => Err(PyRuntimeError::new_err(format!(
            "the verification ended early: {other:?}"
        ))),
    }
}
