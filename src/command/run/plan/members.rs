//! Several runs in one: methods, values of parameters, initial states.

use std::path::Path;
use std::rc::Rc;

use lie_codegen::diagnostic::Kind;
use lie_program::protocol::Start;

use super::super::values::Given;
use super::{Member, Plan, Planned, Planner, Point, Several, npy, plan};
use crate::command::args;
use crate::compiler::Spec;
use crate::message::{Message, Place, Source};
use crate::output::Labels;

/// The most runs of one command.
const MOST: usize = 1_000_000;

/// Finds the mistakes of all options, then answers.
///
/// # Errors
/// Every mistake.
pub fn several(spec: &Spec, flags: &args::Run) -> Result<Several, Vec<Message>> {
    let mut mistakes = Vec::new();
    let (sweeps, fixed) = sweeps(flags).unwrap_or_else(|found| {
        mistakes.extend(found);
        (Vec::new(), flags.param.clone())
    });
    let mut flags = args::Run {
        param: fixed,
        ..flags.clone()
    };
    let states = flags.initial_file.take().map(|path| {
        let found = states(spec, &path);
        found.unwrap_or_else(|message| {
            mistakes.push(message);
            States::default()
        })
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
        return Err(vec![too_many(plans.len() * points.len())]);
    }
    let starts: Vec<(Vec<f64>, Start)> = points
        .into_iter()
        .map(|(parameters, point)| (parameters, point.named(spec)))
        .collect();
    let members = (0..plans.len()).flat_map(|plan| {
        starts.iter().map(move |(parameters, start)| Member {
            plan,
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

fn too_many(runs: usize) -> Message {
    let text = format!("{runs} runs, and {MOST} can be made at once");
    let message = Message::new(Kind::Limit, text).at_option("--param");
    message.help("take fewer values, or several commands for parts of them")
}

/// A name that no column of the system has.
fn free(spec: &Spec, name: &str) -> String {
    let model = &spec.model;
    let mut name = name.to_owned();
    let taken = |name: &str| {
        model.coordinates.iter().any(|known| known.text == name)
            || model.casimirs.iter().any(|known| known.name == name)
            || model.parameters.iter().any(|known| known.name == name)
    };
    while taken(&name) {
        name.push('_');
    }
    name
}

/// A plan for each method.
fn plans(spec: &Spec, flags: &args::Run) -> Result<Vec<Plan>, Vec<Message>> {
    let methods: Vec<Vec<String>> = match flags.method.len() {
        0 => vec![Vec::new()],
        _ => flags.method.iter().map(|m| vec![m.clone()]).collect(),
    };
    let found = methods.into_iter().map(|method| {
        let flags = args::Run {
            method,
            ..flags.clone()
        };
        plan(spec, &flags)
    });
    let found: Vec<Planned> = found.collect();
    let mut mistakes: Vec<Message> = Vec::new();
    let mut say = |message: &Message| {
        // what is wrong with the other options is said once
        if !mistakes.iter().any(|known| known.text == message.text) {
            mistakes.push(message.clone());
        }
    };
    for (option, message) in &found[0].foreign {
        let of_none = |other: &Planned| other.foreign.iter().any(|(name, _)| name == option);
        if found.iter().all(of_none) {
            say(message);
        }
    }
    let mut plans: Vec<Plan> = Vec::new();
    for planned in found {
        planned.mistakes.iter().for_each(&mut say);
        let Some(plan) = planned.plan else { continue };
        if plans.iter().any(|known| known.method == plan.method) {
            let text = format!("`{}` is given twice", plan.method.label());
            say(&Message::option("--method", text).help("give it once"));
        }
        plans.push(plan);
    }
    match mistakes.is_empty() {
        true => Ok(plans),
        false => Err(mistakes),
    }
}

/// The parameters and the initial state of each run, and the values of the parameters that have several.
fn points(
    spec: &Spec,
    flags: &args::Run,
    sweeps: &[Sweep],
    states: Option<States>,
) -> Result<Vec<(Vec<f64>, Point)>, Vec<Message>> {
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
        flags
            .param
            .extend(swept.map(|(sweep, value)| format!("{}={value:?}", sweep.name)));
        let mut planner = Planner::new(spec, &flags);
        let found = match &states {
            None => planner.start().into_iter().collect(),
            Some(states) => planner.starts(states),
        };
        if !planner.mistakes.is_empty() {
            return Err(planner.mistakes);
        }
        points.extend(found.into_iter().map(|point| (values.clone(), point)));
    }
    Ok(points)
}

/// A parameter with several values.
struct Sweep {
    name: String,
    values: Vec<f64>,
}

/// The parameters with several values, and what `--param` says of the others.
fn sweeps(flags: &args::Run) -> Result<(Vec<Sweep>, Vec<String>), Vec<Message>> {
    let (mut sweeps, mut fixed, mut mistakes) = (Vec::new(), Vec::new(), Vec::new());
    let mut runs = 1_usize;
    for text in &flags.param {
        let range = text
            .split_once('=')
            .filter(|(_, range)| range.contains(':'));
        let Some((name, range)) = range else {
            fixed.push(text.clone());
            continue;
        };
        let given = Given::flag("--param", text).part(name.len() + 1..text.len());
        match values(&given, range) {
            Ok(values) => {
                runs = runs.saturating_mul(values.len());
                let name = name.trim().to_owned();
                sweeps.push(Sweep { name, values });
            }
            Err(message) => mistakes.push(message),
        }
    }
    if runs > MOST {
        mistakes.push(too_many(runs));
    }
    match mistakes.is_empty() {
        true => Ok((sweeps, fixed)),
        false => Err(mistakes),
    }
}

/// The values of `FROM:TO:COUNT`, at equal distances, both ends among them.
fn values(given: &Given, range: &str) -> Result<Vec<f64>, Message> {
    let mut parts = Vec::new();
    let mut from = 0;
    for part in range.split(':') {
        parts.push(given.part(from..from + part.len()));
        from += part.len() + 1;
    }
    let [from, to, count] = parts.as_slice() else {
        let message = given.wrong(format!("`{range}` is not FROM:TO:COUNT"));
        return Err(message.help("write it like `--param k=1:2:11`, for 1, 1.1, …, 2"));
    };
    let (from, to) = (from.number()?, to.number()?);
    let help = "give the number of values, at least 1, such as `--param k=1:2:11`";
    let count = count.count().map_err(|message| message.help(help))? as usize;
    if count > MOST {
        return Err(too_many(count).at(given.wrong("").place));
    }
    if count == 1 && from != to {
        let message = given.wrong("one value cannot be both ends");
        return Err(message.help("take at least 2 values, or give one as NAME=VALUE"));
    }
    let last = (count - 1).max(1) as f64;
    let value = |k: usize| match k + 1 == count {
        true => to,
        false => from + (to - from) * (k as f64 / last),
    };
    Ok((0..count).map(value).collect())
}

/// Initial states from a file.
#[derive(Default)]
pub(super) struct States {
    /// The numbers of each, and where they stand.
    pub(super) all: Vec<(Vec<f64>, Place)>,
}

fn states(spec: &Spec, path: &Path) -> Result<States, Message> {
    let unread = |text: String, help: &str| Message::io(path, text).help(help);
    let bytes = std::fs::read(path).map_err(|error| {
        unread(
            format!("it cannot be read: {error}"),
            "give a file of initial states, CSV or NPY",
        )
    })?;
    let states = if bytes.starts_with(b"\x93NUMPY") {
        array(&bytes, path)?
    } else {
        let text = String::from_utf8(bytes).map_err(|_| {
            let help = "write a state in each line, or save an array by `numpy.save`";
            unread("it is neither text nor an array of NumPy".to_owned(), help)
        })?;
        lines(spec, text, path)?
    };
    match states.all.len() {
        0 => Err(unread(
            "it has no state".to_owned(),
            "write a state in each line",
        )),
        1..=MOST => Ok(states),
        more => {
            let text = format!("it has {more} states, and {MOST} runs can be made at once");
            Err(unread(text, "split the file"))
        }
    }
}

/// The rows of an array.
fn array(bytes: &[u8], path: &Path) -> Result<States, Message> {
    let array =
        npy::parse(bytes).map_err(|fault| Message::io(path, fault.text).help(fault.help))?;
    let width = match array.shape.as_slice() {
        [_, width] => *width,
        shape => {
            let text = format!("its shape is {shape:?}");
            let help = "write an array with two axes, a row for each state";
            return Err(Message::io(path, text).help(help));
        }
    };
    let place = |row: usize| Place::File(format!("{}, row {row}", path.display()));
    let rows = array.values.chunks_exact(width.max(1)).enumerate();
    Ok(States {
        all: rows.map(|(k, row)| (row.to_vec(), place(k))).collect(),
    })
}

/// The lines of a table, below the names of the coordinates or without them.
fn lines(spec: &Spec, text: String, path: &Path) -> Result<States, Message> {
    let source = Rc::new(Source {
        path: path.display().to_string(),
        text,
    });
    let shown = spec.model.shown_coordinates().into_iter();
    let names: Vec<&str> = shown
        .map(|i| spec.model.coordinates[i].text.as_str())
        .collect();
    let mut order: Option<Vec<usize>> = None;
    let mut all = Vec::new();
    let (mut at, mut first) = (0, true);
    for line in source.text.split_inclusive('\n') {
        let start = at;
        at += line.len();
        let content = line.trim();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let from = start + line.find(content).unwrap_or(0);
        let place = Place::Text(Rc::clone(&source), from..from + content.len());
        let fields: Vec<&str> = content.split(',').map(str::trim).collect();
        let number = crate::compiler::constant(fields[0]).is_ok();
        let header = std::mem::take(&mut first) && !number;
        if header {
            order = Some(permutation(&fields, &names, &place)?);
            continue;
        }
        let mut values = numbers(&fields, &place)?;
        if let Some(order) = &order {
            if values.len() != order.len() {
                let text = format!("{} values below {} names", values.len(), order.len());
                let message = Message::new(Kind::StateLength, text).at(place);
                return Err(message.help("give each line a value for each name"));
            }
            values = order.iter().map(|&k| values[k]).collect();
        }
        all.push((values, place));
    }
    Ok(States { all })
}

/// Where the value of each coordinate stands in a line.
fn permutation(fields: &[&str], names: &[&str], place: &Place) -> Result<Vec<usize>, Message> {
    let find = |name: &&str| fields.iter().position(|field| field == name);
    let order: Option<Vec<usize>> = names.iter().map(find).collect();
    order
        .filter(|order| order.len() == fields.len())
        .ok_or_else(|| {
            if separated_otherwise(fields) {
                let text = "no commas stand between these numbers".to_owned();
                let message = Message::new(Kind::Option, text).at(place.clone());
                return message.help("write a state in each line, such as `0.1,0.2,0.3`");
            }
            let odd = fields.iter().find(|field| !names.contains(field));
            let text = match odd {
                Some(odd) => format!("`{odd}` is not the name of a coordinate"),
                None => "these are not the names of the coordinates".to_owned(),
            };
            let message = Message::new(Kind::Option, text).at(place.clone());
            message.help(format!("write `{}`, in any order", names.join(",")))
        })
}

/// Whether a line without commas consists of numbers.
fn separated_otherwise(fields: &[&str]) -> bool {
    let [line] = fields else { return false };
    let mut parts = line.split([';', '\t', ' ']).filter(|part| !part.is_empty());
    parts.all(|part| crate::compiler::constant(part).is_ok())
}

fn numbers(fields: &[&str], place: &Place) -> Result<Vec<f64>, Message> {
    let number = |field: &&str| {
        let value = crate::compiler::constant(field).ok();
        value.filter(|value| value.is_finite()).ok_or_else(|| {
            let text = format!("`{field}` is not a finite number");
            let message = Message::new(Kind::Option, text).at(place.clone());
            message.help("give numbers such as 0.01 or 1/7, with commas between them")
        })
    };
    fields.iter().map(number).collect()
}
