//! `lie stress`: methods at the limits of steps, parameters and states, and through a long run.

use lie_codegen::diagnostic::Kind;
use lie_codegen::program::Purpose;
use lie_in_process::list;
use lie_measure::stress::{Cell, Experiment, Found, Growth, Moved, Options, Outcome};
use lie_poisson::plot::map::{self, Cell as Square, Column, Map};

use super::growth;
use super::table::{self, short};
use super::{Bed, Ended, bed, files, interrupted};
use crate::command::run::values::Given;
use crate::command::{args, print};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};

/// What is said of an experiment.
fn title(experiment: Experiment) -> &'static str {
    match experiment {
        Experiment::Step => "step over h0",
        Experiment::Parameter => "parameter times",
        Experiment::Scale => "state times",
        Experiment::Component => "component times",
        Experiment::Casimir => "Casimir times",
        Experiment::Long => "long run",
    }
}

/// The colour of a cell.
fn outcome(cell: &Cell) -> map::Outcome {
    let Moved { drift, growth } = cell.energy;
    // in a run that is short beside the system's own times, growth says nothing
    let long = cell.experiment != Experiment::Step || cell.value >= 0.5;
    match cell.outcome {
        Outcome::Lost => map::Outcome::Lost,
        Outcome::Stopped => map::Outcome::Stopped,
        Outcome::Domain => map::Outcome::Domain,
        Outcome::Kept if long && growth > 3.0 && drift > 1e-13 => {
            map::Outcome::Growing(drift.log10())
        }
        Outcome::Kept => map::Outcome::Drift(drift.log10()),
    }
}

/// What happened, in one line.
fn text(cell: &Cell) -> String {
    let experiment = cell.experiment.word();
    let (value, step) = (short(cell.value), short(cell.step));
    let place = format!("{}, {experiment} {} {value}", cell.method, cell.name);
    match cell.outcome {
        Outcome::Lost if cell.claimed <= 1.0 => {
            format!(
                "{place}, step {step}: {} after {} steps",
                cell.what, cell.steps
            )
        }
        Outcome::Lost => format!(
            "{place}, step {step}: {} beyond {} times its round-off bound after {} steps",
            cell.what,
            short(cell.claimed),
            cell.steps
        ),
        Outcome::Kept => format!(
            "{place}: energy {} (grows {}), Casimirs {} (grows {}), {} iterations of the solver",
            short(cell.energy.drift),
            short(cell.energy.growth),
            short(cell.casimirs.drift),
            short(cell.casimirs.growth),
            short(cell.newton)
        ),
        Outcome::Stopped | Outcome::Domain => format!("{place}, step {step}: {}", cell.what),
    }
}

/// What the program has found.
struct Results {
    cells: Vec<Cell>,
    growths: Vec<Growth>,
    step: f64,
}

impl Results {
    /// Takes what is found; answers the long run of a method, and what is lost.
    fn take(&mut self, found: Found) -> Option<String> {
        match found {
            Found::Ground { step } => self.step = step,
            Found::Growth(growth) => self.growths.push(growth),
            Found::Cell(cell) => {
                let line = match cell.outcome {
                    Outcome::Lost => Some(format!("lost: {}", text(&cell))),
                    _ if cell.experiment == Experiment::Long => Some(text(&cell)),
                    _ => None,
                };
                self.cells.push(cell);
                return line;
            }
        }
        None
    }

    fn of(&self, outcome: Outcome) -> Vec<&Cell> {
        let of_outcome = self.cells.iter().filter(|cell| cell.outcome == outcome);
        of_outcome.collect()
    }

    /// Says what is lost; whether anything is.
    fn loses(&self) -> bool {
        let lost = self.of(Outcome::Lost);
        for cell in &lost {
            eprintln!("lost: {}", text(cell));
        }
        let growths = self.growths.iter();
        let growing: Vec<&Growth> = growths.filter(|growth| growth::is_lost(growth)).collect();
        for growth in &growing {
            eprintln!("lost: {}", growth::text(growth));
        }
        !lost.is_empty() || !growing.is_empty()
    }
}

