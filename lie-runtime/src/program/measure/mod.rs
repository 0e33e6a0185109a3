//! Programs that measure many methods on one system: the parts that `verify`, `bench` and `stress` share.
//!
//! Requests are lines as for [`Program`](super::Program), here: `method <label>` (repeated), `parameter <index>
//! <value>`, `initial <v1> <v2> …`, further keys with a number each, then `run`. Results are lines on standard
//! output, fields separated by tabs, the first of them naming the kind of line; progress and the last word are lines
//! on standard error, as there, and `stage <done> <all> <what>` before each part of the work. When the input ends after `run`, the program stops after the measurement that
//! it is at, but not later than two seconds after.

mod bench;
mod driven;
mod kernels;
mod outside;
mod stress;
mod timing;
mod verify;

pub use bench::{Bench, Control, ControlRun};
pub use stress::Stress;
pub use verify::Verify;

use super::{Build, say};
use crate::poisson::Poisson;
use crate::state::State;
use std::io::{self, BufRead, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long a measurement may take after the input has ended.
const GRACE: Duration = Duration::from_secs(2);

/// What is asked for.
pub(super) struct Request {
    methods: Vec<String>,
    parameters: Vec<f64>,
    initial: Vec<f64>,
    numbers: Vec<(String, f64)>,
}

impl Request {
    /// Reads the lines up to `run`; none if the input ends before.
    fn read(input: &mut impl BufRead, defaults: &[f64]) -> Result<Option<Self>, String> {
        let mut request = Self {
            methods: Vec::new(),
            parameters: defaults.to_vec(),
            initial: Vec::new(),
            numbers: Vec::new(),
        };
        let mut line = String::new();
        loop {
            line.clear();
            match input.read_line(&mut line) {
                Ok(0) => return Ok(None),
                Ok(_) => {}
                Err(error) => return Err(error.to_string()),
            }
            if line.trim() == "run" {
                return Ok(Some(request));
            }
            request
                .take(line.trim())
                .ok_or_else(|| line.trim().to_owned())?;
        }
    }

    fn take(&mut self, line: &str) -> Option<()> {
        let (key, rest) = line.split_once(' ')?;
        match key {
            "method" => self.methods.push(rest.to_owned()),
            "initial" => {
                let values = rest.split_whitespace().map(str::parse);
                self.initial = values.collect::<Result<_, _>>().ok()?;
            }
            "parameter" => {
                let (index, value) = rest.split_once(' ')?;
                *self.parameters.get_mut(index.parse::<usize>().ok()?)? = value.parse().ok()?;
            }
            _ => self.numbers.push((key.to_owned(), rest.parse().ok()?)),
        }
        Some(())
    }

    /// A number by its key.
    fn number(&self, key: &str) -> Option<f64> {
        let found = self.numbers.iter().find(|(known, _)| known == key);
        found.map(|(_, value)| *value)
    }
}

/// What a measuring program talks to while it works.
pub(super) struct Session<'a> {
    output: &'a mut dyn Write,
    messages: &'a mut dyn Write,
    interrupted: Arc<AtomicBool>,
    reported: Instant,
    lost: Option<io::Error>,
}

/// How a measuring program ends, with the last line on standard error.
pub(super) type Ended = Result<(), (u8, String)>;

impl Session<'_> {
    /// Writes one line of results.
    fn line(&mut self, fields: &[&str]) {
        let result =
            writeln!(self.output, "{}", fields.join("\t")).and_then(|()| self.output.flush());
        if let Err(error) = result {
            self.lost.get_or_insert(error);
        }
    }

    /// Says what is done next, and whether to go on.
    ///
    /// # Errors
    /// As of [`progress`](Self::progress).
    fn stage(&mut self, done: u64, all: u64, what: &str) -> Ended {
        let _ = writeln!(self.messages, "stage {done} {all} {what}");
        self.progress(done, all)
    }

    /// Says how far it is, and whether to go on.
    ///
    /// # Errors
    /// The user wants it to end, or nobody takes the results.
    fn progress(&mut self, done: u64, all: u64) -> Ended {
        if let Some(error) = &self.lost {
            return Err((1, format!("output {error}")));
        }
        if self.interrupted.load(Ordering::Relaxed) {
            return Err((130, "interrupted".to_owned()));
        }
        if self.reported.elapsed() > Duration::from_millis(100) {
            self.reported = Instant::now();
            let _ = writeln!(self.messages, "progress {done} {all}");
        }
        Ok(())
    }
}

/// A system of parameters at an initial state.
fn prepare<P: Poisson<f64>>(
    build: &Build<P>,
    parameters: &[f64],
    initial: &[f64],
) -> Result<(P, P::State), (u8, String)> {
    let system = match build(parameters) {
        Ok(system) => system,
        Err(error) => return Err((2, format!("parameter {} {error}", error.name))),
    };
    if initial.len() != system.dimension() {
        let given = initial.len();
        return Err((
            2,
            format!(
                "initial {given} values where {} are needed",
                system.dimension()
            ),
        ));
    }
    let mut mu = system.zero_state();
    mu.as_mut_slice().copy_from_slice(initial);
    Ok((system, mu))
}

/// Serves one request on standard input.
fn main(defaults: &[f64], work: &dyn Fn(&Request, &mut Session<'_>) -> Ended) -> ExitCode {
    let input = io::BufReader::new(io::stdin());
    ExitCode::from(serve(
        Some(GRACE),
        defaults,
        input,
        &mut io::stdout().lock(),
        &mut io::stderr(),
        work,
    ))
}

/// Serves one request; returns the exit code.
fn serve(
    grace: Option<Duration>,
    defaults: &[f64],
    mut input: impl BufRead + Send + 'static,
    output: &mut dyn Write,
    messages: &mut dyn Write,
    work: &dyn Fn(&Request, &mut Session<'_>) -> Ended,
) -> u8 {
    let request = match Request::read(&mut input, defaults) {
        Ok(Some(request)) => request,
        Ok(None) => return 130,
        Err(text) => return say(messages, 2, &format!("request {text}")),
    };
    let mut session = Session {
        output,
        messages,
        interrupted: super::lifeline(input, grace),
        reported: Instant::now(),
        lost: None,
    };
    let ended = work(&request, &mut session);
    let ended = ended.and_then(|()| match session.lost.take() {
        Some(error) => Err((1, format!("output {error}"))),
        None => Ok(()),
    });
    match ended {
        Ok(()) => say(messages, 0, "done"),
        Err((code, text)) => say(messages, code, &text),
    }
}
