//! The events of runs: their table, and what the summary says of them.

use std::path::Path;

use lie_codegen::structure::Structure;
use lie_in_process::words::counted;
use lie_program::protocol::Event;

use crate::command::args;
use crate::command::events::{Columns, open};
use crate::command::files::{Inputs, unwritable};
use crate::message::{Failure, Message};
use lie_output::Destination;

/// The table on its way to its file.
pub struct Table {
    destination: Destination,
    columns: Columns,
    text: String,
}

impl Table {
    /// Opens what the flag names.
    ///
    /// # Errors
    /// As of [`open`]; `option` for a file of the rows or of the picture.
    pub fn open(
        flags: &args::Run,
        model: &Structure,
        inputs: &Inputs,
        several: bool,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = flags.events.as_deref() else {
            return Ok(None);
        };
        let beside = [flags.out.as_deref(), flags.plot.as_deref()];
        if beside.contains(&Some(path)) {
            let text = "events cannot go to the file of the rows or of the picture";
            return Err(Message::option("--events", text)
                .help("give another file")
                .into());
        }
        let destination = open(path, model, inputs)?;
        let columns = Columns::new(model, several.then_some("run"));
        Ok(Some(Self {
            destination,
            text: columns.header(),
            columns,
        }))
    }

    /// Adds the events of a run.
    pub fn add(&mut self, number: usize, events: &[Event]) {
        self.columns.add(&mut self.text, number, events);
    }

    /// Writes it.
    ///
    /// # Errors
    /// `io`.
    pub fn finish(self, flags: &args::Run) -> Result<(), Failure> {
        let path = flags.events.as_deref().unwrap_or(Path::new(""));
        let replaced = self.destination.replace(self.text.as_bytes());
        replaced.map_err(|error| unwritable(path, &error))
    }
}

/// How often each event happened, and which of them ended the run; nothing where none are declared.
pub fn said(model: &Structure, events: &[Event]) -> Option<String> {
    if model.events.is_empty() {
        return None;
    }
    let count = |name: &str| events.iter().filter(|event| event.name == name).count();
    let counts = model.events.iter();
    let counts = counts.map(|event| format!("{} {}", event.name, count(&event.name)));
    let counts: Vec<String> = counts.collect();
    let last = events.last().filter(|event| event.stops);
    let end = last.map_or(String::new(), |event| {
        format!("; `{}` ended the run at t = {:?}", event.name, event.time)
    });
    let all = counted(events.len() as u64, "event");
    Some(format!("{all}: {}{end}\n", counts.join(", ")))
}
