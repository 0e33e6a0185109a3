//! Values of options with the place where they were given.

use std::ops::Range;
use std::sync::Arc;

use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

use super::Value;
use crate::message::{Message, Place, Source};

/// Beyond 2^53 not every whole number is a double.
const MOST: f64 = 9_007_199_254_740_992.0;

/// The value of one option, and where it was given.
#[derive(Clone, Debug)]
pub struct OptionValue {
    /// The value as text; empty of a list.
    pub text: String,
    /// What it is where that is no text.
    value: Option<Value>,
    place: At,
}

/// Where an option was given.
#[derive(Clone, Debug)]
enum At {
    /// By an option or an argument: its name, its whole value, and the place of `text` in it.
    Argument(Arc<(String, String)>, usize),
    /// In the spec's `run`.
    Spec(Arc<Source>, Range<usize>),
}

/// The value of an exact constant such as `1/7` or `cos(11/10)`.
///
/// # Errors
/// What is wrong with it; places count from the beginning of `text`.
pub fn constant(text: &str) -> Result<f64, Diagnostic> {
    lie_codegen::compile::constant(text).map_err(|diagnostics| {
        let first = diagnostics.into_iter().next();
        first.unwrap_or_else(|| Diagnostic::placeless(Kind::Number, "not a constant"))
    })
}

impl OptionValue {
    /// The text of an option, as its name is written.
    pub fn flag(name: &str, text: &str) -> Self {
        Self {
            text: text.to_owned(),
            value: None,
            place: At::Argument(Arc::new((name.to_owned(), text.to_owned())), 0),
        }
    }

    /// The value of an option.
    pub fn value(name: &str, value: &Value) -> Self {
        match value {
            Value::Text(text) => Self::flag(name, text),
            Value::Number(number) => Self {
                value: Some(value.clone()),
                ..Self::flag(name, &written(*number))
            },
            Value::List(_) => Self {
                value: Some(value.clone()),
                ..Self::flag(name, "")
            },
        }
    }

    /// A value of the spec's `run`.
    pub fn spec(source: &Arc<Source>, text: &str, origin: Origin) -> Self {
        let range = match origin {
            Origin::Text { start, end } => start..end,
            Origin::Span(_) => 0..0,
        };
        Self {
            text: text.to_owned(),
            value: None,
            place: At::Spec(Arc::clone(source), range),
        }
    }

    /// A mistake in this value.
    pub fn wrong(&self, text: impl Into<String>) -> Message {
        Message::new(Kind::Option, text).at_place(self.at(0..self.text.len()))
    }

    fn at(&self, range: Range<usize>) -> Place {
        match &self.place {
            At::Argument(whole, offset) => Place::Argument {
                name: whole.0.clone(),
                value: Some((whole.1.clone(), range.start + offset..range.end + offset)),
            },
            At::Spec(source, range) => Place::Text(Arc::clone(source), range.clone()),
        }
    }

    /// Whether it was given as a number.
    pub fn is_number(&self) -> bool {
        matches!(self.value, Some(Value::Number(_)))
    }

    /// The value as an exact constant, rounded to the nearest number.
    ///
    /// # Errors
    /// It is none, or not finite.
    pub fn number(&self) -> Result<f64, Message> {
        let value = match self.value {
            Some(Value::Number(value)) => value,
            _ => constant(&self.text).map_err(|diagnostic| self.diagnostic(diagnostic))?,
        };
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
    ///
    /// # Errors
    /// It is none.
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
        let mut message =
            Message::new(diagnostic.kind, diagnostic.message).at_place(self.at(range));
        message.help = diagnostic.help;
        message
    }

    /// The values of a list, or the parts between commas outside parentheses.
    pub fn split(&self) -> Vec<OptionValue> {
        if let (Some(Value::List(values)), At::Argument(whole, _)) = (&self.value, &self.place) {
            return values
                .iter()
                .map(|value| Self::value(&whole.0, value))
                .collect();
        }
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
    pub fn part(&self, range: Range<usize>) -> OptionValue {
        let place = match &self.place {
            At::Argument(whole, offset) => At::Argument(Arc::clone(whole), offset + range.start),
            At::Spec(..) => self.place.clone(),
        };
        OptionValue {
            text: self.text[range].to_owned(),
            value: None,
            place,
        }
    }
}

/// A number as people write it.
fn written(number: f64) -> String {
    match number.is_finite() {
        true => format!("{number:?}"),
        false => number.to_string().to_lowercase(),
    }
}
