//! One method and one start: the request over the spec's `run` over defaults, everything checked.

use lie_codegen::methods::Choice;
use lie_codegen::model::{Model, Parameter};
use lie_codegen::program::Chart;
use lie_codegen::structure::group;
use lie_program::protocol::{Held, Milestones, Run, Sources, Start, Times, Tolerances};
use lie_runtime::driver::{Density, Pace, Source};
use lie_runtime::methods::Keep;
use lie_runtime::newton::NewtonOptions;
use std::collections::BTreeMap;

use super::{OptionValue, Request};
use crate::message::{Fault, Message};
use crate::spec::Spec;

/// Everything about a run that does not depend on where its rows go.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The method and its options.
    pub method: Choice,
    /// Step size or tolerance, and as it was written.
    pub pace: (Pace, String),
    /// Whether the method was taken because of a tolerance.
    pub picked: bool,
    /// The time at which a run starts.
    pub from: f64,
    /// When rows are wanted.
    pub times: Times,
    /// How the group element is written, if it is.
    pub chart: Option<Chart>,
    /// Tolerances of an adaptive method.
    pub tolerances: Tolerances,
    /// The solver of an implicit method.
    pub newton: NewtonOptions,
    /// What a projection behind each step keeps.
    pub keep: Keep,
    /// Whether steps follow the motion.
    pub density: Density,
    /// Whether a second run tells the error at the end.
    pub assess: bool,
    /// What is held from step to step.
    pub held: Held,
    /// Where the values of inputs come from, in a call.
    pub sources: BTreeMap<String, Source>,
}

impl Plan {
    /// What a run of a system from a start is asked for, with the group element that it declares.
    pub fn run_of(&self, model: &Model, start: Start) -> Run {
        let parameters = model.parameters.iter();
        let value = |p: &Parameter| start.parameters.get(&p.name).copied();
        let parameters = parameters.map(|p| value(p).unwrap_or(p.default_value));
        let parameters: Vec<f64> = parameters.collect();
        let element = self
            .chart
            .and_then(|chart| model.initial_element(chart, &parameters));
        Run {
            element: element.unwrap_or_default(),
            ..self.run(start)
        }
    }

    /// The same from the identity on.
    pub fn run(&self, start: Start) -> Run {
        Run {
            method: self.method.label(),
            start,
            element: Vec::new(),
            pace: self.pace.0,
            from: self.from,
            times: self.times.clone(),
            tolerances: self.tolerances,
            newton: self.newton,
            keep: self.keep,
            density: self.density,
            assess: if self.assess { u64::MAX } else { 0 },
            held: self.held.clone(),
            sources: Sources(self.sources.clone()),
            from_milestone: None,
            milestones: Milestones::None,
            curve: false,
        }
    }

    /// The final time.
    pub fn end(&self) -> f64 {
        end(&self.times, self.from)
    }
}

/// The last of some times, or the start where there are none.
fn end(times: &Times, from: f64) -> f64 {
    match times {
        Times::Until { end, .. } | Times::Within { end, .. } => *end,
        Times::At(times) => times.last().copied().unwrap_or(from),
    }
}

/// What is found for one method.
pub(super) struct Planned {
    /// The plan, where there are no mistakes.
    pub(super) plan: Option<Plan>,
    pub(super) mistakes: Vec<Message>,
    /// Options that the method does not take, which may belong to another one.
    pub(super) foreign: Vec<Foreign>,
}

/// An option that the method does not take.
pub(super) struct Foreign {
    pub(super) name: String,
    /// What is to be said if no other method takes it.
    pub(super) message: Message,
    /// Whether the method has it, with a value of its own.
    pub(super) own: bool,
}

/// What is asked for of the one method of a request.
///
/// # Errors
/// Every mistake but those of the start.
pub fn plan(spec: &Spec, request: &Request) -> Result<Plan, Vec<Message>> {
    let Planned {
        plan,
        mut mistakes,
        foreign,
    } = planned(spec, request);
    mistakes.extend(foreign.into_iter().map(|foreign| foreign.message));
    plan.filter(|_| mistakes.is_empty()).ok_or(mistakes)
}

