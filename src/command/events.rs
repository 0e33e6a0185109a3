//! `--events`: tables of events, `event,t,<state>`.

use std::fmt::Write as _;
use std::path::Path;

use lie_codegen::structure::Structure;
use lie_program::protocol::Event;

use super::files::Inputs;
use super::run::outputs;
use crate::message::{Failure, Message};
use lie_output::Destination;

/// The columns of a table.
pub struct Columns {
    names: String,
    /// The coordinates that are shown.
    shown: Vec<usize>,
    /// Whether rows begin with the number of what has the events.
    numbered: bool,
}

impl Columns {
    /// Those of the events of a system; of several runs with the name of what has them in front.
    pub fn new(model: &Structure, whose: Option<&str>) -> Self {
        let shown = model.shown_coordinates();
        let names = shown.iter().map(|&place| &*model.coordinates[place].text);
        let names = whose.into_iter().chain(["event", "t"]).chain(names);
        Self {
            names: names.collect::<Vec<_>>().join(","),
            numbered: whose.is_some(),
            shown,
        }
    }

    /// The first line.
    pub fn header(&self) -> String {
        format!("{}\n", self.names)
    }

    /// Adds the lines of events, in their order, which are those of a run with this number.
    pub fn add(&self, text: &mut String, number: usize, events: &[Event]) {
        for event in events {
            if self.numbered {
                let _ = write!(text, "{number},");
            }
            let _ = write!(text, "{},{:?}", event.name, event.time);
            for &place in &self.shown {
                let _ = write!(text, ",{:?}", event.state[place]);
            }
            text.push('\n');
        }
    }
}

/// Opens the file of a table.
///
/// # Errors
/// `option` where no events are declared, or for a file that is another one; `io`.
pub fn open(path: &Path, model: &Structure, inputs: &Inputs) -> Result<Destination, Failure> {
    if model.events.is_empty() {
        let text = format!("{} declares no events", model.name);
        let help =
            "declare them in the spec, such as \"events\": { \"down\": { \"when\": \"z\" } }";
        return Err(Message::option("--events", text).help(help).into());
    }
    outputs::table("--events", Some(path))?;
    inputs.open("--events", path)
}
