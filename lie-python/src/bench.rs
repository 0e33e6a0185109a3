//! Errors of methods beside the times that they take.

use crate::talk::Measurement;
use lie_codegen::methods::Choice;
use lie_codegen::program::Purpose;
use lie_codegen::structure::Structure;
use lie_in_process::spec::Spec;
use lie_measure::bench::{ClockKind, Found, Measure, Options, Plane};
use lie_program::protocol::Start;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A run: method, "step" or "tolerance", its value; error, what is left of it across the orbit; seconds for a unit of time of
/// the system (least, median, on the wall); steps, evaluations, Newton iterations.
type Row = (
    String,
    &'static str,
    f64,
    f64,
    Option<f64>,
    f64,
    f64,
    f64,
    u64,
    u64,
    u64,
);
/// A run that did not come to its end: method, "step" or "tolerance", its value, why.
type Stopped = (String, &'static str, f64, String);

/// What was measured.
#[derive(Default, IntoPyObject)]
pub struct Results {
    until: f64,
    rows: Vec<Row>,
    stopped: Vec<Stopped>,
    /// The estimated error of the reference solution, and its distance from a second one.
    reference: Option<(f64, f64)>,
    /// Errors below it are not told from 0.
    floor: f64,
    /// The place of the coordinate of the surface of section, its value, how often it is passed.
    section: Option<(usize, f64, u64)>,
    /// Whether times are those of the processor.
    processor: bool,
    /// Whether Ctrl-C ended it.
    interrupted: bool,
}

impl Results {
    fn record(&mut self, found: Found) {
        match found {
            Found::Reference(found) => {
                self.reference = Some((found.error, found.difference));
                self.floor = found.floor;
            }
            Found::Section { plane, passages } => {
                self.section = Some((plane.coordinate, plane.value, passages));
            }
            Found::Clock(kind) => self.processor = kind == ClockKind::Processor,
            Found::Climbed { .. } => {}
            Found::Point(point) => self.row((
                point.method,
                point.control.word(),
                point.value,
                point.error,
                point.across,
                point.seconds,
                point.median,
                point.wall,
                point.steps,
                point.evaluations,
                point.newton,
            )),
            Found::Stopped {
                method,
                control,
                value,
                why,
            } => self.stopped.push((method, control.word(), value, why)),
        }
    }

    /// Takes the row of a run, or better times of one that is known.
    fn row(&mut self, row: Row) {
        let known = |known: &&mut Row| (&known.0, known.1, known.2) == (&row.0, row.1, row.2);
        match self.rows.iter_mut().find(known) {
            Some(known) => *known = row,
            None => self.rows.push(row),
        }
    }
}

/// What is asked for: seconds for a run, the sense of errors, the surface of section.
pub type ComparisonOptions = (f64, String, Option<(usize, f64)>);

/// Compares methods until a time.
pub struct Comparison {
    pub until: f64,
    pub options: ComparisonOptions,
}

impl Comparison {
    fn options(&self) -> PyResult<Options> {
        let (budget, measure, plane) = &self.options;
        let plane = plane.map(|(coordinate, value)| Plane { coordinate, value });
        let measure = match measure.as_str() {
            "state" => Measure::State,
            "energy" => Measure::Energy,
            "casimirs" => Measure::Casimirs,
            "phase" => Measure::Phase,
            "section" => Measure::Section(plane),
            other => return Err(PyValueError::new_err(format!("no measure `{other}`"))),
        };
        Ok(Options {
            until: self.until,
            budget: *budget,
            measure,
        })
    }
}

impl Measurement for Comparison {
    const PURPOSE: Purpose = Purpose::Bench;
    const COMMAND: &'static str = "lie bench";
    type Options = Options;
    type Found = Found;
    type Results = Results;
    type Output = Results;

    fn usual(model: &Structure) -> Vec<Choice> {
        lie_in_process::list::fewer(model)
    }

    fn begin(&self, spec: &Spec, _: &Start) -> PyResult<(Options, Results)> {
        let options = self.options()?;
        if options.measure == Measure::Energy
            && let Some(more) = spec.model.beside_hamiltonian()
        {
            let text = format!(
                "{more}, and the drift of its energy says nothing of a method: take measure=\"state\""
            );
            return Err(PyValueError::new_err(text));
        }
        let without = spec
            .model
            .casimirs
            .iter()
            .all(|casimir| casimir.multivalued || !casimir.kept);
        if options.measure == Measure::Casimirs && without {
            let text = "the system has no Casimir with one branch: declare one, or take measure=\"energy\"";
            return Err(PyValueError::new_err(text));
        }
        let results = Results {
            until: self.until,
            ..Results::default()
        };
        Ok((options, results))
    }

    fn record(results: &mut Results, found: Found) {
        results.record(found);
    }

    fn end(&self, results: Results, _: &Structure, _: &[String], whole: bool) -> Results {
        Results {
            interrupted: !whole,
            ..results
        }
    }
}
