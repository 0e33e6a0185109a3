//! The core of the Python package: declarations compiled, run and evaluated without the interpreter's lock.

mod batch;
mod choice;
mod errors;
mod observer;
mod verify;

use choice::wanted;
use errors::{declaration, method_error};
use lie_codegen::methods::Choice;
use lie_codegen::model::Model;
use lie_dynamic::{Declared, Dynamic};
use lie_jit::Jit;
use lie_program::protocol::Start;
use lie_runtime::diagnostics::Forgotten;
use lie_runtime::driver::{
    Chart, Options, Pace, Problem, Reconstruction, Save, Solution, SolveError, solve_observed,
};
use lie_runtime::{Poisson, SquareMatrix};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A checked declaration, with what was compiled of it.
#[pyclass(module = "liepoisson._core", frozen)]
struct Core {
    text: String,
    names: Vec<String>,
    parameters: Vec<(String, f64)>,
    casimirs: Vec<String>,
    system: String,
    lie_poisson: bool,
    run: HashMap<String, Vec<String>>,
    /// By the label of the method whose fused code it has; the empty label is that of none.
    compiled: Mutex<HashMap<String, Compiled>>,
}

/// What was compiled for a method.
#[derive(Clone)]
struct Compiled {
    /// None where no method was asked for.
    choice: Option<Choice>,
    declared: Arc<Declared>,
}

/// A run, as Python takes it.
type Rows<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
);

#[pymethods]
impl Core {
    #[new]
    fn new(py: Python<'_>, text: String) -> PyResult<Self> {
        let model = lie_codegen::compile::compile_spec(&text);
        let model = model.map_err(|diagnostics| declaration(py, &text, &diagnostics))?;
        let parameters = model.parameters.iter();
        let run = model.run.iter().map(|option| {
            let values = option.values.iter().map(|(text, _)| text.clone());
            (option.name.text.clone(), values.collect())
        });
        Ok(Self {
            names: model
                .coordinates
                .iter()
                .map(|name| name.text.clone())
                .collect(),
            parameters: parameters
                .map(|p| (p.name.clone(), p.default_value))
                .collect(),
            casimirs: model
                .casimirs
                .iter()
                .map(|casimir| casimir.name.clone())
                .collect(),
            system: model.name.clone(),
            lie_poisson: model.is_lie_poisson(),
            run: run.collect(),
            compiled: Mutex::default(),
            text,
        })
    }

    #[getter]
    fn text(&self) -> &str {
        &self.text
    }
    #[getter]
    fn name(&self) -> &str {
        &self.system
    }
    #[getter]
    fn coordinates(&self) -> Vec<String> {
        self.names.clone()
    }
    #[getter]
    fn parameters(&self) -> HashMap<String, f64> {
        self.parameters.iter().cloned().collect()
    }
    #[getter]
    fn casimirs(&self) -> Vec<String> {
        self.casimirs.clone()
    }

    /// The names of the parameters, in order.
    fn parameter_names(&self) -> Vec<String> {
        self.parameters
            .iter()
            .map(|(name, _)| name.clone())
            .collect()
    }

