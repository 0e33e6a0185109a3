//! The signs of brackets: in which direction of time mechanics runs in a canonical pair, and which way a vector turns.

use lie_codegen::structure::Structure;
use lie_codegen::structure::directions::{self, Form, Pair, Roles, Turn};
use lie_program::protocol::Start;
use lie_symbolic::symbolic::Symbol;
use lie_syntax::ast::Invariance;
use serde_json::{Value, json};

use crate::words::counted;

/// The most pairs that are named together.
const MOST: usize = 3;

/// The brackets for programs, as a declaration writes them.
pub(super) fn brackets(model: &Structure) -> Value {
    directions::brackets(model).into()
}

/// The canonical pairs for programs. `initial` is null without an initial state, at which neither sign is taken, and of
/// families.
pub(super) fn canonical(model: &Structure) -> Value {
    let parameters = model.defaults();
    let initial = match model.family {
        Some(_) => None,
        None => model.initial_values(&parameters),
    };
    let pairs = told(model);
    pairs
        .map(|pair| {
            let value = initial.as_ref().map(|state| {
                let found = &model.directions;
                found.value(pair, &parameters, &|k| state[k])
            });
            json!({
                "position": name(model, pair.position),
                "momentum": name(model, pair.momentum),
                "bracket": model.directions.display(pair, model),
                "forwards": forwards(model, pair),
                "initial": value.and_then(|value| match value {
                    value if value > 0.0 => Some("forwards"),
                    value if value < 0.0 => Some("backwards"),
                    _ => None,
                }),
            })
        })
        .collect()
}

/// What is to be said of canonical pairs and of vectors that turn, sentence by sentence.
pub fn sentences(model: &Structure, start: Option<&Start>) -> Vec<String> {
    let mut sentences = Vec::new();
    let pairs: Vec<&Pair> = told(model).collect();
    let mut groups: Vec<Vec<&Pair>> = Vec::new();
    for pair in pairs {
        let same = |group: &&mut Vec<&Pair>| group[0].value == pair.value;
        match groups.iter_mut().find(same) {
            Some(group) => group.push(pair),
            None => groups.push(vec![pair]),
        }
    }
    for group in groups.iter().take(MOST) {
        sentences.extend(of_pairs(model, group, start));
    }
    if let Some(rest) = groups.get(MOST..).filter(|rest| !rest.is_empty()) {
        let more = rest.iter().map(Vec::len).sum::<usize>() as u64;
        sentences.push(format!("the same of {}", counted(more, "more pair")));
    }
    let turns = &model.directions.turns;
    if let Some(first) = turns.first() {
        let mut sentence = of_turn(model, first);
        if turns.len() > 1 {
            let more = counted(turns.len() as u64 - 1, "more vector");
            sentence.push_str(&format!(" (and so with {more})"));
        }
        sentences.push(sentence);
    }
    sentences
}

/// What a run that starts backwards in time is told, once for all runs.
pub fn note<'a>(
    model: &Structure,
    starts: impl Iterator<Item = &'a Start> + Clone,
) -> Option<String> {
    let found = &model.directions;
    // a sign that is written as a constant is meant, unless the names say otherwise
    let counts = told(model).filter(|pair| match (pair.roles, found.form(pair)) {
        (Roles::Order, Form::Number(_) | Form::Parameters) => false,
        (roles, _) => roles != Roles::Alike,
    });
    let counts = counts.map(|pair| (pair, Count::of(model, pair, starts.clone())));
    let wrong: Vec<(&Pair, Count)> = counts.filter(|(_, count)| count.backwards > 0).collect();
    let (first, count) = wrong.first()?;
    let shown: Vec<String> = wrong
        .iter()
        .take(MOST)
        .map(|(pair, _)| equation(model, pair))
        .collect();
    let mut shown = shown.join(", ");
    if wrong.len() > MOST {
        shown.push_str(&format!(" and {} more", wrong.len() - MOST));
    }
    let (verb, who) = match wrong.len() {
        1 => {
            let [q, p] = [first.position, first.momentum].map(|k| name(model, k));
            ("is", format!("in {q} and {p}"))
        }
        _ => ("are", "in these pairs".to_owned()),
    };
    let place = count.place(model, wrong.len() == 1);
    let remedy = remedy(model, &wrong);
    Some(format!(
        "{shown} {verb} {place}: mechanics {who} runs backwards in time there; {remedy} (the page Signs of the book)"
    ))
}

