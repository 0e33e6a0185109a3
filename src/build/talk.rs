//! Talks with what does the work: a question goes in, findings come out. It is a built program, by the protocol of
//! [`lie_program`], or a thread of this one.

use std::io::{self, BufReader, Read, Write as _};
use std::path::PathBuf;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::sync::Arc;
use std::time::Duration;

use lie_in_process::converse::{Last, Listener, converse};
use lie_in_process::{Question, Work};
use lie_program::listen::listen;
use lie_program::protocol::{End, Message, Obstacle, Progress, Stop, Wire};
use lie_syntax::diagnostic::Kind;
use serde::Serialize;

use crate::interrupt::{Interrupt, own_group};
use crate::message::{Failure, INTERRUPTED};

/// How long a thread may take after a signal, as long as the programs that measure.
const GRACE: Duration = Duration::from_secs(2);
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

/// Takes what is found.
pub type Sink<'a, R> = dyn FnMut(R) -> io::Result<()> + 'a;

/// What does the work.
pub enum Worker {
    /// A built program.
    Program(PathBuf),
    /// A thread of this program.
    InProcess(Arc<Work>),
}

impl Worker {
    /// Has a question answered to its end.
    ///
    /// # Errors
    /// The program cannot be started.
    pub fn talk<Q>(
        &self,
        question: Q,
        interrupt: &Interrupt,
        found: &mut Sink<'_, Q::Found>,
        progress: &mut dyn FnMut(&Progress),
    ) -> io::Result<Outcome>
    where
        Q: Question<Found: Wire> + Serialize,
    {
        match self {
            Self::Program(program) => {
                talk(Command::new(program), &question, interrupt, found, progress)
            }
            Self::InProcess(work) => talk_here(work, question, interrupt, found, progress),
        }
    }

    /// What it is, for those who read times.
    pub fn engine(&self) -> &'static str {
        match self {
            Self::Program(_) => "a program built by cargo",
            Self::InProcess(_) => {
                "machine code made by this command; --compile measures what cargo builds"
            }
        }
    }

    /// It does what it should not.
    pub fn broken(&self, how: &str) -> Failure {
        match self {
            Self::Program(program) => super::broken(program, how),
            Self::InProcess(_) => Failure::surroundings(fault(how)),
        }
    }

    /// The system does not start it.
    pub fn not_started(&self, error: &io::Error) -> Failure {
        match self {
            Self::Program(program) => super::not_started(program, error),
            Self::InProcess(_) => Failure::surroundings(fault(&error.to_string())),
        }
    }
}

/// Has a question answered to its end by a thread of this program.
///
/// # Errors
/// There is no thread.
pub fn talk_here<Q: Question>(
    work: &Arc<Work>,
    question: Q,
    interrupt: &Interrupt,
    found: &mut Sink<'_, Q::Found>,
    progress: &mut dyn FnMut(&Progress),
) -> io::Result<Outcome> {
    interrupt.expect();
    let mut listener = Ears {
        found,
        progress,
        interrupt,
    };
    let last = converse(work, question, Some(GRACE), &mut listener)?;
    Ok(outcome_here(last, interrupt))
}

/// A thread that fails.
pub fn fault(how: &str) -> crate::message::Message {
    let text = format!("the run failed: {how}");
    crate::message::Message::new(Kind::Toolchain, text).help(
        "`--compile` runs a program that is built by cargo; if that works, report this failure",
    )
}

/// Hears a thread.
struct Ears<'a, 'f, R> {
    found: &'a mut Sink<'f, R>,
    progress: &'a mut dyn FnMut(&Progress),
    interrupt: &'a Interrupt,
}

impl<R> Listener<R> for Ears<'_, '_, R> {
    fn found(&mut self, found: R) -> io::Result<()> {
        (self.found)(found)
    }

    fn progress(&mut self, progress: &Progress) {
        (self.progress)(progress);
    }

    fn stops(&mut self) -> bool {
        self.interrupt.seen().is_some()
    }
}

/// What the last words of a thread amount to. After a signal, one that does not end in time is left behind, to end with this
/// process: what it has said is kept.
fn outcome_here(last: Last, interrupt: &Interrupt) -> Outcome {
    let end = match (last, interrupt.seen()) {
        (Last::Left | Last::Said(Some(End::Interrupted)), Some(signal)) => {
            return Outcome::Interrupted(signal);
        }
        (Last::NotTaken(error), _) => return Outcome::NotTaken(error),
        (Last::Said(end), _) => end,
        (Last::Left, None) => None,
    };
    ended(end).unwrap_or_else(|| Outcome::Broken("the thread of the run ended".to_owned()))
}

/// Runs a program to its end.
///
/// # Errors
/// It cannot be started.
fn talk<R: Wire>(
    mut command: Command,
    request: &impl Serialize,
    interrupt: &Interrupt,
    found: &mut Sink<'_, R>,
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

fn hear_child<R: Wire>(
    child: &mut Child,
    found: &mut Sink<'_, R>,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Option<End>, Deaf> {
    match child.stdout.take() {
        Some(stdout) => hear(stdout, found, progress),
        None => Ok(None),
    }
}

/// Hands on what is said; answers the last message, if there was one.
fn hear<R: Wire>(
    output: impl Read,
    found: &mut Sink<'_, R>,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Option<End>, Deaf> {
    let mut stdout = BufReader::with_capacity(1 << 16, output);
    let (mut last, mut refused) = (None, false);
    let heard = listen(&mut stdout, &mut |message| {
        match message {
            Message::Found(what) => {
                let taken = found(what);
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
    let agreed = end.filter(|end| code == Some(i32::from(end.code())));
    ended(agreed).unwrap_or_else(|| Outcome::Broken(words.to_owned()))
}

/// What the last message amounts to, where it says how the work ended by itself.
fn ended(end: Option<End>) -> Option<Outcome> {
    match end? {
        End::Done => Some(Outcome::Done),
        End::Stopped(stop) => Some(Outcome::Stopped(stop)),
        End::Parameter { name, why } => Some(Outcome::Parameter(name, why)),
        End::Refused { what, why } => Some(Outcome::Refused(what, why)),
        End::Interrupted | End::Unwritten { .. } => None,
    }
}

#[cfg(all(test, unix))]
#[path = "talk_tests.rs"]
mod tests;
