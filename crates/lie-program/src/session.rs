//! The side of a program: one request in, messages out.

use crate::protocol::{End, Found, Message, Obstacle, Progress};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::{self, BufRead, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How often a program says how far it is.
const PROGRESS: Duration = Duration::from_millis(120);

/// Whether the input of a session has ended, for work that does not talk to it.
#[derive(Clone, Debug, Default)]
pub struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// Whether it has.
    pub fn is_there(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What a program talks to while it works.
pub struct Session<'a> {
    output: &'a mut dyn Write,
    interrupted: Interruption,
    reported: Instant,
    lost: Option<io::Error>,
}

impl<'a> Session<'a> {
    /// A session that nobody interrupts.
    pub fn undisturbed(output: &'a mut dyn Write) -> Self {
        Self::new(output, Interruption::default())
    }

    fn new(output: &'a mut dyn Write, interrupted: Interruption) -> Self {
        Self {
            output,
            interrupted,
            reported: Instant::now(),
            lost: None,
        }
    }

    /// Says what was found.
    pub fn found<R: Serialize>(&mut self, found: R) {
        self.say(&Message::Found(found));
        self.flush();
    }

    /// Says something of a run, at once or with what follows it.
    pub(crate) fn of_run(&mut self, found: Found, bytes: &[u8]) {
        self.say(&Message::Found(found));
        self.write(bytes);
    }

    /// Says what is done next.
    ///
    /// # Errors
    /// As of [`goes_on`](Self::goes_on).
    pub fn stage(&mut self, done: u64, all: u64, what: &str) -> Result<(), End> {
        self.tell(Progress {
            done,
            all,
            stage: Some(what.to_owned()),
        });
        self.goes_on()
    }

    /// Says how far it is, if it has not just said so.
    ///
    /// # Errors
    /// As of [`goes_on`](Self::goes_on).
    pub fn progress(&mut self, done: u64, all: u64) -> Result<(), End> {
        if self.reported.elapsed() >= PROGRESS {
            self.reported = Instant::now();
            self.tell(Progress {
                done,
                all,
                stage: None,
            });
        }
        self.goes_on()
    }

    /// Whether to go on.
    ///
    /// # Errors
    /// The input has ended, or nobody takes the results.
    pub fn goes_on(&mut self) -> Result<(), End> {
        self.intact()?;
        match self.is_interrupted() {
            true => Err(End::Interrupted),
            false => Ok(()),
        }
    }

    /// Whether everything so far was written.
    ///
    /// # Errors
    /// It was not.
    pub fn intact(&mut self) -> Result<(), End> {
        self.lost.as_ref().map_or(Ok(()), |error| {
            let why = error.to_string();
            Err(End::Unwritten { why })
        })
    }

    /// Whether the input has ended.
    pub fn is_interrupted(&self) -> bool {
        self.interrupted.is_there()
    }

    /// Tells the same elsewhere.
    pub fn interruption(&self) -> Interruption {
        self.interrupted.clone()
    }

    pub(crate) fn flush(&mut self) {
        let flushed = self.output.flush();
        self.keep(flushed);
    }

    fn tell(&mut self, progress: Progress) {
        self.say(&Message::<()>::Progress(progress));
        self.flush();
    }

    fn say<R: Serialize>(&mut self, message: &Message<R>) {
        match serde_json::to_vec(message) {
            Ok(mut line) => {
                line.push(b'\n');
                self.write(&line);
            }
            Err(error) => self.keep(Err(error.into())),
        }
    }

    fn write(&mut self, bytes: &[u8]) {
        if self.lost.is_none() {
            let written = self.output.write_all(bytes);
            self.keep(written);
        }
    }

    /// Keeps the first error for the end.
    fn keep(&mut self, result: io::Result<()>) {
        if let Err(error) = result {
            self.lost.get_or_insert(error);
        }
    }
}

/// A method that a program was not built with.
pub fn no_method(label: &str) -> End {
    End::refused(
        Obstacle::Request,
        format!("no method `{label}` in this program"),
    )
}

/// What a program does with the line of a request.
///
/// The line and not the request: what reads requests and writes messages is the same for every system, and is not to be
/// compiled again with each.
pub type Work<'a> = dyn Fn(&str, &mut Session<'_>) -> Result<(), End> + 'a;

/// The request of a line.
///
/// # Errors
/// It is none.
pub fn read<Q: DeserializeOwned>(line: &str) -> Result<Q, End> {
    serde_json::from_str(line).map_err(|error| End::refused(Obstacle::Request, error.to_string()))
}

/// Serves the request on standard input. After the end of the input, what is still running once the grace is over ends with
/// the process.
pub fn main(grace: Duration, work: &Work<'_>) -> ExitCode {
    let input = Box::new(io::BufReader::new(io::stdin()));
    let mut output = io::BufWriter::with_capacity(1 << 16, io::stdout().lock());
    ExitCode::from(serve(Some(grace), input, &mut output, work))
}

/// Serves one request; returns the exit code.
pub fn serve(
    grace: Option<Duration>,
    mut input: Box<dyn BufRead + Send>,
    output: &mut dyn Write,
    work: &Work<'_>,
) -> u8 {
    let mut line = String::new();
    if let Err(error) = input.read_line(&mut line) {
        let end = End::refused(Obstacle::Request, error.to_string());
        return last(&mut Session::undisturbed(output), end);
    }
    if !line.ends_with('\n') {
        return End::Interrupted.code();
    }
    let mut session = Session::new(output, lifeline(input, grace));
    let ended = work(&line, &mut session);
    let ended = ended.and_then(|()| session.intact());
    last(&mut session, ended.err().unwrap_or(End::Done))
}

/// Says how it ended. Where nobody listens any more, the exit code has to do, and a line for people.
fn last(session: &mut Session<'_>, end: End) -> u8 {
    let code = end.code();
    session.say(&Message::<()>::End(end));
    session.flush();
    if let Some(error) = &session.lost {
        // there may be no standard error either
        let _ = writeln!(io::stderr(), "the results cannot be written: {error}");
    }
    code
}

/// Becomes true when the input ends.
fn lifeline(mut input: Box<dyn BufRead + Send>, grace: Option<Duration>) -> Interruption {
    let ended = Interruption::default();
    let flag = ended.clone();
    std::thread::spawn(move || {
        // an error of the input ends the run as its end does
        let _ = io::copy(&mut input, &mut io::sink());
        flag.0.store(true, Ordering::Relaxed);
        if let Some(grace) = grace {
            std::thread::sleep(grace);
            std::process::exit(i32::from(End::Interrupted.code()));
        }
    });
    ended
}
