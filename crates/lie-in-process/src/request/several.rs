//! Several runs in one: methods, values of parameters, initial states.

use lie_program::protocol::Start;
use lie_syntax::diagnostic::Kind;

use super::plan::{Foreign, Planned, Planner, planned};
use super::range::{Range, Words};
use super::sites::bound_to_itself;
use super::states::{States, states};
use super::{Front, Labels, Member, OptionValue, Parameter, Plan, Point, Request, Several, Value};
use crate::memory;
use crate::message::{Fault, Message};
use crate::spec::Spec;
use crate::words::counted;

/// The most runs of one command.
pub(super) const MOST: usize = 1_000_000;

/// Bytes of a run beside its state.
const RUN: f64 = 500.0;

/// The runs of a request. Finds the mistakes of all options, then answers.
///
/// # Errors
/// Every mistake.
pub fn several(spec: &Spec, request: &Request) -> Result<Several, Vec<Message>> {
    let mut mistakes = Vec::new();
    let (sweeps, fixed) = sweeps(request).unwrap_or_else(|found| {
        mistakes.extend(found);
        (Vec::new(), request.param.clone())
    });
    let mut flags = Request {
        param: fixed,
        ..request.clone()
    };
    let states = flags.initial_file.take().and_then(|path| {
        let found = states(spec, &path);
        found.map_err(|message| mistakes.push(message)).ok()
    });
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
    let labels = (flags.method.len() > 1 || !sweeps.is_empty() || states.is_some()).then(|| {
        let free = |name: &str| free(spec, name);
        Labels {
            run: free("run"),
            method: (flags.method.len() > 1).then(|| free("method")),
            parameters: sweeps.iter().map(|sweep| sweep.name.clone()).collect(),
        }
    });
    let points = points(spec, &flags, &sweeps, states);
    let plans = plans(spec, &flags);
    let (plans, points) = match (plans, points) {
        (Ok(plans), Ok(points)) => (plans, points),
        (plans, points) => {
            let found = plans.err().into_iter().chain(points.err());
            return Err(found.flatten().collect());
        }
    };
    if plans.len() * points.len() > MOST {
        return Err(vec![too_many(request.front, plans.len() * points.len())]);
    }
    let bound = |plan: &Plan| {
        let mut points = points.iter().map(|(_, point)| &point.parameters);
        points.find_map(|values| bound_to_itself(&spec.model, &plan.method, values, request.front))
    };
    if let Some(message) = plans.iter().find_map(bound) {
        return Err(vec![message]);
    }
    let starts: Vec<(Vec<f64>, Start)> = points
        .into_iter()
        .map(|(parameters, point)| (parameters, point.named(spec)))
        .collect();
    let members = (0..plans.len()).flat_map(|plan| {
        let starts = starts.iter().enumerate();
        starts.map(move |(point, (parameters, start))| Member {
            plan,
            point,
            parameters: parameters.clone(),
            start: start.clone(),
        })
    });
    Ok(Several {
        members: members.collect(),
        plans,
        labels,
    })
}

fn too_many(front: Front, runs: usize) -> Message {
    let text = format!("{runs} runs, and {MOST} can be made at once");
    let message = Message::new(Kind::Limit, text).at_option(&front.option("param"));
    message.help("take fewer values, or several commands for parts of them")
}

/// A name that no column of the system has.
fn free(spec: &Spec, name: &str) -> String {
    let model = &spec.model;
    let mut name = name.to_owned();
    let taken = |name: &str| {
        model.coordinates.iter().any(|known| known.text == name)
            || model.casimirs.iter().any(|known| known.name == name)
            || model.quantities.iter().any(|known| known.name == name)
            || model.parameters.iter().any(|known| known.name == name)
    };
    while taken(&name) {
        name.push('_');
    }
    name
}

/// A plan for each method.
fn plans(spec: &Spec, flags: &Request) -> Result<Vec<Plan>, Vec<Message>> {
    let methods: Vec<Vec<String>> = match flags.method.len() {
        0 => vec![Vec::new()],
        _ => flags.method.iter().map(|m| vec![m.clone()]).collect(),
    };
    let found = methods.into_iter().map(|method| {
        let flags = Request {
            method,
            ..flags.clone()
        };
        planned(spec, &flags)
    });
    let found: Vec<Planned> = found.collect();
    let mut mistakes: Vec<Message> = Vec::new();
    let mut say = |message: &Message| {
        // what is wrong with the other options is said once
        if !mistakes.iter().any(|known| known.text == message.text) {
            mistakes.push(message.clone());
        }
    };
    for foreign in &found[0].foreign {
        let same = |other: &&Foreign| other.name == foreign.name;
        let of_each = found.iter().map(|other| other.foreign.iter().find(same));
        let of_each: Option<Vec<&Foreign>> = of_each.collect();
        // none takes it: that one of them has a value of its own says more than that the others cannot have one
        if let Some(of_each) = of_each {
            let own = of_each.iter().find(|other| other.own);
            say(&own.unwrap_or(&foreign).message);
        }
    }
    let mut plans: Vec<Plan> = Vec::new();
    for planned in found {
        planned.mistakes.iter().for_each(&mut say);
        let Some(plan) = planned.plan else { continue };
        if plans.iter().any(|known| known.method == plan.method) {
            let text = format!("`{}` is given twice", plan.method.label());
            let option = flags.front.option("method");
            say(&Message::option(&option, text).help("give it once"));
        }
        plans.push(plan);
    }
    match mistakes.is_empty() {
        true => Ok(plans),
        false => Err(mistakes),
    }
}

