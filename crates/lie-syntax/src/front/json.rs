//! JSON with places: every value knows its byte range in the file.
//!
//! Values are borrowed as raw text and taken apart one level at a time, where the reader expects
//! a level. Nothing recurses over the input, and a number keeps its decimal text.

use std::fmt;

use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::value::RawValue;

use super::text::Source;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// A JSON value and where it stands.
#[derive(Clone, Copy, Debug)]
pub struct Value<'a> {
    text: &'a str,
    start: usize,
}

/// A key of an object with its value.
#[derive(Clone, Debug)]
pub struct Member<'a> {
    /// The key.
    pub key: Source<'a>,
    /// The value.
    pub value: Value<'a>,
}

/// The types of JSON.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// `{…}`
    Object,
    /// `[…]`
    Array,
    /// `"…"`
    String,
    /// A number.
    Number,
    /// `true` or `false`
    Boolean,
    /// `null`
    Null,
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Type::Object => "an object",
            Type::Array => "a list",
            Type::String => "a string",
            Type::Number => "a number",
            Type::Boolean => "a boolean",
            Type::Null => "null",
        })
    }
}

/// What to do about the mistakes that the parser of JSON finds.
const REMEDIES: &[(&str, &str)] = &[
    ("EOF", "close what is still open, with `\"`, `]` or `}`"),
    (
        "key must be a string",
        "write keys in double quotes, without comments and without a comma before `}`",
    ),
    (
        "trailing comma",
        "remove the comma before the closing bracket",
    ),
    ("trailing characters", "remove everything after the object"),
    (
        "expected `,`",
        "put a comma between two of a kind; a constant such as \"1/3\" stands in quotes",
    ),
    ("expected `:`", "write `\"key\": value`"),
    (
        "expected value",
        "a value is a number, a \"string\", a list, an object, true, false or null",
    ),
    (
        "expected ident",
        "the words of JSON are true, false and null; text stands in double quotes",
    ),
    (
        "invalid number",
        "numbers are like 2, 0.5 or -1e-3; a constant such as \"1/3\" stands in quotes",
    ),
    (
        "control character",
        "a string ends on its line; a line break in it is written `\\n`",
    ),
    ("escape", "a backslash is written twice, as `\\\\`"),
];

/// The value of a whole file.
///
/// # Errors
/// `schema` at the byte where the JSON ends to make sense.
pub fn document(file: &str) -> Result<Value<'_>, Diagnostic> {
    let json = file.strip_prefix('\u{feff}').unwrap_or(file);
    let skipped = file.len() - json.len();
    match serde_json::from_str::<&RawValue>(json) {
        Ok(raw) => Ok(Value {
            text: raw.get(),
            start: skipped + offset_in(json, raw.get()),
        }),
        Err(error) => {
            let at = skipped + error_offset(json, &error);
            let end = file[at..].chars().next().map_or(at, |c| at + c.len_utf8());
            if let Some(mistake) = foreign(file, at) {
                return Err(mistake);
            }
            let message = error.to_string();
            let message = message.split(" at line ").next().unwrap_or(&message);
            let remedy = REMEDIES
                .iter()
                .find(|(mistake, _)| message.contains(mistake));
            Err(Diagnostic::new(
                Kind::Schema,
                Origin::Text { start: at, end },
                format!("malformed JSON: {message}"),
            )
            .help(match remedy {
                _ if json.trim().is_empty() => "a spec is one JSON object; the file is empty",
                Some((_, remedy)) => remedy,
                None => "a spec is one JSON object",
            }))
        }
    }
}

/// What other languages write, by how it begins: what it is and what to do.
const FOREIGN: &[(&[&str], &str, &str)] = &[
    (
        &["//", "/*", "#"],
        "a comment, which JSON does not have",
        "remove it; a text for people stands under the key \"description\"",
    ),
    (
        &["NaN", "nan", "NAN", "Infinity", "infinity", "Inf", "inf"],
        "no number of JSON",
        "write a finite number",
    ),
    (&["True"], "no word of JSON", "write `true`"),
    (&["False"], "no word of JSON", "write `false`"),
    (&["None"], "no word of JSON", "remove the key"),
    (
        &["'"],
        "no quote of JSON",
        "keys and text stand in double quotes",
    ),
    (&["."], "no number of JSON", "write the zero, as in 0.5"),
];

