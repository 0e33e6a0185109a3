//! Inputs and noise of runs.

use std::collections::BTreeMap;
use std::path::Path;

use lie_codegen::methods::Choice;
use lie_codegen::model::Acting;
use lie_program::protocol::{Held, Table};
use lie_runtime::driver::{Pace, Source};
use lie_syntax::diagnostic::Kind;
use lie_syntax::front::npy;
use lie_syntax::suggest::meant;

use super::plan::Planner;
use super::{Request, Value};
use crate::message::Message;

/// The seed of a request, 1 where there is none.
///
/// # Errors
/// One that is no whole number.
pub fn seed(request: &Request) -> Result<u64, Message> {
    let whole = match &request.seed {
        None => Some(1),
        Some(Value::Number(value)) => {
            let whole = value.fract() == 0.0 && (0.0..9e15).contains(value);
            whole.then_some(*value as u64)
        }
        Some(Value::Text(text)) => text.trim().parse().ok(),
        Some(Value::List(_)) => None,
    };
    whole.ok_or_else(|| {
        let option = request.front.option("seed");
        Message::option(&option, "a seed is a whole number that is not negative")
            .help("write a number such as 1, or leave it out")
    })
}

impl Planner<'_> {
    /// What is held from step to step in runs by a method.
    pub(super) fn held(
        &mut self,
        method: &Choice,
        pace: Option<Pace>,
    ) -> (Held, BTreeMap<String, Source>) {
        let model = &self.spec.model;
        let noises = model.driving.as_ref().map_or(0, |driving| driving.noises);
        let seed = self.keep(seed(self.request)).unwrap_or(1);
        if noises > 0 && matches!(pace, Some(Pace::Tolerance(_))) {
            let text = format!(
                "{} has noise: no tolerance says how far a random path is right",
                model.name
            );
            let step = self.request.front.assignment("step", "0.01");
            let message = self.option_mistake("tol", text);
            self.mistakes
                .push(message.help(format!("give a step, such as {step}")));
        }
        if noises > 0 && self.request.density.is_some() {
            let text = format!("{} has noise, which needs steps of one size", model.name);
            let message = self.option_mistake("density", text);
            self.mistakes.push(message.help("leave the option out"));
        }
        let mut sources = self.request.sources.values();
        let controlled = sources.any(|source| matches!(source, Source::Controller(_)));
        if (noises > 0 || controlled) && self.request.assess {
            let text = format!(
                "a second run finds the error at the end, and {} would have other noise or another answer of a function in it",
                model.name
            );
            let message = self.option_mistake("assess", text);
            let help = "leave the option out, and compare with a run by half of the step";
            self.mistakes.push(message.help(help));
        }
        let mut tables = BTreeMap::new();
        for written in &self.request.input {
            let found = self.table(written);
            tables.extend(self.keep(found));
        }
        for name in self.request.sources.keys() {
            let known = self.known(name);
            self.keep(known);
        }
        let explicit = method
            .solved()
            .entry()
            .is_some_and(|method| method.explicit);
        let held = Held {
            seed,
            stream: self.request.stream,
            bounded: !explicit,
            inputs: tables,
        };
        (held, self.request.sources.clone())
    }

    /// A temperature has one direction of time.
    pub(super) fn warm(&mut self, from: f64, end: f64) {
        let model = &self.spec.model;
        let mut declared = model.driving.iter().flat_map(|driving| &driving.declared);
        let warm = declared.any(|acting| match acting {
            Acting::Temperature(value) => !model.graph.is_zero(*value),
            _ => false,
        });
        if !warm || end >= from {
            return;
        }
        let text = format!(
            "{} has a temperature, and runs only forwards in time: backwards its damping would drive, against exp(-H/T) and not towards it",
            model.name
        );
        let help = "give an end behind the start and a positive step, or leave `temperature` out: damping without noise goes backwards too";
        self.mistakes
            .push(self.option_mistake("step", text).help(help));
    }

    /// Whether a system has an input.
    fn known(&self, name: &str) -> Result<(), Message> {
        let inputs = &self.spec.model.inputs;
        if inputs.iter().any(|input| input.name == name) {
            return Ok(());
        }
        let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
        let option = self.request.front.option("input");
        let message = Message::option(&option, format!("there is no input `{name}`"));
        Err(
            match (meant(name, names.iter().copied()), names.is_empty()) {
                (Some(near), _) => message.help(format!("did you mean `{near}`?")),
                (None, true) => message.help("declare it: `\"inputs\": {\"u\": {\"default\": 0}}`"),
                (None, false) => message.help(format!("the inputs are {}", names.join(", "))),
            },
        )
    }

    /// `NAME=FILE`
    fn table(&self, written: &str) -> Result<(String, Table), Message> {
        let Some((name, path)) = written.split_once('=') else {
            let option = self.request.front.option("input");
            let message = Message::option(&option, format!("`{written}` has no `=`"));
            return Err(message.help("write NAME=FILE, such as u=torque.csv"));
        };
        self.known(name.trim())?;
        let table = read(Path::new(path.trim()))?;
        Ok((name.trim().to_owned(), table))
    }
}