/// Stresses methods on a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Stress) -> Result<u8, Failure> {
    let flags = &arguments.measured;
    let help = "give the number of steps of the long run, such as 1000000";
    let steps = Given::flag("--steps", &arguments.steps).count();
    let steps = steps.map_err(|message| message.help(help))?;
    let bed = bed(flags, Purpose::Stress, |spec| list::fewer(&spec.model))?;
    let out = files::open("--out", arguments.out.as_deref(), &flags.spec)?;
    let plot = files::open("--plot", arguments.plot.as_deref(), &flags.spec)?;
    let interrupt = Interrupt::install();
    let program = bed.program(flags, Purpose::Stress, &interrupt)?;
    let mut results = Results {
        cells: Vec::new(),
        growths: Vec::new(),
        step: f64::NAN,
    };
    let options = Options { steps };
    let ended = bed.measure(flags, &program, options, &interrupt, &mut |found| {
        results.take(found)
    })?;
    if let Ended::Refused(_, why) = &ended {
        files::write(out, None, None)?;
        files::write(plot, None, None)?;
        let text = format!("nothing can be stressed on {}: {why}", bed.spec.model.name);
        let message = Message::new(Kind::Domain, text).at_option("--initial");
        return Err(message
            .help("give another initial state with `--initial`")
            .into());
    }
    sort(&mut results.cells, &bed);
    let wanted = !results.cells.is_empty();
    let table = || csv(&results);
    files::write(out, arguments.out.as_deref(), wanted.then(table))?;
    let picture = || picture(&bed, &results.cells, results.step);
    files::write(plot, arguments.plot.as_deref(), wanted.then(picture))?;
    print(&report(&bed, &results, steps))?;
    if let Ended::Interrupted(code) = ended {
        return Ok(interrupted(flags, code));
    }
    Ok(u8::from(results.loses()))
}

/// In the order of methods and experiments, whatever ended first.
fn sort(cells: &mut [Cell], bed: &Bed) {
    let labels: Vec<String> = bed.choices.iter().map(|choice| choice.label()).collect();
    let method = |cell: &Cell| labels.iter().position(|label| *label == cell.method);
    // names of parameters, components and Casimirs keep the order in which they were declared
    let model = &bed.spec.model;
    let layout = bed.layout();
    let parameters = model.parameters.iter().map(|p| &p.name);
    let names: Vec<&String> = parameters.chain(&layout.columns).collect();
    let name = |cell: &Cell| names.iter().position(|name| **name == cell.name);
    cells.sort_by(|a, b| {
        (method(a), a.experiment, name(a))
            .cmp(&(method(b), b.experiment, name(b)))
            .then(a.value.total_cmp(&b.value))
    });
}

fn csv(results: &Results) -> String {
    let mut text = "method,experiment,name,value,step,outcome,steps,newton_per_step,energy_drift,energy_growth,\
                    casimir_drift,casimir_growth,claimed_over_bound,what\n"
        .to_owned();
    for cell in &results.cells {
        text.push_str(&format!(
            "{},{},{},{:?},{:?},{},{},{:?},{:?},{:?},{:?},{:?},{:?},{}\n",
            cell.method,
            cell.experiment.word(),
            cell.name,
            cell.value,
            cell.step,
            cell.outcome.word(),
            cell.steps,
            cell.newton,
            cell.energy.drift,
            cell.energy.growth,
            cell.casimirs.drift,
            cell.casimirs.growth,
            cell.claimed,
            cell.what.replace(',', ";")
        ));
    }
    let growths = results.growths.iter().map(growth::csv);
    growths.for_each(|line| text.push_str(&line));
    text
}

fn methods(cells: &[Cell]) -> Vec<&str> {
    let mut methods: Vec<&str> = cells.iter().map(|cell| cell.method.as_str()).collect();
    methods.dedup();
    methods
}

const COLUMNS: [&str; 11] = [
    "method",
    "largest step",
    "parameters",
    "scales",
    "near singular",
    "long run: energy",
    "grows",
    "Casimirs",
    "grows",
    "Newton",
    "round-off",
];

/// The line of a method.
fn line(results: &Results, method: &str) -> Vec<String> {
    let of = |experiments: &[Experiment]| {
        let of_method = results.cells.iter().filter(|cell| cell.method == method);
        of_method
            .filter(|cell| experiments.contains(&cell.experiment))
            .collect::<Vec<_>>()
    };
    // the last before the first that was not kept
    let ladder = of(&[Experiment::Step]);
    let kept = ladder
        .iter()
        .take_while(|cell| cell.outcome == Outcome::Kept);
    let largest = kept.last().map_or("none".to_owned(), |cell| {
        format!("{} h0", short(cell.value))
    });
    let mut row = vec![
        method.to_owned(),
        largest,
        tally(&of(&[Experiment::Parameter])),
        tally(&of(&[Experiment::Scale])),
        tally(&of(&[Experiment::Component, Experiment::Casimir])),
    ];
    row.extend(long_run(of(&[Experiment::Long]).first().copied()));
    let growth = results
        .growths
        .iter()
        .find(|growth| growth.method == method);
    row.push(growth.map_or_else(|| "–".to_owned(), growth::cell));
    row
}

