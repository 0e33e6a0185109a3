//! Parameters and the initial state.

use lie_codegen::check::violation;
use lie_runtime::lattice::count;
use lie_syntax::ast::BONDS;
use lie_syntax::diagnostic::Kind;
use lie_syntax::front::names::normalised;
use lie_syntax::suggest::did_you_mean;

use super::plan::Planner;
use super::sites::{FINITE, not_finite};
use super::states::{States, without_commas};
use super::{Front, OptionValue, Parameter, Point};
use crate::message::{Fault, Message, Place};
use crate::words::counted;

impl Planner<'_> {
    pub(super) fn start(&mut self) -> Option<Point> {
        let parameters = self.parameters()?;
        self.holds(&parameters);
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
        self.holds(&parameters);
        let mut points = Vec::new();
        let before = self.mistakes.len();
        for (state, values) in states.all.iter().enumerate() {
            let place = || states.place(state);
            if let Some(initial) = self.of_file(values, &place, &parameters) {
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

    /// What was checked of constraints and of dissipation at the default parameters holds at these.
    fn holds(&mut self, parameters: &[f64]) {
        if let Some([text, help]) = self.spec.model.void_constraint(parameters) {
            let option = self.request.front.option("param");
            let mut message = Message::option(&option, text);
            message.kind = Kind::Constraint;
            self.mistakes.push(message.help(help));
        }
        if let Some(wrong) = violation(&self.spec.model, parameters) {
            let option = self.request.front.option("param");
            let message = Message::option(&option, wrong.message);
            self.mistakes.push(match wrong.help {
                Some(help) => message.help(help),
                None => message,
            });
        }
    }

    fn of_file(
        &mut self,
        values: &[f64],
        place: &dyn Fn() -> Place,
        parameters: &[f64],
    ) -> Option<Vec<f64>> {
        let model = &self.spec.model;
        if let Some(wrong) = model.violation(values, parameters) {
            let message = Message::new(Kind::Constraint, wrong.message);
            let message = message.at_place(place());
            self.mistakes.push(message.help(wrong.help));
            return None;
        }
        let (wanted, state) = match &model.family {
            Some(family) => {
                let sites = family.sites(parameters).map_or(1, count);
                let wanted = sites.saturating_mul(model.dimension());
                let whole = || model.complete_sites(values.to_vec(), sites);
                (wanted, (values.len() == wanted).then(whole))
            }
            None => {
                let wanted = model.shown_coordinates().len();
                (wanted, model.complete_state(values, parameters))
            }
        };
        let Some(state) = state else {
            let given = counted(values.len() as u64, "value");
            let text = format!("{given} for a state of {wanted}");
            let message = Message::new(Kind::StateLength, text).at_place(place());
            let names = self.shown().join(", ");
            self.mistakes
                .push(message.help(format!("give the values of {names}")));
            return None;
        };
        if model.family.is_some() {
            let Some(text) = not_finite(model, values) else {
                return Some(state);
            };
            let message = Message::new(Kind::Domain, text).at_place(place());
            self.mistakes.push(message.help(FINITE));
            return None;
        }
        if let Some(fault) = self.spec.fault(&state, parameters) {
            let text = format!("{} at this initial state", fault.message);
            let message = Message::new(Kind::Domain, text).at_place(place());
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
        for parameter in &self.request.param {
            let Some((name, value)) = self.parameter(parameter) else {
                continue;
            };
            let known = normalised(name.text.trim());
            let known = known.as_str();
            let Some(index) = names.iter().position(|name| *name == known) else {
                let message = name.wrong(format!("unknown parameter `{known}`"));
                let data = self
                    .spec
                    .model
                    .family
                    .iter()
                    .flat_map(|family| &family.data);
                let mut data = data.map(|data| &data.name);
                let mut inputs = self.spec.model.inputs.iter();
                let help = match did_you_mean(known, names.iter().copied()) {
                    _ if inputs.any(|input| input.name == known) => format!(
                        "`{known}` is an input: {}",
                        match self.request.front {
                            Front::Command => format!("write `--input {known}=FILE`"),
                            Front::Call => format!("write `inputs={{\"{known}\": ...}}`"),
                        }
                    ),
                    _ if known == BONDS && data.any(|name| name == known) => {
                        "`bonds` stand in the spec, and no option changes them".to_owned()
                    }
                    _ if data.any(|name| name == known) => format!(
                        "`{known}` has a value for each site: these stand in the spec, and no option changes them"
                    ),
                    Some(near) => format!("did you mean `{near}`?"),
                    None if names.is_empty() => "the system has no parameters".to_owned(),
                    None => format!("the parameters are {}", names.join(", ")),
                };
                self.mistakes.push(message.help(help));
                continue;
            };
            if std::mem::replace(&mut set[index], true) {
                let message = value.wrong(format!("`{known}` is set twice"));
                self.mistakes.push(message.help("set it once"));
            }
            if let Some((first, _)) = value.text.split_once(':') {
                // those of `lie run` are taken apart before
                let text = format!(
                    "`{}` is a range of values, which `lie run` alone takes",
                    value.text.trim()
                );
                let one = self.request.front.parameter(known, first.trim());
                let help = format!("give one value, such as {one}, and call the command for each");
                self.mistakes.push(value.wrong(text).help(help));
                continue;
            }
            let Some(number) = self.keep(value.number()) else {
                continue;
            };
            if declared[index].positive && number <= 0.0 {
                let message = value.wrong(format!("the parameter `{known}` must be positive"));
                let help = "give it a positive value; the spec declares it positive, and proofs rely on that";
                self.mistakes.push(message.help(help));
            }
            values[index] = number;
        }
        (self.mistakes.len() == before).then_some(values)
    }

    /// The name and the value of a parameter.
    fn parameter(&mut self, parameter: &Parameter) -> Option<(OptionValue, OptionValue)> {
        let front = self.request.front;
        let option = front.option("param");
        match parameter {
            Parameter::Set(name, value) => {
                let place = match front {
                    Front::Command => &option,
                    Front::Call => name,
                };
                Some((
                    OptionValue::flag(place, name),
                    OptionValue::value(place, value),
                ))
            }
            Parameter::Written(text) => {
                let given = OptionValue::flag(&option, text);
                let Some(equals) = text.find('=') else {
                    let message = given.wrong(format!("`{text}` is not NAME=VALUE"));
                    let help = format!("write it like {}", front.parameter("I1", "2"));
                    self.mistakes.push(message.help(help));
                    return None;
                };
                Some((given.part(0..equals), given.part(equals + 1..text.len())))
            }
        }
    }

    fn initial(&mut self, parameters: &[f64]) -> Option<Vec<f64>> {
        let model = &self.spec.model;
        if let Some(family) = &model.family {
            let sites = family.sites(parameters).map_or(1, count);
            let of_sites = self.family_state(family, parameters)?;
            return Some(model.complete_sites(of_sites, sites));
        }
        let dimension = model.shown_coordinates().len();
        let values = if let Some(given) = self.requested("initial") {
            let parts = given.split();
            if model
                .complete_state(&vec![0.0; parts.len()], parameters)
                .is_none()
            {
                let text = match parts.as_slice() {
                    [_] if without_commas(&given.text) => {
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
            let values = parts.iter().enumerate().map(|(place, part)| {
                let number = part
                    .number()
                    .map_err(|message| self.of_entry(place, message));
                self.keep(number)
            });
            let values: Vec<Option<f64>> = values.collect();
            let values: Option<Vec<f64>> = values.into_iter().collect();
            let values = values?;
            if let Some(wrong) = model.violation(&values, parameters) {
                let mut message = parts[wrong.coordinate].wrong(wrong.message);
                message.kind = Kind::Constraint;
                self.mistakes.push(message.help(wrong.help));
                return None;
            }
            model.complete_state(&values, parameters)?
        } else if let Some(values) = model.initial_values(parameters) {
            values
        } else {
            let text = format!("the spec of {} has no `initial`", model.name);
            let message = self
                .option_mistake("initial", text)
                .with_fault(Fault::Arguments);
            self.mistakes.push(message.help(self.example()));
            return None;
        };
        self.in_domain(parameters, &values).then_some(values)
    }

    /// A mistake in an entry of a state, which a caret shows on a command line, and its name in a call.
    fn of_entry(&self, place: usize, mut message: Message) -> Message {
        let named = self.shown().get(place).copied();
        if let (Front::Call, Some(name)) = (self.request.front, named) {
            message.text = format!("{name}: {}", message.text);
        }
        message
    }

    fn example(&self) -> String {
        let (names, front) = (self.shown(), self.request.front);
        let zeros: Vec<String> = (1..=names.len()).map(|k| format!("0.{k}")).collect();
        let example = match front {
            Front::Command => zeros.join(","),
            Front::Call => format!("[{}]", zeros.join(", ")),
        };
        let example = front.assignment("initial", &example);
        format!("give the values of {}, such as {example}", names.join(", "))
    }

    /// Whether H, its gradient and the Casimirs have values there. The defaults were checked with
    /// the spec; flags may have moved away from them.
    fn in_domain(&mut self, parameters: &[f64], state: &[f64]) -> bool {
        let Some(fault) = self.spec.fault(state, parameters) else {
            return true;
        };
        let flag = match self.request.initial {
            Some(_) => "initial",
            None => "param",
        };
        let text = format!("{} at the initial state", fault.message);
        let help = "start at a state where it is defined, or change the parameters";
        let mut message = self.option_mistake(flag, text).help(help);
        message.kind = Kind::Domain;
        self.mistakes.push(message);
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
