//! `lie frequencies`: of which frequencies a motion is made.

use std::collections::HashSet;
use std::f64::consts::PI;
use std::io;

use lie_in_process::request::{Plan, several};
use lie_in_process::table;
use lie_in_process::words::{number, with_digits};
use lie_program::protocol::{Found, Start};
use lie_runtime::driver::Pace;
use lie_spectra::frequencies::{self, Frequencies, LEAST, Line, Options};
use lie_syntax::suggest::{did_you_mean, listed};
use serde_json::{Map, Value, json};

use super::run::bar::Bar;
use super::run::layout::{Layout, Places};
use super::run::said::{stopped_text, title};
use super::run::{impossible, workers};
use super::{args, print};
use crate::build::talk::{Outcome, Worker};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, STOPPED};
use crate::render;

/// Lines below this part of the largest one are not warned of.
const NOTICED: f64 = 1e-6;

/// The columns that are analysed, beside the times of their rows.
struct Samples {
    times: Vec<f64>,
    signals: Vec<(String, Vec<f64>)>,
    step: f64,
}

/// Runs, analyses and prints.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Frequencies) -> Result<u8, Failure> {
    let spec = compiler::load(&arguments.spec)?;
    let asked = several(&spec, &arguments.request).map_err(Failure::invalid)?;
    let ([plan], [member], None) = (&*asked.plans, &*asked.members, &asked.labels) else {
        let text = format!(
            "{} runs are asked for, and one is analysed",
            asked.members.len()
        );
        let help = "give one method, one value of each parameter and one initial state";
        return Err(Message::option("SPEC", text).help(help).into());
    };
    let layout = Layout::new(&spec.model, plan.chart, &member.start.parameters);
    let columns = columns(&layout, &arguments.of)?;
    if !arguments.quiet {
        render::print(&spec.warnings());
    }
    let interrupt = Interrupt::install();
    let flags = args::Run {
        quiet: arguments.quiet,
        ..args::Run::default()
    };
    let workers = workers(&spec, &asked.plans, &flags, &interrupt)?;
    let (outcome, samples) = sampled(
        (&spec, plan, &member.start),
        (&layout, &columns),
        &workers[0],
        (&interrupt, arguments.quiet),
    )?;
    let code = ended(outcome, &workers[0], arguments.quiet)?;
    if code != 0 && samples.times.len() < LEAST {
        return Ok(code);
    }
    let distance = distance(&samples)?;
    check(&samples, distance.1)?;
    // the analysis may take long, and has nothing to end in order
    interrupt.expect_no_more();
    if let Some(signal) = interrupt.seen().filter(|_| code == 0) {
        return Ok(signal);
    }
    let options = Options {
        count: arguments.count as usize,
        window: arguments.window,
    };
    let find = |(name, values): &(String, Vec<f64>)| {
        let found = frequencies::frequencies(&values[..distance.1], distance.0, options);
        (name.clone(), found)
    };
    let found: Vec<(String, Frequencies)> = samples.signals.iter().map(find).collect();
    if !arguments.quiet {
        render::print(&at_the_limit(distance, options.window, &found));
    }
    let title = title(&spec, plan, samples.step);
    match arguments.json {
        true => {
            let value = as_json(&spec, plan, (&samples, distance), &found);
            print(&format!("{value:#}\n"))?;
        }
        false => print(&text(&title, distance, &found))?,
    }
    Ok(code)
}

