//! The core of the Python package: declarations compiled, run and evaluated without the interpreter's lock.

mod batch;
mod bench;
mod choice;
mod declaration;
mod errors;
mod evaluate;
mod observer;
mod progress;
mod report;
mod stress;
mod talk;
mod trajectory;
mod verify;

use choice::wanted;
use declaration::Declaration;
use lie_codegen::methods::Choice;
use lie_codegen::model::Model;
use lie_in_process::families;
use lie_program::protocol::Start;
use lie_runtime::Poisson as _;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::HashMap;

/// Where a measurement starts: the values of the parameters, the state.
type Begin = (Vec<f64>, Vec<f64>);

/// A checked declaration, as the package sees it.
#[pyclass(module = "liepoisson._core", frozen)]
struct Core(Declaration);

#[pymethods]
impl Core {
    #[new]
    fn new(py: Python<'_>, text: String) -> PyResult<Self> {
        Declaration::new(py, text).map(Self)
    }

    #[getter]
    fn text(&self) -> &str {
        &self.0.text
    }
    #[getter]
    fn name(&self) -> &str {
        &self.0.facts.system
    }
    #[getter]
    fn coordinates(&self) -> Vec<String> {
        self.0.facts.names.clone()
    }
    /// Whether it is a family.
    #[getter]
    fn family(&self) -> bool {
        self.0.facts.family
    }
    /// Whether its sites are on a lattice.
    #[getter]
    fn lattice(&self) -> bool {
        self.0.facts.lattice
    }
    #[getter]
    fn parameters(&self) -> HashMap<String, f64> {
        self.0.facts.parameters.iter().cloned().collect()
    }
    #[getter]
    fn casimirs(&self) -> Vec<String> {
        self.0.facts.casimirs.clone()
    }

    /// The names of the parameters, in order.
    fn parameter_names(&self) -> Vec<String> {
        let parameters = self.0.facts.parameters.iter();
        parameters.map(|(name, _)| name.clone()).collect()
    }

    /// The number of rows and columns of the sites of a family for these parameters; none of another system.
    fn sites(&self, py: Python<'_>, parameters: Vec<f64>) -> PyResult<Option<[usize; 2]>> {
        Ok(self.0.system(py, &parameters)?.sizes())
    }

    /// The names of the coordinates of all sites of a family for these parameters.
    fn names_of_sites(&self, py: Python<'_>, parameters: Vec<f64>) -> PyResult<Vec<String>> {
        let system = self.0.system(py, &parameters)?;
        let names = (0..system.dimension()).map(|place| system.coordinate(place).to_owned());
        Ok(names.collect())
    }