/// What to do about pairs with the other sign.
fn remedy(model: &Structure, wrong: &[(&Pair, Count)]) -> String {
    let first = wrong[0].0;
    match model.directions.form(first) {
        Form::Number(_) => return "give the bracket the other sign".to_owned(),
        Form::Parameters => {
            return format!("take parameters with {}", forwards(model, first));
        }
        Form::Multiple(..) | Form::Other => {}
    }
    let mut wanted: Vec<String> = Vec::new();
    for (pair, _) in wrong {
        let condition = forwards(model, pair);
        if !wanted.contains(&condition) {
            wanted.push(condition);
        }
    }
    let more = if wanted.len() > MOST { ", …" } else { "" };
    wanted.truncate(MOST);
    let start = format!("start from {}{more}", wanted.join(", "));
    // what is wrong in a part would be right in the others
    let all = wrong.iter().all(|(_, count)| count.backwards == count.all);
    let turns = all && model.is_lie_poisson() && model.invariance == Invariance::Left;
    match turns {
        true => format!(
            "{start}, or declare \"invariance\": \"right\", which turns the signs of all brackets"
        ),
        false => start,
    }
}

/// The pairs of which positions and momenta are told apart.
fn told(model: &Structure) -> impl Iterator<Item = &Pair> {
    let pairs = model.directions.pairs.iter();
    pairs.filter(|pair| pair.roles != Roles::Alike)
}

/// In how many places a pair has which sign: in runs, and at sites of a family.
struct Count {
    backwards: usize,
    forwards: usize,
    all: usize,
    runs: usize,
    /// The first value that is negative.
    value: f64,
}

impl Count {
    fn of<'a>(model: &Structure, pair: &Pair, starts: impl Iterator<Item = &'a Start>) -> Self {
        let mut count = Self {
            backwards: 0,
            forwards: 0,
            all: 0,
            runs: 0,
            value: 0.0,
        };
        for start in starts {
            let parameters = model.parameters.iter().map(|parameter| {
                let given = start.parameters.get(&parameter.name);
                given.copied().unwrap_or(parameter.default_value)
            });
            let parameters: Vec<f64> = parameters.collect();
            let state = &start.initial;
            // the first coordinates of all sites stand before the second ones
            let sites = match model.family {
                Some(_) => model.of_sites(state).len() / model.dimension(),
                None => 1,
            };
            count.runs += 1;
            for site in 0..sites {
                let at = |k: usize| state[k * sites + site];
                let value = model.directions.value(pair, &parameters, &at);
                count.all += 1;
                count.forwards += usize::from(value > 0.0);
                if value < 0.0 && count.backwards == 0 {
                    count.value = value;
                }
                count.backwards += usize::from(value < 0.0);
            }
        }
        count
    }

    /// Where it is negative, as a predicate.
    fn place(&self, model: &Structure, with_value: bool) -> String {
        let (some, all) = (self.backwards, self.all);
        match (model.family.is_some(), self.runs) {
            (true, 1) => format!("negative at {some} of {all} sites"),
            (true, _) => format!("negative at {some} of {all} sites of all runs"),
            (false, 1) if with_value => format!("{:?} at the initial state", self.value),
            (false, 1) => "negative at the initial state".to_owned(),
            (false, _) => format!("negative in {some} of {all} runs"),
        }
    }
}

