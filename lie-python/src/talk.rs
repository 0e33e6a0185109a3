//! Questions to work in this process, and those of the measurements.

use crate::arguments;
use crate::declaration::Declaration;
use crate::errors::{method_error, of_system, refused};
use crate::progress::Progress;
use lie_codegen::methods::Choice;
use lie_codegen::program::Purpose;
use lie_codegen::structure::Structure;
use lie_in_process::converse::{self, Last, Listener, converse_here};
use lie_in_process::families::Limit;
use lie_in_process::message::Message;
use lie_in_process::request::{Front, Request, method};
use lie_in_process::spec::Spec;
use lie_in_process::{Question, Work};
use lie_program::protocol::{self, End, Obstacle, Start};
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::io;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

/// Between two looks for Ctrl-C.
const PAUSE: Duration = Duration::from_millis(20);
/// The stack of a thread that compiles.
const STACK: usize = 64 << 20;
/// So long a step may take after Ctrl-C; then its thread is left behind, and ends with the step.
const GRACE: Duration = Duration::from_secs(1);

/// A kind of measurement: what is asked for, and what becomes of the answers.
pub trait Measurement: Sync {
    /// What measures it.
    const PURPOSE: Purpose;
    /// The command that does the same.
    const COMMAND: &'static str;
    type Options;
    type Found;
    /// What was found so far.
    type Results;
    /// What Python gets.
    type Output: Send;

    /// The methods where none is named.
    fn usual(model: &Structure) -> Vec<Choice>;

    /// What is asked for, and the results before there are any.
    fn begin(&self, spec: &Spec, start: &Start) -> PyResult<(Self::Options, Self::Results)>;

    fn record(results: &mut Self::Results, found: Self::Found);

    /// The results of methods in order, of all or up to an interruption.
    fn end(
        &self,
        results: Self::Results,
        model: &Structure,
        labels: &[String],
        whole: bool,
    ) -> Self::Output;
}

/// What is measured, from where on, and who hears how far it is.
pub struct Subject<'a> {
    declaration: &'a Declaration,
    /// The labels of the methods; the usual ones where there are none.
    methods: &'a [String],
    start: Start,
    progress: Option<Py<PyAny>>,
}

impl<'a> Subject<'a> {
    pub fn new(
        py: Python<'_>,
        declaration: &'a Declaration,
        methods: &'a [String],
        request: &Request,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        Ok(Self {
            start: arguments::checked(py, declaration, request, arguments::start)?,
            declaration,
            methods,
            progress,
        })
    }

    /// Has it measured, without the interpreter's lock.
    pub fn measure<M: Measurement>(self, py: Python<'_>, measurement: &M) -> PyResult<M::Output>
    where
        lie_measure::Request<M::Options>: Question<Found = M::Found>,
    {
        let Self {
            declaration,
            methods,
            start,
            progress,
        } = self;
        let spec = declaration.spec();
        let model = &spec.model;
        let choices =
            choices(model, methods, M::usual).map_err(|message| refused(py, &[message]))?;
        let limit = Limit::for_purpose(M::PURPOSE);
        let exceeded = limit.and_then(|limit| limit.exceeded(model, start.initial.len()));
        if let Some((text, help)) = exceeded {
            return Err(PyValueError::new_err(format!("{text}\n  help: {help}")));
        }
        let labels: Vec<String> = choices.iter().map(Choice::label).collect();
        let declared = Arc::clone(&spec);
        let work = attended(py, move || {
            let clock = lie_in_process::clock::processor;
            Work::new(&declared.model, &choices, M::PURPOSE, clock)
        });
        let work = Arc::new(work?.ok_or_else(|| not_here(py, M::COMMAND))?);
        py.detach(|| {
            let (options, mut results) = measurement.begin(&spec, &start)?;
            let request = lie_measure::Request {
                methods: labels.clone(),
                start,
                options,
            };
            let take = |found| {
                M::record(&mut results, found);
                Ok(())
            };
            let asked = (&work, Who::Apart);
            let outcome = converse(asked, request, Progress::new("", progress), take)?;
            let whole = outcome.whole(model)?;
            Ok(measurement.end(results, model, &labels, whole))
        })
    }
}

/// The choices of these labels; all that `usual` gives where there are none.
fn choices(
    model: &Structure,
    labels: &[String],
    usual: fn(&Structure) -> Vec<Choice>,
) -> Result<Vec<Choice>, Message> {
    match labels {
        [] => Ok(usual(model)),
        labels => labels.iter().map(|label| wanted(model, label)).collect(),
    }
}

/// The method of a label such as `lie-midpoint --retraction cayley`, if it applies.
///
/// # Errors
/// There is none, or it does not apply.
pub fn wanted(model: &Structure, label: &str) -> Result<Choice, Message> {
    method::labelled(label, Front::Call).and_then(|choice| method::applies(choice, model))
}

/// The answer where a measurement would need a built program.
fn not_here(py: Python<'_>, command: &str) -> PyErr {
    let text = "not all of this runs in Python yet: a method or the kind of system";
    let help = format!("`{command}` has it: write the declaration to a file");
    method_error(py, text, &help)
}

/// Why there is no thread: mostly for want of memory for its stack.
fn no_thread(error: io::Error) -> PyErr {
    match error.kind() {
        io::ErrorKind::WouldBlock | io::ErrorKind::OutOfMemory => {
            PyMemoryError::new_err("there is no memory for a thread")
        }
        _ => error.into(),
    }
}

/// Has something done by a thread of its own, without the interpreter's lock, while this one looks for Ctrl-C. That leaves the
/// thread behind, which ends by itself.
pub fn attended<R: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> R + Send + 'static,
) -> PyResult<R> {
    let (sender, done) = sync_channel(1);
    let work = move || {
        // nobody waits for it after Ctrl-C
        let _ = sender.send(work());
    };
    let thread = std::thread::Builder::new()
        .stack_size(STACK)
        .spawn(work)
        .map_err(no_thread)?;
    py.detach(move || {
        loop {
            match done.recv_timeout(PAUSE) {
                Ok(found) => return Ok(found),
                Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals())?,
                Err(RecvTimeoutError::Disconnected) => {
                    let panic = thread.join().err();
                    std::panic::resume_unwind(panic.unwrap_or_else(|| Box::new("a thread ended")));
                }
            }
        }
    })
}

