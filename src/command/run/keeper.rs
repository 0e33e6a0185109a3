//! Keeps the checkpoint of a run up to date.

use std::error::Error;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use lie_in_process::request::Several;
use lie_program::protocol::{Milestone, Milestones};

use super::checkpoint::{self, Checkpoint, Place, refused};
use super::reception::Received;
use crate::command::args;
use crate::command::files::{Inputs, unwritable};
use crate::compiler::Spec;
use crate::message::{Failure, Message};
use lie_output::Rows;

/// The checkpoint of a run, and where it is.
pub struct Keeper {
    path: PathBuf,
    rows: PathBuf,
    every: Option<u64>,
    checkpoint: Checkpoint,
    began: Instant,
    before: Duration,
}

/// A checkpoint that cannot be written, which ends the run: the one before it stays.
#[derive(Debug)]
pub struct Unwritten(pub PathBuf, io::Error);

impl fmt::Display for Unwritten {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the checkpoint cannot be written: {}", self.1)
    }
}

impl Error for Unwritten {}

/// Whether a run can have a checkpoint.
///
/// # Errors
/// `option`.
pub fn check(flags: &args::Run, several: &Several) -> Result<(), Failure> {
    let (text, help) = if flags.out.is_none() {
        (
            "the rows that a run goes on behind are those of a file",
            "add `--out FILE`",
        )
    } else if flags.plot.is_some() {
        (
            "a run that is taken up again has only a part of the rows to draw",
            "leave out `--plot`, or `--checkpoint`",
        )
    } else if several.labels.is_some() {
        (
            "a checkpoint is that of one run, and these are several",
            "make them one by one, each with a checkpoint of its own",
        )
    } else {
        return Ok(());
    };
    Err(Message::option("--checkpoint", text).help(help).into())
}

impl Keeper {
    /// The keeper of a run that begins, or goes on from a checkpoint.
    ///
    /// # Errors
    /// `option` for a file that is something else, `checkpoint` for one of a run that has not ended, `io`.
    pub fn new(
        flags: &args::Run,
        path: &Path,
        spec: &Spec,
        inputs: &Inputs,
        taken_up: Option<Checkpoint>,
    ) -> Result<Self, Failure> {
        let rows = flags.out.clone().unwrap_or_default();
        let checkpoint = match taken_up {
            Some(checkpoint) => Checkpoint {
                finished: false,
                ..checkpoint
            },
            None => {
                inputs.with_rows(&rows).spare("--checkpoint", path)?;
                vacant(path)?;
                let checkpoint = checkpoint::of(flags, spec)?;
                checkpoint::write(&checkpoint, path).map_err(|error| unwritable(path, &error))?;
                checkpoint
            }
        };
        let seconds = checkpoint.place.as_ref().map_or(0.0, |place| place.seconds);
        Ok(Self {
            path: path.to_owned(),
            rows,
            every: flags.checkpoint_every,
            checkpoint,
            began: Instant::now(),
            before: Duration::try_from_secs_f64(seconds).unwrap_or_default(),
        })
    }

    /// How far the run was when it was taken up.
    pub fn place(&self) -> Option<&Place> {
        self.checkpoint.place.as_ref()
    }

    /// Which milestones it wants to know.
    pub fn milestones(&self) -> Milestones {
        self.every.map_or(Milestones::Timed, Milestones::Every)
    }

    /// The time that the run took before it was taken up.
    pub fn before(&self) -> Duration {
        self.before
    }

    /// Takes down how far the run is.
    ///
    /// # Errors
    /// The rows cannot be brought to the disk, or [`Unwritten`].
    pub fn keep(
        &mut self,
        milestone: Milestone,
        rows: &mut Rows,
        received: &Received,
    ) -> io::Result<()> {
        self.checkpoint.place = Some(Place {
            milestone,
            written: rows.written(&self.rows)?,
            drift: received.drift.kept(),
            events: received.events.clone(),
            shortened: received.shortened,
            seconds: (self.before + self.began.elapsed()).as_secs_f64(),
        });
        self.write()
    }

    /// Takes down that the run came to its end.
    ///
    /// # Errors
    /// [`Unwritten`].
    pub fn finish(&mut self) -> io::Result<()> {
        self.checkpoint.finished = true;
        self.write()
    }

    fn write(&self) -> io::Result<()> {
        let written = checkpoint::write(&self.checkpoint, &self.path);
        written.map_err(|error| io::Error::other(Unwritten(self.path.clone(), error)))
    }

    /// What to type to go on, after a signal.
    pub fn remedy(&self) -> String {
        let step = self.place().map_or(0, |place| place.milestone.index);
        let path = self.path.display();
        format!("`lie resume {path}` goes on from step {step}.")
    }
}

/// Refuses a file that is no checkpoint, and the checkpoint of a run that can go on.
fn vacant(path: &Path) -> Result<(), Failure> {
    match path.metadata() {
        Err(_) => return Ok(()),
        Ok(found) if found.is_file() && found.len() == 0 => return Ok(()),
        Ok(found) if found.is_file() => {}
        Ok(_) => {
            let text = format!("`{}` is no file", path.display());
            let help = "give the name of a file, which is made";
            return Err(Message::option("--checkpoint", text).help(help).into());
        }
    }
    let place = match checkpoint::read(path) {
        Ok(Checkpoint {
            finished: false,
            place: Some(place),
            ..
        }) => place,
        Ok(_) => return Ok(()),
        Err(_) => {
            let text = format!("`{}` holds something else", path.display());
            let help = "give a file that does not exist, or remove it";
            return Err(Message::option("--checkpoint", text).help(help).into());
        }
    };
    let text = format!(
        "this is the checkpoint of a run that has come to step {}",
        place.milestone.index
    );
    let shown = path.display();
    let help =
        format!("`lie resume {shown}` goes on with it; remove the file to begin another run");
    Err(refused(path, text).help(help).into())
}
