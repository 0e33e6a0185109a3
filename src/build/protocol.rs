//! Talks with a built program: the job goes in as lines, rows of float64 come out.
//!
//! Rows come on its stdout (little-endian, fixed width), progress and the end on its stderr as
//! lines. It stops in order when its stdin ends, also when this process is killed.

use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::process::{Child, ChildStderr, Command, Stdio};

use crate::interrupt::{Interrupt, own_group};
use crate::message::INTERRUPTED;

/// At which times rows are wanted.
#[derive(Clone, Debug, PartialEq)]
pub enum Times {
    /// Every so many steps until a final time.
    Until {
        /// The final time.
        end: f64,
        /// Steps between rows.
        every: u64,
    },
    /// At given times.
    At(Vec<f64>),
}

/// What a program is asked to do.
#[derive(Clone, Debug)]
pub struct Job {
    /// Id of the method.
    pub method: String,
    /// Step size.
    pub step: f64,
    /// When rows are wanted.
    pub times: Times,
    /// Values of all parameters, in order.
    pub parameters: Vec<f64>,
    /// The initial state.
    pub initial: Vec<f64>,
    /// Tolerances that differ from the method's own.
    pub tolerances: Vec<(&'static str, f64)>,
}

impl Job {
    /// The lines of the protocol; `{:?}` of an f64 reads back as the same number.
    fn lines(&self) -> String {
        let mut lines = format!("method {}\nstep {:?}\n", self.method, self.step);
        match &self.times {
            Times::Until { end, every } => {
                lines.push_str(&format!("until {end:?}\nevery {every}\n"));
            }
            Times::At(times) => {
                times
                    .iter()
                    .for_each(|time| lines.push_str(&format!("at {time:?}\n")));
            }
        }
        for (index, value) in self.parameters.iter().enumerate() {
            lines.push_str(&format!("parameter {index} {value:?}\n"));
        }
        lines.push_str("initial");
        self.initial
            .iter()
            .for_each(|value| lines.push_str(&format!(" {value:?}")));
        for (name, value) in &self.tolerances {
            lines.push_str(&format!("\n{name} {value:?}"));
        }
        lines.push_str("\nrun\n");
        lines
    }
}

/// What was counted during a run; a program counts what its method has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts {
    /// Steps taken.
    pub steps: u64,
    /// Evaluations of the vector field or the residual.
    pub evaluations: u64,
    /// Newton iterations.
    pub newton: u64,
    /// Steps that an adaptive method took within those; every other method takes one.
    pub accepted: u64,
    /// Steps tried and refused by an adaptive method.
    pub rejected: u64,
}

/// Why an integration stopped early.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stop {
    /// The step that failed, counted from 0.
    pub step: String,
    /// Time at its beginning.
    pub time: String,
    /// Iterations spent on it.
    pub iterations: String,
    /// What was left of the residual.
    pub residual: String,
    /// Why.
    pub reason: String,
    /// What to do.
    pub remedy: String,
}

/// How a program ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// All rows were written.
    Done(Counts),
    /// Asked to stop by a signal, which asks for this exit code.
    Interrupted(u8),
    /// The integration stopped early.
    Stopped(Stop),
    /// A parameter's value is impossible: its name and why.
    Parameter(String, String),
    /// Something that the protocol does not know; a bug of ours, or the system killed it.
    Broken(String),
}

