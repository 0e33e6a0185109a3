//! The side of what works: one request in, messages out, as lines of another process or by a channel of this one.

use crate::protocol::{End, Message, Obstacle, Progress, Wire};
use serde::de::DeserializeOwned;
use std::io::{self, BufRead, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

/// How often a program says how far it is.
const PROGRESS: Duration = Duration::from_millis(120);

/// Whether a session is to end, for work that does not talk to it.
#[derive(Clone, Debug, Default)]
pub struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// Whether it is.
    pub fn is_there(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Asks the session to end.
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Takes what is said in a session.
pub trait Output<F> {
    /// Takes a message.
    ///
    /// # Errors
    /// Nobody listens any more.
    fn say(&mut self, message: Message<F>) -> io::Result<()>;

    /// Hands on what was taken.
    ///
    /// # Errors
    /// As of [`say`](Self::say).
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Lines for another process.
pub struct Lines<'a>(pub &'a mut dyn Write);

impl<F: Wire> Output<F> for Lines<'_> {
    fn say(&mut self, message: Message<F>) -> io::Result<()> {
        let mut line = serde_json::to_vec(&message)?;
        line.push(b'\n');
        if let Message::Found(found) = &message {
            line.extend(
                found
                    .numbers()
                    .iter()
                    .flat_map(|number| number.to_le_bytes()),
            );
        }
        self.0.write_all(&line)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl<F> Output<F> for SyncSender<Message<F>> {
    fn say(&mut self, message: Message<F>) -> io::Result<()> {
        let sent = self.send(message);
        sent.map_err(|_| io::ErrorKind::BrokenPipe.into())
    }
}

/// Keeps everything.
impl<F> Output<F> for Vec<Message<F>> {
    fn say(&mut self, message: Message<F>) -> io::Result<()> {
        self.push(message);
        Ok(())
    }
}

/// What work talks to, `F` being what it finds.
pub struct Session<'a, F> {
    output: &'a mut dyn Output<F>,
    interrupted: Interruption,
    reported: Instant,
    lost: Option<io::Error>,
}

impl<'a, F> Session<'a, F> {
    /// A session that nobody interrupts.
    pub fn undisturbed(output: &'a mut dyn Output<F>) -> Self {
        Self::new(output, Interruption::default())
    }

    fn new(output: &'a mut dyn Output<F>, interrupted: Interruption) -> Self {
        Self {
            output,
            interrupted,
            reported: Instant::now(),
            lost: None,
        }
    }

    /// Says what was found.
    pub fn found(&mut self, found: F) {
        self.say(Message::Found(found));
        self.flush();
    }

    /// The same, at once or with what follows it.
    pub(crate) fn mentions(&mut self, found: F) {
        self.say(Message::Found(found));
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
        if self.lost.is_none() {
            self.lost = self.output.flush().err();
        }
    }

    fn tell(&mut self, progress: Progress) {
        self.say(Message::Progress(progress));
        self.flush();
    }

    /// Keeps the first error for the end.
    fn say(&mut self, message: Message<F>) {
        if self.lost.is_none() {
            self.lost = self.output.say(message).err();
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

/// What is done with a request.
pub type Work<'a, Q, F> = dyn Fn(Q, &mut Session<'_, F>) -> Result<(), End> + 'a;

/// Serves the request on standard input. After the end of the input, what is still running once the grace is over ends with
/// the process.
pub fn main<Q: DeserializeOwned, F: Wire>(grace: Duration, work: &Work<'_, Q, F>) -> ExitCode {
    let input = Box::new(io::BufReader::new(io::stdin()));
    let mut output = io::BufWriter::with_capacity(1 << 16, io::stdout().lock());
    ExitCode::from(serve(Some(grace), input, &mut output, work))
}

/// Serves one request; returns the exit code.
pub fn serve<Q: DeserializeOwned, F: Wire>(
    grace: Option<Duration>,
    mut input: Box<dyn BufRead + Send>,
    output: &mut dyn Write,
    work: &Work<'_, Q, F>,
) -> u8 {
    let mut output = Lines(output);
    let refused =
        |error: &dyn std::error::Error| End::refused(Obstacle::Request, error.to_string());
    let mut line = String::new();
    let read = input.read_line(&mut line);
    if read.is_ok() && !line.ends_with('\n') {
        return End::Interrupted.code();
    }
    let request = match &read {
        Ok(_) => serde_json::from_str(&line).map_err(|error| refused(&error)),
        Err(error) => Err(refused(error)),
    };
    let (code, lost) = attend(
        &mut output,
        lifeline(input, grace),
        |session: &mut Session<'_, F>| work(request?, session),
    );
    if let Some(error) = lost {
        // there may be no standard error either
        let _ = writeln!(io::stderr(), "the results cannot be written: {error}");
    }
    code
}

/// Has work done in a session, and says how it ended; returns the exit code, which has to do where nobody listens any
/// more, and why nobody does.
pub fn attend<F>(
    output: &mut dyn Output<F>,
    interruption: Interruption,
    work: impl FnOnce(&mut Session<'_, F>) -> Result<(), End>,
) -> (u8, Option<io::Error>) {
    let mut session = Session::new(output, interruption);
    let ended = work(&mut session);
    let ended = ended.and_then(|()| session.intact());
    let end = ended.err().unwrap_or(End::Done);
    let code = end.code();
    session.say(Message::End(end));
    session.flush();
    (code, session.lost)
}

/// Becomes true when the input ends.
fn lifeline(mut input: Box<dyn BufRead + Send>, grace: Option<Duration>) -> Interruption {
    let ended = Interruption::default();
    let flag = ended.clone();
    std::thread::spawn(move || {
        // an error of the input ends the run as its end does
        let _ = io::copy(&mut input, &mut io::sink());
        flag.set();
        if let Some(grace) = grace {
            std::thread::sleep(grace);
            std::process::exit(i32::from(End::Interrupted.code()));
        }
    });
    ended
}