    /// The declared initial state for these parameters.
    fn initial<'py>(
        &self,
        py: Python<'py>,
        parameters: Vec<f64>,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let system = self.system(py, "", &parameters)?;
        Ok(system.initial_state().map(|state| state.into_pyarray(py)))
    }

    /// The state for the values that a user gives: all, or without what carries the time; none where there are more or fewer.
    fn complete(&self, given: Vec<f64>) -> Option<Vec<f64>> {
        match given.len() == self.names.len() {
            true => Some(given),
            false => self.model().complete_state(&given),
        }
    }

    /// The names of the coordinates that users give.
    fn shown(&self) -> Vec<String> {
        let shown = self.model().shown_coordinates();
        shown.into_iter().map(|i| self.names[i].clone()).collect()
    }

    /// What the declaration says of a run, as it was written.
    fn run_options(&self) -> HashMap<String, Vec<String>> {
        self.run.clone()
    }

    /// The method where none is named.
    fn usual_method(&self) -> &'static str {
        match self.lie_poisson {
            true => "lie-midpoint",
            false => "midpoint",
        }
    }

    /// Every method with its order, and the reason where it does not apply.
    fn methods(&self) -> Vec<(String, Option<String>)> {
        let model = self.model();
        let known = lie_codegen::methods::applicability(&model);
        known
            .into_iter()
            .map(|(id, why)| (id.to_owned(), why))
            .collect()
    }

    /// Every claim of these methods, of all that apply where none is named, measured from a state on; and what is wrong with
    /// the measurements themselves.
    fn verify(
        &self,
        py: Python<'_>,
        methods: Vec<String>,
        parameters: Vec<f64>,
        start: Vec<f64>,
        options: (Option<f64>, u64),
    ) -> PyResult<(Vec<verify::Fact>, Vec<String>)> {
        let model = self.model();
        let choices = match methods.is_empty() {
            true => every(&model),
            false => {
                let choices = methods.iter().map(|label| wanted(py, &model, label));
                choices.collect::<PyResult<_>>()?
            }
        };
        let names = self.parameter_names().into_iter();
        let start = Start {
            parameters: names.zip(parameters).collect(),
            initial: start,
        };
        let found = verify::verify(py, &model, &choices, start, options)?;
        Ok((found.facts, found.unsound))
    }

    /// The generated Rust.
    fn rust(&self, py: Python<'_>, methods: Vec<String>) -> PyResult<String> {
        let model = self.model();
        let choices = methods.iter().map(|label| wanted(py, &model, label));
        let choices: Vec<Choice> = choices.collect::<PyResult<_>>()?;
        Ok(lie_codegen::compile::expand(&model, &choices))
    }

    /// The equations of motion in the names of the declaration, line by line, where they are short.
    fn equations(&self) -> Vec<String> {
        let plan = lie_codegen::plan::plan(&self.model(), &[]);
        let kernels = plan.system.poisson.iter();
        let explicit = kernels.flat_map(|kernel| kernel.explicit.clone());
        explicit.collect()
    }

    /// One trajectory: times, states, energies and Casimirs; the step; what ended it early.
    #[expect(
        clippy::too_many_arguments,
        reason = "the names are given on the side of Python"
    )]
    fn run<'py>(
        &self,
        py: Python<'py>,
        label: &str,
        parameters: Vec<f64>,
        start: Vec<f64>,
        pace: (Option<f64>, Option<f64>),
        end: f64,
        every: u64,
        at: Option<Vec<f64>>,
        tolerances: (Option<f64>, Option<f64>),
        solver: choice::Solver,
        group: Option<&str>,
    ) -> PyResult<(Rows<'py>, Bound<'py, PyDict>)> {
        let (choice, declared) = self.method(py, label)?;
        let system = made(&declared, &parameters)?;
        let tolerances = choice::tolerances(py, &choice, tolerances, pace.1)?;
        lie_dynamic::method::<f64>(&choice, tolerances).ok_or_else(|| unsupported(py, label))?;
        let options = Options {
            pace: match pace {
                (_, Some(tolerance)) => Pace::Tolerance(tolerance),
                (step, None) => Pace::Step(step.unwrap_or(0.01)),
            },
            save: at.map_or(Save::Every(every), Save::At),
            newton: solver.options(py, &choice, pace.1.is_some())?,
            assess: pace.1.is_some(),
        };
        let chart = group.map(|name| self.chart(name)).transpose()?;
        let problem = Problem {
            system,
            mu0: start,
            span: (0.0, end),
        };
        let (outcome, watch, elements) = py.detach(|| {
            let watch = observer::Watch::default();
            let method = lie_dynamic::method::<f64>(&choice, tolerances);
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
        let outcome = outcome.ok_or_else(|| unsupported(py, label))?;
        let found = PyDict::new(py);
        let solution = match outcome {
            Ok(solution) => solution,
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
        Ok((rows(py, solution, self.names.len())?, found))
    }

    /// A kernel at states, one in each row.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        kernel: &str,
        parameters: Vec<f64>,
        states: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let system = self.system(py, "", &parameters)?;
        let states = states.as_array();
        let all: Vec<Vec<f64>> = states.rows().into_iter().map(|row| row.to_vec()).collect();
        let n = system.dimension();
        let width = match kernel {
            "hamiltonian" => 1,
            "vector_field" | "gradient" => n,
            "jacobian" | "hessian" | "poisson_matrix" => n * n,
            "casimirs" => system.casimir_count(),
            other => return Err(PyValueError::new_err(format!("no function `{other}`"))),
        };
        let values = py.detach(|| {
            let (mut out, mut matrix) = (system.zero_state(), system.zero_jacobian());
            let mut casimirs = vec![0.0; system.casimir_count()];
            let mut values = Vec::with_capacity(all.len() * width);
            for mu in &all {
                match kernel {
                    "hamiltonian" => values.push(system.hamiltonian(mu)),
                    "casimirs" => {
                        system.casimirs(mu, &mut casimirs);
                        values.extend_from_slice(&casimirs);
                    }
                    "vector_field" => {
                        system.vector_field(mu, &mut out);
                        values.extend_from_slice(&out);
                    }
                    "gradient" => {
                        system.gradient(mu, &mut out);
                        values.extend_from_slice(&out);
                    }
                    matrix_kernel => {
                        match matrix_kernel {
                            "jacobian" => system.jacobian(mu, &mut matrix),
                            "hessian" => system.hessian(mu, &mut matrix),
                            _ => system.poisson_matrix(mu, &mut matrix),
                        }
                        for i in 0..n {
                            values.extend((0..n).map(|j| matrix.get(i, j)));
                        }
                    }
                }
            }
            values
        });
        values.into_pyarray(py).reshape([all.len(), width])
    }

    /// The ends of many trajectories, and why some ended early: member, time, reason.
    #[expect(
        clippy::too_many_arguments,
        reason = "the names are given on the side of Python"
    )]
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        label: &str,
        parameters: PyReadonlyArray2<'py, f64>,
        starts: PyReadonlyArray2<'py, f64>,
        step: f64,
        end: f64,
        threads: usize,
        tolerances: (Option<f64>, Option<f64>),
        solver: choice::Solver,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Vec<(usize, f64, String)>)> {
        let (choice, declared) = self.method(py, label)?;
        let tolerances = choice::tolerances(py, &choice, tolerances, None)?;
        lie_dynamic::method::<f64>(&choice, tolerances).ok_or_else(|| unsupported(py, label))?;
        let rows = |array: &PyReadonlyArray2<'py, f64>| -> Vec<Vec<f64>> {
            let rows = array.as_array();
            rows.rows().into_iter().map(|row| row.to_vec()).collect()
        };
        let members = batch::Members {
            declared: &declared,
            choice: &choice,
            tolerances,
            newton: solver.options(py, &choice, false)?,
            parameters: rows(&parameters),
            starts: rows(&starts),
            step,
            end,
        };
        let (ends, failures) = py.detach(|| members.run(threads))?;
        let ends = ends
            .into_pyarray(py)
            .reshape([starts.as_array().nrows(), self.names.len()])?;
        Ok((ends, failures))
    }
}

