//! The content of a checkpoint, from which `lie resume` goes on, and the text of its file.
//!
//! The text has three lines: what it is and which program has written it; the content as JSON; a digest of both.

use std::path::PathBuf;

use lie_program::protocol::{Event, Milestone};
use serde::{Deserialize, Serialize};

use crate::key::Key;

/// What each begins with; the number is that of the form.
const MARK: &str = "lie checkpoint 1, by lie ";

/// What is kept of a run.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// The command line behind `lie`.
    pub arguments: Vec<String>,
    /// The folder in which it was given.
    pub folder: PathBuf,
    /// The files that were read, with a digest of each.
    pub inputs: Vec<(PathBuf, String)>,
    /// How far the run is; nothing before its first milestone.
    pub place: Option<Place>,
    /// Whether it came to its end.
    pub finished: bool,
}

/// How far a run is.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// Where it can be taken up again.
    pub milestone: Milestone,
    /// The rows in the file; nothing before the first.
    pub written: Option<Written>,
    /// The errors of the invariants.
    pub drift: KeptDrift,
    /// The events so far.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<Event>,
    /// The step that was shortened, and since when.
    pub shortened: Option<(f64, f64)>,
    /// The time that it took.
    pub seconds: f64,
}

/// So much of a file that rows go to as is on the disk.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Written {
    /// Bytes at the start that change with the number of rows.
    pub start: u64,
    /// Bytes in all.
    pub length: u64,
    /// Rows among them.
    pub rows: u64,
    /// A digest of the last bytes.
    pub tail: String,
}

/// The bits of the errors so far.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct KeptDrift {
    /// The first value of each invariant, and how far it was from that.
    pub invariants: Vec<(u64, u64)>,
    /// The largest absolute value of a component of the state.
    pub scale: u64,
    /// The time of the last row.
    pub time: u64,
}

/// Why a text is not taken for a checkpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unread {
    /// It is something else.
    Foreign,
    /// Another version has written it.
    Version(String),
    /// Something of it is not as it was written.
    Damaged(String),
}

impl Checkpoint {
    /// Reads what a version has written.
    ///
    /// # Errors
    /// What is none, is damaged, or was written by another version.
    pub fn read(bytes: &[u8], version: &str) -> Result<Self, Unread> {
        let damaged = |what: &str| Unread::Damaged(what.to_owned());
        let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or(&[]);
        let writer = first.strip_prefix(MARK.as_bytes());
        let writer = String::from_utf8_lossy(writer.ok_or(Unread::Foreign)?);
        if writer != version {
            return Err(Unread::Version(writer.into_owned()));
        }
        let text = std::str::from_utf8(bytes).map_err(|_| damaged("it is no text"))?;
        let mut lines = text.split_inclusive('\n').skip(1);
        let (Some(content), Some(digest), None) = (lines.next(), lines.next(), lines.next()) else {
            return Err(damaged("a part of it is missing"));
        };
        let signed = &text[..text.len() - digest.len()];
        if digest.strip_suffix('\n') != Some(Key::digest(signed.as_bytes()).as_str()) {
            return Err(damaged("its digest is another one"));
        }
        serde_json::from_str(content).map_err(|error| damaged(&error.to_string()))
    }

    /// The text of its file.
    ///
    /// # Errors
    /// Numbers that are none, which no run has.
    pub fn text(&self, version: &str) -> serde_json::Result<String> {
        Ok(signed(&serde_json::to_string(self)?, version))
    }
}

/// The text with a content that is JSON in one line.
#[must_use]
pub fn signed(content: &str, version: &str) -> String {
    let text = format!("{MARK}{version}\n{content}\n");
    let digest = Key::digest(text.as_bytes());
    format!("{text}{digest}\n")
}
