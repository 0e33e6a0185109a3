//! One trajectory.

use crate::arguments;
use crate::declaration::Declaration;
use crate::errors::of_system;
use crate::progress::Progress;
use crate::talk::{Outcome, converse};
use lie_codegen::program::Chart;
use lie_in_process::memory;
use lie_in_process::report::signs;
use lie_in_process::request::{Plan, Request};
use lie_program::protocol::{Columns, End, Found, Obstacle, Run, Stop, Times};
use lie_runtime::driver::Pace;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::io;

/// A run, as Python takes it.
pub type Rows<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
);

/// What is heard of a run.
#[derive(Default)]
struct Heard {
    /// How many rows there will be, once the step is known.
    rows: Option<f64>,
    columns: Columns,
    times: Vec<f64>,
    states: Vec<f64>,
    energies: Vec<f64>,
    casimirs: Vec<f64>,
    elements: Vec<f64>,
    /// The step that was chosen, and the one that it was shortened to on the way.
    step: Option<f64>,
    smallest: Option<f64>,
    /// The error at the end, where it was asked for, and whether it is much larger than the tolerance; not a number where it
    /// cannot be told.
    assessed: Option<(f64, bool)>,
    /// From when on the tolerance is not kept.
    lost: Option<f64>,
    steps: u64,
}

impl Heard {
    /// Takes what is found.
    ///
    /// # Errors
    /// There is no memory for it.
    fn record(&mut self, found: Found, plan: &Plan) -> io::Result<()> {
        match found {
            Found::Chosen(chosen) => {
                self.step = Some(chosen.step);
                self.rows = Some(memory::rows(&plan.times, plan.from, chosen.step));
            }
            Found::Lost { time } => self.lost = Some(time),
            Found::Assessed { error, missed } => self.assessed = Some((error, missed)),
            Found::Columns(columns) => {
                self.columns = columns;
                self.reserve(self.rows.unwrap_or(0.0))?;
            }
            Found::Rows(rows) => {
                self.reserve(rows.count as f64)?;
                let rows = rows.numbers.chunks_exact(rows.width);
                rows.for_each(|row| self.row(row));
            }
            Found::Work(work) => self.steps = work.steps,
            Found::Shortened { step, .. } => self.smallest = Some(step),
            Found::Between(_) | Found::Milestone(_) => {}
        }
        Ok(())
    }

    /// Makes room for so many more rows.
    fn reserve(&mut self, rows: f64) -> io::Result<()> {
        let columns = &self.columns;
        if rows <= (self.times.capacity() - self.times.len()) as f64 {
            return Ok(());
        }
        memory::fits(rows * columns.width() as f64 * memory::NUMBER)?;
        for (numbers, width) in [
            (&mut self.times, 1),
            (&mut self.states, columns.coordinates.len()),
            (&mut self.energies, 1),
            (&mut self.casimirs, columns.casimirs.len()),
            (&mut self.elements, columns.element),
        ] {
            memory::reserve(numbers, (rows as usize).saturating_mul(width))?;
        }
        Ok(())
    }

    fn row(&mut self, row: &[f64]) {
        let columns = &self.columns;
        let (state, energy) = (columns.coordinates(), columns.energy());
        let (casimirs, element) = (columns.casimirs(), columns.element());
        self.times.push(row[0]);
        self.states.extend_from_slice(&row[state..energy]);
        self.energies.push(row[energy]);
        self.casimirs.extend_from_slice(&row[casimirs..element]);
        self.elements.extend_from_slice(&row[element..]);
    }
}

/// How a run ended.
enum Ended {
    Done,
    Stopped(Stop),
}