/// Runs a program to its end.
///
/// `rows` receives whole rows of `width` numbers each; `progress` steps done and in all, on
/// another thread.
///
/// # Errors
/// The program cannot be started, or `rows` refused some: then the program has been stopped.
pub fn run(
    mut command: Command,
    job: &Job,
    width: usize,
    interrupt: &Interrupt,
    rows: &mut dyn FnMut(&[f64]) -> io::Result<()>,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> io::Result<End> {
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    own_group(&mut command);
    let mut child = command.spawn()?;
    if let Some(mut stdin) = child.stdin.take() {
        // A program that has died already says why on its stderr.
        let _ = stdin
            .write_all(job.lines().as_bytes())
            .and_then(|()| stdin.flush());
        interrupt.watch(stdin);
    }
    let stderr = child.stderr.take();
    let (taken, last) = std::thread::scope(|scope| {
        let listener = scope.spawn(|| stderr.map(|pipe| listen(pipe, progress)));
        let taken = take_rows(&mut child, width, rows);
        if taken.is_err() {
            interrupt.stop();
            // The program may be waiting for us to read.
            let _ = child.kill();
        }
        (taken, listener.join().ok().flatten().unwrap_or_default())
    });
    let status = child.wait()?;
    interrupt.stop();
    taken?;
    Ok(match (status.code(), last) {
        (Some(130), _) if interrupt.seen().is_some() => {
            End::Interrupted(interrupt.seen().unwrap_or(INTERRUPTED))
        }
        (Some(0), Last::Done(counts)) => End::Done(counts),
        (Some(2), Last::Parameter(name, why)) => End::Parameter(name, why),
        (Some(3), Last::Failed(stop)) => End::Stopped(stop),
        (_, last) => {
            let words = if let Last::Other(words) = last {
                words
            } else {
                String::new()
            };
            End::Broken(format!(
                "{status}{}{words}",
                if words.is_empty() { "" } else { ": " }
            ))
        }
    })
}

/// How far a measuring program is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress<'a> {
    /// So much is done, of so much.
    Done(u64, u64),
    /// The same, and what comes next.
    Stage(u64, u64, &'a str),
}

/// How a measuring program ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Words {
    /// Its exit code, if it was not killed.
    pub code: Option<i32>,
    /// The same for people.
    pub status: String,
    /// Its last line on stderr.
    pub last: String,
}