/// Finds the mistakes of all options but those of the start, for the first method that is given.
pub(super) fn planned(spec: &Spec, request: &Request) -> Planned {
    let mut planner = Planner::new(spec, request);
    let method = planner.method();
    let pace = planner.pace();
    let from = planner.from();
    let times = from.and_then(|from| planner.times(from, pace.as_ref()));
    if let Some((from, times)) = from.zip(times.as_ref()) {
        planner.warm(from, end(times, from));
    }
    let solved = method.as_ref();
    if let (Some(method), Some((Pace::Tolerance(_), given))) = (solved, &pace) {
        planner.takes_tolerance(method, given);
    }
    let overall = pace.as_ref().map(|(pace, _)| *pace);
    let tolerances = solved.map(|method| planner.tolerances(method, overall));
    let newton = solved.map(|method| planner.newton(method, overall));
    let keep = solved.map(|method| planner.kept(method));
    let density = solved.map(|method| planner.density(method, keep.unwrap_or_default()));
    let held = solved.map(|method| planner.held(method, overall));
    let (held, sources) = held.unwrap_or_default();
    let chart = planner.chart();
    let picked = planner.picks();
    let plan = match (method, pace, from.zip(times)) {
        (Some(method), Some((pace, given)), Some((from, times))) => Some(Plan {
            method,
            pace: (pace, given.text),
            picked,
            from,
            times,
            chart,
            tolerances: tolerances.unwrap_or_default(),
            newton: newton.unwrap_or_default(),
            keep: keep.unwrap_or_default(),
            density: density.unwrap_or_default(),
            assess: request.assess,
            held,
            sources,
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

/// Checks a request, and collects its mistakes.
pub(super) struct Planner<'a> {
    pub(super) spec: &'a Spec,
    pub(super) request: &'a Request,
    pub(super) mistakes: Vec<Message>,
    foreign: Vec<Foreign>,
}

impl<'a> Planner<'a> {
    pub(super) fn new(spec: &'a Spec, request: &'a Request) -> Self {
        Self {
            spec,
            request,
            mistakes: Vec::new(),
            foreign: Vec::new(),
        }
    }

    /// What the spec's `run` says under a name.
    pub(super) fn in_spec(&self, name: &str) -> Vec<OptionValue> {
        let options = self
            .spec
            .model
            .run
            .iter()
            .filter(|option| option.name.text == name);
        let values = options.flat_map(|option| &option.values);
        values
            .map(|(text, origin)| OptionValue::spec(&self.spec.source, text, *origin))
            .collect()
    }

    /// An option of the request.
    pub(super) fn requested(&self, name: &str) -> Option<OptionValue> {
        let value = self.request.get(name)?;
        Some(OptionValue::value(&self.request.front.option(name), value))
    }

    /// An option: of the request, else of the spec.
    pub(super) fn option(&self, name: &str) -> Option<OptionValue> {
        self.requested(name)
            .or_else(|| self.in_spec(name).into_iter().next())
    }

    /// An option of the method or its solver. What the spec says of these belongs to the method of the spec.
    pub(super) fn method_option(&self, name: &str) -> Option<OptionValue> {
        let own = self.request.method.is_empty() && !self.picks();
        self.requested(name)
            .or_else(|| self.in_spec(name).into_iter().next().filter(|_| own))
    }

    /// A mistake at an option as a whole.
    pub(super) fn option_mistake(&self, name: &str, text: impl Into<String>) -> Message {
        Message::option(&self.request.front.option(name), text)
    }

    pub(super) fn keep<T>(&mut self, result: Result<T, Message>) -> Option<T> {
        result.map_err(|message| self.mistakes.push(message)).ok()
    }

    fn chart(&mut self) -> Option<Chart> {
        let given = self.option("group")?;
        let text = given.text.trim();
        let chart = match (text, text.strip_prefix("euler:")) {
            ("matrix", _) => Ok(Chart::Matrix),
            ("quaternion", _) => Ok(Chart::Quaternion),
            (_, Some(axes)) => axes.parse().map(Chart::Euler).map_err(|wrong| {
                given
                    .wrong(format!("`{axes}`: {wrong}"))
                    .help("write `euler:zxz` or `euler:zyx`")
            }),
            _ => {
                let message = given.wrong(format!("unknown form of the group element `{text}`"));
                Err(message
                    .help("write `matrix`, `quaternion`, or Euler angles such as `euler:zxz`"))
            }
        };
        let chart = self.keep(chart)?;
        if let Some((reason, help)) = group::refusal(&self.spec.model, chart) {
            self.mistakes.push(given.wrong(reason).help(help));
            return None;
        }
        Some(chart)
    }

    /// An option that the method does not have.
    pub(super) fn foreign(&mut self, name: &str, message: Message) {
        self.foreign.push(Foreign {
            name: name.to_owned(),
            message: message.with_fault(Fault::Method),
            own: false,
        });
    }

    /// An option of which the method has another value behind its id.
    pub(super) fn twice(&mut self, name: &str, given: &OptionValue, label: &str) {
        let text = format!("no method takes this flag: `{}` has its own", label.trim());
        let help = format!("leave out `--{name}`, or what stands behind the method");
        self.foreign.push(Foreign {
            name: name.to_owned(),
            message: given.wrong(text).help(help),
            own: true,
        });
    }
}
