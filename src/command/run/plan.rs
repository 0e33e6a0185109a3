//! What to run: flags over the spec's `run` over defaults, everything validated.

use lie_codegen::check::domain;
use lie_codegen::diagnostic::Kind;
use lie_codegen::methods::Choice;
use lie_codegen::suggest::did_you_mean;

use super::values::{At, Given};
use crate::build::protocol::Times;
use crate::command::args;
use crate::command::method;
use crate::compiler::Spec;
use crate::message::Message;

const METHOD: &str = "lie-midpoint";
const STEP: &str = "0.01";
const UNTIL: &str = "10";

/// Everything about a run that does not depend on where its rows go.
#[derive(Debug)]
pub struct Plan {
    /// The method and its options.
    pub method: Choice,
    /// Step size, and as it was written.
    pub step: (f64, String),
    /// When rows are wanted.
    pub times: Times,
    /// Values of the parameters, in order.
    pub parameters: Vec<f64>,
    /// The initial state.
    pub initial: Vec<f64>,
    /// Tolerances that were given.
    pub tolerances: Vec<(&'static str, f64)>,
}

impl Plan {
    /// The final time.
    pub fn end(&self) -> f64 {
        match &self.times {
            Times::Until { end, .. } => *end,
            Times::At(times) => times.last().copied().unwrap_or(0.0),
        }
    }
}

/// Finds the mistakes of all options, then answers.
///
/// # Errors
/// Every mistake.
pub fn plan(spec: &Spec, flags: &args::Run) -> Result<Plan, Vec<Message>> {
    let mut planner = Planner {
        spec,
        flags,
        mistakes: Vec::new(),
    };
    let method = planner.method();
    let step = planner.step();
    let times = planner.times(step.as_ref());
    let tolerances = planner.tolerances();
    let parameters = planner.parameters();
    let initial = parameters
        .as_ref()
        .and_then(|values| planner.initial(values));
    match (method, step, times, parameters, initial) {
        (Some(method), Some((step, given)), Some(times), Some(parameters), Some(initial))
            if planner.mistakes.is_empty() =>
        {
            let step = (step, given.text);
            Ok(Plan {
                method,
                step,
                times,
                parameters,
                initial,
                tolerances,
            })
        }
        _ => Err(planner.mistakes),
    }
}

struct Planner<'a> {
    spec: &'a Spec,
    flags: &'a args::Run,
    mistakes: Vec<Message>,
}