/// Every method that applies and runs in Python, at its default options.
fn every(model: &Model) -> Vec<Choice> {
    let known = lie_codegen::methods::applicability(model);
    let apply = known.into_iter().filter(|(_, why)| why.is_none());
    apply
        .filter_map(|(id, _)| Choice::from_id(id).ok())
        .filter(|choice| {
            lie_dynamic::method::<f64>(choice, lie_dynamic::Tolerances::default()).is_some()
        })
        .collect()
}

/// The system of these parameters.
fn made(declared: &Declared, parameters: &[f64]) -> PyResult<Dynamic<f64>> {
    let system = declared.system(parameters);
    system.map_err(|error| PyValueError::new_err(error.to_string()))
}

impl Core {
    /// How the group element is written.
    fn chart(&self, name: &str) -> PyResult<Chart> {
        let chart = match name {
            "matrix" => Chart::Matrix,
            "quaternion" => Chart::Quaternion,
            other => {
                return Err(PyValueError::new_err(format!(
                    "no form of the group element `{other}`: there are \"matrix\" and \"quaternion\""
                )));
            }
        };
        let quaternion = chart == Chart::Quaternion;
        match lie_codegen::structure::group::refusal(&self.model(), quaternion) {
            Some((reason, help)) => Err(PyValueError::new_err(format!(
                "group=\"{name}\": {reason}\n  help: {help}"
            ))),
            None => Ok(chart),
        }
    }