/// The places of the columns that are asked for.
fn columns(layout: &Layout, of: &[String]) -> Result<Vec<usize>, Failure> {
    let all = layout.columns.made(0..layout.columns.len());
    let place = |name: &String| {
        let name = name.trim();
        let known = all.iter().skip(1).position(|known| known == name);
        known.map(|place| place + 1).ok_or_else(|| {
            let text = format!("`{name}` is no column of the run");
            let names: Vec<&str> = all[1..].iter().map(String::as_str).collect();
            let help = match did_you_mean(name, names.iter().copied()) {
                Some(meant) => format!("did you mean `{meant}`?"),
                None => format!("the columns are {}", listed(&names)),
            };
            Message::option("--of", text).help(help)
        })
    };
    let mut mistakes = Vec::new();
    let places = of.iter().map(place);
    let places = places.filter_map(|place| place.map_err(|wrong| mistakes.push(wrong)).ok());
    let mut places: Vec<usize> = places.collect();
    let mut seen = HashSet::new();
    places.retain(|place| seen.insert(*place));
    match mistakes.is_empty() {
        true => Ok(places),
        false => Err(Failure::invalid(mistakes)),
    }
}

/// Runs, and keeps of the rows what is analysed.
fn sampled(
    (spec, plan, start): (&Spec, &Plan, &Start),
    (layout, columns): (&Layout, &[usize]),
    worker: &Worker,
    (interrupt, quiet): (&Interrupt, bool),
) -> Result<(Outcome, Samples), Failure> {
    let names = layout.columns.made(0..layout.columns.len());
    let signals = columns
        .iter()
        .map(|place| (names[*place].clone(), Vec::new()));
    let mut samples = Samples {
        times: Vec::new(),
        signals: signals.collect(),
        step: match plan.pace.0 {
            Pace::Step(step) => step,
            Pace::Tolerance(_) => f64::NAN,
        },
    };
    let mut known: Option<(Places, usize)> = None;
    let bar = Bar::new(!quiet);
    let wrong = || io::Error::new(io::ErrorKind::InvalidData, "these are not the columns");
    let outcome = worker.talk(
        plan.run_of(&spec.model, start.clone()),
        interrupt,
        &mut |found| {
            match found {
                Found::Chosen(chosen) => samples.step = chosen.step,
                Found::Columns(all) => {
                    let places = layout.places(&all).ok_or_else(wrong)?;
                    known = Some((places, all.width()));
                }
                Found::Rows(rows) => {
                    let (places, width) = known.as_ref().ok_or_else(wrong)?;
                    let shown = places.shown(rows.numbers, *width);
                    for row in shown.chunks_exact(places.len()) {
                        samples.times.push(row[0]);
                        let signals = samples.signals.iter_mut().zip(columns);
                        signals.for_each(|((_, values), place)| values.push(row[*place]));
                    }
                }
                _ => {}
            }
            Ok(())
        },
        &mut |progress| bar.show(progress.done, progress.all),
    );
    bar.clear();
    Ok((
        outcome.map_err(|error| worker.not_started(&error))?,
        samples,
    ))
}

/// What is said of the end of the run, and the exit code.
fn ended(outcome: Outcome, worker: &Worker, quiet: bool) -> Result<u8, Failure> {
    match outcome {
        Outcome::Done => Ok(0),
        Outcome::Interrupted(code) => {
            if !quiet {
                render::say("Interrupted; the rows so far are analysed.");
            }
            Ok(code)
        }
        Outcome::Stopped(stop) => {
            let why = stopped_text(&stop, "the rows so far are analysed");
            render::stopped(&why, &stop.remedy);
            Ok(STOPPED)
        }
        Outcome::Parameter(name, why) => Err(impossible(&name, &why)),
        Outcome::Refused(_, why) | Outcome::Broken(why) => Err(worker.broken(&why)),
        Outcome::NotTaken(error) => Err(worker.broken(&error.to_string())),
    }
}

/// The distance of the samples, and how many there are at equal ones.
fn distance(samples: &Samples) -> Result<(f64, usize), Failure> {
    let count = samples.times.len();
    if count < LEAST {
        let text = format!("{count} samples, and lines take at least {LEAST}");
        let help = "give a later end with `--until`, or a smaller `--step` or `--every`";
        return Err(Message::option("--until", text).help(help).into());
    }
    frequencies::even(&samples.times).ok_or_else(|| {
        let text = "the rows of the run are at no equal distances";
        let help = "ask for some by `--rows T1:T2:COUNT`";
        Message::option("--of", text).help(help).into()
    })
}

