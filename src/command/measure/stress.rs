//! `lie stress`: methods at the limits of steps, parameters and states, and through a long run.

use lie_codegen::diagnostic::Kind;
use lie_codegen::program::Purpose;
use lie_poisson::plot::map::{Cell as Square, Column, Map, Outcome};

use super::growth::{self, Growth};
use super::table::{self, short};
use super::{Bed, Ended, bed, files, interrupted, list};
use crate::command::run::values::Given;
use crate::command::{args, print};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};

/// What is said of an experiment.
const EXPERIMENTS: [(&str, &str); 6] = [
    ("step", "step over h0"),
    ("parameter", "parameter times"),
    ("scale", "state times"),
    ("component", "component times"),
    ("casimir", "Casimir times"),
    ("long", "long run"),
];

/// One experiment with one method.
#[derive(Clone, Debug)]
struct Cell {
    method: String,
    experiment: String,
    name: String,
    value: f64,
    step: f64,
    word: String,
    steps: u64,
    newton: f64,
    energy: [f64; 2],
    casimirs: [f64; 2],
    claimed: f64,
    what: String,
}

impl Cell {
    fn read(fields: &[&str], parameters: &[String]) -> Option<Self> {
        let text = |index: usize| fields.get(index).map(|text| (*text).to_owned());
        let number = |index: usize| fields.get(index)?.parse::<f64>().ok();
        let mut name = text(3)?;
        if *fields.get(2)? == "parameter" {
            name = parameters.get(name.parse::<usize>().ok()?)?.clone();
        }
        Some(Self {
            method: text(1)?,
            experiment: text(2)?,
            name,
            value: number(4)?,
            step: number(5)?,
            word: text(6)?,
            steps: fields.get(7)?.parse().ok()?,
            newton: number(8)?,
            energy: [number(9)?, number(10)?],
            casimirs: [number(11)?, number(12)?],
            claimed: number(13)?,
            what: text(14)?,
        })
    }

    fn outcome(&self) -> Outcome {
        match self.word.as_str() {
            "lost" => Outcome::Lost,
            "stopped" => Outcome::Stopped,
            "domain" => Outcome::Domain,
            // in a run that is short beside the system's own times, growth says nothing
            _ if self.long() && self.energy[1] > 3.0 && self.energy[0] > 1e-13 => {
                Outcome::Growing(self.energy[0].log10())
            }
            _ => Outcome::Drift(self.energy[0].log10()),
        }
    }

    fn long(&self) -> bool {
        self.experiment != "step" || self.value >= 0.5
    }

    /// What happened, in one line.
    fn text(&self) -> String {
        let place = format!("{} {} {}", self.experiment, self.name, short(self.value));
        match self.word.as_str() {
            "lost" if self.claimed <= 1.0 => format!(
                "{}, {place}, step {}: {} after {} steps",
                self.method,
                short(self.step),
                self.what,
                self.steps
            ),
            "lost" => format!(
                "{}, {place}, step {}: {} beyond {} times its round-off bound after {} steps",
                self.method,
                short(self.step),
                self.what,
                short(self.claimed),
                self.steps
            ),
            "kept" => format!(
                "{}, {place}: energy {} (grows {}), Casimirs {} (grows {}), {} Newton iterations",
                self.method,
                short(self.energy[0]),
                short(self.energy[1]),
                short(self.casimirs[0]),
                short(self.casimirs[1]),
                short(self.newton)
            ),
            _ => format!(
                "{}, {place}, step {}: {}",
                self.method,
                short(self.step),
                self.what
            ),
        }
    }
}

