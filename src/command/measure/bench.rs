//! `lie bench`: the error at the end of a run against the time that it takes.

mod picture;
mod table;

use lie_codegen::program::{Purpose, confirming};
use lie_in_process::request::{OptionValue, Request, span};
use lie_in_process::words::{counted, short};
use lie_in_process::{list, table::text as aligned};
use lie_measure::bench::{ClockKind, Found, Measure, Options, Plane, Point, Reference};
use lie_program::protocol::Obstacle;
use lie_syntax::diagnostic::Kind;

use self::table::{cells, lines, micro};
use super::quiet::Quiet;
use super::{Bed, Ended, bed, files, interrupted, sense};
use crate::command::files::Inputs;
use crate::command::fold::folded;
use crate::command::{args, print};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, SURROUNDINGS};
use crate::render;

/// What the program has found.
#[derive(Default)]
struct Results {
    points: Vec<Point>,
    /// Runs that did not come to their end, in words.
    stopped: Vec<String>,
    reference: Option<Reference>,
    /// The surface of section, and how often it is passed.
    section: Option<(Plane, u64)>,
    clock: ClockKind,
}

impl Results {
    /// Takes what is found; answers how a method did in its runs, before their times are measured again.
    fn record(&mut self, found: Found) -> Option<String> {
        match found {
            Found::Reference(reference) => self.reference = Some(reference),
            Found::Section { plane, passages } => self.section = Some((plane, passages)),
            Found::Clock(clock) => self.clock = clock,
            Found::Point(point) => match self.points.iter_mut().find(|p| point.is_again(p)) {
                Some(known) => *known = point,
                None => self.points.push(point),
            },
            Found::Climbed { method } => return Some(climbed(&method, &self.points)),
            Found::Stopped {
                method,
                control,
                value,
                why,
            } => {
                let control = control.word();
                self.stopped
                    .push(format!("{method}, {control} {value:?}: {why}"));
            }
        }
        None
    }
}

/// The errors of a method, and the time of the best run.
fn climbed(method: &str, points: &[Point]) -> String {
    let own: Vec<&Point> = points.iter().filter(|p| p.method == method).collect();
    let best = own.iter().min_by(|a, b| a.error.total_cmp(&b.error));
    match (own.iter().map(|p| p.error).reduce(f64::max), best) {
        (Some(largest), Some(best)) => format!(
            "{method}: {}, errors {} to {} in {} microseconds per unit of time",
            counted(own.len() as u64, "run"),
            short(largest),
            short(best.error),
            micro(best.seconds)
        ),
        _ => format!("{method}: no run came to its end"),
    }
}

/// Compares methods on a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Bench) -> Result<u8, Failure> {
    let flags = &arguments.measured;
    let budget = positive("--budget", arguments.budget.as_ref())?.unwrap_or(0.2);
    let bed = bed(flags, Purpose::Bench, |spec| list::fewer(&spec.model))?;
    let request = Request {
        until: arguments.until.clone(),
        ..Request::default()
    };
    let until = span(&bed.spec, &request)?;
    let measure = sense::measure(arguments, &bed)?;
    let inputs = Inputs::of_spec(&flags.spec, &bed.spec);
    let files = (arguments.out.as_deref(), arguments.plot.as_deref());
    let [out, plot] = files::open(files.0, files.1, &inputs)?;
    let interrupt = Interrupt::install();
    let program = bed.program(flags, Purpose::Bench, &interrupt)?;
    let mut results = Results::default();
    let options = Options {
        until,
        budget,
        measure,
    };
    let ended = bed.measure(flags, &program, options, &interrupt, &mut |found| {
        results.record(found)
    })?;
    if let Ended::Refused(what, why) = &ended {
        files::write(out, None, None)?;
        files::write(plot, None, None)?;
        return Err(refused(&bed.spec.model.name, *what, why));
    }
    let points = &results.points;
    let picture = || picture::draw(&bed, &options, points, results.reference);
    let wanted = !points.is_empty();
    let quiet = Quiet::new(points, results.clock);
    // a file that cannot be written does not take the table with it, nor the other way round
    let printed = print(&report(&bed, &options, &results, &quiet, program.engine()));
    let table = || csv(points, measure);
    let written = files::write(out, files.0, wanted.then(table));
    files::write(plot, files.1, wanted.then(picture))?;
    written.and(printed)?;
    if let (Some(warning), false) = (quiet.warning(), flags.quiet) {
        render::say(&format!("warning: {warning}"));
    }
    if let Ended::Interrupted(code) = ended {
        return Ok(interrupted(flags, code));
    }
    Ok(0)
}

/// Why nothing is compared.
fn refused(system: &str, what: Obstacle, why: &str) -> Failure {
    if what == Obstacle::Still {
        let text = format!("nothing can be compared on {system}: {why}");
        let message = Message::new(Kind::Domain, text).at_option("--initial");
        let help = "give an initial state with `--initial` that is not an equilibrium";
        return message.help(help).into();
    }
    if what == Obstacle::Section {
        let message = Message::new(Kind::Option, why).at_option("--section");
        let help = "give a coordinate and a value that it passes, such as the middle of its range, or a longer span with `--until`";
        return message.help(help).into();
    }
    let text = format!("the reference solution is not confirmed: {why}");
    let message = Message::new(Kind::Domain, text).at_option("--until");
    Failure {
        messages: vec![message.help("take a shorter span with `--until`")],
        code: SURROUNDINGS,
    }
}

