//! `lie bench`: the error at the end of a run against the time that it takes.

use lie_codegen::diagnostic::Kind;
use lie_codegen::methods::Choice;
use lie_codegen::program::Purpose;
use lie_poisson::plot::frontier::{Curve, Frontier};

use super::quiet::{Quiet, percent, spread};
use super::table::{self, short};
use super::{Bed, Ended, bed, files, interrupted, list};
use crate::command::run::values::Given;
use crate::command::{args, print};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, SURROUNDINGS};

/// Accuracies of the table.
const TARGETS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];
/// The longest default span.
const SPAN: f64 = 20.0;

/// One measured run.
#[derive(Clone, Debug)]
pub struct Point {
    method: String,
    kind: String,
    value: f64,
    error: f64,
    /// The least time per unit of time, the median of the rounds, and what passed meanwhile.
    pub seconds: f64,
    /// See `seconds`.
    pub median: f64,
    /// See `seconds`.
    pub wall: f64,
    counts: [u64; 3],
}

impl Point {
    /// Reads the fields of a line.
    pub fn read(fields: &[&str]) -> Option<Self> {
        let number = |index: usize| fields.get(index)?.parse::<f64>().ok();
        let count = |index: usize| fields.get(index)?.parse::<u64>().ok();
        Some(Self {
            method: (*fields.get(1)?).to_owned(),
            kind: (*fields.get(2)?).to_owned(),
            value: number(3)?,
            error: number(4)?,
            seconds: number(5)?,
            median: number(6)?,
            wall: number(7)?,
            counts: [count(8)?, count(9)?, count(10)?],
        })
    }
}

/// Compares methods on a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Bench) -> Result<u8, Failure> {
    let flags = &arguments.measured;
    let budget = positive("--budget", arguments.budget.as_ref())?.unwrap_or(0.2);
    let bed = bed(flags, |spec| list::fewer(&spec.model))?;
    let until = until(arguments, &bed)?;
    let out = files::open("--out", arguments.out.as_deref(), &flags.spec)?;
    let plot = files::open("--plot", arguments.plot.as_deref(), &flags.spec)?;
    let interrupt = Interrupt::install();
    let program = bed.program(flags, Purpose::Bench, &interrupt)?;
    let (mut points, mut stopped, mut reference) = (Vec::new(), Vec::new(), [f64::NAN; 2]);
    let mut clock = String::new();
    let numbers = [("until", until), ("budget", budget)];
    let ended = bed.measure(
        flags,
        program,
        &numbers,
        &interrupt,
        &mut |fields| match fields {
            ["point", ..] => points.extend(Point::read(fields)),
            ["clock", name] => clock = (*name).to_owned(),
            ["stopped", label, kind, value, why] => {
                stopped.push(format!("{label}, {kind} {value}: {why}"));
            }
            ["reference", error, difference, ..] => {
                reference = [error, difference].map(|text| text.parse().unwrap_or(f64::NAN));
            }
            _ => {}
        },
    )?;
    if let Ended::Said(word, text) = &ended {
        files::write(out, None, None)?;
        files::write(plot, None, None)?;
        if word == "still" {
            let text = format!("nothing can be compared on {}: {text}", bed.spec.model.name);
            let message = Message::new(Kind::Domain, text).at_option("--initial");
            return Err(message
                .help("give an initial state that is no equilibrium with `--initial`")
                .into());
        }
        let text = format!("the reference solution is not confirmed: {text}");
        let message = Message::new(Kind::Domain, text).at_option("--until");
        return Err(Failure {
            messages: vec![message.help("take a shorter span with `--until`")],
            code: SURROUNDINGS,
        });
    }
    let picture = || picture(&bed, until, &points, reference);
    let wanted = !points.is_empty();
    files::write(out, arguments.out.as_deref(), wanted.then(|| csv(&points)))?;
    files::write(plot, arguments.plot.as_deref(), wanted.then(picture))?;
    let quiet = Quiet::of(&points, &clock);
    print(&report(&bed, until, &points, &stopped, reference, &quiet))?;
    if let (Some(warning), false) = (quiet.warning(), flags.quiet) {
        eprintln!("warning: {warning}");
    }
    if let Ended::Interrupted(code) = ended {
        return Ok(interrupted(flags, code));
    }
    Ok(0)
}

