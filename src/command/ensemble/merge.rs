//! `lie merge`: puts the shares of an ensemble together.

use std::fs::File;
use std::io::{self, BufReader, Read as _};
use std::path::Path;

use lie_in_process::key::Key;
use lie_in_process::reduce::Bins;
use lie_in_process::share::{Record, Share};
use lie_in_process::words::counted;
use lie_syntax::diagnostic::Kind;

use super::beside::{Beside, path_of_record};
use super::gathering::Gathering;
use crate::command::args;
use crate::command::files::Inputs;
use crate::command::fold::folded;
use crate::command::run::outputs::writing_failed;
use crate::message::{Failure, Message, Place};
use crate::output::npy;
use crate::render;

/// Numbers that are read at a time.
const CHUNK: usize = 1 << 16;
/// So many of the gaps between shares are named.
const NAMED: usize = 10;

/// A share on the disk.
struct Part<'a> {
    path: &'a Path,
    record: Record,
}

/// Puts shares together.
///
/// # Errors
/// A share is lost, or files do not belong together.
pub fn run(arguments: &args::Merge) -> Result<u8, Failure> {
    let parts = arguments.files.iter().map(|path| read(path));
    let mut parts: Vec<Part<'_>> = parts.collect::<Result<_, _>>()?;
    belong(&parts)?;
    parts.sort_by_key(|part| part.record.share.number);
    lost(&parts)?;
    for part in &parts {
        is_whole(part)?;
    }
    let mut record = Record {
        share: Share::WHOLE,
        failures: Vec::new(),
        numbers: None,
        histogram: parts[0].record.histogram.as_ref().map(Bins::empty),
        complete: false,
        ..parts[0].record.clone()
    };
    let failures = parts
        .iter()
        .flat_map(|part| part.record.failures.iter().cloned());
    record.failures = failures.collect();
    let inputs = arguments
        .files
        .iter()
        .fold(Inputs::default(), |inputs, path| {
            let record = path_of_record(path);
            inputs.with("FILE", path).with("FILE", &record)
        });
    let beside = Beside::open(&arguments.out, &inputs, &record)?;
    let mut gathering = Gathering::begin(beside, record, Vec::new())?;
    for part in &parts {
        copy(part, &mut gathering, &arguments.out)?;
    }
    let record = gathering.end(&arguments.out)?;
    if !arguments.quiet {
        let members = counted(record.members as u64, "member");
        let shares = counted(parts.len() as u64, "share");
        let early = match record.failures.len() {
            0 => String::new(),
            early => format!(", {early} of which ended early"),
        };
        let (system, method) = (&record.system, &record.method);
        render::say(&folded(&format!(
            "{system}, {method}: {members} from {shares}{early}"
        )));
    }
    Ok(0)
}

/// What a file says of itself.
fn read(path: &Path) -> Result<Part<'_>, Failure> {
    let beside = path_of_record(path);
    let unread =
        |text: String, help: String| Failure::surroundings(Message::io(path, text).help(help));
    if let Err(error) = path.metadata() {
        let help = "run its share again by `lie ensemble --shard`, or give the name that it has";
        return Err(unread(
            format!("the share cannot be read: {error}"),
            help.to_owned(),
        ));
    }
    let bytes = std::fs::read(&beside).map_err(|error| {
        let text = format!(
            "{}, which says what it holds, cannot be read: {error}",
            beside.display()
        );
        let help = "give files of `lie ensemble --shard`, with the .json beside each".to_owned();
        unread(text, help)
    })?;
    let record: Record = serde_json::from_slice(&bytes).map_err(|error| {
        let message = Message::io(
            &beside,
            format!("this is no record of `lie ensemble`: {error}"),
        );
        message.help("run the share again by `lie ensemble --shard`")
    })?;
    if record.format != Record::FORMAT || !(1..=record.share.of).contains(&record.share.number) {
        let text = format!(
            "the record has the form {}, and this program knows {}",
            record.format,
            Record::FORMAT
        );
        let help = "merge by the program that has written it";
        return Err(Message::io(&beside, text).help(help).into());
    }
    if record
        .histogram
        .as_ref()
        .is_some_and(|bins| !bins.is_sound())
    {
        let message = Message::io(
            &beside,
            "the record has no bins that members can be counted in",
        );
        let help = "run the share again by `lie ensemble --shard`";
        return Err(message.help(help).into());
    }
    Ok(Part { path, record })
}

