//! What methods did at their limits, in words.

use lie_measure::stress::{Cell, Experiment, Found, Growth, Outcome};

use crate::words::short;

/// What was found so far.
pub struct Results {
    /// The experiments.
    pub cells: Vec<Cell>,
    /// How round-off grows.
    pub growths: Vec<Growth>,
    /// The step h0 that all experiments share; not a number before it is known.
    pub step: f64,
}

impl Default for Results {
    fn default() -> Self {
        Self {
            cells: Vec::new(),
            growths: Vec::new(),
            step: f64::NAN,
        }
    }
}

impl Results {
    /// Takes what was found; answers the long run of a method, and what is lost.
    pub fn record(&mut self, found: Found) -> Option<String> {
        match found {
            Found::Ground { step } => self.step = step,
            Found::Growth(growth) => self.growths.push(growth),
            Found::Cell(cell) => {
                let line = match cell.outcome {
                    Outcome::Lost => Some(format!("lost: {}", cell_text(&cell))),
                    _ if cell.experiment == Experiment::Long => Some(cell_text(&cell)),
                    _ => None,
                };
                self.cells.push(cell);
                return line;
            }
        }
        None
    }

    /// The experiments that came to this.
    pub fn with_outcome(&self, outcome: Outcome) -> Vec<&Cell> {
        let of_outcome = self.cells.iter().filter(|cell| cell.outcome == outcome);
        of_outcome.collect()
    }

    /// What is lost, in words.
    pub fn losses(&self) -> Vec<String> {
        let lost = self.with_outcome(Outcome::Lost).into_iter().map(cell_text);
        let growing = self.growths.iter().filter(|growth| is_lost(growth));
        lost.chain(growing.map(growth_text)).collect()
    }

    /// Puts all into the order of methods, experiments, and names of parameters, components and Casimirs, whatever ended
    /// first; names that are not among these come in the order of their letters.
    pub fn sort(&mut self, labels: &[String], names: &[String]) {
        let method = |method: &String| labels.iter().position(|label| label == method);
        let name = |cell: &Cell| names.iter().position(|name| *name == cell.name);
        self.cells.sort_by(|a, b| {
            (method(&a.method), a.experiment, name(a), &a.name)
                .cmp(&(method(&b.method), b.experiment, name(b), &b.name))
                .then(a.value.total_cmp(&b.value))
        });
        let place = |growth: &Growth| method(&growth.method);
        self.growths
            .sort_by(|a, b| (place(a).cmp(&place(b))).then(a.step.total_cmp(&b.step)));
    }

    /// A line for each method below a head.
    pub fn table(&self) -> Vec<Vec<String>> {
        let mut rows = vec![COLUMNS.map(str::to_owned).to_vec()];
        let methods = methods(&self.cells).into_iter();
        rows.extend(methods.map(|method| self.line(method)));
        rows
    }

    /// The line of a method.
    fn line(&self, method: &str) -> Vec<String> {
        let of = |experiments: &[Experiment]| {
            let of_method = self.cells.iter().filter(|cell| cell.method == method);
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
        // h0 itself, and the largest step that goes
        for large in [false, true] {
            let mut of_method = self.growths.iter().filter(|growth| growth.method == method);
            let growth = of_method.find(|growth| (growth.step > self.step) == large);
            let [mut exponent, bias] =
                growth.map_or(["–".to_owned(), "–".to_owned()], growth_cells);
            if let Some(growth) = growth.filter(|_| large) {
                let factor = growth.step / self.step;
                exponent = format!("{} h0: {exponent}", short(factor));
            }
            row.extend([exponent, bias]);
        }
        row
    }

    /// What the column on round-off says.
    pub fn legend(&self) -> String {
        let Some(growth) = self.growths.iter().max_by_key(|growth| growth.states) else {
            return String::new();
        };
        format!(
            "round-off: the claimed invariant that moves most, root of the mean square over {} states near the initial one against \
             the steps N, {} to {}; 0.5 is a random walk, 1 a bias\n\
             bias: the mean of that error per step, with its standard error over the states\n",
            growth.states, growth.from, growth.to
        )
    }
}

const COLUMNS: [&str; 14] = [
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
    "bias",
    "at larger steps",
    "bias",
];

/// The methods of experiments that are in order.
pub fn methods(cells: &[Cell]) -> Vec<&str> {
    let mut methods: Vec<&str> = cells.iter().map(|cell| cell.method.as_str()).collect();
    methods.dedup();
    methods
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

/// What happened in an experiment, in one line.
pub fn cell_text(cell: &Cell) -> String {
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
            "{place}, step {step}: {} up to {} times the round-off bound after {} steps",
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

/// Whether some state moved further than round-off does.
pub fn is_lost(growth: &Growth) -> bool {
    !matches!(growth.ratio, ratio if ratio <= 1.0)
}

/// As `length2 N^0.95 ± 0.03` and `+4.7e-18 ± 2.0e-19`.
fn growth_cells(growth: &Growth) -> [String; 2] {
    [
        format!(
            "{} N^{:.2} ± {:.2}",
            growth.invariant, growth.exponent, growth.error
        ),
        format!("{:+.1e} ± {:.1e}", growth.bias, growth.bias_error),
    ]
}

/// How round-off grew, in one line.
fn growth_text(growth: &Growth) -> String {
    format!(
        "{}, {} states near the initial one, step {}: {} up to {} times its round-off bound after {} steps",
        growth.method,
        growth.states,
        short(growth.step),
        growth.invariant,
        short(growth.ratio),
        growth.to
    )
}