fn positive(flag: &'static str, text: Option<&String>) -> Result<Option<f64>, Failure> {
    let Some(text) = text else { return Ok(None) };
    let given = OptionValue::flag(flag, text);
    let value = given.number()?;
    if value > 0.0 {
        return Ok(Some(value));
    }
    let message = given.wrong(format!("`{}` is not positive", text.trim()));
    Err(message.help("give a positive number").into())
}

fn csv(points: &[Point], measure: Measure) -> String {
    let mut text =
        "method,control,value,error,seconds_per_unit_time,median_seconds_per_unit_time,wall_seconds_per_unit_time,steps,evaluations,newton"
            .to_owned();
    text.push_str(match measure {
        Measure::Phase => ",across\n",
        _ => "\n",
    });
    for point in points {
        text.push_str(&format!(
            "{},{},{:?},{:?},{:?},{:?},{:?},{},{},{}",
            point.method,
            point.control.word(),
            point.value,
            point.error,
            point.seconds,
            point.median,
            point.wall,
            point.steps,
            point.evaluations,
            point.newton
        ));
        if let Some(across) = point.across {
            text.push_str(&format!(",{across:?}"));
        }
        text.push('\n');
    }
    text
}

/// What errors are taken against, in a line or two.
fn basis(bed: &Bed, results: &Results) -> String {
    let mut text = match results.reference {
        Some(Reference {
            error,
            difference,
            floor,
        }) => format!(
            "reference: extrapolation, error about {}; differs from {} by {}; errors below {} are not told from 0\n",
            short(error),
            confirming(&bed.spec.model).label(),
            short(difference),
            short(floor)
        ),
        None => "largest over all steps; for methods that show no steps, over at least 32 times\n"
            .to_owned(),
    };
    if let Some((Plane { coordinate, value }, passages)) = results.section {
        let name = sense::coordinate(bed, coordinate);
        let times = match passages {
            1 => "once".to_owned(),
            _ => format!("{passages} times"),
        };
        let compared = match passages {
            0..=32 => "",
            _ => ", of which the last 32 count",
        };
        text.push_str(&format!(
            "section: {name} rises through {value:.6}, {times}{compared}\n"
        ));
    }
    text
}

fn report(bed: &Bed, options: &Options, results: &Results, quiet: &Quiet, engine: &str) -> String {
    let Options { until, measure, .. } = *options;
    let head = format!(
        "{}, to t = {until}: microseconds per unit of time to {}\n{}",
        bed.spec.model.name,
        sense::head(measure),
        basis(bed, results),
    );
    let mut text = format!(
        "{}\n{}",
        folded(&head),
        aligned(&cells(
            &lines(bed, &results.points, results.reference),
            measure,
            results.reference
        )),
    );
    let times = quiet.text();
    let said = format!("\n* the fastest\n{times}\nmeasured: {engine}\n");
    text.push_str(&folded(&said));
    if !results.stopped.is_empty() {
        let runs = counted(results.stopped.len() as u64, "run");
        text.push_str(&format!("\n{runs} stopped early:\n"));
        for line in &results.stopped {
            text.push_str(&format!("  {line}\n"));
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use lie_measure::bench::Accuracy;

    pub(super) fn point(method: &str, value: f64, error: f64, seconds: f64) -> Point {
        Point {
            method: method.to_owned(),
            control: Accuracy::Step,
            value,
            error,
            across: None,
            seconds,
            median: seconds,
            wall: seconds,
            steps: 1,
            evaluations: 1,
            newton: 1,
        }
    }

    #[test]
    fn what_is_told_again_has_better_times() {
        let mut results = Results::default();
        for found in [
            point("rk4", 0.1, 1e-3, 3e-6),
            point("rk4", 0.05, 6e-5, 6e-6),
            point("midpoint", 0.1, 2e-3, 5e-6),
        ] {
            assert_eq!(results.record(Found::Point(found)), None);
        }
        let method = "rk4".to_owned();
        assert_eq!(
            results.record(Found::Climbed { method }).as_deref(),
            Some("rk4: 2 runs, errors 1.0e-3 to 6.0e-5 in 6.00 microseconds per unit of time")
        );
        assert_eq!(
            results.record(Found::Point(point("rk4", 0.1, 1e-3, 2e-6))),
            None
        );
        let times: Vec<f64> = results.points.iter().map(|p| p.seconds).collect();
        assert_eq!(times, [2e-6, 6e-6, 5e-6]);
        let method = "midpoint --none".to_owned();
        let line = results.record(Found::Climbed { method });
        assert_eq!(
            line.as_deref(),
            Some("midpoint --none: no run came to its end")
        );
    }
}