    /// The declared initial state for these parameters.
    fn initial<'py>(
        &self,
        py: Python<'py>,
        parameters: Vec<f64>,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let system = self.0.system(py, &parameters)?;
        Ok(system.initial_state().map(|state| state.into_pyarray(py)))
    }

    /// The states for those that a user gives: all coordinates, or without what carries the time, or without the group
    /// element; none where there are more or fewer.
    fn complete(&self, py: Python<'_>, given: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
        let all = self.0.facts.names.len();
        if given.iter().all(|state| state.len() == all) {
            return Some(given);
        }
        self.0.with_model(py, |model| {
            let states = given.iter().map(|state| model.complete_state(state));
            states.collect()
        })
    }

    /// The places of the coordinates that users give.
    fn shown(&self) -> Vec<usize> {
        self.0.facts.shown.clone()
    }

    /// The place of the time, where the Hamiltonian depends on it.
    fn time(&self) -> Option<usize> {
        self.0.facts.time
    }

    /// What the declaration says of a run, as it was written.
    fn run_options(&self) -> HashMap<String, Vec<String>> {
        self.0.facts.run.clone()
    }

    /// The method where none is named.
    fn usual_method(&self) -> &'static str {
        match (self.0.facts.family, self.0.facts.lie_poisson) {
            (true, _) => "gauss16",
            (false, true) => "lie-midpoint",
            (false, false) => "midpoint",
        }
    }

    /// Every method as an object of JSON, with the reason where it does not apply.
    fn methods(&self, py: Python<'_>) -> String {
        self.0.with_model(py, |model| report::methods(&model))
    }

    /// What `lie check --json` says, with the warnings.
    fn check(&self, py: Python<'_>, deep: bool) -> PyResult<String> {
        report::check(py, &self.0, deep)
    }

    /// Every claim of these methods, of all that apply where none is named, measured from a state on; and the kernels before the
    /// declaration.
    fn verify(
        &self,
        py: Python<'_>,
        methods: Vec<String>,
        from: Begin,
        options: (Option<f64>, u64),
        progress: Option<Py<PyAny>>,
    ) -> PyResult<verify::Facts> {
        self.measurable(py, |model| families::VERIFIED.exceeded(model, from.1.len()))?;
        let verification = verify::Verification {
            text: &self.0.text,
            parameters: from.0.clone(),
            step: options.0,
            seed: options.1,
        };
        self.subject(&methods, from, progress)
            .measure(py, &verification)
    }

    /// Errors of these methods beside their times, of the usual ones where none is named.
    fn bench(
        &self,
        py: Python<'_>,
        methods: Vec<String>,
        from: Begin,
        asked: bench::Asked,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<bench::Results> {
        self.measurable(py, |model| families::BENCHED.exceeded(model, from.1.len()))?;
        self.subject(&methods, from, progress)
            .measure(py, &bench::Comparison(asked))
    }

    /// These methods at their limits, the usual ones where none is named, with so many steps of the long run.
    fn stress(
        &self,
        py: Python<'_>,
        methods: Vec<String>,
        from: Begin,
        steps: u64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<stress::Limits> {
        self.measurable(py, |model| families::STRESSED.exceeded(model, from.1.len()))?;
        self.subject(&methods, from, progress)
            .measure(py, &stress::Stress(steps))
    }

    /// The generated Rust.
    fn rust(&self, py: Python<'_>, methods: Vec<String>) -> PyResult<String> {
        let text = self.0.with_model(py, |model| {
            let choices = methods.iter().map(|label| wanted(&model, label));
            let choices: Vec<Choice> = choices.collect::<Result<_, _>>()?;
            Ok(lie_codegen::compile::expand(&model, &choices))
        });
        text.map_err(|refused: choice::Refused| refused.raise(py))
    }

    /// The Hamiltonian and the equations of motion in the names of the declaration, line by line; the Hamiltonian alone where they
    /// are long.
    fn equations(&self, py: Python<'_>) -> Vec<String> {
        self.0.with_model(py, |model| report::equations(&model))
    }

    /// Lines of these as LaTeX, one below the other.
    fn latex(&self, py: Python<'_>, lines: Vec<String>) -> String {
        self.0.with_model(py, |model| report::latex(&model, &lines))
    }

    /// One trajectory: times, states, energies and Casimirs; the step; what ended it early.
    fn run<'py>(
        &self,
        py: Python<'py>,
        asked: trajectory::Asked,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(trajectory::Rows<'py>, Bound<'py, pyo3::types::PyDict>)> {
        trajectory::run(py, &self.0, asked, progress)
    }

    /// A kernel at states, one in each row, in the coordinates that users give.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        kernel: &str,
        parameters: Vec<f64>,
        states: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let system = self.0.system(py, &parameters)?;
        evaluate::evaluate(py, kernel, &system, &self.0.shown(&system), &states)
    }

    /// Many trajectories: the times, the states of members by rows, and why some ended early: member, time, reason.
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray2<'py, f64>,
        starts: PyReadonlyArray2<'py, f64>,
        asked: batch::Asked,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<batch::Saved<'py>> {
        batch::ensemble(py, &self.0, &parameters, &starts, asked, progress)
    }
}

impl Core {
    /// Refuses a family of which something is not measured.
    fn measurable(
        &self,
        py: Python<'_>,
        against: impl FnOnce(&Model) -> Option<(String, String)> + Send,
    ) -> PyResult<()> {
        if !self.0.facts.family {
            return Ok(());
        }
        match self.0.with_model(py, |model| against(&model)) {
            None => Ok(()),
            Some((text, help)) => Err(PyValueError::new_err(format!("{text}\n  help: {help}"))),
        }
    }

    fn subject<'a>(
        &'a self,
        methods: &'a [String],
        (parameters, initial): Begin,
        progress: Option<Py<PyAny>>,
    ) -> talk::Subject<'a> {
        talk::Subject {
            declaration: &self.0,
            methods,
            start: Start {
                parameters: self.0.named(parameters).collect(),
                initial,
            },
            progress,
        }
    }
}

/// The value of an exact constant such as `1/7` or `cos(11/10)`.
#[pyfunction]
fn constant(text: &str) -> PyResult<f64> {
    lie_codegen::compile::constant(text).map_err(|diagnostics| {
        let first = diagnostics.into_iter().next();
        PyValueError::new_err(first.map_or_else(|| "not a constant".to_owned(), |d| d.message))
    })
}

/// Rows of cells as text in columns.
#[pyfunction]
fn columns(rows: Vec<Vec<String>>) -> String {
    lie_in_process::table::text(&rows)
}

// Everything that calls share is behind a lock of Rust: no interpreter needs one of its own for it.
#[pymodule(gil_used = false)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<Core>()?;
    module.add_function(wrap_pyfunction!(constant, module)?)?;
    module.add_function(wrap_pyfunction!(columns, module)?)?;
    Ok(())
}
