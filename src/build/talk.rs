//! Talks with what does the work, by the protocol of [`lie_program`]: a request goes in, messages come out. It is a built
//! program, or a thread of this one.

use std::io::{self, BufRead, BufReader, BufWriter, Read, Write as _};
use std::path::PathBuf;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use lie_codegen::diagnostic::Kind;
use lie_in_process::Work;
use lie_program::listen::listen;
use lie_program::protocol::{End, Message, Obstacle, Progress, Stop};
use lie_program::session::serve;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::interrupt::{Interrupt, own_group};
use crate::message::{Failure, INTERRUPTED};

/// So much of the last words of a program is kept.
const WORDS: usize = 1000;

/// How a program ended.
#[derive(Debug)]
pub enum Outcome {
    /// With everything that was asked for.
    Done,
    /// Asked to stop by a signal, which asks for this exit code.
    Interrupted(u8),
    /// The integration stopped early.
    Stopped(Stop),
    /// A parameter's value is impossible: its name and why.
    Parameter(String, String),
    /// Something else stands against it, and why.
    Refused(Obstacle, String),
    /// Something that the protocol does not know; a bug of ours, or the system killed it.
    Broken(String),
    /// It was ended because what it found was not taken.
    NotTaken(io::Error),
}

/// Takes what a program finds, and what follows it on the output.
pub type Take<'a, R> = dyn FnMut(R, &mut dyn BufRead) -> io::Result<()> + 'a;

/// What does the work.
pub enum Worker {
    /// A built program.
    Program(PathBuf),
    /// A thread of this program.
    Here(Arc<Work>),
}

impl Worker {
    /// Has a request served to its end.
    ///
    /// # Errors
    /// The program cannot be started.
    pub fn talk<R: DeserializeOwned>(
        &self,
        request: &impl Serialize,
        interrupt: &Interrupt,
        found: &mut Take<'_, R>,
        progress: &mut dyn FnMut(&Progress),
    ) -> io::Result<Outcome> {
        match self {
            Self::Program(program) => {
                talk(Command::new(program), request, interrupt, found, progress)
            }
            Self::Here(work) => talk_here(work, request, interrupt, found, progress),
        }
    }

    /// What it is, for those who read times.
    pub fn engine(&self) -> &'static str {
        match self {
            Self::Program(_) => "a program built by cargo",
            Self::Here(_) => {
                "machine code made by this command; --compile measures what cargo builds"
            }
        }
    }

    /// It does what it should not.
    pub fn broken(&self, how: &str) -> Failure {
        match self {
            Self::Program(program) => super::broken(program, how),
            Self::Here(_) => Failure::surroundings(fault(how)),
        }
    }

    /// The system does not start it.
    pub fn not_started(&self, error: &io::Error) -> Failure {
        match self {
            Self::Program(program) => super::not_started(program, error),
            Self::Here(_) => Failure::surroundings(fault(&error.to_string())),
        }
    }
}

/// A thread that fails.
fn fault(how: &str) -> crate::message::Message {
    let text = format!("the run failed: {how}");
    crate::message::Message::new(Kind::Toolchain, text).help(
        "`--compile` runs a program that is built by cargo; if that works, report this failure",
    )
}

/// An output that nobody may listen to any more: why is known on the other side, which also ends the work. It can be closed
/// from elsewhere, so that whoever listens does not wait for what does not end.
struct Unheard<W>(Arc<Mutex<Option<W>>>);

impl<W> Clone for Unheard<W> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<W: io::Write> Unheard<W> {
    fn new(output: W) -> Self {
        Self(Arc::new(Mutex::new(Some(output))))
    }

    fn close(&self) {
        drop(self.lock().take());
    }

    fn lock(&self) -> MutexGuard<'_, Option<W>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Closes an output when it is dropped.
struct CloseAtEnd<W: io::Write>(Unheard<W>);

impl<W: io::Write> Drop for CloseAtEnd<W> {
    fn drop(&mut self) {
        self.0.close();
    }
}

impl<W: io::Write> io::Write for Unheard<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.lock().as_mut().map(|output| output.write(bytes)) {
            None => Ok(bytes.len()),
            Some(Err(error)) if error.kind() == io::ErrorKind::BrokenPipe => Ok(bytes.len()),
            Some(written) => written,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.lock().as_mut().map_or(Ok(()), io::Write::flush)
    }
}

