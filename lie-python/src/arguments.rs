//! What a call asks for, from the dictionary of its arguments.

use crate::declaration::Declaration;
use crate::errors::refused;
use lie_in_process::message::Message;
use lie_in_process::request::{self, Front, Parameter, Plan, Request, Value};
use lie_in_process::spec::Spec;
use lie_program::protocol::{Run, Start};
use lie_runtime::driver::{Controller, Source};
use numpy::IntoPyArray;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// A value of an argument.
#[derive(FromPyObject)]
enum Argument {
    Number(f64),
    Text(String),
    List(Vec<Argument>),
}

impl From<Argument> for Value {
    fn from(given: Argument) -> Self {
        match given {
            Argument::Number(number) => Self::Number(number),
            Argument::Text(text) => Self::Text(text),
            Argument::List(values) => Self::List(values.into_iter().map(Self::from).collect()),
        }
    }
}

/// The request of a dictionary: options by the names of arguments, the method, and the values of the parameters in order.
pub fn request(declaration: &Declaration, asked: &Bound<'_, PyDict>) -> PyResult<Request> {
    let mut request = Request {
        front: Front::Call,
        ..Request::default()
    };
    for (name, value) in asked {
        let name: String = name.extract()?;
        if value.is_none() {
            continue;
        }
        match name.as_str() {
            "method" => request.method = vec![value.extract()?],
            "assess" => request.assess = value.extract()?,
            "stream" => request.stream = value.extract()?,
            "inputs" => {
                for (name, value) in value.cast::<PyDict>()? {
                    request
                        .sources
                        .insert(name.extract()?, source(declaration, &value)?);
                }
            }
            "parameters" => {
                let values = declaration.named(value.extract()?);
                let set = |(name, value)| Parameter::Set(name, Value::Number(value));
                request.param = values.map(set).collect();
            }
            _ if !request.set(
                &Front::canonical(&name),
                value.extract::<Argument>()?.into(),
            ) =>
            {
                return Err(PyTypeError::new_err(format!("no argument `{name}`")));
            }
            _ => {}
        }
    }
    Ok(request)
}

/// Times and values, or a function of time, state and group element; what it raises is kept by whoever gave it, and no number here.
fn source(declaration: &Declaration, value: &Bound<'_, PyAny>) -> PyResult<Source> {
    if let Ok((times, values)) = value.extract::<(Vec<f64>, Vec<f64>)>() {
        return Ok(Source::Table {
            times: times.into(),
            values: values.into(),
        });
    }
    let spec = declaration.spec();
    let shown = declaration.facts.shown.clone();
    let function: Py<PyAny> = value.clone().unbind();
    let controller: Controller = Arc::new(move |time, state, element| {
        Python::attach(|py| {
            let state: Vec<f64> = match spec.model.family {
                Some(_) => spec.model.of_sites(state).to_vec(),
                None => shown.iter().map(|place| state[*place]).collect(),
            };
            let element = (!element.is_empty()).then(|| element.to_vec().into_pyarray(py));
            let answer = function.call1(py, (time, state.into_pyarray(py), element));
            let number = answer.and_then(|answer| answer.extract::<f64>(py));
            number.unwrap_or(f64::NAN)
        })
    });
    Ok(Source::Controller(controller))
}

/// What a request comes to, by a check of it.
pub fn checked<R: Send>(
    py: Python<'_>,
    declaration: &Declaration,
    request: &Request,
    check: impl FnOnce(&Spec, &Request) -> Result<R, Vec<Message>> + Send,
) -> PyResult<R> {
    let found = declaration.with_spec(py, |spec| check(spec, request));
    found.map_err(|messages| refused(py, &messages))
}

/// Where it starts.
pub fn start(spec: &Spec, request: &Request) -> Result<Start, Vec<Message>> {
    request::start(spec, request).map(|start| start.named(spec))
}

/// How it runs, with the mistakes of both.
pub fn run(spec: &Spec, request: &Request) -> Result<(Plan, Run), Vec<Message>> {
    match (request::plan(spec, request), request::start(spec, request)) {
        (Ok(plan), Ok(start)) => {
            let (method, values) = (&plan.method, &start.parameters);
            let bound = request::bound_to_itself(&spec.model, method, values, request.front);
            let run = plan.run_of(&spec.model, start.named(spec));
            bound.map_or(Ok((plan, run)), |message| Err(vec![message]))
        }
        (plan, start) => {
            let mistakes = start.err().into_iter().chain(plan.err());
            Err(mistakes.flatten().collect())
        }
    }
}
