//! Many trajectories.

use crate::arguments;
use crate::declaration::Declaration;
use crate::errors::of_system;
use crate::progress::Progress;
use crate::talk::{Outcome, converse};
use lie_codegen::structure::Structure;
use lie_in_process::ensemble::Ensemble;
use lie_in_process::members::Member;
use lie_in_process::memory::{self, Exceeded};
use lie_in_process::report::signs;
use lie_in_process::request::{Request, plan};
use lie_program::protocol::{End, Obstacle, Start};
use lie_runtime::driver::Pace;
use numpy::{
    IntoPyArray, PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods as _,
};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::io;

/// A member that ended early: its number, the time, why.
pub type Failed = (usize, f64, String);

/// What all members gave: the times, the states member after member and row after row, what failed in order. Rows to which a
/// member did not come are not numbers.
struct Found {
    times: Vec<f64>,
    states: Vec<f64>,
    failures: Vec<Failed>,
}

fn collected(width: usize, members: Vec<Member>) -> io::Result<Found> {
    let longest = members.iter().map(|member| &member.times);
    let times = longest.max_by_key(|times| times.len());
    let times = times.cloned().unwrap_or_default();
    let mut states = Vec::new();
    memory::reserve(&mut states, members.len() * times.len() * width)?;
    let mut failures = Vec::new();
    for (index, member) in members.into_iter().enumerate() {
        let missing = width * times.len() - member.states.len();
        states.extend(member.states);
        states.extend(std::iter::repeat_n(f64::NAN, missing));
        failures.extend(member.failed.map(|(time, why)| (index, time, why)));
    }
    Ok(Found {
        times,
        states,
        failures,
    })
}

/// The times, the states of members by rows, why some ended early, and what is to be noted of their starts.
pub type Saved<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray3<f64>>,
    Vec<Failed>,
    Option<String>,
);

/// Many trajectories, from the rows of an array.
pub fn ensemble<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    parameters: &PyReadonlyArray2<'py, f64>,
    starts: &PyReadonlyArray2<'py, f64>,
    (request, threads): (&Request, usize),
    progress: Option<Py<PyAny>>,
) -> PyResult<Saved<'py>> {
    let plan = arguments::checked(py, declaration, request, plan)?;
    if matches!(plan.pace.0, Pace::Tolerance(_)) && request.every.is_some() {
        let text =
            "with a tolerance each member has a step of its own: give at=[…] in place of every";
        return Err(PyTypeError::new_err(text));
    }
    let work = declaration.work(py, &plan.method, None)?;
    let rows = |array: &PyReadonlyArray2<'py, f64>| -> Vec<Vec<f64>> {
        let rows = array.as_array();
        rows.rows().into_iter().map(|row| row.to_vec()).collect()
    };
    let ensemble = Ensemble {
        plan,
        ends: request.every.is_none() && request.at.is_none(),
        parameters: rows(parameters),
        starts: rows(starts),
        threads,
    };
    let note = declaration.with_model(py, |model| note(model, &ensemble));
    let mut members = Vec::new();
    let progress = Progress::new("members", progress);
    let take = |found: Result<_, Exceeded>| {
        members = found?;
        Ok(())
    };
    let outcome = py.detach(|| converse(&work, ensemble, progress, take))?;
    match outcome {
        Outcome {
            interrupted: Some(error),
            ..
        } => return Err(error),
        Outcome {
            end: Some(End::Done),
            ..
        } => {}
        Outcome {
            end:
                Some(End::Refused {
                    what: Obstacle::Option,
                    why,
                }),
            ..
        } => return Err(PyValueError::new_err(why)),
        Outcome { end, .. } => {
            let text = format!("the ensemble ended early: {end:?}");
            return Err(PyRuntimeError::new_err(text));
        }
    }
    let found = collected(starts.shape()[1], members).map_err(of_system)?;
    let shape = [starts.shape()[0], found.times.len(), starts.shape()[1]];
    let states = found.states.into_pyarray(py).reshape(shape)?;
    Ok((found.times.into_pyarray(py), states, found.failures, note))
}

/// What is to be noted of the starts.
fn note(model: &Structure, ensemble: &Ensemble) -> Option<String> {
    let names = model.parameters.iter().map(|parameter| &parameter.name);
    // a row for each member, or one for all
    let rows = ensemble.parameters.iter().cycle().zip(&ensemble.starts);
    let starts = rows.map(|(values, state)| Start {
        parameters: names.clone().cloned().zip(values.iter().copied()).collect(),
        initial: state.clone(),
    });
    signs::note(model, starts.collect::<Vec<_>>().iter())
}
