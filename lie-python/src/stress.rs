//! Methods at the limits of steps, parameters and states, and through a long run.

use crate::talk::Measurement;
use lie_codegen::methods::Choice;
use lie_codegen::program::Purpose;
use lie_codegen::structure::Structure;
use lie_in_process::spec::Spec;
use lie_in_process::stress::Results;
use lie_measure::stress::{Cell, Found, Growth, Options};
use lie_program::protocol::Start;
use pyo3::prelude::*;

/// An experiment.
#[derive(IntoPyObject)]
struct Experiment {
    method: String,
    experiment: &'static str,
    name: String,
    value: f64,
    step: f64,
    outcome: &'static str,
    steps: u64,
    newton: f64,
    energy_drift: f64,
    energy_growth: f64,
    casimir_drift: f64,
    casimir_growth: f64,
    claimed: f64,
    what: String,
}

impl From<Cell> for Experiment {
    fn from(cell: Cell) -> Self {
        Self {
            experiment: cell.experiment.word(),
            outcome: cell.outcome.word(),
            method: cell.method,
            name: cell.name,
            value: cell.value,
            step: cell.step,
            steps: cell.steps,
            newton: cell.newton,
            energy_drift: cell.energy.drift,
            energy_growth: cell.energy.growth,
            casimir_drift: cell.casimirs.drift,
            casimir_growth: cell.casimirs.growth,
            claimed: cell.claimed,
            what: cell.what,
        }
    }
}

/// How round-off grows: method, invariant, exponent and its error, bias and its error; the error at the end, the largest; the
/// steps of the first and of the last point; states, step; the largest error over its bound.
type Grown = (
    String,
    String,
    [f64; 2],
    [f64; 2],
    [f64; 2],
    [u64; 2],
    usize,
    f64,
    f64,
);

fn grown(growth: Growth) -> Grown {
    (
        growth.method,
        growth.invariant,
        [growth.exponent, growth.error],
        [growth.bias, growth.bias_error],
        [growth.end, growth.largest],
        [growth.from, growth.to],
        growth.states,
        growth.step,
        growth.ratio,
    )
}

/// What was found.
#[derive(IntoPyObject)]
pub struct Limits {
    /// The step that experiments share.
    step: f64,
    cells: Vec<Experiment>,
    growths: Vec<Grown>,
    /// What is lost, in words.
    losses: Vec<String>,
    /// A line for each method, below a head.
    table: Vec<Vec<String>>,
    /// What its last columns say.
    legend: String,
    complete: bool,
}

/// Stresses methods, with so many steps of the long run.
pub struct Stress(pub u64);

impl Measurement for Stress {
    const PURPOSE: Purpose = Purpose::Stress;
    const COMMAND: &'static str = "lie stress";
    type Options = Options;
    type Found = Found;
    type Results = Results;
    type Output = Limits;

    fn usual(model: &Structure) -> Vec<Choice> {
        lie_in_process::list::fewer(model)
    }

    fn begin(&self, _: &Spec, _: &Start) -> PyResult<(Options, Results)> {
        Ok((Options { steps: self.0 }, Results::default()))
    }

    fn record(results: &mut Results, found: Found) {
        results.record(found);
    }

    fn end(
        &self,
        mut results: Results,
        model: &Structure,
        labels: &[String],
        whole: bool,
    ) -> Limits {
        let parameters = model.parameters.iter().map(|p| p.name.clone());
        let coordinates = model.coordinates.iter().map(|c| c.text.to_string());
        let casimirs = model.casimirs.iter().map(|c| c.name.to_string());
        let names: Vec<String> = parameters.chain(coordinates).chain(casimirs).collect();
        results.sort(labels, &names);
        Limits {
            step: results.step,
            losses: results.losses(),
            table: results.table(),
            legend: results.legend(),
            cells: results.cells.into_iter().map(Experiment::from).collect(),
            growths: results.growths.into_iter().map(grown).collect(),
            complete: whole,
        }
    }
}
