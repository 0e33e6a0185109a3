//! What to run: flags over the spec's `run` over defaults, everything validated.

mod members;
mod npy;
mod runs;
mod sites;
mod solver;
mod state;
mod states;
mod times;

use lie_codegen::methods::{Choice, OptionError};
use lie_codegen::program::Chart;
use lie_codegen::structure::group;
use lie_program::protocol::{Start, Times, Tolerances};
use lie_runtime::driver::Pace;
use lie_runtime::newton::NewtonOptions;

pub use members::several;
pub use runs::{Member, Several};

use super::values::Given;
use crate::command::args;
use crate::command::method;
use crate::compiler::Spec;
use crate::message::Message;

/// The method where none is given, for Lie–Poisson brackets and for others.
const METHODS: [&str; 2] = ["lie-midpoint", "midpoint"];
/// That of a tolerance.
const OF_TOLERANCE: &str = "gauss16";
/// That of a system by a discrete Lagrangian in coordinates of the exponential map.
const DISCRETE: &str = "discrete-euler-poincare";

/// Everything about a run that does not depend on where its rows go.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The method and its options.
    pub method: Choice,
    /// Step size or tolerance, and as it was written.
    pub pace: (Pace, String),
    /// Whether the method was taken because of a tolerance.
    pub picked: bool,
    /// When rows are wanted.
    pub times: Times,
    /// How the group element is written, if it is.
    pub chart: Option<Chart>,
    /// Tolerances of an adaptive method.
    pub tolerances: Tolerances,
    /// The solver of an implicit method.
    pub newton: NewtonOptions,
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

/// What is found for one method.
struct Planned {
    /// The plan, where there are no mistakes.
    plan: Option<Plan>,
    mistakes: Vec<Message>,
    /// Options that the method does not take, which may belong to another one.
    foreign: Vec<Foreign>,
}

/// An option that the method does not take.
struct Foreign {
    name: String,
    /// What is to be said if no other method takes it.
    message: Message,
    /// Whether the method has it, with a value of its own.
    own: bool,
}

/// Finds the mistakes of all options but those of the start, for the first method that is given.
fn plan(spec: &Spec, flags: &args::Run) -> Planned {
    let mut planner = Planner::new(spec, flags);
    let method = planner.method();
    let pace = planner.pace();
    let times = planner.times(pace.as_ref());
    let solved = method.as_ref();
    if let (Some(method), Some((Pace::Tolerance(_), given))) = (solved, &pace) {
        planner.takes_tolerance(method, given);
    }
    let overall = pace.as_ref().map(|(pace, _)| *pace);
    let tolerances = solved.map(|method| planner.tolerances(method, overall));
    let newton = solved.map(|method| planner.newton(method, overall));
    let chart = planner.chart();
    let picked = planner.picks();
    let plan = match (method, pace, times) {
        (Some(method), Some((pace, given)), Some(times)) => Some(Plan {
            method,
            pace: (pace, given.text),
            picked,
            times,
            chart,
            tolerances: tolerances.unwrap_or_default(),
            newton: newton.unwrap_or_default(),
        }),
        _ => None,
    };
    let Planner {
        mistakes, foreign, ..
    } = planner;
    Planned {
        plan: plan.filter(|_| mistakes.is_empty()),
        mistakes,
        foreign,
    }
}

/// The values of the parameters and the initial state, in order.
#[derive(Clone)]
pub struct Point {
    /// Values of the parameters.
    pub parameters: Vec<f64>,
    /// The initial state.
    pub initial: Vec<f64>,
}

impl Point {
    /// The same as programs take it.
    pub fn named(self, spec: &Spec) -> Start {
        let names = spec.model.parameters.iter().map(|p| p.name.clone());
        Start {
            parameters: names.zip(self.parameters).collect(),
            initial: self.initial,
        }
    }
}

/// Where a system starts, alone.
///
/// # Errors
/// Every mistake.
pub fn start(spec: &Spec, flags: &args::Run) -> Result<Point, Vec<Message>> {
    let mut planner = Planner::new(spec, flags);
    match planner.start() {
        Some(start) if planner.mistakes.is_empty() => Ok(start),
        _ => Err(planner.mistakes),
    }
}

