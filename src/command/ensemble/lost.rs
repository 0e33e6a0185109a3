//! Shares that are not there, by their members.

use std::path::Path;

use lie_in_process::share::Share;
use lie_in_process::words::counted;
use lie_syntax::diagnostic::Kind;

use super::merge::Part;
use crate::message::{Failure, Message, Place};

/// So many of the gaps between shares are named.
const NAMED: usize = 10;

/// Shares that lie side by side: missing, or one that did not come to its end, in its file.
struct Lost<'a> {
    first: u64,
    last: u64,
    file: Option<&'a Path>,
}

/// Names the shares that are missing, and those that did not come to their end.
///
/// # Errors
/// `io` where there are some.
pub fn lost(parts: &[Part<'_>]) -> Result<(), Failure> {
    let (of, members) = (parts[0].record.share.of, parts[0].record.members);
    let mut all = Vec::new();
    let mut before = 0;
    let missing = |before: u64, next: u64| Lost {
        first: before + 1,
        last: next,
        file: None,
    };
    for part in parts {
        let number = part.record.share.number;
        if number - before > 1 {
            all.push(missing(before, number - 1));
        }
        if !part.record.complete {
            all.push(Lost {
                first: number,
                last: number,
                file: Some(part.path),
            });
        }
        before = number;
    }
    if before < of {
        all.push(missing(before, of));
    }
    if all.is_empty() {
        return Ok(());
    }
    let (named, more) = all.split_at(all.len().min(NAMED));
    let named = named.iter().map(|lost| lost.message(of, members));
    let mut messages: Vec<Message> = named.collect();
    let more: u64 = more.iter().map(|lost| lost.last - lost.first + 1).sum();
    if more > 0 {
        let more = counted(more, "more share");
        let text = format!("of {more} the members are lost too");
        messages.push(Message::new(Kind::Io, text).help("merge again to have them named"));
    }
    Err(Failure {
        messages,
        code: crate::message::SURROUNDINGS,
    })
}

impl Lost<'_> {
    fn message(&self, of: u64, members: usize) -> Message {
        let &Self { first, last, file } = self;
        let start = Share { number: first, of }.members(members).start;
        let end = Share { number: last, of }.members(members).end;
        let which = match end - start {
            0 => "no members".to_owned(),
            1 => format!("member {start}"),
            _ => format!("members {start} to {}", end - 1),
        };
        let (shares, help) = match first == last {
            true => (
                format!("share {first} of {of}"),
                format!("run it by `lie ensemble … --shard {first}/{of}`, and merge again"),
            ),
            false => (
                format!("shares {first} to {last} of {of}"),
                format!(
                    "run them by `lie ensemble … --shard {first}/{of}` and so on, and merge again"
                ),
            ),
        };
        let (what, place) = match file {
            Some(path) => (
                "did not come to its end",
                Place::File(path.display().to_string()),
            ),
            None if first == last => ("is missing", Place::None),
            None => ("are missing", Place::None),
        };
        let text = format!("{shares} {what}: {which}");
        Message::new(Kind::Io, text).at_place(place).help(help)
    }
}