/// A column that is not finite somewhere in the samples that are analysed has no lines.
fn check(samples: &Samples, count: usize) -> Result<(), Failure> {
    let wrong = samples.signals.iter().filter_map(|(name, values)| {
        let analysed = &values[..count];
        let place = analysed.iter().position(|value| !value.is_finite())?;
        let text = format!("`{name}` is not finite at t = {}", samples.times[place]);
        let help = "leave the column out, or give an end or rows where it is defined";
        Some(Message::option("--of", text).help(help))
    });
    let wrong: Vec<Message> = wrong.collect();
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(Failure::invalid(wrong)),
    }
}

/// Warnings for columns with a line within the resolution of the largest frequency that samples tell, pi over their distance: there its
/// amplitude and phase are those of the samples, and a faster line looks the same.
fn at_the_limit(
    (distance, count): (f64, usize),
    window: u8,
    found: &[(String, Frequencies)],
) -> Vec<Message> {
    let limit = PI / distance;
    let resolution = 2.0 * limit * f64::from(window + 1) / count as f64;
    let warning = |(name, found): &(String, Frequencies)| {
        let most = found.lines.first()?.amplitude;
        let at_limit =
            |line: &&Line| line.frequency > limit - resolution && line.amplitude > NOTICED * most;
        let line = found.lines.iter().find(at_limit)?;
        let text = format!(
            "`{name}` has a line at {}, where samples at distances of {distance} end to tell frequencies, at {}: its amplitude and phase mean nothing, and it may be a faster one",
            with_digits(line.frequency, resolution),
            with_digits(limit, resolution),
        );
        let mut message = Message::option("--of", text);
        message.warning = true;
        Some(message.help("take rows at smaller distances, with a smaller `--step` or `--every`"))
    };
    found.iter().filter_map(warning).collect()
}

/// What was found, for people.
fn text(title: &str, (distance, count): (f64, usize), found: &[(String, Frequencies)]) -> String {
    let mut text = format!("{title}: {count} samples at distances of {distance}\n");
    for (name, found) in found {
        let (mean, rest) = (found.mean, found.rest);
        text.push_str(&format!("\n{name}: mean {mean:.6e}, left {rest:.1e}\n"));
        if found.lines.is_empty() {
            text.push_str("  no line\n");
            continue;
        }
        let head = ["", "angular frequency", "amplitude", "phase", "drift"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let lines = found.lines.iter().enumerate();
        rows.extend(lines.map(|(number, line)| {
            vec![
                format!("  {}.", number + 1),
                with_digits(line.frequency, line.drift()),
                format!("{:.7e}", line.amplitude),
                format!("{:.6}", line.phase),
                format!("{:.1e}", line.drift()),
            ]
        }));
        text.push_str(&table::text(&rows));
    }
    text
}

/// The same for programs.
fn as_json(
    spec: &Spec,
    plan: &Plan,
    (samples, (distance, count)): (&Samples, (f64, usize)),
    found: &[(String, Frequencies)],
) -> Value {
    let line = |line: &Line| {
        json!({
            "frequency": number(line.frequency),
            "amplitude": number(line.amplitude),
            "phase": number(line.phase),
            "halves": [number(line.halves[0]), number(line.halves[1])],
            "drift": number(line.drift()),
        })
    };
    let signals = found.iter().map(|(name, found)| {
        let lines: Vec<Value> = found.lines.iter().map(line).collect();
        let value =
            json!({ "mean": number(found.mean), "rest": number(found.rest), "lines": lines });
        (name.clone(), value)
    });
    json!({
        "system": spec.model.name,
        "method": plan.method.label(),
        "step": number(samples.step),
        "samples": count,
        "distance": number(distance),
        "largest_frequency": number(PI / distance),
        "from": number(samples.times[0]),
        "signals": signals.collect::<Map<String, Value>>(),
    })
}