/// Has a thread serve a request, by pipes: what is said, and how it is ended, is as with a program. After a signal, a thread
/// that does not end in time is left behind, to end with this process: what it has said is kept.
fn talk_here<R: DeserializeOwned>(
    work: &Arc<Work>,
    request: &impl Serialize,
    interrupt: &Interrupt,
    found: &mut Take<'_, R>,
    progress: &mut dyn FnMut(&Progress),
) -> io::Result<Outcome> {
    let mut line = serde_json::to_vec(request)?;
    line.push(b'\n');
    let (questions, mut asks) = io::pipe()?;
    let (answers, says) = io::pipe()?;
    let says = Unheard::new(says);
    let (work, output) = (Arc::clone(work), says.clone());
    let served = std::thread::spawn(move || {
        // dropped last, also where the work panics: nobody waits for more
        let _end = CloseAtEnd(output.clone());
        let mut output = BufWriter::with_capacity(1 << 16, output);
        serve(
            None,
            Box::new(BufReader::new(questions)),
            &mut output,
            &*work,
        )
    });
    let _ = asks.write_all(&line);
    let leave = says.clone();
    interrupt.watch_here(Box::new(asks), Box::new(move || leave.close()));
    let heard = hear(answers, found, progress);
    interrupt.stop();
    if let (Ok(None) | Err(Deaf::NotUnderstood(_)), Some(signal)) = (&heard, interrupt.seen())
        && !served.is_finished()
    {
        return Ok(Outcome::Interrupted(signal));
    }
    let code = served.join().ok();
    Ok(match heard {
        Ok(end) => outcome(
            code.map(i32::from),
            end,
            "the thread of the run ended",
            interrupt,
        ),
        Err(Deaf::NotUnderstood(error)) => Outcome::Broken(error.to_string()),
        Err(Deaf::NotTaken(error)) => Outcome::NotTaken(error),
    })
}

/// Runs a program to its end.
///
/// # Errors
/// It cannot be started.
fn talk<R: DeserializeOwned>(
    mut command: Command,
    request: &impl Serialize,
    interrupt: &Interrupt,
    found: &mut Take<'_, R>,
    progress: &mut dyn FnMut(&Progress),
) -> io::Result<Outcome> {
    let mut line = serde_json::to_vec(request)?;
    line.push(b'\n');
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    own_group(&mut command);
    let mut child = command.spawn()?;
    if let Some(mut stdin) = child.stdin.take() {
        // A program that has died already says why on its stderr.
        let _ = stdin.write_all(&line).and_then(|()| stdin.flush());
        interrupt.watch(Box::new(stdin));
    }
    let stderr = child.stderr.take();
    let (heard, words) = std::thread::scope(|scope| {
        let words = scope.spawn(|| stderr.map(last_words));
        let heard = hear_child(&mut child, found, progress);
        if heard.is_err() {
            interrupt.stop();
            // The program may be waiting for us to read.
            let _ = child.kill();
        }
        (heard, words.join().ok().flatten().unwrap_or_default())
    });
    let status = child.wait()?;
    interrupt.stop();
    Ok(match heard {
        Ok(end) => {
            let words = match words.as_str() {
                "" => status.to_string(),
                words => format!("{status}: {words}"),
            };
            outcome(status.code(), end, &words, interrupt)
        }
        Err(Deaf::NotUnderstood(error)) => Outcome::Broken(error.to_string()),
        Err(Deaf::NotTaken(error)) => Outcome::NotTaken(error),
    })
}

/// Why nothing more is heard.
enum Deaf {
    NotUnderstood(io::Error),
    NotTaken(io::Error),
}

fn hear_child<R: DeserializeOwned>(
    child: &mut Child,
    found: &mut Take<'_, R>,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Option<End>, Deaf> {
    match child.stdout.take() {
        Some(stdout) => hear(stdout, found, progress),
        None => Ok(None),
    }
}

/// Hands on what is said; answers the last message, if there was one.
fn hear<R: DeserializeOwned>(
    output: impl Read,
    found: &mut Take<'_, R>,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Option<End>, Deaf> {
    let mut stdout = BufReader::with_capacity(1 << 16, output);
    let (mut last, mut refused) = (None, false);
    let heard = listen(&mut stdout, &mut |message, rest| {
        match message {
            Message::Found(what) => {
                let taken = found(what, rest);
                refused = taken.is_err();
                return taken;
            }
            Message::Progress(so_far) => progress(&so_far),
            Message::End(end) => last = Some(end),
        }
        Ok(())
    });
    match heard {
        Ok(()) => Ok(last),
        Err(error) if refused => Err(Deaf::NotTaken(error)),
        Err(error) => Err(Deaf::NotUnderstood(error)),
    }
}

/// What a program says to people, its end: for the report of a bug.
fn last_words(mut pipe: ChildStderr) -> String {
    let mut words = Vec::new();
    let mut piece = [0; 4096];
    while let Ok(read @ 1..) = pipe.read(&mut piece) {
        words.extend_from_slice(&piece[..read]);
        words.drain(..words.len().saturating_sub(WORDS));
    }
    String::from_utf8_lossy(&words).trim().to_owned()
}

/// What exit code and last message amount to. They have to agree.
fn outcome(code: Option<i32>, end: Option<End>, words: &str, interrupt: &Interrupt) -> Outcome {
    match interrupt.seen() {
        Some(signal) if code == Some(i32::from(INTERRUPTED)) => {
            return Outcome::Interrupted(signal);
        }
        _ => {}
    }
    match end {
        Some(end) if code != Some(i32::from(end.code())) => {}
        Some(End::Done) => return Outcome::Done,
        Some(End::Stopped(stop)) => return Outcome::Stopped(stop),
        Some(End::Parameter { name, why }) => return Outcome::Parameter(name, why),
        Some(End::Refused { what, why }) => return Outcome::Refused(what, why),
        Some(End::Interrupted | End::Unwritten { .. }) | None => {}
    }
    Outcome::Broken(words.to_owned())
}

#[cfg(all(test, unix))]
#[path = "talk_tests.rs"]
mod tests;