/// Whether all are shares of one ensemble, each once.
fn belong(parts: &[Part<'_>]) -> Result<(), Failure> {
    let first = &parts[0];
    let mut mistakes = Vec::new();
    let at = |path: &Path| Place::File(path.display().to_string());
    for (place, part) in parts.iter().enumerate() {
        if let Some(how) = part.record.differs(&first.record) {
            let text = format!(
                "this is no share of the ensemble of {}: {how}",
                first.path.display()
            );
            let message = Message::new(Kind::Option, text).at_place(at(part.path));
            mistakes.push(message.help("merge the shares of one call of `lie ensemble` alone"));
            continue;
        }
        let number = part.record.share.number;
        let same = |other: &&Part<'_>| other.record.share.number == number;
        if let Some(other) = parts[..place].iter().find(same) {
            let text = format!(
                "share {number} is given twice, as {} too",
                other.path.display()
            );
            let message = Message::new(Kind::Option, text).at_place(at(part.path));
            mistakes.push(message.help("give each share once"));
        }
    }
    match mistakes.is_empty() {
        true => Ok(()),
        false => Err(Failure::invalid(mistakes)),
    }
}

/// Shares that lie side by side: missing, or one that did not come to its end, in its file.
struct Lost<'a> {
    first: u64,
    last: u64,
    file: Option<&'a Path>,
}

/// Names the shares that are missing, and those that did not come to their end.
fn lost(parts: &[Part<'_>]) -> Result<(), Failure> {
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

/// Whether a file has the members that its record speaks of.
fn is_whole(part: &Part<'_>) -> Result<(), Failure> {
    let record = &part.record;
    let (members, shape) = (record.share.members(record.members).len(), record.shape());
    let expected = npy::header(members as u64, &shape);
    let length = npy::LENGTH as u64 + 8 * (members * shape.iter().product::<usize>()) as u64;
    let mut header = vec![0; npy::LENGTH];
    let read = File::open(part.path).and_then(|mut file| {
        file.read_exact(&mut header)?;
        file.metadata()
    });
    match read {
        Ok(found) if found.len() == length && header == expected => Ok(()),
        other => {
            let what = match other {
                Ok(found) => format!("it has {} bytes of {length}, or other ones", found.len()),
                Err(error) => error.to_string(),
            };
            let Share { number, of } = record.share;
            let text =
                format!("the members of share {number} of {of} are not in this file: {what}");
            let message = Message::io(part.path, text);
            let help = format!("run it by `lie ensemble … --shard {number}/{of}`, and merge again");
            Err(Failure::surroundings(message.help(help)))
        }
    }
}

/// Takes the members of a share, and sees whether they are those that its record speaks of.
fn copy(part: &Part<'_>, gathering: &mut Gathering, out: &Path) -> Result<(), Failure> {
    let record = &part.record;
    let size = record.shape().iter().product::<usize>().max(1);
    let unread = |error: io::Error| {
        let message = Message::io(part.path, format!("it cannot be read any more: {error}"));
        Failure::surroundings(message.help("check that the disk is still there, and merge again"))
    };
    let mut file = BufReader::with_capacity(1 << 20, File::open(part.path).map_err(unread)?);
    file.seek_relative(npy::LENGTH as i64).map_err(unread)?;
    let mut left = record.share.members(record.members).len();
    let mut key = Key::new();
    while left > 0 {
        let some = left.min((CHUNK / size).max(1));
        let mut bytes = vec![0; 8 * some * size];
        file.read_exact(&mut bytes).map_err(unread)?;
        key = key.bytes(&bytes);
        let numbers = bytes.chunks_exact(8);
        let number = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
        let numbers: Vec<f64> = numbers.map(number).collect();
        let pushed = gathering.push(&numbers);
        pushed.map_err(|error| writing_failed(Some(out), &error))?;
        left -= some;
    }
    if record.numbers == Some(key.hex()) {
        return Ok(());
    }
    let Share { number, of } = record.share;
    let text = format!(
        "the numbers in this file are not those of share {number} of {of}: it was changed, or another file was copied over it"
    );
    let help = format!("run it by `lie ensemble … --shard {number}/{of}`, and merge again");
    Err(Failure::surroundings(
        Message::io(part.path, text).help(help),
    ))
}
