//! One trajectory.

use crate::choice::{self, unsupported};
use crate::declaration::{Declaration, made};
use crate::observer;
use crate::progress::Progress as Told;
use lie_runtime::Poisson as _;
use lie_runtime::diagnostics::Forgotten;
use lie_runtime::driver::{
    Options, Pace, Problem, Reconstruction, Save, Solution, SolveError, solve_observed,
};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A run, as Python takes it.
pub type Rows<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
);

/// What is asked for: a dictionary of Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    label: String,
    parameters: Vec<f64>,
    start: Vec<f64>,
    /// The step, or the tolerance in its place.
    pace: (Option<f64>, Option<f64>),
    end: f64,
    every: u64,
    at: Option<Vec<f64>>,
    tolerances: (Option<f64>, Option<f64>),
    solver: choice::Solver,
    group: Option<String>,
}

/// Times, states, energies and Casimirs; the step; what ended it early.
pub fn run<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    asked: Asked,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Rows<'py>, Bound<'py, PyDict>)> {
    let pace = asked.pace;
    let (choice, declared) = declaration.method(py, &asked.label)?;
    let system = made(&declared, &asked.parameters)?;
    let tolerances = choice::tolerances(py, &choice, asked.tolerances, pace.1)?;
    lie_dynamic::method(&choice, tolerances).ok_or_else(|| unsupported(py, &asked.label))?;
    let options = Options {
        pace: match pace {
            (_, Some(tolerance)) => Pace::Tolerance(tolerance),
            (step, None) => Pace::Step(step.unwrap_or(0.01)),
        },
        save: asked.at.map_or(Save::Every(asked.every), Save::At),
        newton: asked.solver.options(py, &choice, pace.1.is_some())?,
        assess: pace.1.is_some(),
    };
    let chart = asked
        .group
        .as_deref()
        .map(|name| declaration.chart(py, name))
        .transpose()?;
    let problem = Problem {
        system,
        mu0: asked.start,
        span: (0.0, asked.end),
    };
    let (outcome, watch, elements) = py.detach(|| {
        let watch = observer::Watch::new(Told::of("steps", progress));
        let method = lie_dynamic::method(&choice, tolerances);
        let mut elements = None;
        let outcome = method.map(|method| {
            let method = Forgotten(method.as_ref());
            let Some(chart) = chart else {
                return solve_observed(&problem, method, &options, &watch);
            };
            let mut on_group = observer::OnGroup {
                watch: &watch,
                reconstruction: Reconstruction::new(&problem.system, chart),
            };
            let outcome = solve_observed(&problem, method, &options, &mut on_group);
            elements = Some(on_group.reconstruction.rows().concat());
            outcome
        });
        (outcome, watch, elements)
    });
    watch.outcome()?;
    let outcome = outcome.ok_or_else(|| unsupported(py, &asked.label))?;
    let found = PyDict::new(py);
    let solution = match outcome {
        Ok(solution) => {
            watch.ended()?;
            solution
        }
        Err(SolveError::Option(error)) => return Err(PyValueError::new_err(error.to_string())),
        Err(SolveError::Step { error, solution }) => {
            found.set_item("step_number", error.step)?;
            found.set_item("time", error.time)?;
            found.set_item("why", error.failure.reason.to_string())?;
            found.set_item("remedy", error.remedy().to_string())?;
            *solution
        }
    };
    let step = match (watch.chosen(), options.pace) {
        (Some(step), _) => step,
        (None, Pace::Step(step) | Pace::Tolerance(step)) => step,
    };
    if let Some(elements) = elements {
        found.set_item("group", elements.into_pyarray(py))?;
    }
    if let Some(error) = watch.missed() {
        found.set_item("missed", error)?;
    }
    found.set_item("step", step)?;
    found.set_item("steps", solution.stats.steps)?;
    found.set_item("evaluations", solution.stats.evaluations)?;
    Ok((rows(py, solution, problem.system.dimension())?, found))
}

/// The rows of a run as arrays.
fn rows<'py>(
    py: Python<'py>,
    solution: Solution<f64, Vec<f64>>,
    dimension: usize,
) -> PyResult<Rows<'py>> {
    let count = solution.t.len();
    let casimirs = solution.casimir_names.len();
    let flat = |rows: Vec<Vec<f64>>| -> Vec<f64> { rows.into_iter().flatten().collect() };
    Ok((
        solution.t.into_pyarray(py),
        flat(solution.mu)
            .into_pyarray(py)
            .reshape([count, dimension])?,
        solution.energy.into_pyarray(py),
        flat(solution.casimirs)
            .into_pyarray(py)
            .reshape([count, casimirs])?,
    ))
}