/// Stresses methods on a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Stress) -> Result<u8, Failure> {
    let flags = &arguments.measured;
    let steps = Given::flag("--steps", &arguments.steps)
        .count()
        .map_err(|message| {
            message.help("give the number of steps of the long run, such as 1000000")
        })?;
    let bed = bed(flags, |spec| list::fewer(&spec.model))?;
    let out = files::open("--out", arguments.out.as_deref(), &flags.spec)?;
    let plot = files::open("--plot", arguments.plot.as_deref(), &flags.spec)?;
    let interrupt = Interrupt::install();
    let program = bed.program(flags, Purpose::Stress, &interrupt)?;
    let parameters: Vec<String> = bed
        .spec
        .model
        .parameters
        .iter()
        .map(|p| p.name.clone())
        .collect();
    let (mut cells, mut growths) = (Vec::new(), Vec::new());
    let mut step = f64::NAN;
    let ended = bed.measure(
        flags,
        program,
        &[("steps", steps as f64)],
        &interrupt,
        &mut |fields| match fields {
            ["cell", ..] => cells.extend(Cell::read(fields, &parameters)),
            ["growth", ..] => growths.extend(Growth::read(fields)),
            ["ground", text, ..] => step = text.parse().unwrap_or(f64::NAN),
            _ => {}
        },
    )?;
    if let Ended::Said(_, text) = &ended {
        files::write(out, None, None)?;
        files::write(plot, None, None)?;
        let text = format!("nothing can be stressed on {}: {text}", bed.spec.model.name);
        let message = Message::new(Kind::Domain, text).at_option("--initial");
        return Err(message
            .help("give another initial state with `--initial`")
            .into());
    }
    sort(&mut cells, &bed);
    let wanted = !cells.is_empty();
    files::write(
        out,
        arguments.out.as_deref(),
        wanted.then(|| csv(&cells, &growths)),
    )?;
    let picture = || picture(&bed, &cells, step);
    files::write(plot, arguments.plot.as_deref(), wanted.then(picture))?;
    print(&report(&bed, &cells, &growths, step, steps))?;
    if let Ended::Interrupted(code) = ended {
        return Ok(interrupted(flags, code));
    }
    let lost: Vec<&Cell> = cells.iter().filter(|cell| cell.word == "lost").collect();
    for cell in &lost {
        eprintln!("lost: {}", cell.text());
    }
    let growing: Vec<&Growth> = growths.iter().filter(|growth| growth.is_lost()).collect();
    for growth in &growing {
        eprintln!("lost: {}", growth.text());
    }
    Ok(u8::from(!lost.is_empty() || !growing.is_empty()))
}

/// In the order of methods and experiments, whatever ended first.
fn sort(cells: &mut [Cell], bed: &Bed) {
    let labels: Vec<String> = bed.choices.iter().map(|choice| choice.label()).collect();
    let method = |cell: &Cell| labels.iter().position(|label| *label == cell.method);
    let experiment = |cell: &Cell| {
        EXPERIMENTS
            .iter()
            .position(|(name, _)| *name == cell.experiment)
    };
    // names of parameters, components and Casimirs keep the order in which they were declared
    let model = &bed.spec.model;
    let names: Vec<&str> = model
        .parameters
        .iter()
        .map(|p| p.name.as_str())
        .chain(model.coordinates.iter().map(|c| c.text.as_str()))
        .chain(model.casimirs.iter().map(|c| c.name.as_str()))
        .collect();
    let name = |cell: &Cell| names.iter().position(|name| *name == cell.name);
    cells.sort_by(|a, b| {
        (method(a), experiment(a), name(a))
            .cmp(&(method(b), experiment(b), name(b)))
            .then(a.value.total_cmp(&b.value))
    });
}

fn csv(cells: &[Cell], growths: &[Growth]) -> String {
    let mut text = "method,experiment,name,value,step,outcome,steps,newton_per_step,energy_drift,energy_growth,\
                    casimir_drift,casimir_growth,claimed_over_bound,what\n"
        .to_owned();
    for cell in cells {
        text.push_str(&format!(
            "{},{},{},{:?},{:?},{},{},{:?},{:?},{:?},{:?},{:?},{:?},{}\n",
            cell.method,
            cell.experiment,
            cell.name,
            cell.value,
            cell.step,
            cell.word,
            cell.steps,
            cell.newton,
            cell.energy[0],
            cell.energy[1],
            cell.casimirs[0],
            cell.casimirs[1],
            cell.claimed,
            cell.what.replace(',', ";")
        ));
    }
    growths
        .iter()
        .for_each(|growth| text.push_str(&growth.csv()));
    text
}

fn methods(cells: &[Cell]) -> Vec<&str> {
    let mut methods: Vec<&str> = cells.iter().map(|cell| cell.method.as_str()).collect();
    methods.dedup();
    methods
}

