//! Mistakes of what people ask for, with their place and their remedy.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// A spec as it was read.
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
    Text(Arc<Source>, Range<usize>),
    /// An option or an argument, of the command line or of a call, with its value and the bad range in it.
    Argument {
        /// `--step`, `SPEC`, `h`, ….
        name: String,
        /// The value and the byte range in it that is wrong.
        value: Option<(String, Range<usize>)>,
    },
}

/// What is at fault, which is an exception of its own in Python.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fault {
    /// What was given for an argument.
    #[default]
    Value,
    /// Which arguments were given: one is missing, or two exclude each other.
    Arguments,
    /// The method, or an option that it does not have.
    Method,
    /// Nothing that was asked for: there is too little memory for it.
    Memory,
}

/// One mistake or warning.
#[derive(Clone, Debug)]
pub struct Message {
    /// Its kind, as in `error[KIND]`.
    pub kind: Kind,
    /// What is at fault.
    pub fault: Fault,
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
            fault: match kind {
                Kind::Method | Kind::Legendre | Kind::Splitting => Fault::Method,
                _ => Fault::Value,
            },
            text: text.into(),
            place: Place::None,
            help: None,
            warning: false,
        }
    }

    /// An `option` error at an option or argument.
    pub fn option(name: &str, text: impl Into<String>) -> Self {
        Self::new(Kind::Option, text).at_option(name)
    }

    /// A file that cannot be read or written.
    pub fn io(path: &Path, text: impl Into<String>) -> Self {
        let mut message = Self::new(Kind::Io, text);
        message.place = Place::File(path.display().to_string());
        message
    }

    /// A diagnostic of the compiler, found in `source`.
    pub fn from_spec(source: &Arc<Source>, diagnostic: Diagnostic) -> Self {
        let place = match diagnostic.origin {
            Some(Origin::Text { start, end }) => Place::Text(Arc::clone(source), start..end),
            _ => Place::File(source.path.clone()),
        };
        let message = Self::new(diagnostic.kind, diagnostic.message);
        Self {
            place,
            help: diagnostic.help,
            warning: diagnostic.warning,
            ..message
        }
    }

    /// Puts the message at an option or argument.
    #[must_use]
    pub fn at_option(mut self, name: &str) -> Self {
        self.place = Place::Argument {
            name: name.to_owned(),
            value: None,
        };
        self
    }

    /// Puts the message somewhere else.
    #[must_use]
    pub fn at_place(mut self, place: Place) -> Self {
        self.place = place;
        self
    }

    /// Adds the remedy.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Says what is at fault.
    #[must_use]
    pub fn with_fault(mut self, fault: Fault) -> Self {
        self.fault = fault;
        self
    }
}
