//! Parameters and the initial state.

use lie_codegen::check::domain;
use lie_codegen::diagnostic::Kind;
use lie_codegen::front::names::normalised;
use lie_codegen::suggest::did_you_mean;
use lie_in_process::words::counted;

use super::super::values::Given;
use super::states::{States, without_commas};
use super::{Planner, Point};
use crate::message::{Message, Place};

impl Planner<'_> {
    pub(super) fn start(&mut self) -> Option<Point> {
        let parameters = self.parameters()?;
        let initial = self.initial(&parameters)?;
        Some(Point {
            parameters,
            initial,
        })
    }

    /// The same for each initial state of a file.
    pub(super) fn starts(&mut self, states: &States) -> Vec<Point> {
        let Some(parameters) = self.parameters() else {
            return Vec::new();
        };
        let mut points = Vec::new();
        let before = self.mistakes.len();
        for (values, place) in &states.all {
            if let Some(initial) = self.of_file(values, place, &parameters) {
                let parameters = parameters.clone();
                points.push(Point {
                    parameters,
                    initial,
                });
            }
        }
        let of_rows = self.mistakes.split_off(before);
        self.mistakes.extend(said_once(of_rows));
        points
    }

    fn of_file(&mut self, values: &[f64], place: &Place, parameters: &[f64]) -> Option<Vec<f64>> {
        let model = &self.spec.model;
        let (wanted, state) = match &model.family {
            Some(family) => {
                let [rows, columns] = family.sites(parameters).unwrap_or([1, 1]);
                let wanted = rows * columns * model.dimension();
                (wanted, (values.len() == wanted).then(|| values.to_vec()))
            }
            None => {
                let wanted = model.shown_coordinates().len();
                (wanted, model.complete_state(values))
            }
        };
        let Some(state) = state else {
            let given = counted(values.len() as u64, "value");
            let text = format!("{given} for a state of {wanted}");
            let message = Message::new(Kind::StateLength, text).at(place.clone());
            let names = self.shown().join(", ");
            self.mistakes
                .push(message.help(format!("give the values of {names}")));
            return None;
        };
        if model.family.is_some() {
            return Some(state);
        }
        let fault = domain::fault(model, &state, parameters);
        if let Some(fault) = fault {
            let text = format!("{} at this initial state", fault.message);
            let message = Message::new(Kind::Domain, text).at(place.clone());
            let help = "start at a state where it is defined, or change the parameters";
            self.mistakes.push(message.help(help));
            return None;
        }
        Some(state)
    }

    /// The names of the coordinates of which values are given.
    fn shown(&self) -> Vec<&str> {
        let model = &self.spec.model;
        let shown = model.shown_coordinates().into_iter();
        shown.map(|i| model.coordinates[i].text.as_str()).collect()
    }

    fn parameters(&mut self) -> Option<Vec<f64>> {
        let declared = &self.spec.model.parameters;
        let names: Vec<&str> = declared
            .iter()
            .map(|parameter| parameter.name.as_str())
            .collect();
        let mut values = self.spec.model.defaults();
        let mut set = vec![false; names.len()];
        let before = self.mistakes.len();
        for text in &self.flags.param {
            let given = Given::flag("--param", text);
            let Some(equals) = text.find('=') else {
                let message = given.wrong(format!("`{text}` is not NAME=VALUE"));
                self.mistakes
                    .push(message.help("write it like `--param I1=2`"));
                continue;
            };
            let name = normalised(text[..equals].trim());
            let name = name.as_str();
            let Some(index) = names.iter().position(|known| *known == name) else {
                let message = given
                    .part(0..equals)
                    .wrong(format!("unknown parameter `{name}`"));
                let help = match did_you_mean(name, names.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if names.is_empty() => "the system has no parameters".to_owned(),
                    None => format!("the parameters are {}", names.join(", ")),
                };
                self.mistakes.push(message.help(help));
                continue;
            };
            if std::mem::replace(&mut set[index], true) {
                let message = given.wrong(format!("`{name}` is set twice"));
                self.mistakes.push(message.help("set it once"));
            }
            let part = given.part(equals + 1..text.len());
            if let Some((first, _)) = part.text.split_once(':') {
                // those of `lie run` are taken apart before
                let text = format!(
                    "`{}` is a range of values, which `lie run` alone takes",
                    part.text.trim()
                );
                let help = format!(
                    "give one value, such as `--param {name}={}`, and call the command for each",
                    first.trim()
                );
                self.mistakes.push(part.wrong(text).help(help));
                continue;
            }
            let Some(value) = self.keep(part.number()) else {
                continue;
            };
            if declared[index].positive && value <= 0.0 {
                let message = part.wrong(format!("the parameter `{name}` must be positive"));
                let help = "give it a positive value; the spec declares it positive, and proofs rely on that";
                self.mistakes.push(message.help(help));
            }
            values[index] = value;
        }
        (self.mistakes.len() == before).then_some(values)
    }

    fn initial(&mut self, parameters: &[f64]) -> Option<Vec<f64>> {
        let model = &self.spec.model;
        if let Some(family) = &model.family {
            return self.of_family(family, parameters);
        }
        let dimension = model.shown_coordinates().len();
        let values = if let Some(text) = &self.flags.initial {
            let given = Given::flag("--initial", text);
            let parts = given.split();
            if model.complete_state(&vec![0.0; parts.len()]).is_none() {
                let text = match parts.as_slice() {
                    [_] if without_commas(text) => {
                        "no commas stand between these numbers".to_owned()
                    }
                    parts => format!(
                        "{} for a state of {dimension}",
                        counted(parts.len() as u64, "value")
                    ),
                };
                let mut message = given.wrong(text);
                message.kind = Kind::StateLength;
                self.mistakes.push(message.help(self.example()));
                return None;
            }
            let before = self.mistakes.len();
            let values: Vec<f64> = parts
                .iter()
                .filter_map(|part| self.keep(part.number()))
                .collect();
            if self.mistakes.len() > before {
                return None;
            }
            model.complete_state(&values)?
        } else if let Some(values) = model.initial_values(parameters) {
            values
        } else {
            let text = format!("the spec of {} has no `initial`", model.name);
            self.mistakes
                .push(Message::option("--initial", text).help(self.example()));
            return None;
        };
        self.in_domain(parameters, &values).then_some(values)
    }

    fn example(&self) -> String {
        let names = self.shown();
        let zeros: Vec<String> = (1..=names.len()).map(|k| format!("0.{k}")).collect();
        let zeros = zeros.join(",");
        format!(
            "give the values of {} with `--initial`, such as `--initial {zeros}`",
            names.join(", ")
        )
    }

    /// Whether H, its gradient and the Casimirs have values there. The defaults were checked with
    /// the spec; flags may have moved away from them.
    fn in_domain(&mut self, parameters: &[f64], state: &[f64]) -> bool {
        let model = &self.spec.model;
        let Some(fault) = domain::fault(model, state, parameters) else {
            return true;
        };
        let flag = if self.flags.initial.is_some() {
            "--initial"
        } else {
            "--param"
        };
        let text = format!("{} at the initial state", fault.message);
        let help = "start at a state where it is defined, or change the parameters";
        self.mistakes
            .push(Message::new(Kind::Domain, text).at_option(flag).help(help));
        false
    }
}

/// The mistakes of rows, each with the number of other rows that have it.
fn said_once(mistakes: Vec<Message>) -> impl Iterator<Item = Message> {
    let mut all: Vec<(Message, u64)> = Vec::new();
    for message in mistakes {
        let known = all.iter_mut().find(|(known, _)| known.text == message.text);
        match known {
            Some((_, more)) => *more += 1,
            None => all.push((message, 0)),
        }
    }
    all.into_iter().map(|(mut message, more)| {
        if more > 0 {
            let more = counted(more, "more row");
            message.text.push_str(&format!(", as in {more}"));
        }
        message
    })
}