/// The parameters and the initial state of each run, and the values of the parameters that have several.
pub(super) fn points(
    spec: &Spec,
    flags: &Request,
    sweeps: &[Sweep],
    states: Option<States>,
) -> Result<Vec<(Vec<f64>, Point)>, Vec<Message>> {
    let front = flags.front;
    let count: usize = sweeps.iter().map(|sweep| sweep.values.len()).product();
    let mut points = Vec::new();
    for number in 0..count {
        let mut rest = number;
        let mut values = vec![0.0; sweeps.len()];
        for (value, sweep) in values.iter_mut().zip(sweeps).rev() {
            *value = sweep.values[rest % sweep.values.len()];
            rest /= sweep.values.len();
        }
        let mut flags = flags.clone();
        let swept = sweeps.iter().zip(&values);
        let set = |(sweep, value): (&Sweep, &f64)| {
            Parameter::Set(sweep.name.clone(), Value::Number(*value))
        };
        flags.param.extend(swept.map(set));
        let mut planner = Planner::new(spec, &flags);
        let found = match &states {
            None => planner.start().into_iter().collect(),
            Some(states) => planner.starts(states),
        };
        if !planner.mistakes.is_empty() {
            return Err(planner.mistakes);
        }
        if let (0, Some(first)) = (number, found.first()) {
            let runs = count * found.len() * flags.method.len().max(1);
            let state = first.initial.len() as f64 * memory::NUMBER;
            // it is kept once for each method, and its parameters with it
            memory::fits(runs as f64 * (state + RUN)).map_err(|exceeded| {
                let message = too_many(front, runs);
                let text = format!("{}: {exceeded}", counted(runs as u64, "run"));
                vec![Message { text, ..message }.with_fault(Fault::Memory)]
            })?;
        }
        points.extend(found.into_iter().map(|point| (values.clone(), point)));
    }
    Ok(points)
}

/// A parameter with several values.
pub(super) struct Sweep {
    pub(super) name: String,
    pub(super) values: Vec<f64>,
}

/// The parameters with several values, and what is said of the others.
pub(super) fn sweeps(request: &Request) -> Result<(Vec<Sweep>, Vec<Parameter>), Vec<Message>> {
    let (mut sweeps, mut fixed, mut mistakes) = (Vec::new(), Vec::new(), Vec::new());
    let mut runs = 1_usize;
    let front = request.front;
    for parameter in &request.param {
        let range = match parameter {
            Parameter::Written(text) => text
                .split_once('=')
                .filter(|(_, range)| range.contains(':'))
                .map(|(name, _)| (text, name)),
            Parameter::Set(..) => None,
        };
        let Some((text, name)) = range else {
            fixed.push(parameter.clone());
            continue;
        };
        let given =
            OptionValue::flag(&front.option("param"), text).part(name.len() + 1..text.len());
        match values(front, &given) {
            Ok(values) => {
                runs = runs.saturating_mul(values.len());
                let name = name.trim().to_owned();
                sweeps.push(Sweep { name, values });
            }
            Err(message) => mistakes.push(message),
        }
    }
    if runs > MOST {
        mistakes.push(too_many(front, runs));
    }
    match mistakes.is_empty() {
        true => Ok((sweeps, fixed)),
        false => Err(mistakes),
    }
}

/// Names of parameters with the values that each takes.
type Ranges = Vec<(String, Vec<f64>)>;

/// The parameters with several values, and what is said of the others.
///
/// # Errors
/// Every range that is none.
pub fn ranges(request: &Request) -> Result<(Ranges, Vec<Parameter>), Vec<Message>> {
    let (sweeps, fixed) = sweeps(request)?;
    let sweeps = sweeps.into_iter().map(|sweep| (sweep.name, sweep.values));
    Ok((sweeps.collect(), fixed))
}

/// The values of `FROM:TO:COUNT`.
fn values(front: Front, given: &OptionValue) -> Result<Vec<f64>, Message> {
    let words = Words {
        form: "FROM:TO:COUNT",
        example: front.parameter("k", "1:2:11"),
        meaning: "1, 1.1, …, 2",
        what: "values",
        single: "NAME=VALUE".to_owned(),
        most: MOST,
        too_many: &|count| too_many(front, count),
    };
    Range::read(given, &words).map(|range| range.values())
}
