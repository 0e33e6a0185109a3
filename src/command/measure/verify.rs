//! `lie verify`: claimed against measured.

use std::collections::BTreeMap;

use lie_codegen::program::Purpose;
use lie_in_process::evidence::Evidence;
use lie_in_process::list;
use lie_in_process::request::{Request, step_of_facts};
use lie_in_process::table;
use lie_in_process::verify::{Results, Row, options};
use lie_in_process::words::{counted, number, short};
use lie_measure::facts::{Finding, Verdict};
use lie_measure::verify::GroundFound as Ground;
use lie_program::protocol::Obstacle;
use lie_syntax::diagnostic::Kind;
use serde_json::{Map, Value, json};

use super::{Ended, bed, interrupted};
use crate::command::fold::folded;
use crate::command::{args, print};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};
use crate::render;

/// The facts that are measured at the step itself: an order takes many steps, the iteration others of its own.
const SINGLE: [&str; 7] = [
    "symmetric",
    "energy",
    "quadratic Casimirs",
    "other Casimirs",
    "quadratic integrals",
    "orbit",
    "Poisson",
];

/// Verifies methods on a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Verify) -> Result<u8, Failure> {
    let flags = &arguments.measured;
    let bed = bed(flags, Purpose::Verify, |spec| list::applicable(&spec.model))?;
    let request = Request {
        step: arguments.step.clone(),
        ..Request::default()
    };
    let step = step_of_facts(&bed.spec, &request)?;
    let interrupt = Interrupt::install();
    let program = bed.program(flags, Purpose::Verify, &interrupt)?;
    let model = &bed.spec.model;
    let options = options(model, &bed.point.parameters, step, arguments.seed.into());
    let (text, parameters) = (&bed.spec.source.text, &bed.point.parameters);
    let mut results = Results::new(Evidence::from_spec(text, model, parameters));
    let ended = bed.measure(flags, &program, options, &interrupt, &mut |found| {
        results.record(found)
    })?;
    if let Ended::Refused(what, why) = &ended {
        let what = match what {
            Obstacle::Ground => format!("nothing can be measured on {}: {why}", model.name),
            _ => why.clone(),
        };
        let message = Message::new(Kind::Domain, what).at_option("--initial");
        return Err(message
            .help("give another initial state with `--initial`, or a smaller `--step`")
            .into());
    }
    if arguments.json {
        let interrupted = matches!(ended, Ended::Interrupted(_));
        let value = as_json(&model.name, &results, interrupted);
        print(&format!("{value:#}\n"))?;
    } else {
        print(&report(&model.name, &results))?;
    }
    if let Ended::Interrupted(code) = ended {
        return Ok(interrupted(flags, code));
    }
    let failures = results.failures();
    for failure in &failures {
        render::say(&format!("failed: {failure}"));
    }
    Ok(u8::from(!failures.is_empty()))
}

/// What the table shows.
fn cell(row: &Row) -> String {
    let mut measured = short(row.finding.measured);
    if row.finding.error.is_finite() {
        measured = format!("{measured} ± {}", short(row.finding.error));
    }
    match row.finding.verdict {
        Verdict::Absent => "–".to_owned(),
        Verdict::Holds => format!("{measured} ✓"),
        Verdict::Fails => format!("{measured} ✗"),
        Verdict::NotMeasurable => "not measurable".to_owned(),
        Verdict::NotClaimed => measured,
    }
}

fn facts(rows: &[Row]) -> Vec<&str> {
    let mut facts: Vec<&str> = Vec::new();
    for row in rows {
        if !facts.contains(&&*row.finding.fact) {
            facts.push(&row.finding.fact);
        }
    }
    facts
}

fn methods(rows: &[Row]) -> Vec<&str> {
    let mut methods: Vec<&str> = rows.iter().map(|row| row.method.as_str()).collect();
    methods.dedup();
    methods
}

/// The steps at which a method's invariants were measured: where the one asked for failed, smaller ones.
fn steps(rows: &[Row], method: &str) -> String {
    let own = rows
        .iter()
        .filter(|row| row.method == method && SINGLE.contains(&&*row.finding.fact))
        .map(|row| row.finding.step.abs());
    let (least, most) = own
        .filter(|step| step.is_finite())
        .fold((f64::INFINITY, 0.0_f64), |(least, most), step| {
            (least.min(step), most.max(step))
        });
    if most == 0.0 {
        "–".to_owned()
    } else if least == most {
        short(most)
    } else {
        format!("{} to {}", short(least), short(most))
    }
}

