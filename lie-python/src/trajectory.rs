//! One trajectory.

use crate::arguments;
use crate::declaration::{Declaration, lock};
use crate::errors::of_system;
use crate::kept::Prepared;
use crate::progress::Progress;
use crate::talk::{Outcome, Who, converse};
use lie_codegen::program::Chart;
use lie_in_process::memory;
use lie_in_process::report::signs;
use lie_in_process::request::{Plan, Request};
use lie_program::protocol::{Columns, End, Event, Found, Obstacle, Run, Stop, Times};
use lie_runtime::driver::{Density, Pace};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};
use std::io;
use std::sync::Arc;
use std::time::Instant;

/// A run, as Python takes it: times, states, energies and Casimirs; the method, its step and how many there were; the span; and
/// what is not of every run.
pub type Made<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Py<PyString>,
    f64,
    u64,
    (f64, f64),
    Option<Bound<'py, PyDict>>,
);

/// A step of more iterations may be long, whatever those before took.
const ITERATIONS: u32 = 500;

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
    quantities: Vec<f64>,
    elements: Vec<f64>,
    events: Vec<Event>,
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
                if plan.density == Density::Constant {
                    self.rows = Some(memory::rows(&plan.times, plan.from, chosen.step));
                }
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
            Found::Event(event) => self.events.push(event),
            Found::Work(work) => self.steps = work.steps,
            Found::Shortened { step, .. } => self.smallest = Some(step),
            Found::Between(_) | Found::Milestone(_) | Found::Uneven { .. } => {}
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
            (&mut self.quantities, columns.quantities.len()),
            (&mut self.elements, columns.element),
        ] {
            memory::reserve(numbers, (rows as usize).saturating_mul(width))?;
        }
        Ok(())
    }

    fn row(&mut self, row: &[f64]) {
        let columns = &self.columns;
        let (state, energy) = (columns.coordinates(), columns.energy());
        let (casimirs, quantities) = (columns.casimirs(), columns.quantities());
        let element = columns.element();
        self.times.push(row[0]);
        self.states.extend_from_slice(&row[state..energy]);
        self.energies.push(row[energy]);
        self.casimirs.extend_from_slice(&row[casimirs..quantities]);
        self.quantities.extend_from_slice(&row[quantities..element]);
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
    (prepared, run): (&Prepared, Run),
    progress: Option<Py<PyAny>>,
) -> PyResult<(Heard, Ended)> {
    let Prepared { plan, compiled, .. } = prepared;
    let facts = &declaration.facts;
    let (dimension, beside) = (
        run.start.initial.len(),
        facts.casimirs.len() + facts.quantities.len(),
    );
    let mut heard = Heard::default();
    if let (Pace::Step(step), Density::Constant) = (plan.pace.0, plan.density) {
        let rows = memory::rows(&plan.times, plan.from, step);
        let width = dimension + beside + 2;
        memory::fits(rows * width as f64 * memory::NUMBER)
            .map_err(|exceeded| of_system(exceeded.into()))?;
        heard.rows = Some(rows);
    }
    let progress = Progress::new("steps", progress);
    let begun = Instant::now();
    let take = |found| heard.record(found, plan);
    let who = match plan.newton.max_iterations <= ITERATIONS {
        true => compiled.who(),
        false => Who::Apart,
    };
    let asked = (&compiled.work, who);
    let outcome = py.detach(|| converse(asked, run, progress, take))?;
    // a step over many sites may be longer than one over few
    if !declaration.facts.family {
        compiled.took(begun.elapsed());
    }
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

/// What a request comes to.
fn prepare(
    py: Python<'_>,
    declaration: &Declaration,
    request: &Request,
) -> PyResult<(Prepared, Run)> {
    let (plan, run) = arguments::checked(py, declaration, request, arguments::run)?;
    let prepared = Prepared {
        compiled: declaration.work(py, &plan.method, plan.chart)?,
        label: PyString::new(py, &plan.method.label()).unbind(),
        plan,
    };
    Ok((prepared, run))
}

/// The states of a run at times in its order, which is made again up to there: with a step until the last of them, with a
/// tolerance, from whose span the step is chosen, until its end. Fewer where it stops early.
pub fn at<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    request: &Request,
    times: Vec<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (mut prepared, mut run) = prepare(py, declaration, request)?;
    prepared.plan.times = match prepared.plan.pace.0 {
        Pace::Tolerance(_) => Times::Within {
            end: prepared.plan.end(),
            times,
        },
        Pace::Step(_) => Times::At(times),
    };
    run.times = prepared.plan.times.clone();
    let dimension = run.start.initial.len();
    let (heard, _) = make(py, declaration, (&prepared, run), None)?;
    let rows = heard.times.len();
    let width = heard.states.len().checked_div(rows).unwrap_or(dimension);
    Ok(by_rows(py, heard.states, (rows, width)))
}

