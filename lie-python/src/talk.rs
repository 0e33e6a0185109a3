//! Requests to the measurements, which are served by a thread.

use crate::choice::wanted;
use crate::declaration::Declaration;
use crate::errors::method_error;
use crate::progress::Progress;
use lie_codegen::methods::Choice;
use lie_codegen::model::Model;
use lie_codegen::program::Purpose;
use lie_program::listen::listen;
use lie_program::protocol::{End, Message, Obstacle, Start};
use lie_program::session::serve;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::{self, BufReader, BufWriter, Write as _};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Between two looks for Ctrl-C.
const PAUSE: Duration = Duration::from_millis(5);

/// A kind of measurement: what is asked for, and what becomes of the answers.
pub trait Measurement: Sync {
    /// What measures it.
    const PURPOSE: Purpose;
    /// The command that does the same.
    const COMMAND: &'static str;
    type Options: Serialize;
    type Found: DeserializeOwned + Send;
    /// What was found so far.
    type Results;
    /// What Python gets.
    type Made: Send;

    /// The methods where none is named.
    fn usual(model: &Model) -> Vec<Choice>;

    /// What is asked for, and the results before there are any.
    fn begin(&self, model: &Model) -> PyResult<(Self::Options, Self::Results)>;

    fn take(results: &mut Self::Results, found: Self::Found);

    /// The results of methods in order, of all or up to an interruption.
    fn end(
        &self,
        results: Self::Results,
        model: &Model,
        labels: &[String],
        whole: bool,
    ) -> Self::Made;
}

/// What is measured, from where on, and who hears how far it is.
pub struct Subject<'a> {
    pub declaration: &'a Declaration,
    /// The labels of the methods; the usual ones where there are none.
    pub methods: &'a [String],
    pub start: Start,
    pub progress: Option<Py<PyAny>>,
}

impl Subject<'_> {
    /// Has it measured, without the interpreter's lock.
    pub fn measure<M: Measurement>(self, py: Python<'_>, measurement: &M) -> PyResult<M::Made> {
        let Self {
            declaration,
            methods,
            start,
            progress,
        } = self;
        declaration.with_model(py, |model| {
            let choices = choices(&model, methods, M::usual)
                .map_err(|refused| Python::attach(|py| refused.raise(py)))?;
            let (options, mut results) = measurement.begin(&model)?;
            let work = lie_in_process::work(
                &model,
                &choices,
                M::PURPOSE,
                lie_in_process::clock::processor,
            );
            let work = work.ok_or_else(|| not_here(M::COMMAND))?;
            let labels: Vec<String> = choices.iter().map(Choice::label).collect();
            let request = lie_measure::Request {
                methods: labels.clone(),
                start,
                options,
            };
            let mut line = serde_json::to_vec(&request)
                .map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
            line.push(b'\n');
            let take = |found| M::take(&mut results, found);
            let whole = converse(&work, &line, Progress::of("", progress), take)?.whole(&model)?;
            Ok(measurement.end(results, &model, &labels, whole))
        })
    }
}

/// The choices of these labels; of all that `usual` gives where there are none, those that run here.
fn choices(
    model: &Model,
    labels: &[String],
    usual: fn(&Model) -> Vec<Choice>,
) -> Result<Vec<Choice>, crate::choice::Refused> {
    match labels {
        [] => Ok(usual(model)
            .into_iter()
            .filter(crate::declaration::runs)
            .collect()),
        labels => labels.iter().map(|label| wanted(model, label)).collect(),
    }
}

/// The answer where a measurement would need a built program.
fn not_here(command: &str) -> PyErr {
    let text = "not all of this runs in Python yet: a method or the kind of system";
    let help = format!("`{command}` has it: write the declaration to a file");
    Python::attach(|py| method_error(py, text, &help))
}

/// How a conversation ended.
struct Outcome {
    end: Option<End>,
    /// The exception that ended it early.
    interrupted: Option<PyErr>,
}

impl Outcome {
    /// Whether it came to its end, and not to Ctrl-C.
    fn whole(self, model: &Model) -> PyResult<bool> {
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
        Obstacle::Request | Obstacle::Option | Obstacle::Initial => return why.to_owned(),
    };
    format!("{what} {system}: {why}\n  help: {help}")
}

/// What is heard of a measurement.
enum News<F> {
    Found(F),
    Progress(lie_program::protocol::Progress),
}

/// Has a request served by a thread, and looks for Ctrl-C meanwhile: closing the input ends the work. `take` gets what is found.
fn converse<F: DeserializeOwned + Send>(
    work: &lie_in_process::Work,
    line: &[u8],
    mut progress: Progress,
    mut take: impl FnMut(F),
) -> PyResult<Outcome> {
    let (questions, mut asks) = io::pipe()?;
    let (answers, says) = io::pipe()?;
    asks.write_all(line)?;
    let mut asks = Some(asks);
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let mut output = BufWriter::new(says);
            serve(None, Box::new(BufReader::new(questions)), &mut output, work)
        });
        let (sender, news) = channel();
        let heard = scope.spawn(move || hear(answers, &sender));
        let mut interrupted = None;
        loop {
            let next = next(&news);
            let said = match next {
                Next::Over => break,
                Next::Nothing => Ok(()),
                Next::News(News::Found(found)) => {
                    take(found);
                    Ok(())
                }
                Next::News(News::Progress(_)) if interrupted.is_some() => Ok(()),
                Next::News(News::Progress(news)) => match &news.stage {
                    Some(what) => progress.stage(news.done, news.all, what),
                    None => progress.tell(news.done, news.all),
                },
            };
            if interrupted.is_none() {
                let signals = || Python::attach(|py| py.check_signals());
                interrupted = said.and_then(|()| signals()).err();
                if interrupted.is_some() {
                    asks = None;
                }
            }
        }
        drop(asks);
        let end = heard
            .join()
            .unwrap_or_else(|_| Err(io::Error::other("a thread failed")))?;
        if matches!((&end, &interrupted), (Some(End::Done), None)) {
            // what was measured stays, also where the last word is answered with Ctrl-C
            interrupted = progress.end().err();
        }
        Ok(Outcome { end, interrupted })
    })
}

/// What comes next from a measurement.
enum Next<F> {
    News(News<F>),
    Nothing,
    Over,
}

fn next<F>(news: &Receiver<News<F>>) -> Next<F> {
    match news.recv_timeout(PAUSE) {
        Ok(news) => Next::News(news),
        Err(RecvTimeoutError::Timeout) => Next::Nothing,
        Err(RecvTimeoutError::Disconnected) => Next::Over,
    }
}

/// Hands on what a measurement says, to its last message.
fn hear<F: DeserializeOwned>(
    answers: io::PipeReader,
    sender: &Sender<News<F>>,
) -> io::Result<Option<End>> {
    let mut end = None;
    listen(&mut BufReader::new(answers), &mut |message, _| {
        let news = match message {
            Message::Found(found) => News::Found(found),
            Message::Progress(progress) => News::Progress(progress),
            Message::End(last) => {
                end = Some(last);
                return Ok(());
            }
        };
        // the other side hears all until this thread is over
        let _ = sender.send(news);
        Ok(())
    })?;
    Ok(end)
}