fn report(system: &str, results: &Results) -> String {
    let rows = &results.rows;
    // what holds of the form and not of the method is summed up below the table
    let (summed, facts): (Vec<&str>, Vec<&str>) = facts(rows)
        .into_iter()
        .partition(|fact| OF_THE_FORM.contains(fact) && all_hold(rows, fact));
    let ground = results.ground.as_ref();
    let number = |of: fn(&Ground) -> f64| short(ground.map_or(f64::NAN, of));
    let count = |of: fn(&Ground) -> usize| ground.map_or(String::new(), |g| of(g).to_string());
    let head = format!(
        "{}: {}, step {}, {} states, {} linear and {} quadratic first integrals, reference to {}",
        system,
        counted(methods(rows).len() as u64, "method"),
        number(|ground| ground.step),
        count(|ground| ground.states),
        count(|ground| ground.linear),
        count(|ground| ground.quadratic),
        number(|ground| ground.error),
    );
    let said = format!(
        "✓ claimed and measured, ✗ claimed and not measured, no sign: not claimed; relative to the size of the terms\n\
         {}{}\n{} claims, {} fail\n",
        summary(rows, &summed),
        results.evidence.summary(),
        rows.iter().filter(|row| row.is_claimed()).count(),
        rows.iter().filter(|row| row.fails()).count(),
    );
    let table = table::text(&lines(rows, &facts));
    format!("{}\n\n{table}\n{}", folded(&head), folded(&said))
}

/// The table: a line for each method, a column for each fact.
fn lines(rows: &[Row], facts: &[&str]) -> Vec<Vec<String>> {
    let by_place: BTreeMap<(&str, &str), &Row> = rows
        .iter()
        .map(|row| ((row.method.as_str(), &*row.finding.fact), row))
        .collect();
    let header = ["method", "step"].into_iter().chain(facts.iter().copied());
    let mut lines = vec![header.map(str::to_owned).collect::<Vec<_>>()];
    for method in methods(rows) {
        let of = |fact: &&str| match by_place.get(&(method, *fact)) {
            Some(row) if fact.ends_with("order") && row.is_claimed() => {
                format!("{}: {}", row.finding.claim, cell(row))
            }
            Some(row) => cell(row),
            None => "–".to_owned(),
        };
        let start = [method.to_owned(), steps(rows, method)];
        lines.push(start.into_iter().chain(facts.iter().map(of)).collect());
    }
    lines
}

/// Facts that no method claims of itself: two forms of its code agree, the driver shows its steps.
const OF_THE_FORM: [&str; 5] = [
    "generic form",
    "row exchanges",
    "failed steps",
    "rows",
    "group",
];

fn all_hold(rows: &[Row], fact: &str) -> bool {
    rows.iter()
        .all(|row| row.finding.fact != fact || !row.fails())
}

/// One line on the facts that hold everywhere.
fn summary(rows: &[Row], summed: &[&str]) -> String {
    let parts: Vec<String> = summed
        .iter()
        .map(|fact| {
            let of_fact = rows.iter().map(|row| &row.finding);
            let holds = |f: &&Finding| f.fact == *fact && f.verdict == Verdict::Holds;
            let count = of_fact.filter(holds).count();
            let what = match *fact {
                "generic form" => "the generic form makes the same steps",
                "row exchanges" => "elimination in fixed order",
                "failed steps" => "a failed step leaves the state",
                "rows" => "rows on and off the grid",
                _ => "group element",
            };
            format!("{what} ({count})")
        })
        .collect();
    match parts.is_empty() {
        true => String::new(),
        false => format!(
            "these hold too, each with the number of methods: {}\n",
            parts.join(", ")
        ),
    }
}

/// What was found; where a signal has ended the measurement, it says that more was to come.
fn as_json(system: &str, results: &Results, interrupted: bool) -> Value {
    let mut all = Map::new();
    for row in &results.rows {
        let method = all
            .entry(row.method.clone())
            .or_insert_with(|| Value::Object(Map::new()));
        method[&*row.finding.fact] = row.as_json();
    }
    let ground = results.ground.as_ref();
    let of = |value: fn(&Ground) -> f64| ground.map_or(Value::Null, |ground| number(value(ground)));
    json!({
        "system": system,
        "step": of(|ground| ground.step),
        "span": of(|ground| ground.span),
        "reference_error": of(|ground| ground.error),
        "states": of(|ground| ground.states as f64),
        "linear_integrals": of(|ground| ground.linear as f64),
        "quadratic_integrals": of(|ground| ground.quadratic as f64),
        "methods": all,
        "judge": results.evidence.as_json(),
        "failed": results.rows.iter().filter(|row| row.fails()).count(),
        "interrupted": interrupted,
    })
}
