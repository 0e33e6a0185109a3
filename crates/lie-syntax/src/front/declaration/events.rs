//! The block `events`.

use super::entry::Entry;
use crate::ast::Name;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::entries::{Awaited, Line};
use crate::front::item;
use crate::front::token::{Token, render, span, split_commas};

/// `{ down = z, direction -1, stop; }`
pub fn read<'a>(block: &[Entry<'a>], report: &mut Report) -> Vec<Awaited<'a>> {
    let mut read = Vec::new();
    for entry in block {
        let parts = item::definition(entry.tokens, "an event", entry.origin(), report);
        read.extend(parts.and_then(|(name, value)| event(name, value, report)));
    }
    read
}

fn event<'a>(name: Name, value: &'a [Token], report: &mut Report) -> Option<Awaited<'a>> {
    let parts = split_commas(value);
    let (tokens, words) = parts
        .split_first()
        .map_or((value, &[][..]), |(f, w)| (*f, w));
    let (mut direction, mut stop) = (0, false);
    for word in words {
        match word {
            [word] if word.is_word("stop") => stop = true,
            [word, number @ ..] if word.is_word("direction") => {
                direction = match render(number).replace(' ', "").as_str() {
                    "-1" => -1,
                    "0" => 0,
                    "1" => 1,
                    _ => return malformed(&name, span(word_or(number, word)), report),
                };
            }
            other => return malformed(&name, span(other), report),
        }
    }
    let place = name.origin;
    let tokens = tokens.into();
    Some(Awaited {
        name,
        when: Line { tokens, place },
        direction,
        stop,
    })
}

/// What stands behind a word, or the word.
fn word_or<'a>(behind: &'a [Token], word: &'a Token) -> &'a [Token] {
    match behind {
        [] => std::slice::from_ref(word),
        behind => behind,
    }
}

fn malformed<T>(name: &Name, place: Option<Origin>, report: &mut Report) -> Option<T> {
    let message = "behind the function of an event stand `direction` with -1, 0 or 1, and `stop`";
    let help = format!("write `{} = …, direction -1, stop;`", name.text);
    report.push(Diagnostic::new(Kind::Syntax, place.unwrap_or(name.origin), message).help(help));
    None
}
