//! `lie merge`: puts the shares of an ensemble together.

use std::path::Path;

use lie_in_process::share::Record;
use lie_in_process::words::counted;
use lie_syntax::diagnostic::Kind;

use super::beside::{Beside, path_of_record};
use super::gathering::{Gathering, Taking};
use super::lost::lost;
use super::stops;
use super::table::Table;
use crate::command::args;
use crate::command::files::Inputs;
use crate::command::fold::folded;
use crate::command::run::outputs;
use crate::message::{Failure, Message, Place};
use crate::render;

/// A share on the disk.
pub struct Part<'a> {
    /// The file of its members.
    pub path: &'a Path,
    /// What stands beside them.
    pub record: Record,
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
        part.is_whole()?;
    }
    let mut record = parts[0].record.whole();
    let failures = parts
        .iter()
        .flat_map(|part| part.record.failures.iter().cloned());
    record.failures = failures.collect();
    let unmerged = record.events.is_some() && arguments.events.is_none();
    record.events = record.events.filter(|_| !unmerged);
    let inputs = parts.iter().fold(Inputs::default(), |inputs, part| {
        let files = part.files().into_iter();
        let files = files.chain([part.path.to_owned(), path_of_record(part.path)]);
        files.fold(inputs, |inputs, path| inputs.with("FILE", &path))
    });
    let taking = Taking {
        table: table(arguments, &parts, &inputs)?,
        ..Taking::default()
    };
    let beside = Beside::open(&arguments.out, &inputs, &record)?;
    let mut gathering = Gathering::begin(beside, record, taking)?;
    for part in &parts {
        part.copy(&mut gathering, &arguments.out)?;
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
        for line in stops::said(&record) {
            render::say(&folded(&line));
        }
        if unmerged {
            render::say("The shares have tables of events, which `--events FILE` puts together.");
        }
    }
    Ok(0)
}

/// Opens the table of all events, if it is asked for.
fn table(
    arguments: &args::Merge,
    parts: &[Part<'_>],
    inputs: &Inputs,
) -> Result<Option<Table>, Failure> {
    let Some(path) = &arguments.events else {
        return Ok(None);
    };
    if parts.iter().any(|part| part.table().is_none()) {
        let text = "there are no tables of events in the shares";
        let help = "run them with `lie ensemble … --shard K/N --events FILE`, or leave this out";
        return Err(Message::option("--events", text).help(help).into());
    }
    outputs::table("--events", Some(path))?;
    let destination = inputs.open("--events", path)?;
    Ok(Some(Table::new(path, destination, None)))
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