/// Runs a measuring program to its end: `request` goes in, `line` receives each line of its stdout as it comes,
/// `progress` how far it is, on another thread.
///
/// # Errors
/// The program cannot be started.
pub fn measure(
    mut command: Command,
    request: &str,
    interrupt: &Interrupt,
    line: &mut dyn FnMut(&str),
    progress: &mut (dyn FnMut(Progress<'_>) + Send),
) -> io::Result<Words> {
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    own_group(&mut command);
    let mut child = command.spawn()?;
    if let Some(mut stdin) = child.stdin.take() {
        // A program that has died already says why on its stderr.
        let _ = stdin
            .write_all(request.as_bytes())
            .and_then(|()| stdin.flush());
        interrupt.watch(stdin);
    }
    let stderr = child.stderr.take();
    let stdout = child.stdout.take();
    let last = std::thread::scope(|scope| {
        let listener = scope.spawn(|| stderr.map(|pipe| last_line(pipe, progress)));
        if let Some(pipe) = stdout {
            let lines = BufReader::new(pipe).lines();
            lines.map_while(Result::ok).for_each(|text| line(&text));
        }
        listener.join().ok().flatten().unwrap_or_default()
    });
    let status = child.wait()?;
    interrupt.stop();
    Ok(Words {
        code: status.code(),
        status: status.to_string(),
        last,
    })
}

fn last_line(pipe: ChildStderr, progress: &mut (dyn FnMut(Progress<'_>) + Send)) -> String {
    let mut last = String::new();
    for text in BufReader::new(pipe).lines().map_while(Result::ok) {
        match how_far(&text) {
            Some(how_far) => progress(how_far),
            None => last = text,
        }
    }
    last
}

/// What a line says of the progress, if it does.
fn how_far(line: &str) -> Option<Progress<'_>> {
    let mut words = line.splitn(4, ' ');
    let kind = words.next()?;
    let (done, all) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
    match kind {
        "progress" => Some(Progress::Done(done, all)),
        "stage" => Some(Progress::Stage(done, all, words.next()?)),
        _ => None,
    }
}

/// Hands on whole rows as they come; half a row at the end of a killed program is dropped.
fn take_rows(
    child: &mut Child,
    width: usize,
    rows: &mut dyn FnMut(&[f64]) -> io::Result<()>,
) -> io::Result<()> {
    let Some(mut stdout) = child.stdout.take() else {
        return Ok(());
    };
    let row = width * 8;
    let mut bytes = vec![0; row.max(1 << 16)];
    let mut numbers = Vec::new();
    let mut filled = 0;
    loop {
        let read = match stdout.read(&mut bytes[filled..]) {
            Ok(0) => return Ok(()),
            Ok(read) => read,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        filled += read;
        let whole = filled - filled % row;
        numbers.clear();
        numbers.extend(
            bytes[..whole]
                .chunks_exact(8)
                .filter_map(|eight| eight.try_into().ok())
                .map(f64::from_le_bytes),
        );
        if !numbers.is_empty() {
            rows(&numbers)?;
        }
        bytes.copy_within(whole..filled, 0);
        filled -= whole;
    }
}

/// The last word of a program.
#[derive(Debug, Default)]
enum Last {
    #[default]
    Nothing,
    Done(Counts),
    Failed(Stop),
    Parameter(String, String),
    Other(String),
}

fn listen(pipe: ChildStderr, progress: &mut (dyn FnMut(u64, u64) + Send)) -> Last {
    let mut last = Last::Nothing;
    let mut reader = BufReader::new(pipe);
    let mut line = Vec::new();
    while matches!(reader.read_until(b'\n', &mut line), Ok(read) if read > 0) {
        let text = String::from_utf8_lossy(&line).trim_end().to_owned();
        line.clear();
        let (word, rest) = text.split_once(' ').unwrap_or((&text, ""));
        match word {
            "progress" => {
                let mut numbers = rest.split(' ').map_while(|number| number.parse().ok());
                if let (Some(done), Some(all)) = (numbers.next(), numbers.next()) {
                    progress(done, all);
                }
            }
            "done" => last = Last::Done(counts(rest)),
            "failed" => last = Last::Failed(stop(rest)),
            "parameter" => {
                let (name, why) = rest.split_once(' ').unwrap_or((rest, ""));
                last = Last::Parameter(name.to_owned(), why.to_owned());
            }
            // The last two lines of anything else, for the report of a bug.
            _ => {
                last = Last::Other(match last {
                    Last::Other(before) => {
                        let tail = before.rsplit('\n').next().unwrap_or_default();
                        format!("{tail}\n{text}")
                    }
                    _ => text,
                });
            }
        }
    }
    last
}

fn counts(fields: &str) -> Counts {
    let value = |name| {
        let found = fields
            .split(' ')
            .find_map(|field| field.strip_prefix(name)?.strip_prefix('='));
        found.and_then(|value| value.parse().ok()).unwrap_or(0)
    };
    Counts {
        steps: value("steps"),
        evaluations: value("evaluations"),
        newton: value("newton"),
        accepted: value("accepted"),
        rejected: value("rejected"),
    }
}

fn stop(fields: &str) -> Stop {
    // `reason` and `remedy` are sentences and stand last.
    let (fields, sentences) = fields.split_once("reason=").unwrap_or((fields, ""));
    let (reason, remedy) = sentences.split_once(" remedy=").unwrap_or((sentences, ""));
    let value = |name| {
        let found = fields
            .split(' ')
            .find_map(|field| field.strip_prefix(name)?.strip_prefix('='));
        found.unwrap_or_default().to_owned()
    };
    Stop {
        step: value("step"),
        time: value("time"),
        iterations: value("iterations"),
        residual: value("residual"),
        reason: reason.trim().to_owned(),
        remedy: remedy.trim().to_owned(),
    }
}

#[cfg(all(test, unix))]
#[path = "protocol_tests.rs"]
mod tests;