/// Whether no part of a line begins as a number does.
fn names_columns(line: &str) -> bool {
    let begins = |part: &str| {
        part.trim()
            .starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
    };
    !line.split([',', ';', '\t']).any(begins)
}

/// A table of a file: times and values.
fn read(path: &Path) -> Result<Table, Message> {
    let bytes = std::fs::read(path).map_err(|error| {
        let help = "give a file of CSV or NPY; a constant is the input's `default` in the spec";
        Message::io(path, error.to_string()).help(help)
    })?;
    let wrong = |text: String, help: &str| {
        let message = Message::new(Kind::Input, format!("{}: {text}", path.display()));
        message.help(help)
    };
    let pairs: Vec<(f64, f64)> = if path.extension().is_some_and(|ending| ending == "npy") {
        let array = npy::parse(&bytes).map_err(|fault| wrong(fault.text, fault.help))?;
        match array.shape.as_slice() {
            [_, 2] => array
                .values
                .chunks_exact(2)
                .map(|row| (row[0], row[1]))
                .collect(),
            shape => {
                let text = format!("an array of shape {shape:?}");
                return Err(wrong(
                    text,
                    "save an array of shape (n, 2): a time and a value in each row",
                ));
            }
        }
    } else {
        let text = String::from_utf8_lossy(&bytes);
        let mut pairs = Vec::new();
        for (number, line) in text.lines().enumerate() {
            if line.trim().is_empty() {
                continue;
            }
            let numbers = line.split(',').map(|part| part.trim().parse::<f64>());
            match numbers.collect::<Result<Vec<f64>, _>>().as_deref() {
                Ok(&[time, value]) => pairs.push((time, value)),
                // names of the columns
                Err(_) if number == 0 && names_columns(line) => {}
                _ => {
                    let text = format!(
                        "line {}: `{}` is not a time and a value",
                        number + 1,
                        line.trim()
                    );
                    return Err(wrong(text, "write `time,value` in each line"));
                }
            }
        }
        pairs
    };
    let ascend = pairs.windows(2).all(|pair| pair[0].0 < pair[1].0);
    let finite = pairs
        .iter()
        .all(|(time, value)| time.is_finite() && value.is_finite());
    if pairs.is_empty() {
        return Err(wrong(
            "there are no numbers".into(),
            "write `time,value` in each line",
        ));
    }
    if !finite {
        return Err(wrong(
            "a number is not finite".into(),
            "leave lines without a value out: an input is held until the next one",
        ));
    }
    if !ascend {
        return Err(wrong(
            "the times do not ascend".into(),
            "sort the lines by their times, each once",
        ));
    }
    let (times, values) = pairs.into_iter().unzip();
    Ok(Table { times, values })
}