fn report(bed: &Bed, cells: &[Cell], growths: &[Growth], step: f64, steps: u64) -> String {
    let mut rows = vec![
        [
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
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    for method in methods(cells) {
        let of = |experiments: &[&str]| {
            let of_method = cells.iter().filter(|cell| cell.method == method);
            of_method
                .filter(|cell| experiments.contains(&cell.experiment.as_str()))
                .collect::<Vec<_>>()
        };
        // the last before the first that was not kept
        let ladder = of(&["step"]);
        let largest = ladder
            .iter()
            .take_while(|cell| cell.word == "kept")
            .last()
            .map_or("none".to_owned(), |cell| {
                format!("{} h0", short(cell.value))
            });
        let tally = |cells: &[&Cell]| {
            let within: Vec<_> = cells.iter().filter(|cell| cell.word != "domain").collect();
            let kept = within.iter().filter(|cell| cell.word == "kept").count();
            let lost = within.iter().filter(|cell| cell.word == "lost").count();
            let mut text = format!("{kept} of {}", within.len());
            if lost > 0 {
                text.push_str(&format!(", {lost} lost"));
            }
            text
        };
        let mut row = vec![
            method.to_owned(),
            largest,
            tally(&of(&["parameter"])),
            tally(&of(&["scale"])),
            tally(&of(&["component", "casimir"])),
        ];
        match of(&["long"]).first() {
            Some(cell) if cell.word == "kept" || cell.word == "lost" => row.extend([
                short(cell.energy[0]),
                short(cell.energy[1]),
                short(cell.casimirs[0]),
                short(cell.casimirs[1]),
                short(cell.newton),
            ]),
            Some(cell) => {
                row.push(cell.what.clone());
                row.extend(std::iter::repeat_n(String::new(), 4));
            }
            None => row.extend(std::iter::repeat_n(String::new(), 5)),
        }
        let growth = growths.iter().find(|growth| growth.method == method);
        row.push(growth.map_or_else(|| "–".to_owned(), Growth::cell));
        rows.push(row);
    }
    let mut text = format!(
        "{}: {} experiments, h0 = {}, {steps} steps of the long run at h0\n\n{}\n\
         kept of tried: no claimed invariant beyond its round-off bound, no step refused; drifts relative to the size of the terms;\n\
         grows: the last tenth of the run over the first\n{}",
        bed.spec.model.name,
        cells.len(),
        short(step),
        table::text(&rows),
        growth::legend(growths),
    );
    let model = &bed.spec.model;
    let independent = model.casimirs_to_find();
    if model.casimirs.len() < independent {
        text.push_str(&format!(
            "{} of {independent} Casimirs declared: the others are not looked at, declare them in the spec\n",
            model.casimirs.len()
        ));
    }
    let stopped: Vec<&Cell> = cells.iter().filter(|cell| cell.word == "stopped").collect();
    if !stopped.is_empty() {
        text.push_str(&format!("\n{} stopped with a message:\n", stopped.len()));
        for cell in stopped {
            text.push_str(&format!("  {}\n", cell.text()));
        }
    }
    text
}

fn picture(bed: &Bed, cells: &[Cell], step: f64) -> String {
    let mut keys: Vec<(&str, &str, f64)> = Vec::new();
    for cell in cells {
        let key = (cell.experiment.as_str(), cell.name.as_str(), cell.value);
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let columns = keys.iter().map(|(experiment, name, value)| {
        let title = EXPERIMENTS.iter().find(|(known, _)| known == experiment);
        let title = title.map_or(*experiment, |(_, title)| *title);
        let group = match *experiment {
            "step" | "scale" | "long" => title.to_owned(),
            _ => format!("{name} times"),
        };
        Column {
            group,
            label: if *value == 0.0 || (1.0..1e4).contains(value) {
                value.to_string()
            } else {
                format!("{value:.0e}")
            },
        }
    });
    let rows = methods(cells).into_iter().map(|method| {
        let squares = keys.iter().map(|key| {
            let cell = cells.iter().find(|cell| {
                cell.method == method
                    && (cell.experiment.as_str(), cell.name.as_str(), cell.value) == *key
            })?;
            Some(Square {
                outcome: cell.outcome(),
                text: cell.text(),
            })
        });
        let title = bed.choices.iter().find(|choice| choice.label() == method);
        (
            title.map_or(method.to_owned(), |choice| choice.title()),
            squares.collect(),
        )
    });
    Map {
        title: format!("{}: what methods do at their limits", bed.spec.model.name),
        subtitle: format!(
            "h0 = {}; 400 steps each; parameters multiplied, components and Casimirs made small, each by itself",
            short(step)
        ),
        columns: columns.collect(),
        rows: rows.collect(),
    }
    .to_svg()
}