/// How a conversation ended.
pub struct Outcome {
    pub end: Option<End>,
    /// The exception that ended it early.
    pub interrupted: Option<PyErr>,
}

impl Outcome {
    /// Whether it came to its end, and not to Ctrl-C.
    pub fn whole(self, model: &Structure) -> PyResult<bool> {
        match (self.interrupted, self.end) {
            (Some(error), _) => {
                match Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py)) {
                    true => Ok(false),
                    false => Err(error),
                }
            }
            (None, Some(End::Done)) => Ok(true),
            (None, Some(End::Refused { what, why })) => {
                Err(PyValueError::new_err(refusal(&model.name, what, &why)))
            }
            (None, Some(End::Parameter { name, why })) => Err(PyValueError::new_err(format!(
                "the parameter {name}: {why}"
            ))),
            (None, other) => Err(PyRuntimeError::new_err(format!(
                "the measurement ended early: {other:?}"
            ))),
        }
    }
}

/// What stands against a measurement, and a remedy.
fn refusal(system: &str, what: Obstacle, why: &str) -> String {
    let (what, help) = match what {
        Obstacle::Ground => (
            "nothing can be measured on",
            "give another x0, or a smaller h where there is one",
        ),
        Obstacle::Still => (
            "nothing can be compared on",
            "give an x0 that is not an equilibrium",
        ),
        Obstacle::Section => (
            "the surface of section is not passed on",
            "give a coordinate and a value that it passes, such as the middle of its range, or a longer t",
        ),
        Obstacle::Reference => (
            "the reference solution is not confirmed on",
            "take a shorter t",
        ),
        Obstacle::Request
        | Obstacle::Option
        | Obstacle::Keep
        | Obstacle::Milestone
        | Obstacle::Initial => {
            return why.to_owned();
        }
    };
    format!("{what} {system}: {why}\n  help: {help}")
}

/// Hears what is said, tells how far it is, and looks for Ctrl-C.
struct Ears<T> {
    take: T,
    progress: Progress,
    looked: Instant,
    interrupted: Option<PyErr>,
}

impl<T> Ears<T> {
    fn look(&mut self) {
        self.looked = Instant::now();
        self.interrupted = Python::attach(|py| py.check_signals()).err();
    }
}

impl<F, T: FnMut(F) -> io::Result<()>> Listener<F> for Ears<T> {
    fn found(&mut self, found: F) -> io::Result<()> {
        (self.take)(found)
    }

    fn progress(&mut self, progress: &protocol::Progress) {
        if self.interrupted.is_some() {
            return;
        }
        let said = match &progress.stage {
            Some(what) => self.progress.stage(progress.done, progress.all, what),
            None => self.progress.tell(progress.done, progress.all),
        };
        match said {
            Ok(()) => self.look(),
            Err(error) => self.interrupted = Some(error),
        }
    }

    fn stops(&mut self) -> bool {
        if self.interrupted.is_none() && self.looked.elapsed() >= PAUSE {
            self.look();
        }
        self.interrupted.is_some()
    }
}

/// Who answers a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// The thread that asks: of work that was brief when it was done last.
    Here,
    /// Another thread, which is left behind where it does not hear Ctrl-C.
    Apart,
}

/// Has a question answered, without the interpreter's lock, and looks for Ctrl-C meanwhile. `take` gets what is found.
pub fn converse<Q: Question>(
    (work, who): (&Arc<Work>, Who),
    question: Q,
    progress: Progress,
    take: impl FnMut(Q::Found) -> io::Result<()>,
) -> PyResult<Outcome> {
    let mut ears = Ears {
        take,
        progress,
        looked: Instant::now(),
        interrupted: None,
    };
    let last = match who {
        Who::Here => converse_here(work, question, &mut ears),
        Who::Apart => {
            converse::converse(work, question, Some(GRACE), &mut ears).map_err(no_thread)?
        }
    };
    let end = match last {
        Last::Said(end) => end,
        Last::NotTaken(error) => return Err(of_system(error)),
        Last::Left => None,
    };
    let Ears {
        mut progress,
        mut interrupted,
        ..
    } = ears;
    if matches!((&end, &interrupted), (Some(End::Done), None)) {
        // what was measured stays, also where the last word is answered with Ctrl-C
        interrupted = progress.end().err();
    }
    Ok(Outcome { end, interrupted })
}