/// How many were kept of those that could be tried.
fn tally(cells: &[&Cell]) -> String {
    let count = |outcome| cells.iter().filter(|cell| cell.outcome == outcome).count();
    let (kept, lost) = (count(Outcome::Kept), count(Outcome::Lost));
    let mut text = format!("{kept} of {}", cells.len() - count(Outcome::Domain));
    if lost > 0 {
        text.push_str(&format!(", {lost} lost"));
    }
    text
}

fn long_run(cell: Option<&Cell>) -> [String; 5] {
    match cell {
        Some(cell) if matches!(cell.outcome, Outcome::Kept | Outcome::Lost) => [
            cell.energy.drift,
            cell.energy.growth,
            cell.casimirs.drift,
            cell.casimirs.growth,
            cell.newton,
        ]
        .map(short),
        Some(cell) => [&cell.what, "", "", "", ""].map(str::to_owned),
        None => Default::default(),
    }
}

fn report(bed: &Bed, results: &Results, steps: u64) -> String {
    let mut rows = vec![COLUMNS.map(str::to_owned).to_vec()];
    let methods = methods(&results.cells).into_iter();
    rows.extend(methods.map(|method| line(results, method)));
    let mut text = format!(
        "{}: {} experiments, h0 = {}, {steps} steps of the long run at h0\n\n{}\n\
         kept of tried: no claimed invariant beyond its round-off bound, no step refused; drifts relative to the size of the terms;\n\
         grows: the last tenth of the run over the first\n{}",
        bed.spec.model.name,
        results.cells.len(),
        short(results.step),
        table::text(&rows),
        growth::legend(&results.growths),
    );
    let model = &bed.spec.model;
    let independent = model.casimirs_to_find();
    if model.casimirs.len() < independent {
        text.push_str(&format!(
            "{} of {independent} Casimirs known: the others are not looked at, declare them in the spec\n",
            model.casimirs.len()
        ));
    }
    let stopped = results.of(Outcome::Stopped);
    if !stopped.is_empty() {
        text.push_str(&format!("\n{} stopped with a message:\n", stopped.len()));
        for cell in stopped {
            text.push_str(&format!("  {}\n", self::text(cell)));
        }
    }
    text
}

fn picture(bed: &Bed, cells: &[Cell], step: f64) -> String {
    let mut keys: Vec<(Experiment, &str, f64)> = Vec::new();
    for cell in cells {
        if !keys.contains(&key(cell)) {
            keys.push(key(cell));
        }
    }
    let rows = methods(cells).into_iter().map(|method| {
        let squares = keys.iter().map(|wanted| {
            let mut of_method = cells.iter().filter(|cell| cell.method == method);
            let cell = of_method.find(|cell| key(cell) == *wanted)?;
            Some(Square {
                outcome: outcome(cell),
                text: text(cell),
            })
        });
        let choice = bed.choices.iter().find(|choice| choice.label() == method);
        let title = choice.map_or(method.to_owned(), |choice| choice.title());
        (title, squares.collect())
    });
    Map {
        title: format!("{}: what methods do at their limits", bed.spec.model.name),
        subtitle: format!(
            "h0 = {}; 400 steps each; parameters multiplied, components and Casimirs made small, each by itself",
            short(step)
        ),
        columns: keys.iter().map(column).collect(),
        rows: rows.collect(),
    }
    .to_svg()
}

/// What tells the experiments of a method apart.
fn key(cell: &Cell) -> (Experiment, &str, f64) {
    (cell.experiment, &cell.name, cell.value)
}

fn column((experiment, name, value): &(Experiment, &str, f64)) -> Column {
    Column {
        group: match experiment {
            Experiment::Step | Experiment::Scale | Experiment::Long => {
                title(*experiment).to_owned()
            }
            Experiment::Parameter | Experiment::Component | Experiment::Casimir => {
                format!("{name} times")
            }
        },
        label: if *value == 0.0 || (1.0..1e4).contains(value) {
            value.to_string()
        } else {
            format!("{value:.0e}")
        },
    }
}