/// What is to be said of pairs with the same bracket: what it is, and which way mechanics runs by it.
fn of_pairs(model: &Structure, pairs: &[&Pair], start: Option<&Start>) -> [String; 2] {
    let shown = pairs.iter().take(MOST).map(|pair| left(model, pair));
    let shown: Vec<String> = shown.collect();
    let value = model.directions.display(pairs[0], model);
    let more = match pairs.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!(" (and {})", counted(more as u64, "more pair")),
    };
    let who = match pairs {
        [pair] => {
            let [q, p] = [pair.position, pair.momentum].map(|k| name(model, k));
            match pair.roles {
                Roles::Order => format!("{q} as position and {p} as momentum are canonical"),
                _ => format!("{q} and {p} are canonical"),
            }
        }
        _ => "these pairs are canonical".to_owned(),
    };
    let form = model.directions.form(pairs[0]);
    let way = match form {
        Form::Number(false) => "forwards".to_owned(),
        Form::Number(true) => "backwards in time".to_owned(),
        Form::Multiple(k, negative) => {
            let (here, there) = if negative { ('<', '>') } else { ('>', '<') };
            let k = name(model, k);
            format!("forwards where {k} {here} 0, backwards in time where {k} {there} 0")
        }
        Form::Parameters | Form::Other => {
            format!("forwards where {value} > 0, backwards in time where it is negative")
        }
    };
    let start = start.filter(|_| !matches!(form, Form::Number(_)));
    let here = start.map(|start| Count::of(model, pairs[0], std::iter::once(start)));
    let here = here.map_or("", |count| match (count.forwards, count.backwards) {
        (0, 0) => "; at the initial state it is zero",
        (_, 0) => "; forwards at the initial state",
        (0, _) => "; backwards at the initial state",
        _ => "; forwards at some sites of the initial state, backwards at others",
    });
    [
        format!(
            "{} = {value}{more} does not change in time: {who}",
            shown.join(" = ")
        ),
        format!("mechanics runs {way}{here}"),
    ]
}

/// What is to be said of a vector that turns.
fn of_turn(model: &Structure, turn: &Turn) -> String {
    let [x, y, z] = turn.coordinates.map(|k| name(model, k));
    let factor = match turn.scale.to_string().as_str() {
        "1" => String::new(),
        "-1" => "-".to_owned(),
        other => format!("{other}*"),
    };
    let brackets = format!(
        "{{{x}, {y}}} = {factor}{z}, {{{y}, {z}}} = {factor}{x}, {{{z}, {x}}} = {factor}{y}"
    );
    let (own, other) = match turn.scale.is_negative() {
        true => (
            "a body in its own frame or a magnetic moment, m' = m x grad H",
            "a textbook spin, {Jx, Jy} = Jz,",
        ),
        false => (
            "a textbook spin, {Jx, Jy} = Jz, m' = grad H x m",
            "a body in its own frame, or a magnetic moment,",
        ),
    };
    format!("{brackets}: ({x}, {y}, {z}) turns as {own}; {other} turns the other way")
}

/// `z < 0`: where mechanics in a pair runs forwards.
fn forwards(model: &Structure, pair: &Pair) -> String {
    match model.directions.form(pair) {
        Form::Multiple(k, negative) => {
            let sign = if negative { '<' } else { '>' };
            format!("{} {sign} 0", name(model, k))
        }
        Form::Number(negative) => if negative { "never" } else { "always" }.to_owned(),
        Form::Parameters | Form::Other => format!("{} > 0", model.directions.display(pair, model)),
    }
}

fn name(model: &Structure, coordinate: usize) -> String {
    directions::name(model, Symbol::Coordinate(coordinate))
}

/// `{q, p}`
fn left(model: &Structure, pair: &Pair) -> String {
    let [q, p] = [pair.position, pair.momentum].map(|k| name(model, k));
    format!("{{{q}, {p}}}")
}

/// `{q, p} = -z`
fn equation(model: &Structure, pair: &Pair) -> String {
    format!(
        "{} = {}",
        left(model, pair),
        model.directions.display(pair, model)
    )
}