/// A run of a request, and what is kept of it for a call with the same options.
pub fn run<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    (request, options): (&Request, &Bound<'py, PyTuple>),
    progress: Option<Py<PyAny>>,
) -> PyResult<Made<'py>> {
    let (prepared, run) = prepare(py, declaration, request)?;
    let prepared = Arc::new(prepared);
    let made = of_prepared(py, declaration, (&prepared, run), progress)?;
    // the start of a family is not only a list of numbers
    if !declaration.facts.family {
        lock(&declaration.kept).keep(options, prepared);
    }
    Ok(made)
}

/// A run whose options were checked.
pub fn of_prepared<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    (prepared, run): (&Prepared, Run),
    progress: Option<Py<PyAny>>,
) -> PyResult<Made<'py>> {
    let plan = &prepared.plan;
    let note = declaration.with_model(py, |model| signs::note(model, std::iter::once(&run.start)));
    let (dimension, casimirs) = (run.start.initial.len(), declaration.facts.casimirs.len());
    let (mut heard, ended) = make(py, declaration, (prepared, run), progress)?;
    let more = PyDict::new(py);
    let mut end = plan.end();
    if let Ended::Stopped(stop) = ended {
        heard.steps = stop.step - 1;
        end = stop.time;
        more.set_item("step_number", stop.step)?;
        more.set_item("time", stop.time)?;
        more.set_item("why", stop.reason)?;
        more.set_item("remedy", stop.remedy)?;
    }
    let (Pace::Step(given) | Pace::Tolerance(given)) = plan.pace.0;
    if let Some(note) = note {
        more.set_item("note", note)?;
    }
    if let Some((error, missed)) = heard.assessed {
        more.set_item("error", error)?;
        more.set_item("missed", missed)?;
        more.set_item("tolerance", given)?;
    }
    if let Some(time) = heard.lost {
        more.set_item("lost", time)?;
    }
    if plan.density == Density::Reversible {
        more.set_item("density", "reversible")?;
    }
    if declaration.facts.noisy {
        more.set_item("seed", plan.held.seed)?;
    }
    if let Some(chart) = plan.chart {
        more.set_item("matrix", chart == Chart::Matrix)?;
        more.set_item("group", heard.elements.into_pyarray(py))?;
    }
    if let Some(last) = heard.events.last().filter(|event| event.stops) {
        end = last.time;
        more.set_item("stopped", &last.name)?;
    }
    if !declaration.facts.events.is_empty() {
        more.set_item("events", events(py, declaration, &heard.events, dimension)?)?;
    }
    let rows = heard.times.len();
    // rows of a family have its sites, without what is carried beside them
    let width = heard.states.len().checked_div(rows).unwrap_or(dimension);
    let quantities = declaration.facts.quantities.len();
    if quantities > 0 {
        more.set_item(
            "quantities",
            by_rows(py, heard.quantities, (rows, quantities)),
        )?;
    }
    Ok((
        heard.times.into_pyarray(py),
        by_rows(py, heard.states, (rows, width)),
        heard.energies.into_pyarray(py),
        by_rows(py, heard.casimirs, (rows, casimirs)),
        prepared.label.clone_ref(py),
        heard.smallest.or(heard.step).unwrap_or(given),
        heard.steps,
        (plan.from, end),
        (!more.is_empty()).then_some(more),
    ))
}

/// The times and states of events by their names.
fn events<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    found: &[Event],
    dimension: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    for name in &declaration.facts.events {
        let of_name = || found.iter().filter(|event| event.name == *name);
        let times: Vec<f64> = of_name().map(|event| event.time).collect();
        let states: Vec<f64> = of_name().flat_map(|event| event.state.clone()).collect();
        let states = by_rows(py, states, (times.len(), dimension));
        all.set_item(name, (times.into_pyarray(py), states))?;
    }
    Ok(all)
}

/// Numbers row by row as an array.
fn by_rows<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    shape: (usize, usize),
) -> Bound<'py, PyArray2<f64>> {
    let array = Array2::from_shape_vec(shape, numbers);
    array
        .expect("as many numbers as rows have")
        .into_pyarray(py)
}
