//! `--events`: the events of runs as a table.

use std::fmt::Write as _;
use std::path::Path;

use lie_codegen::structure::Structure;
use lie_in_process::words::counted;
use lie_program::protocol::Event;

use super::outputs;
use crate::command::args;
use crate::command::files::{Inputs, unwritable};
use crate::message::{Failure, Message};
use crate::output::Destination;

/// The table on its way to its file.
pub struct Table {
    destination: Destination,
    text: String,
    /// The coordinates that are shown.
    shown: Vec<usize>,
    /// Whether rows begin with the number of their run.
    several: bool,
}

impl Table {
    /// Opens what the flag names.
    ///
    /// # Errors
    /// `option` where no events are declared, or for a file that is another one; `io`.
    pub fn open(
        flags: &args::Run,
        model: &Structure,
        inputs: &Inputs,
        several: bool,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = flags.events.as_deref() else {
            return Ok(None);
        };
        if model.events.is_empty() {
            let text = format!("{} declares no events", model.name);
            let help =
                "declare them in the spec, such as \"events\": { \"down\": { \"when\": \"z\" } }";
            return Err(Message::option("--events", text).help(help).into());
        }
        outputs::table("--events", Some(path))?;
        let beside = [flags.out.as_deref(), flags.plot.as_deref()];
        if beside.contains(&Some(path)) {
            let text = "events cannot go to the file of the rows or of the picture";
            return Err(Message::option("--events", text)
                .help("give another file")
                .into());
        }
        let destination = inputs.open("--events", path)?;
        let shown = model.shown_coordinates();
        let names = shown
            .iter()
            .map(|&place| model.coordinates[place].text.as_str());
        let names: Vec<&str> = names.collect();
        let run = if several { "run," } else { "" };
        Ok(Some(Self {
            destination,
            text: format!("{run}event,t,{}\n", names.join(",")),
            shown,
            several,
        }))
    }

    /// Adds the events of a run.
    pub fn add(&mut self, number: usize, events: &[Event]) {
        for event in events {
            if self.several {
                let _ = write!(self.text, "{number},");
            }
            let _ = write!(self.text, "{},{:?}", event.name, event.time);
            for &place in &self.shown {
                let _ = write!(self.text, ",{:?}", event.state[place]);
            }
            self.text.push('\n');
        }
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