/// A habit of another language at or around the byte where the JSON ends to make sense.
fn foreign(file: &str, at: usize) -> Option<Diagnostic> {
    let begins_word = |c: char| !c.is_alphanumeric() && c != '-';
    let start = match file[..at].rfind(begins_word) {
        Some(before) if file[at..].starts_with(char::is_alphabetic) => {
            before + file[before..].chars().next().map_or(1, char::len_utf8)
        }
        _ => at,
    };
    let text = &file[start..];
    let body = text.strip_prefix('-').unwrap_or(text);
    let sign = text.len() - body.len();
    let (word, what, help) = FOREIGN.iter().find_map(|(words, what, help)| {
        let word = words.iter().find(|word| body.starts_with(**word))?;
        Some((word, what, help))
    })?;
    let place = Origin::Text {
        start,
        end: start + sign + word.len(),
    };
    let message = format!("malformed JSON: `{}` is {what}", &text[..sign + word.len()]);
    Some(Diagnostic::new(Kind::Schema, place, message).help(*help))
}

/// Where `part`, a slice of `whole`, begins in it.
fn offset_in(whole: &str, part: &str) -> usize {
    (part.as_ptr() as usize)
        .saturating_sub(whole.as_ptr() as usize)
        .min(whole.len())
}

/// The byte of the line and column (in bytes, from 1 on, 0 before the first) of the parser.
fn error_offset(json: &str, error: &serde_json::Error) -> usize {
    let line: usize = json
        .split_inclusive('\n')
        .take(error.line().saturating_sub(1))
        .map(str::len)
        .sum();
    let mut at = (line + error.column().saturating_sub(1)).min(json.len());
    while !json.is_char_boundary(at) {
        at -= 1;
    }
    at
}

impl<'a> Value<'a> {
    /// The raw text.
    pub fn raw(&self) -> &'a str {
        self.text
    }

    /// Where the value stands.
    pub fn origin(&self) -> Origin {
        Origin::Text {
            start: self.start,
            end: self.start + self.text.len(),
        }
    }

    /// Where the value begins: its first character. A long object is no place to look at.
    pub fn head(&self) -> Origin {
        Origin::Text {
            start: self.start,
            end: self.start + usize::from(!self.text.is_empty()),
        }
    }

    /// Its type.
    pub fn kind(&self) -> Type {
        match self.text.as_bytes().first() {
            Some(b'{') => Type::Object,
            Some(b'[') => Type::Array,
            Some(b'"') => Type::String,
            Some(b't' | b'f') => Type::Boolean,
            Some(b'n') => Type::Null,
            _ => Type::Number,
        }
    }

    /// The value of a boolean.
    pub fn boolean(&self) -> Option<bool> {
        match self.text {
            "true" => Some(true),
            "false" => Some(false),
            _ => None,
        }
    }

    /// The text of a string.
    pub fn string(&self, report: &mut Report) -> Option<Source<'a>> {
        Source::json(self.text, self.start)
            .map_err(|diagnostic| report.push(diagnostic))
            .ok()
    }

    /// The elements of a list; none for other types.
    pub fn elements(&self) -> Vec<Value<'a>> {
        let mut elements = Vec::new();
        let mut json = serde_json::Deserializer::from_str(self.text);
        // The text was checked as a whole; what is not a list has no elements.
        let _ = json.deserialize_seq(Elements {
            parent: *self,
            into: &mut elements,
        });
        elements
    }

    /// The members of an object, repeated keys included; none for other types.
    pub fn members(&self, report: &mut Report) -> Vec<Member<'a>> {
        let mut members = Vec::new();
        let mut json = serde_json::Deserializer::from_str(self.text);
        let _ = json.deserialize_map(Members {
            parent: *self,
            into: &mut members,
        });
        members
            .into_iter()
            .filter_map(|(key, value)| {
                Some(Member {
                    key: key.string(report)?,
                    value,
                })
            })
            .collect()
    }

    fn part(&self, raw: &'a RawValue) -> Value<'a> {
        Value {
            text: raw.get(),
            start: self.start + offset_in(self.text, raw.get()),
        }
    }
}

struct Elements<'a, 'v> {
    parent: Value<'a>,
    into: &'v mut Vec<Value<'a>>,
}

impl<'a> Visitor<'a> for Elements<'a, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'a>>(self, mut list: A) -> Result<(), A::Error> {
        while let Some(raw) = list.next_element::<&'a RawValue>()? {
            self.into.push(self.parent.part(raw));
        }
        Ok(())
    }
}

struct Members<'a, 'v> {
    parent: Value<'a>,
    into: &'v mut Vec<(Value<'a>, Value<'a>)>,
}

impl<'a> Visitor<'a> for Members<'a, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'a>>(self, mut object: A) -> Result<(), A::Error> {
        while let Some((key, value)) = object.next_entry::<&'a RawValue, &'a RawValue>()? {
            self.into
                .push((self.parent.part(key), self.parent.part(value)));
        }
        Ok(())
    }
}
