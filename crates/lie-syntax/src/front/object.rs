//! Objects of the spec: unknown, repeated and missing keys, wrong types.

use std::path::{Path, PathBuf};

use super::habits;
use super::json::{Member, Type, Value};
use super::text::Source;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::hints;
use crate::suggest::meant;

/// An object whose keys were checked; every key stands for its first value.
#[derive(Debug)]
pub struct Object<'a> {
    members: Vec<Member<'a>>,
    head: Origin,
    folder: Option<PathBuf>,
}

impl<'a> Object<'a> {
    /// Takes an object apart and reports every key that is not in `keys` or stands there twice.
    pub fn read(value: Value<'a>, what: &str, keys: &[&str], report: &mut Report) -> Option<Self> {
        if value.kind() != Type::Object {
            report.push(wrong_type(&value, what, "an object"));
            return None;
        }
        let (mut members, mut misspelt) = (Vec::<Member<'a>>::new(), Vec::new());
        for member in value.members(report) {
            let key = &*member.key.text;
            let place = member.key.extent();
            let mut error = |message: String, help: String| {
                report.push(Diagnostic::new(Kind::Schema, place, message).help(help));
            };
            if members.iter().any(|m| m.key.text == member.key.text) {
                error(
                    format!("duplicate key `{key}` in {what}"),
                    "remove one of the two".into(),
                );
            } else if keys.contains(&key) {
                members.push(member);
            } else {
                // other objects have keys of their own
                let foreign = habits::key(key).filter(|_| keys.contains(&"hamiltonian"));
                let near = match foreign {
                    Some(_) => None,
                    None => meant(key, keys.iter().copied()),
                };
                let help = match (foreign, near) {
                    (Some(why), _) => why.to_owned(),
                    (None, Some(near)) => format!("did you mean `{near}`?"),
                    (None, None) => format!("the keys of {what} are {}", keys.join(", ")),
                };
                error(
                    format!("unknown key `{}` in {what}", key.escape_debug()),
                    help,
                );
                misspelt.extend(near.map(|near| (near.to_owned(), member.value)));
            }
        }
        // A misspelt key stands for the one that was meant, so that nothing else seems missing.
        for (near, value) in misspelt {
            if members.iter().all(|m| m.key.text != near) {
                let key = Source::owned(near);
                members.push(Member { key, value });
            }
        }
        Some(Self {
            members,
            head: value.head(),
            folder: None,
        })
    }

    /// The same in a folder, relative to which it names files.
    #[must_use]
    pub fn with_folder(self, folder: Option<&Path>) -> Self {
        let folder = folder.map(Path::to_owned);
        Self { folder, ..self }
    }

    /// The folder relative to which it names files; nothing where it is text alone.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<Value<'a>> {
        self.members
            .iter()
            .find(|m| m.key.text == key)
            .map(|m| m.value)
    }

    /// The members, each key once.
    pub fn members(&self) -> &[Member<'a>] {
        &self.members
    }

    /// The elements of a key whose value must be a list.
    pub fn elements(&self, key: &str, report: &mut Report) -> Vec<Value<'a>> {
        let elements = self
            .get(key)
            .and_then(|value| list(value, &format!("`{key}`"), report));
        elements.unwrap_or_default()
    }

    /// The strings of a key whose value must be a list of strings; those that are, where some are not.
    pub fn strings(&self, key: &str, report: &mut Report) -> Vec<Source<'a>> {
        let elements = self.elements(key, report);
        let string = |value| string(value, &format!("an element of `{key}`"), report);
        elements.into_iter().filter_map(string).collect()
    }

    /// Reports the keys that must be there and are not.
    pub fn require(&self, what: &str, keys: &[&str], report: &mut Report) {
        for key in keys {
            if self.get(key).is_none() {
                report.push(
                    Diagnostic::new(Kind::Schema, self.head, format!("{what} has no `{key}`"))
                        .help(format!("add the key `\"{key}\"`")),
                );
            }
        }
    }
}

/// A value of another type than the format has there.
pub fn wrong_type(value: &Value<'_>, what: &str, expected: &str) -> Diagnostic {
    let place = match value.kind() {
        Type::Object | Type::Array => value.head(),
        _ => value.origin(),
    };
    Diagnostic::new(
        Kind::Schema,
        place,
        format!("{what} is {expected}, not {}", value.kind()),
    )
    .help(match (value.kind(), expected) {
        (Type::String, "a list") => format!("write `{}`", as_list(value.raw())),
        _ => match example(what) {
            Some(example) => format!("write {expected}, such as `{example}`"),
            None => format!("write {expected}"),
        },
    })
}

/// What may stand for a key, or for one entry of it.
fn example(what: &str) -> Option<&'static str> {
    let what = what.split(" `").next().unwrap_or(what);
    let key = what.trim_matches('`').replace(' ', "_");
    hints::lookup_word("examples", &key)
}

/// The parts of a string between commas, without its quotes; a comma in parentheses is none.
pub fn parts(quoted: &str) -> Vec<&str> {
    let mut depth = 0;
    let parts = quoted.trim_matches('"').split(|c: char| {
        depth += match c {
            '(' | '[' | '{' => 1,
            ')' | ']' | '}' => -1,
            _ => 0,
        };
        c == ',' && depth == 0
    });
    let parts = parts.map(str::trim).filter(|part| !part.is_empty());
    parts.collect()
}

/// The same as a list of strings.
pub fn as_list(quoted: &str) -> String {
    let quoted = parts(quoted).into_iter().map(|part| format!("\"{part}\""));
    format!("[{}]", quoted.collect::<Vec<_>>().join(", "))
}

/// The text of a value that must be a string.
pub fn string<'a>(value: Value<'a>, what: &str, report: &mut Report) -> Option<Source<'a>> {
    if value.kind() != Type::String {
        report.push(wrong_type(&value, what, "a string"));
        return None;
    }
    value.string(report)
}

/// The elements of a value that must be a list.
pub fn list<'a>(value: Value<'a>, what: &str, report: &mut Report) -> Option<Vec<Value<'a>>> {
    if value.kind() != Type::Array {
        report.push(wrong_type(&value, what, "a list"));
        return None;
    }
    Some(value.elements())
}