    /// The checked declaration: it holds what is not sent between threads, and so it is made again from its text.
    fn model(&self) -> Model {
        let model = lie_codegen::compile::compile_spec(&self.text);
        model.unwrap_or_else(|_| unreachable!("the same text was sound before"))
    }

    /// A method with what is compiled for it, once.
    fn method(&self, py: Python<'_>, label: &str) -> PyResult<(Choice, Arc<Declared>)> {
        if label.trim().is_empty() {
            let help = "name one, such as \"lie-midpoint\", or leave it out";
            return Err(method_error(py, "the method is empty", help));
        }
        let Compiled { choice, declared } = self.compiled(py, label)?;
        let choice = choice.unwrap_or_else(|| unreachable!("a method has a label"));
        Ok((choice, declared))
    }

    fn compiled(&self, py: Python<'_>, label: &str) -> PyResult<Compiled> {
        let lock = || self.compiled.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(compiled) = lock().get(label).cloned() {
            return Ok(compiled);
        }
        let model = self.model();
        let choice = match label {
            "" => None,
            label => Some(wanted(py, &model, label)?),
        };
        let plan = lie_codegen::plan::plan(&model, choice.as_slice());
        if !Dynamic::supports(&plan) {
            let text =
                "a system by a Lagrangian, a realization or a family does not run in Python yet";
            let help = "`lie run` integrates it: write the declaration to a file";
            return Err(method_error(py, text, help));
        }
        let declared = Arc::new(py.detach(|| Declared::new(plan, &Jit)));
        let compiled = Compiled { choice, declared };
        lock().insert(label.to_owned(), compiled.clone());
        Ok(compiled)
    }

    fn system(&self, py: Python<'_>, label: &str, parameters: &[f64]) -> PyResult<Dynamic<f64>> {
        made(&self.compiled(py, label)?.declared, parameters)
    }
}

/// A method that only the command has.
fn unsupported(py: Python<'_>, label: &str) -> PyErr {
    let text = format!("`{label}` does not run in Python yet");
    method_error(
        py,
        &text,
        "`lie run` has it; or take another method, see System.methods()",
    )
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

/// The value of an exact constant such as `1/7` or `cos(11/10)`.
#[pyfunction]
fn constant(text: &str) -> PyResult<f64> {
    lie_codegen::check::constant(text).map_err(|diagnostics| {
        let first = diagnostics.into_iter().next();
        PyValueError::new_err(first.map_or_else(|| "not a constant".to_owned(), |d| d.message))
    })
}

/// All methods: id, order, what it is for.
#[pyfunction]
fn catalogue() -> Vec<(&'static str, u32)> {
    let rows = lie_codegen::methods::CATALOGUE.iter();
    rows.map(|row| (row.id, row.order)).collect()
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Core>()?;
    module.add_function(wrap_pyfunction!(constant, module)?)?;
    module.add_function(wrap_pyfunction!(catalogue, module)?)?;
    module.add("Interrupted", module.py().get_type::<PyRuntimeError>())?;
    Ok(())
}
