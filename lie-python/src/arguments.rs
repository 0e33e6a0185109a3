//! What a call asks for, from the dictionary of its arguments.

use crate::declaration::Declaration;
use crate::errors::refused;
use lie_in_process::message::Message;
use lie_in_process::request::{self, Front, Parameter, Plan, Request, Value};
use lie_in_process::spec::Spec;
use lie_program::protocol::{Run, Start};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

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
            let run = plan.run(start.named(spec));
            bound.map_or(Ok((plan, run)), |message| Err(vec![message]))
        }
        (plan, start) => {
            let mistakes = start.err().into_iter().chain(plan.err());
            Err(mistakes.flatten().collect())
        }
    }
}