fn positive(flag: &'static str, text: Option<&String>) -> Result<Option<f64>, Failure> {
    let Some(text) = text else { return Ok(None) };
    let given = Given::flag(flag, text);
    let value = given.number()?;
    if value > 0.0 {
        return Ok(Some(value));
    }
    let message = given.wrong(format!("`{}` is not positive", text.trim()));
    Err(message.help("give a positive number").into())
}

/// The flag, else the spec's `run`, else 10.
fn until(arguments: &args::Bench, bed: &Bed) -> Result<f64, Failure> {
    if let Some(text) = &arguments.until {
        let given = Given::flag("--until", text);
        let value = given.number()?;
        if value == 0.0 {
            let message = given.wrong("there is nothing to integrate");
            return Err(message.help("give an end other than 0").into());
        }
        return Ok(value);
    }
    let run = bed.spec.model.run.iter();
    let of_spec = run
        .filter(|option| option.name.text == "until")
        .flat_map(|option| &option.values)
        .find_map(|(text, _)| crate::compiler::constant(text).ok());
    Ok(of_spec.map_or(10.0, |until: f64| until.clamp(-SPAN, SPAN)))
}

fn csv(points: &[Point]) -> String {
    let mut text =
        "method,control,value,error,seconds_per_unit_time,median_seconds_per_unit_time,wall_seconds_per_unit_time,steps,evaluations,newton\n"
            .to_owned();
    for point in points {
        let [steps, evaluations, newton] = point.counts;
        text.push_str(&format!(
            "{},{},{:?},{:?},{:?},{:?},{:?},{steps},{evaluations},{newton}\n",
            point.method,
            point.kind,
            point.value,
            point.error,
            point.seconds,
            point.median,
            point.wall
        ));
    }
    text
}

/// The points of each method, in the order of the catalogue.
fn by_method(points: &[Point]) -> Vec<(&str, Vec<&Point>)> {
    let mut all: Vec<(&str, Vec<&Point>)> = Vec::new();
    for point in points {
        match all.iter_mut().find(|(method, _)| *method == point.method) {
            Some((_, points)) => points.push(point),
            None => all.push((&point.method, vec![point])),
        }
    }
    all
}

/// The time to an error, between the points by their logarithms; of the fastest way there.
fn time_to(points: &[&Point], target: f64) -> Option<f64> {
    let reaching = points.iter().filter(|point| point.error <= target);
    let reached = reaching.map(|point| point.seconds).reduce(f64::min)?;
    let pairs = points.windows(2).filter_map(|pair| {
        let [a, b] = pair else { return None };
        if a.error <= target || b.error > target {
            return None;
        }
        let part = (target / a.error).ln() / (b.error.max(1e-17) / a.error).ln();
        Some((a.seconds.ln() + part * (b.seconds / a.seconds).ln()).exp())
    });
    Some(pairs.fold(reached, f64::min))
}

