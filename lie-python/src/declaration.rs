//! A checked declaration, and what is compiled of it. The compiler works without the interpreter's lock: the model, which is not
//! sent between threads, is made and dropped on the way.

use crate::choice::{Refused, wanted};
use crate::errors::{Mistakes, method_error};
use lie_codegen::check::Effort;
use lie_codegen::compile::{compile_spec, compile_spec_in};
use lie_codegen::methods::Choice;
use lie_codegen::model::Model;
use lie_dynamic::{Declared, Dynamic};
use lie_jit::Jit;
use lie_runtime::Poisson as _;
use lie_runtime::driver::Chart;
use lie_runtime::family::STATISTICS;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// What is asked of a declaration often.
pub struct Facts {
    pub system: String,
    pub names: Vec<String>,
    /// Whether it is a family, whose coordinates are those of its sites, as many as the parameters say.
    pub family: bool,
    /// Whether its sites are on a lattice.
    pub lattice: bool,
    /// The places of the coordinates that users give.
    pub shown: Vec<usize>,
    /// The place of the time in the state, where the Hamiltonian depends on it.
    pub time: Option<usize>,
    pub parameters: Vec<(String, f64)>,
    pub casimirs: Vec<String>,
    pub lie_poisson: bool,
    pub run: HashMap<String, Vec<String>>,
}

impl Facts {
    fn of(model: &Model) -> Self {
        let run = model.run.iter().map(|option| {
            let values = option.values.iter().map(|(text, _)| text.clone());
            (option.name.text.clone(), values.collect())
        });
        let names = model.coordinates.iter().map(|name| name.text.clone());
        let parameters = model.parameters.iter();
        let casimirs = model
            .casimirs
            .iter()
            .flat_map(|casimir| match model.family {
                Some(_) => STATISTICS
                    .map(|of| format!("{}_{of}", casimir.name))
                    .to_vec(),
                None => vec![casimir.name.clone()],
            });
        let timed = model.configuration.as_ref().is_some_and(|own| own.time);
        Self {
            system: model.name.clone(),
            family: model.family.is_some(),
            lattice: model
                .family
                .as_ref()
                .is_some_and(|family| family.sizes.len() == 2),
            names: names.collect(),
            shown: model.shown_coordinates(),
            // the last is the constant 1
            time: timed.then(|| model.dimension() - 2),
            parameters: parameters
                .map(|p| (p.name.clone(), p.default_value))
                .collect(),
            casimirs: casimirs.collect(),
            lie_poisson: model.is_lie_poisson(),
            run: run.collect(),
        }
    }
}

/// A checked declaration.
pub struct Declaration {
    pub text: String,
    pub facts: Facts,
    /// By the label of the method whose fused code it has; the empty label is that of none.
    compiled: Mutex<HashMap<String, Compiled>>,
}

/// What was compiled for a method.
#[derive(Clone)]
pub struct Compiled {
    /// None where no method was asked for.
    choice: Option<Choice>,
    declared: Arc<Declared>,
}

/// What stands against a compilation.
enum Obstacle {
    Method(Refused),
    System,
}

impl Declaration {
    pub fn new(py: Python<'_>, text: String) -> PyResult<Self> {
        let facts = py.detach(|| match compile_spec(&text) {
            Ok(model) => Ok(Facts::of(&model)),
            Err(diagnostics) => Err(Mistakes::of(&text, &diagnostics)),
        });
        Ok(Self {
            facts: facts.map_err(|mistakes| mistakes.raise(py))?,
            compiled: Mutex::default(),
            text,
        })
    }

    /// Has something done with the model, without the interpreter's lock.
    pub fn with_model<R: Send>(&self, py: Python<'_>, work: impl FnOnce(Model) -> R + Send) -> R {
        py.detach(|| {
            let model = compile_spec(&self.text);
            work(model.unwrap_or_else(|_| unreachable!("the same text was sound before")))
        })
    }

    /// The same with as much work on what is searched for as is said.
    pub fn with_effort<R: Send>(
        &self,
        py: Python<'_>,
        effort: Effort,
        work: impl FnOnce(Model) -> R + Send,
    ) -> PyResult<R> {
        let done = py.detach(|| match compile_spec_in(&self.text, None, effort) {
            Ok(model) => Ok(work(model)),
            Err(diagnostics) => Err(Mistakes::of(&self.text, &diagnostics)),
        });
        done.map_err(|mistakes| mistakes.raise(py))
    }

    /// The parameters with these values, by name.
    pub fn named(&self, values: Vec<f64>) -> impl Iterator<Item = (String, f64)> + '_ {
        let names = self.facts.parameters.iter().map(|(name, _)| name.clone());
        names.zip(values)
    }

    /// A method with what is compiled for it, once.
    pub fn method(&self, py: Python<'_>, label: &str) -> PyResult<(Choice, Arc<Declared>)> {
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
        let compiled = self.with_model(py, |model| {
            let choice = match label {
                "" => None,
                label => Some(wanted(&model, label).map_err(Obstacle::Method)?),
            };
            let plan = lie_codegen::plan::plan(&model, choice.as_slice());
            match Dynamic::supports(&plan) {
                true => Ok(Compiled {
                    choice,
                    declared: Arc::new(Declared::new(plan, &Jit)),
                }),
                false => Err(Obstacle::System),
            }
        });
        let compiled = compiled.map_err(|obstacle| match obstacle {
            Obstacle::Method(refused) => refused.raise(py),
            Obstacle::System => {
                let text = "H calls functions of Rust, which do not run in Python";
                let help = "give them as tables: docs/functions.md";
                method_error(py, text, help)
            }
        })?;
        lock().insert(label.to_owned(), compiled.clone());
        Ok(compiled)
    }

    /// The places of the coordinates of a system that users give.
    pub fn shown(&self, system: &Dynamic<f64>) -> Vec<usize> {
        match self.facts.family {
            true => (0..system.dimension()).collect(),
            false => self.facts.shown.clone(),
        }
    }

    /// The system of these parameters, without code for any method.
    pub fn system(&self, py: Python<'_>, parameters: &[f64]) -> PyResult<Dynamic<f64>> {
        made(&self.compiled(py, "")?.declared, parameters)
    }

    /// How the group element is written.
    pub fn chart(&self, py: Python<'_>, name: &str) -> PyResult<Chart> {
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
        let refusal = self.with_model(py, |model| {
            lie_codegen::structure::group::refusal(&model, quaternion)
                .map(|(reason, help)| format!("group=\"{name}\": {reason}\n  help: {help}"))
        });
        match refusal {
            Some(text) => Err(PyValueError::new_err(text)),
            None => Ok(chart),
        }
    }
}

/// The system of these parameters.
pub fn made(declared: &Declared, parameters: &[f64]) -> PyResult<Dynamic<f64>> {
    let system = declared.system(parameters);
    system.map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Whether a method runs without a compiler of Rust.
pub fn runs(choice: &Choice) -> bool {
    lie_dynamic::method(choice, lie_dynamic::Tolerances::default()).is_some()
}
