//! Reads the values of options: lists and exact constants.

use std::ops::Range;
use std::rc::Rc;

use lie_codegen::diagnostic::{Diagnostic, Kind, Origin};

use crate::compiler;
use crate::message::{Message, Place, Source};

/// Beyond 2^53 not every whole number is a double.
const MOST: f64 = 9_007_199_254_740_992.0;

/// The text of one option, and where it was given.
#[derive(Clone, Debug)]
pub struct Given {
    pub text: String,
    pub place: At,
}

/// Where an option was given.
#[derive(Clone, Debug)]
pub enum At {
    /// On the command line: the flag, its whole value, and the place of `text` in it.
    Flag(&'static str, String, usize),
    /// In the spec's `run`.
    Spec(Rc<Source>, Range<usize>),
}

impl Given {
    /// The value of a flag.
    pub fn flag(name: &'static str, text: &str) -> Self {
        Self {
            text: text.to_owned(),
            place: At::Flag(name, text.to_owned(), 0),
        }
    }

    /// A value of the spec's `run`.
    pub fn spec(source: &Rc<Source>, text: &str, origin: Origin) -> Self {
        let range = match origin {
            Origin::Text { start, end } => start..end,
            Origin::Span(_) => 0..0,
        };
        Self {
            text: text.to_owned(),
            place: At::Spec(Rc::clone(source), range),
        }
    }

    /// A mistake in this value.
    pub fn wrong(&self, text: impl Into<String>) -> Message {
        Message::new(Kind::Option, text).at(self.at(0..self.text.len()))
    }

    fn at(&self, range: Range<usize>) -> Place {
        match &self.place {
            At::Flag(name, whole, offset) => Place::CommandLine {
                option: (*name).to_owned(),
                value: Some((whole.clone(), range.start + offset..range.end + offset)),
            },
            At::Spec(source, range) => Place::Text(Rc::clone(source), range.clone()),
        }
    }

    /// The value as an exact constant, rounded to the nearest number.
    pub fn number(&self) -> Result<f64, Message> {
        let value =
            compiler::constant(&self.text).map_err(|diagnostic| self.diagnostic(diagnostic))?;
        if value.is_finite() {
            Ok(value)
        } else {
            let text = format!(
                "`{}` is not a finite number in double precision",
                self.text.trim()
            );
            Err(self.wrong(text).help("give a number such as 0.01 or 1/7"))
        }
    }

    /// The value as a whole number that is at least 1.
    pub fn count(&self) -> Result<u64, Message> {
        let value = self.number()?;
        if value > MOST {
            let text = format!("`{}` is more than can be counted", self.text.trim());
            Err(self
                .wrong(text)
                .help("give a number up to 2^53, which is 9007199254740992"))
        } else if value.fract() == 0.0 && value >= 1.0 {
            Ok(value as u64)
        } else {
            let text = format!("`{}` is not a whole number of at least 1", self.text.trim());
            Err(self.wrong(text).help("1 keeps every step, 10 every tenth"))
        }
    }

    fn diagnostic(&self, diagnostic: Diagnostic) -> Message {
        let range = match diagnostic.origin {
            Some(Origin::Text { start, end }) => start..end,
            _ => 0..self.text.len(),
        };
        let mut message = Message::new(diagnostic.kind, diagnostic.message).at(self.at(range));
        message.help = diagnostic.help;
        message
    }

    /// The parts between commas outside parentheses.
    pub fn split(&self) -> Vec<Given> {
        let mut parts = Vec::new();
        let (mut depth, mut from) = (0_usize, 0);
        for (at, character) in self.text.char_indices() {
            match character {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                ',' if depth == 0 => {
                    parts.push(self.part(from..at));
                    from = at + 1;
                }
                _ => {}
            }
        }
        parts.push(self.part(from..self.text.len()));
        parts
    }

    /// A part of the value.
    pub fn part(&self, range: Range<usize>) -> Given {
        let place = match &self.place {
            At::Flag(name, whole, offset) => At::Flag(name, whole.clone(), offset + range.start),
            At::Spec(..) => self.place.clone(),
        };
        Given {
            text: self.text[range].to_owned(),
            place,
        }
    }
}