/// Makes a run.
fn make(
    py: Python<'_>,
    declaration: &Declaration,
    (plan, run): (&Plan, Run),
    progress: Option<Py<PyAny>>,
) -> PyResult<(Heard, Ended)> {
    let work = declaration.work(py, &plan.method, plan.chart)?;
    let (dimension, casimirs) = (run.start.initial.len(), declaration.facts.casimirs.len());
    let mut heard = Heard::default();
    if let Pace::Step(step) = plan.pace.0 {
        let rows = memory::rows(&plan.times, plan.from, step);
        let width = dimension + casimirs + 2;
        memory::fits(rows * width as f64 * memory::NUMBER)
            .map_err(|exceeded| of_system(exceeded.into()))?;
        heard.rows = Some(rows);
    }
    let progress = Progress::new("steps", progress);
    let take = |found| heard.record(found, plan);
    let outcome = py.detach(|| converse(&work, run, progress, take))?;
    let Outcome { end, interrupted } = outcome;
    if let Some(error) = interrupted {
        return Err(error);
    }
    match end {
        Some(End::Done) => Ok((heard, Ended::Done)),
        Some(End::Stopped(stop)) => Ok((heard, Ended::Stopped(stop))),
        Some(End::Parameter { why, .. }) => Err(PyValueError::new_err(why)),
        Some(End::Refused {
            what: Obstacle::Option,
            why,
        }) => Err(PyValueError::new_err(why)),
        other => {
            let text = format!("the run ended early: {other:?}");
            Err(PyRuntimeError::new_err(text))
        }
    }
}

/// The states of a run at times in its order, which is made again up to there: with a step until the last of them, with a
/// tolerance, from whose span the step is chosen, until its end. Fewer where it stops early.
pub fn at<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    request: &Request,
    times: Vec<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (mut plan, mut run) = arguments::checked(py, declaration, request, arguments::run)?;
    plan.times = match plan.pace.0 {
        Pace::Tolerance(_) => Times::Within {
            end: plan.end(),
            times,
        },
        Pace::Step(_) => Times::At(times),
    };
    run.times = plan.times.clone();
    let dimension = run.start.initial.len();
    let (heard, _) = make(py, declaration, (&plan, run), None)?;
    let rows = heard.times.len();
    heard.states.into_pyarray(py).reshape([rows, dimension])
}

/// Times, states, energies and Casimirs; the method and its step; what ended it early.
pub fn run<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    request: &Request,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Rows<'py>, Bound<'py, PyDict>)> {
    let (plan, run) = arguments::checked(py, declaration, request, arguments::run)?;
    let note = declaration.with_model(py, |model| signs::note(model, std::iter::once(&run.start)));
    let (dimension, casimirs) = (run.start.initial.len(), declaration.facts.casimirs.len());
    let (mut heard, ended) = make(py, declaration, (&plan, run), progress)?;
    let found = PyDict::new(py);
    let mut end = plan.end();
    if let Ended::Stopped(stop) = ended {
        heard.steps = stop.step - 1;
        end = stop.time;
        found.set_item("step_number", stop.step)?;
        found.set_item("time", stop.time)?;
        found.set_item("why", stop.reason)?;
        found.set_item("remedy", stop.remedy)?;
    }
    found.set_item("span", (plan.from, end))?;
    let (Pace::Step(given) | Pace::Tolerance(given)) = plan.pace.0;
    found.set_item("method", plan.method.label())?;
    found.set_item("step", heard.smallest.or(heard.step).unwrap_or(given))?;
    found.set_item("steps", heard.steps)?;
    found.set_item("note", note)?;
    if let Some((error, missed)) = heard.assessed {
        found.set_item("error", error)?;
        found.set_item("missed", missed)?;
        found.set_item("tolerance", given)?;
    }
    if let Some(time) = heard.lost {
        found.set_item("lost", time)?;
    }
    if let Some(chart) = plan.chart {
        found.set_item("quaternion", chart == Chart::Quaternion)?;
        found.set_item("group", heard.elements.into_pyarray(py))?;
    }
    let rows = heard.times.len();
    let arrays = (
        heard.times.into_pyarray(py),
        heard.states.into_pyarray(py).reshape([rows, dimension])?,
        heard.energies.into_pyarray(py),
        heard.casimirs.into_pyarray(py).reshape([rows, casimirs])?,
    );
    Ok((arrays, found))
}
