//! What the command has to say on stderr: mistakes with their place and their remedy.

use std::ops::Range;
use std::path::Path;
use std::rc::Rc;

use lie_codegen::diagnostic::{Diagnostic, Kind, Origin};

/// Exit code: a check failed, or the surroundings did (unwritable file, full disk, no cargo).
pub const SURROUNDINGS: u8 = 1;
/// Exit code: the input is invalid, nothing was run.
pub const INVALID: u8 = 2;
/// Exit code: the integration stopped early; the rows so far are written.
pub const STOPPED: u8 = 3;
/// Exit code: Ctrl-C; the rows so far are written. Other signals have codes of their own.
pub const INTERRUPTED: u8 = 130;

/// A spec file as it was read.
#[derive(Debug)]
pub struct Source {
    /// The path as the user wrote it.
    pub path: String,
    /// Its text.
    pub text: String,
}

/// Where a mistake is.
#[derive(Clone, Debug)]
pub enum Place {
    /// Nowhere in particular.
    None,
    /// A whole file.
    File(String),
    /// A byte range of a spec.
    Text(Rc<Source>, Range<usize>),
    /// An option or argument of the command line, with its value and the bad range in it.
    CommandLine {
        /// `--step`, `SPEC`, ….
        option: String,
        /// The value and the byte range in it that is wrong.
        value: Option<(String, Range<usize>)>,
    },
}

/// One mistake or warning.
#[derive(Clone, Debug)]
pub struct Message {
    /// Its kind, as in `error[KIND]`.
    pub kind: Kind,
    /// What is wrong.
    pub text: String,
    /// Where.
    pub place: Place,
    /// What to do.
    pub help: Option<String>,
    /// Whether it only warns.
    pub warning: bool,
}

impl Message {
    /// An error without a place.
    pub fn new(kind: Kind, text: impl Into<String>) -> Self {
        Self {
            kind,
            text: text.into(),
            place: Place::None,
            help: None,
            warning: false,
        }
    }

    /// An `option` error at a flag of the command line.
    pub fn option(flag: &str, text: impl Into<String>) -> Self {
        Self::new(Kind::Option, text).at_option(flag)
    }

    /// A file that cannot be read or written.
    pub fn io(path: &Path, text: impl Into<String>) -> Self {
        let mut message = Self::new(Kind::Io, text);
        message.place = Place::File(path.display().to_string());
        message
    }

    /// A diagnostic of the compiler, found in `source`.
    pub fn from_spec(source: &Rc<Source>, diagnostic: Diagnostic) -> Self {
        let place = match diagnostic.origin {
            Some(Origin::Text { start, end }) => Place::Text(Rc::clone(source), start..end),
            _ => Place::File(source.path.clone()),
        };
        Self {
            place,
            ..Self::plain(diagnostic)
        }
    }

    fn plain(diagnostic: Diagnostic) -> Self {
        Self {
            kind: diagnostic.kind,
            text: diagnostic.message,
            place: Place::None,
            help: diagnostic.help,
            warning: diagnostic.warning,
        }
    }

    /// Puts the message at a flag.
    #[must_use]
    pub fn at_option(mut self, flag: &str) -> Self {
        self.place = Place::CommandLine {
            option: flag.to_owned(),
            value: None,
        };
        self
    }

    /// Puts the message somewhere else.
    #[must_use]
    pub fn at(mut self, place: Place) -> Self {
        self.place = place;
        self
    }

    /// Adds the remedy.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Why a command ends early: what it says, and its exit code.
#[derive(Debug)]
pub struct Failure {
    /// What is printed, in this order.
    pub messages: Vec<Message>,
    /// The exit code.
    pub code: u8,
}

impl Failure {
    /// The input is invalid.
    pub fn invalid(messages: Vec<Message>) -> Self {
        Self {
            messages,
            code: INVALID,
        }
    }

    /// The surroundings failed.
    pub fn surroundings(message: Message) -> Self {
        Self {
            messages: vec![message],
            code: SURROUNDINGS,
        }
    }

    /// A signal ended it.
    pub fn interrupted(code: u8) -> Self {
        Self {
            messages: Vec::new(),
            code,
        }
    }

    /// Ends without a word: the reader of our output went away.
    pub fn quiet() -> Self {
        Self {
            messages: Vec::new(),
            code: 0,
        }
    }
}

impl From<Message> for Failure {
    fn from(message: Message) -> Self {
        Self::invalid(vec![message])
    }
}