fn report(
    bed: &Bed,
    until: f64,
    points: &[Point],
    stopped: &[String],
    reference: [f64; 2],
    quiet: &Quiet,
) -> String {
    let spreads: Vec<(&str, f64)> = by_method(points)
        .into_iter()
        .map(|(method, points)| (method, spread(&points)))
        .collect();
    let mut rows: Vec<(Vec<Option<f64>>, f64, &str, String)> = by_method(points)
        .into_iter()
        .map(|(method, points)| {
            let times = TARGETS.iter().map(|&target| time_to(&points, target));
            let least = points.iter().map(|p| p.error).fold(f64::INFINITY, f64::min);
            let order = order_of(bed, method).map_or("–".to_owned(), |order| order.to_string());
            (times.collect(), least, method, order)
        })
        .collect();
    // by the time to 1e-6; methods that do not come there behind, by how far they come
    rows.sort_by(|a, b| {
        let key = |row: &(Vec<Option<f64>>, f64, &str, String)| row.0[1].unwrap_or(f64::INFINITY);
        key(a).total_cmp(&key(b)).then(a.1.total_cmp(&b.1))
    });
    let fastest: Vec<f64> = (0..TARGETS.len())
        .map(|k| {
            rows.iter()
                .filter_map(|row| row.0[k])
                .fold(f64::INFINITY, f64::min)
        })
        .collect();
    let mut cells = vec![vec!["method".to_owned(), "order".to_owned()]];
    cells[0].extend(TARGETS.iter().map(|target| format!("to {target:.0e}")));
    cells[0].extend(["least error", "spread"].map(str::to_owned));
    for (times, least, method, order) in &rows {
        let mut row = vec![(*method).to_owned(), order.clone()];
        for (time, fastest) in times.iter().zip(&fastest) {
            row.push(match time {
                Some(time) if time <= fastest => format!("{} *", micro(*time)),
                Some(time) => micro(*time),
                None => "–".to_owned(),
            });
        }
        row.push(short(*least));
        let found = spreads.iter().find(|(known, _)| known == method);
        row.push(percent(found.map_or(f64::NAN, |(_, spread)| *spread)));
        cells.push(row);
    }
    let mut text = format!(
        "{}, to t = {until}: microseconds per unit of time to a relative error at the end\n\
         reference: extrapolation, error about {}; differs from gauss6 by {}\n\n{}",
        bed.spec.model.name,
        short(reference[0]),
        short(reference[1]),
        table::text(&cells),
    );
    text.push_str(&format!("\n* the fastest\n{}\n", quiet.text()));
    if !stopped.is_empty() {
        text.push_str(&format!(
            "\n{} runs did not come to their end:\n",
            stopped.len()
        ));
        for line in stopped {
            text.push_str(&format!("  {line}\n"));
        }
    }
    text
}

fn micro(seconds: f64) -> String {
    let value = seconds * 1e6;
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 4) as usize;
    format!("{value:.digits$}")
}

fn order_of(bed: &Bed, label: &str) -> Option<u32> {
    let choice = bed.choices.iter().find(|choice| choice.label() == label)?;
    choice.entry().map(|method| method.order)
}

/// The name of a method without its order and options; the base of a composition belongs to it.
fn family(label: &str) -> String {
    let id = label.split(' ').next().unwrap_or(label);
    id.chars().filter(|c| !c.is_ascii_digit()).collect()
}

/// What a method keeps, in a few words; compositions keep what their base keeps.
fn class(choice: Option<&Choice>) -> String {
    let Some(method) = choice.and_then(|choice| choice.solved().entry()) else {
        return "controls".to_owned();
    };
    let kept = method.preserves;
    let words = match (kept.poisson, kept.orbit, kept.energy) {
        (true, _, true) => "Poisson and energy",
        (true, _, false) if method.explicit => "Poisson, explicit",
        (true, _, false) => "Poisson",
        (false, true, true) => "orbit and energy",
        (false, true, false) => "orbit",
        (false, false, true) => "energy, quadratic Casimirs",
        (false, false, false) if kept.quadratic_invariants => "quadratic invariants",
        _ => "controls",
    };
    words.to_owned()
}

fn picture(bed: &Bed, until: f64, points: &[Point], reference: [f64; 2]) -> String {
    let curves = by_method(points).into_iter().map(|(method, points)| {
        let choice = bed.choices.iter().find(|choice| choice.label() == method);
        let control = class(choice) == "controls";
        Curve {
            name: choice.map_or(method.to_owned(), Choice::title),
            class: class(choice),
            family: family(method),
            order: choice
                .and_then(Choice::entry)
                .map_or(if method.ends_with("853") { 8 } else { 5 }, |m| m.order),
            control,
            points: points.iter().map(|p| (p.seconds, p.error)).collect(),
        }
    });
    Frontier {
        title: format!("{}: error against run time", bed.spec.model.name),
        subtitle: format!(
            "relative error at t = {until} against run time per unit of time; bold: fastest in the panel at some error; band: \
             fastest of the catalogue"
        ),
        floor: reference[0].max(reference[1]),
        curves: curves.collect(),
    }
    .to_svg()
}
