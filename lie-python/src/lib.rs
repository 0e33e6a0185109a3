//! The core of the Python package: declarations compiled, run and evaluated without the interpreter's lock.

mod arguments;
mod batch;
mod bench;
mod declaration;
mod errors;
mod evaluate;
mod kept;
mod progress;
mod report;
mod spectra;
mod stress;
mod talk;
mod trajectory;
mod verify;

use declaration::Declaration;
use lie_codegen::methods::Choice;
use lie_in_process::canonical::Canonical;
use lie_in_process::message::Message;
use lie_in_process::request::{self, Front, Request};
use lie_runtime::Poisson as _;
use lie_runtime::lattice::{AXES, count};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::collections::HashMap;

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
        self.0.text()
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
    /// The number of axes along which its sites stand, 1 of a chain; 0 where it is no family.
    #[getter]
    fn axes(&self) -> usize {
        self.0.facts.axes
    }
    #[getter]
    fn parameters(&self) -> HashMap<String, f64> {
        self.0.facts.parameters.iter().cloned().collect()
    }
    #[getter]
    fn casimirs(&self) -> Vec<String> {
        self.0.facts.casimirs.clone()
    }
    /// The inputs.
    #[getter]
    fn inputs(&self) -> Vec<String> {
        self.0.facts.inputs.clone()
    }
    /// Whether there is noise.
    #[getter]
    fn noisy(&self) -> bool {
        self.0.facts.noisy
    }
    #[getter]
    fn events(&self) -> Vec<String> {
        self.0.facts.events.clone()
    }
    #[getter]
    fn quantities(&self) -> Vec<(String, bool)> {
        self.0.facts.quantities.clone()
    }

    /// The names of the parameters, in order.
    fn parameter_names(&self) -> Vec<String> {
        let parameters = self.0.facts.parameters.iter();
        parameters.map(|(name, _)| name.clone()).collect()
    }

    /// The number of layers, rows and columns of the sites of a family for these parameters; none of another system.
    fn sites(&self, py: Python<'_>, parameters: Vec<f64>) -> PyResult<Option<[usize; AXES]>> {
        Ok(self.0.system(py, &parameters)?.sizes())
    }

    /// The names of the coordinates of all sites of a family for these parameters.
    fn names_of_sites(&self, py: Python<'_>, parameters: Vec<f64>) -> PyResult<Vec<String>> {
        let system = self.0.system(py, &parameters)?;
        let shown = self.0.shown_coordinates(&system).into_iter();
        Ok(shown
            .map(|place| system.coordinate(place).to_owned())
            .collect())
    }

    /// The declared initial state for these parameters.
    fn initial<'py>(
        &self,
        py: Python<'py>,
        parameters: Vec<f64>,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let system = self.0.system(py, &parameters)?;
        let shown = self.0.shown_coordinates(&system).len();
        Ok(system.initial_state().map(|mut state| {
            if self.0.facts.family {
                state.truncate(shown);
            }
            state.into_pyarray(py)
        }))
    }

    /// The states for those that a user gives: all coordinates, or without what carries the time, or without the group
    /// element, for values of the parameters of each or of all; none where there are more or fewer.
    ///
    /// # Errors
    /// One of them violates a constraint.
    fn complete(
        &self,
        py: Python<'_>,
        given: Vec<Vec<f64>>,
        parameters: Vec<Vec<f64>>,
    ) -> PyResult<Option<Vec<Vec<f64>>>> {
        let all = self.0.facts.names.len();
        if !self.0.facts.family && given.iter().all(|state| state.len() == all) {
            return Ok(Some(given));
        }
        self.0.with_model(py, |model| {
            let values = parameters.iter().cycle().take(given.len());
            let states = given.iter().zip(values);
            let mut checked = states.clone();
            if let Some(wrong) = checked.find_map(|(state, values)| model.violation(state, values))
            {
                let text = format!("{}; {}", wrong.message, wrong.help);
                return Err(PyValueError::new_err(text));
            }
            let states = states.map(|(state, values)| match &model.family {
                Some(family) => {
                    let sites = count(family.sites(values)?);
                    let fits = sites.checked_mul(all) == Some(state.len());
                    fits.then(|| model.complete_sites(state.clone(), sites))
                }
                None => model.complete_state(state, values),
            });
            Ok(states.collect())
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

    /// Every method as an object of JSON, with the reason where it does not apply.
    fn methods(&self, py: Python<'_>) -> String {
        self.0.with_model(py, report::methods)
    }

    /// What `lie check --json` says, with the warnings.
    fn check(&self, py: Python<'_>, deep: bool) -> PyResult<String> {
        report::check(py, &self.0, deep)
    }

    /// The spec in coordinates in which its bracket is constant, as text.
    fn canonical(&self, py: Python<'_>) -> PyResult<String> {
        let found = self.0.with_spec(py, |spec| Canonical::of(spec, None));
        found.map_or_else(
            |message| Err(errors::refused(py, &[message])),
            |new| Ok(new.text),
        )
    }

    /// Every claim of these methods, of all that apply where none is named, measured from a state on; and the kernels before the
    /// declaration.
    fn verify(
        &self,
        py: Python<'_>,
        methods: Vec<String>,
        asked: &Bound<'_, PyDict>,
        seed: u64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<verify::Facts> {
        let request = arguments::request(&self.0, asked)?;
        let step = arguments::checked(py, &self.0, &request, |spec, request| {
            request::step_of_facts(spec, request).map_err(|message| vec![message])
        })?;
        let subject = talk::Subject::new(py, &self.0, &methods, &request, progress)?;
        subject.measure(py, &verify::Verification { step, seed })
    }

    /// Errors of these methods beside their times, of the usual ones where none is named.
    fn bench(
        &self,
        py: Python<'_>,
        methods: Vec<String>,
        asked: &Bound<'_, PyDict>,
        options: bench::ComparisonOptions,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<bench::Results> {
        let request = arguments::request(&self.0, asked)?;
        let until = arguments::checked(py, &self.0, &request, |spec, request| {
            request::span(spec, request).map_err(|message| vec![message])
        })?;
        let subject = talk::Subject::new(py, &self.0, &methods, &request, progress)?;
        subject.measure(py, &bench::Comparison { until, options })
    }

    /// These methods at their limits, the usual ones where none is named, with so many steps of the long run.
    fn stress(
        &self,
        py: Python<'_>,
        methods: Vec<String>,
        asked: &Bound<'_, PyDict>,
        steps: u64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<stress::Limits> {
        let request = arguments::request(&self.0, asked)?;
        let subject = talk::Subject::new(py, &self.0, &methods, &request, progress)?;
        subject.measure(py, &stress::Stress(steps))
    }

    /// Lyapunov exponents of an orbit but for a time at its start, all of them or so many.
    fn exponents(
        &self,
        py: Python<'_>,
        asked: &Bound<'_, PyDict>,
        own: (f64, Option<u32>),
        progress: Option<Py<PyAny>>,
    ) -> PyResult<spectra::Found> {
        let request = arguments::request(&self.0, asked)?;
        spectra::exponents(py, &self.0, &request, own, progress)
    }

    /// The generated Rust.
    fn rust(&self, py: Python<'_>, methods: Vec<String>) -> PyResult<String> {
        let text = self.0.with_model(py, |model| {
            let choices = methods.iter().map(|label| talk::wanted(model, label));
            let choices: Vec<Choice> = choices.collect::<Result<_, _>>()?;
            Ok(lie_codegen::compile::expand(model, &choices))
        });
        text.map_err(|message: Message| errors::refused(py, &[message]))
    }

    /// The Hamiltonian and the equations of motion in the names of the declaration, line by line; the Hamiltonian alone where they
    /// are long.
    fn equations(&self, py: Python<'_>) -> Vec<String> {
        self.0.with_model(py, report::equations)
    }

    /// Lines of these as LaTeX, one below the other.
    fn latex(&self, py: Python<'_>, lines: Vec<String>) -> String {
        self.0.with_model(py, |model| report::latex(model, &lines))
    }

    /// One trajectory. The options in the order of `run` are those of the request but for the start: a call with the same is known.
    fn run<'py>(
        &self,
        py: Python<'py>,
        asked: &Bound<'py, PyDict>,
        options: &Bound<'py, PyTuple>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<trajectory::Made<'py>> {
        let request = arguments::request(&self.0, asked)?;
        trajectory::run(py, &self.0, (&request, options), progress)
    }

    /// The same of options that are known, from a start that needs no second look; none where one of these is not so.
    fn again<'py>(
        &self,
        py: Python<'py>,
        options: &Bound<'py, PyTuple>,
        x0: &Bound<'py, PyAny>,
        named: &Bound<'py, PyDict>,
    ) -> PyResult<Option<trajectory::Made<'py>>> {
        let Some((prepared, start)) = kept::again(&self.0, options, x0, named) else {
            return Ok(None);
        };
        let run = prepared.plan.run_of(&self.0.spec().model, start);
        trajectory::of_prepared(py, &self.0, (&prepared, run), None).map(Some)
    }

    /// The states of that trajectory at times between its start and its end, in its order.
    fn at<'py>(
        &self,
        py: Python<'py>,
        asked: &Bound<'py, PyDict>,
        times: Vec<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let request = arguments::request(&self.0, asked)?;
        trajectory::at(py, &self.0, &request, times)
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
        evaluate::evaluate(
            py,
            kernel,
            &system,
            &self.0.shown_coordinates(&system),
            &states,
        )
    }

    /// The names of what a projection behind each step of a trajectory keeps.
    fn kept(&self, py: Python<'_>, asked: &Bound<'_, PyDict>) -> PyResult<Vec<String>> {
        let request = arguments::request(&self.0, asked)?;
        arguments::checked(py, &self.0, &request, |spec, request| {
            Ok(request::plan(spec, request)?.kept(spec))
        })
    }

    /// Many trajectories, on so many threads, with their events or without: see [`batch::Saved`].
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray2<'py, f64>,
        starts: PyReadonlyArray2<'py, f64>,
        asked: &Bound<'py, PyDict>,
        options: (usize, bool),
        progress: Option<Py<PyAny>>,
    ) -> PyResult<batch::Saved<'py>> {
        let asked = (&arguments::request(&self.0, asked)?, options);
        batch::ensemble(py, &self.0, &parameters, &starts, asked, progress)
    }

    /// Initial states drawn around one: how many, by which seed, how far they go; nothing for the whole orbit.
    fn drawn<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray2<'py, f64>,
        around: Vec<f64>,
        asked: (usize, u64, Option<f64>),
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        batch::drawn(py, &self.0, &parameters, &around, asked)
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

/// Whether the value of an argument is a word, which is no number.
#[pyfunction]
fn is_word(name: &str) -> bool {
    Request::is_word(&Front::canonical(name))
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
    module.add_function(wrap_pyfunction!(is_word, module)?)?;
    module.add_function(wrap_pyfunction!(columns, module)?)?;
    module.add_function(wrap_pyfunction!(spectra::lines, module)?)?;
    Ok(())
}