impl Planner<'_> {
    /// What the spec's `run` says under a name.
    fn in_spec(&self, name: &str) -> Vec<Given> {
        let options = self
            .spec
            .model
            .run
            .iter()
            .filter(|option| option.name.text == name);
        let values = options.flat_map(|option| &option.values);
        values
            .map(|(text, origin)| Given::spec(&self.spec.source, text, *origin))
            .collect()
    }

    /// An option: the flag, else the spec.
    fn given(&self, flag: &'static str, value: Option<&String>) -> Option<Given> {
        match value {
            Some(text) => Some(Given::flag(flag, text)),
            None => self
                .in_spec(flag.trim_start_matches('-'))
                .into_iter()
                .next(),
        }
    }

    fn keep<T>(&mut self, result: Result<T, Message>) -> Option<T> {
        result.map_err(|message| self.mistakes.push(message)).ok()
    }

    fn method(&mut self) -> Option<Choice> {
        let given = self.given("--method", self.flags.method.as_ref());
        let id = given
            .clone()
            .unwrap_or_else(|| Given::flag("--method", METHOD));
        let place = id.wrong("").place;
        let found = method::find(&id.text).map_err(|message| message.at(place.clone()));
        let mut choice = self.keep(found)?;
        if let Some(given) = self.given("--retraction", self.flags.retraction.as_ref()) {
            // The spec's option belongs to the spec's method; a flag may have replaced that.
            let belongs = matches!(given.place, At::Flag(..)) || self.flags.method.is_none();
            if method::takes(choice, "retraction") {
                choice = self.keep(method::with_retraction(choice, &given.text).map_err(
                    |help| {
                        given
                            .wrong(format!("there is no retraction `{}`", given.text))
                            .help(help)
                    },
                ))?;
            } else if belongs {
                self.foreign("retraction", &given, choice);
            }
        }
        for name in ["composition", "pieces", "lift", "gradient"] {
            if let (Some(given), None) = (self.in_spec(name).first(), &self.flags.method) {
                self.foreign(name, given, choice);
            }
        }
        let applies = method::applies(choice, &self.spec.model);
        self.keep(applies.map_err(|message| message.at(place)))
    }

    fn foreign(&mut self, name: &str, given: &Given, choice: Choice) {
        let text = format!("`{name}` is not an option of {}", choice.id());
        self.mistakes
            .push(given.wrong(text).help(method::help_on_options(choice)));
    }

    fn step(&mut self) -> Option<(f64, Given)> {
        let given = self.given("--step", self.flags.step.as_ref());
        let fallback = given.is_none();
        let given = given.unwrap_or_else(|| Given::flag("--step", STEP));
        let step = self.keep(given.number())?;
        if step == 0.0 {
            let message = given
                .wrong("the step is zero")
                .help("give a step such as 0.01; negative to go backwards");
            self.mistakes.push(message);
            return None;
        }
        // Without a step of the user's, the direction is that of the end.
        let backwards = fallback
            && self
                .ends()
                .iter()
                .any(|end| end.number().is_ok_and(|end| end < 0.0));
        if backwards {
            return Some((-step, Given::flag("--step", &format!("-{STEP}"))));
        }
        Some((step, given))
    }

    /// The final time, or the times asked for.
    fn ends(&self) -> Vec<Given> {
        let flags = self.flags;
        match (&flags.at, &flags.until) {
            (Some(at), _) => Given::flag("--at", at).split(),
            (None, Some(until)) => vec![Given::flag("--until", until)],
            (None, None) if flags.every.is_none() && !self.in_spec("at").is_empty() => {
                self.in_spec("at")
            }
            (None, None) => self
                .in_spec("until")
                .into_iter()
                .next()
                .into_iter()
                .chain(std::iter::once(Given::flag("--until", UNTIL)))
                .take(1)
                .collect(),
        }
    }

    fn times(&mut self, step: Option<&(f64, Given)>) -> Option<Times> {
        let flags = self.flags;
        for (name, other) in [("--until", &flags.until), ("--every", &flags.every)] {
            if flags.at.is_some() && other.is_some() {
                let text = format!("`--at` excludes `{name}`");
                let help =
                    "with `--at` there is one row per time asked for, and the last one is the end";
                self.mistakes.push(Message::option("--at", text).help(help));
                return None;
            }
        }
        if flags.at.is_none() && flags.until.is_none() && flags.every.is_none() {
            let at = self.in_spec("at");
            for name in ["until", "every"] {
                if let (Some(at), false) = (at.first(), self.in_spec(name).is_empty()) {
                    let text = format!("`at` excludes `{name}` in `run`");
                    self.mistakes
                        .push(at.wrong(text).help(format!("remove `{name}`")));
                    return None;
                }
            }
        }
        let wants_times = flags.at.is_some()
            || (flags.until.is_none() && flags.every.is_none() && !self.in_spec("at").is_empty());
        let ends = self.ends();
        let mut values = Vec::new();
        for end in &ends {
            let value = self.keep(end.number());
            if let (Some(value), Some((step, given))) = (value, step) {
                self.compatible(*step, given, value, end);
            }
            values.extend(value);
        }
        if values.len() < ends.len() {
            return None;
        }
        if wants_times {
            values.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
            return Some(Times::At(values));
        }
        let every = match self.given("--every", flags.every.as_ref()) {
            Some(given) => self.keep(given.count())?,
            None => 1,
        };
        Some(Times::Until {
            end: *values.first()?,
            every,
        })
    }

    /// Whether steps of this size get there.
    fn compatible(&mut self, step: f64, given: &Given, end: f64, end_given: &Given) {
        if end != 0.0 && (end > 0.0) != (step > 0.0) {
            let text = format!(
                "steps of {} never reach {}: their signs differ",
                given.text.trim(),
                end_given.text.trim()
            );
            let help = "backwards in time, both the step and the end are negative";
            self.mistakes.push(end_given.wrong(text).help(help));
        } else if end / step > 9e15 {
            let text = format!("{:.1e} steps are more than can be counted", end / step);
            self.mistakes.push(
                given
                    .wrong(text)
                    .help("take a larger step or an earlier end"),
            );
        }
    }

    fn tolerances(&mut self) -> Vec<(&'static str, f64)> {
        let method = self.given("--method", self.flags.method.as_ref());
        let adaptive = method.is_some_and(|given| given.text == "dopri5");
        let mut tolerances = Vec::new();
        for (name, flag, value) in [
            ("rtol", "--rtol", &self.flags.rtol),
            ("atol", "--atol", &self.flags.atol),
        ] {
            let Some(given) = self.given(flag, value.as_ref()) else {
                continue;
            };
            if !adaptive {
                if value.is_some() || self.flags.method.is_none() {
                    let text = format!("`{name}` is an option of dopri5 alone");
                    self.mistakes.push(
                        given
                            .wrong(text)
                            .help("add `--method dopri5`, or leave it out"),
                    );
                }
                continue;
            }
            match given.number() {
                Ok(value) if value > 0.0 => tolerances.push((name, value)),
                Ok(_) => {
                    let message = given.wrong(format!("`{name}` is not positive"));
                    self.mistakes
                        .push(message.help("give a tolerance such as 1e-9"));
                }
                Err(message) => self.mistakes.push(message),
            }
        }
        tolerances
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
            let name = text[..equals].trim();
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
            if let Some(value) = self.keep(given.part(equals + 1..text.len()).number()) {
                values[index] = value;
            }
        }
        (self.mistakes.len() == before).then_some(values)
    }

    fn initial(&mut self, parameters: &[f64]) -> Option<Vec<f64>> {
        let model = &self.spec.model;
        let dimension = model.dimension();
        let values = if let Some(text) = &self.flags.initial {
            let given = Given::flag("--initial", text);
            let parts = given.split();
            if parts.len() != dimension {
                let text = format!("{} values for a state of {dimension}", parts.len());
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
            (self.mistakes.len() == before).then_some(values)?
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
        let names: Vec<&str> = self
            .spec
            .model
            .coordinates
            .iter()
            .map(|c| c.text.as_str())
            .collect();
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
        let help = "start where it is finite, or change the parameters";
        self.mistakes
            .push(Message::new(Kind::Domain, text).at_option(flag).help(help));
        false
    }
}