struct Planner<'a> {
    spec: &'a Spec,
    flags: &'a args::Run,
    mistakes: Vec<Message>,
    foreign: Vec<Foreign>,
}

impl<'a> Planner<'a> {
    fn new(spec: &'a Spec, flags: &'a args::Run) -> Self {
        Self {
            spec,
            flags,
            mistakes: Vec::new(),
            foreign: Vec::new(),
        }
    }

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

    /// Whether a tolerance is given without a method, which is picked then: on the command line, or in the spec.
    fn picks(&self) -> bool {
        let in_spec = self.flags.tol.is_none() && !self.in_spec("method").is_empty();
        self.wants_tolerance() && self.flags.method.is_empty() && !in_spec
    }

    fn method(&mut self) -> Option<Choice> {
        let given = self
            .given("--method", self.flags.method.first())
            .filter(|_| !self.picks());
        let id = given.unwrap_or_else(|| {
            let model = &self.spec.model;
            let discrete = model.energy.lagrangian().and_then(|l| l.discrete);
            let method = if self.picks() || model.family.is_some() {
                OF_TOLERANCE
            } else if discrete.is_some_and(|discrete| !discrete.in_entries) {
                DISCRETE
            } else {
                METHODS[usize::from(!model.is_lie_poisson())]
            };
            Given::flag("--method", method)
        });
        let place = id.wrong("").place;
        let found = method::labelled(&id.text).map_err(|message| message.at(place.clone()));
        let mut choice = self.keep(found)?;
        for name in method::OPTIONS {
            let flag = self.flags.method_options.get(name);
            if id.text.contains(&format!("--{name}")) {
                if let Some((flag, text)) = flag {
                    self.twice(name, &Given::flag(flag, text), &id.text);
                }
                continue;
            }
            let given = match flag {
                Some((flag, text)) => Some(Given::flag(flag, text)),
                None => self.in_spec(name).into_iter().next(),
            };
            let Some(given) = given else {
                continue;
            };
            // The spec's option belongs to the spec's method; a flag may have replaced that.
            let belongs = flag.is_some() || (self.flags.method.is_empty() && !self.picks());
            match choice.clone().with_option(name, &given.text) {
                Ok(chosen) => choice = chosen,
                Err(OptionError::Foreign) => {
                    if belongs {
                        self.foreign(name, &given, &choice);
                    }
                }
                Err(OptionError::Value(text, help)) => {
                    self.mistakes.push(given.wrong(text).help(help));
                    return None;
                }
            }
        }
        let applies = method::applies(choice, &self.spec.model);
        self.keep(applies.map_err(|message| message.at(place)))
    }

    fn chart(&mut self) -> Option<Chart> {
        let given = self.given("--group", self.flags.group.as_ref())?;
        let chart = match given.text.trim() {
            "matrix" => Chart::Matrix,
            "quaternion" => Chart::Quaternion,
            other => {
                let message = given.wrong(format!("unknown form of the group element `{other}`"));
                self.mistakes
                    .push(message.help("write `matrix` or `quaternion`"));
                return None;
            }
        };
        let quaternion = chart == Chart::Quaternion;
        if let Some((reason, help)) = group::refusal(&self.spec.model, quaternion) {
            self.mistakes.push(given.wrong(reason).help(help));
            return None;
        }
        Some(chart)
    }

    fn foreign(&mut self, name: &str, given: &Given, choice: &Choice) {
        let text = format!("`{name}` is not an option of {}", choice.id());
        let message = given.wrong(text).help(method::help_on_options(choice));
        self.foreign.push(Foreign {
            name: name.to_owned(),
            message,
            own: false,
        });
    }

    /// A flag of which the method has another value behind its id.
    fn twice(&mut self, name: &str, given: &Given, label: &str) {
        let text = format!("no method takes this flag: `{}` has its own", label.trim());
        let help = format!("leave out `--{name}`, or what stands behind the method");
        self.foreign.push(Foreign {
            name: name.to_owned(),
            message: given.wrong(text).help(help),
            own: true,
        });
    }
}
