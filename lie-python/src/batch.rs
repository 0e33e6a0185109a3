//! Many trajectories.

use crate::arguments;
use crate::declaration::Declaration;
use crate::errors::of_system;
use crate::progress::Progress;
use crate::talk::{Outcome, Who, converse};
use lie_codegen::structure::Structure;
use lie_in_process::draw::{Draw, Spread, keeps_norm};
use lie_in_process::ensemble::{self, Cast, Ensemble};
use lie_in_process::members::Member;
use lie_in_process::memory::{self, Exceeded};
use lie_in_process::report::signs;
use lie_in_process::request::{Request, plan};
use lie_program::protocol::{End, Event, Obstacle, Start};
use lie_runtime::driver::Pace;
use lie_runtime::lattice::count;
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2,
    PyUntypedArrayMethods as _,
};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::io;

/// A member that ended early: its number, the time, why.
pub type Failed = (usize, f64, String);

/// What all members gave: the states member after member and row after row, and what failed in order. Rows to which a member did not
/// come are not numbers.
struct Found {
    states: Vec<f64>,
    failures: Vec<Failed>,
    stops: Stops,
    events: Events,
}

/// Of each member the event that ended it, -1 where none did, and when.
#[derive(Default)]
struct Stops {
    events: Vec<i64>,
    times: Vec<f64>,
}

/// Events of members: of which, which of the declared ones, when, and the states there.
#[derive(Default)]
struct Events {
    members: Vec<i64>,
    events: Vec<i64>,
    times: Vec<f64>,
    states: Vec<f64>,
}

impl Events {
    fn add(&mut self, member: usize, own: Vec<Event>, names: &[String]) {
        for event in own {
            let place = names.iter().position(|name| *name == event.name);
            self.members.push(member as i64);
            self.events.push(place.map_or(-1, |place| place as i64));
            self.times.push(event.time);
            self.states.extend(event.state);
        }
    }

    fn arrays<'py>(self, py: Python<'py>, width: usize) -> PyResult<Occurrences<'py>> {
        let shape = [self.times.len(), width];
        Ok((
            self.members.into_pyarray(py),
            self.events.into_pyarray(py),
            self.times.into_pyarray(py),
            self.states.into_pyarray(py).reshape(shape)?,
        ))
    }
}

fn collected(size: usize, members: Vec<Member>, names: &[String]) -> io::Result<Found> {
    let mut states = Vec::new();
    memory::reserve(&mut states, members.len() * size)?;
    let mut failures = Vec::new();
    let (mut stops, mut events) = (Stops::default(), Events::default());
    for (index, member) in members.into_iter().enumerate() {
        let missing = size - member.states.len();
        states.extend(member.states);
        states.extend(std::iter::repeat_n(f64::NAN, missing));
        failures.extend(member.failed.map(|(time, why)| (index, time, why)));
        let stop = member.stopped;
        stops.events.push(stop.map_or(-1, |stop| stop.event as i64));
        stops.times.push(stop.map_or(f64::NAN, |stop| stop.time));
        events.add(index, member.events, names);
    }
    Ok(Found {
        states,
        failures,
        stops,
        events,
    })
}

/// Members, events by their places in the declaration, times, states.
type Occurrences<'py> = (
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
);

/// The times, the states of members by rows, why some ended early, what is to be noted of their starts, which event ended
/// each (-1 where none did) and when, and all events where they are kept.
pub type Saved<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray3<f64>>,
    Vec<Failed>,
    Option<String>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<f64>>,
    Occurrences<'py>,
);

/// Many trajectories, from the rows of an array.
pub fn ensemble<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    parameters: &PyReadonlyArray2<'py, f64>,
    starts: &PyReadonlyArray2<'py, f64>,
    (request, (threads, events)): (&Request, (usize, bool)),
    progress: Option<Py<PyAny>>,
) -> PyResult<Saved<'py>> {
    let plan = arguments::checked(py, declaration, request, plan)?;
    if matches!(plan.pace.0, Pace::Tolerance(_)) && request.every.is_some() {
        let text =
            "with a tolerance each member has a step of its own: give at=[…] in place of every";
        return Err(PyTypeError::new_err(text));
    }
    let compiled = declaration.work(py, &plan.method, None)?;
    let rows = |array: &PyReadonlyArray2<'py, f64>| -> Vec<Vec<f64>> {
        let rows = array.as_array();
        rows.rows().into_iter().map(|row| row.to_vec()).collect()
    };
    let ends = request.every.is_none() && request.at.is_none();
    let ensemble = Ensemble {
        plan,
        ends,
        cast: Cast {
            parameters: rows(parameters),
            starts: rows(starts),
            drawn: None,
        },
        some: 0..starts.shape()[0],
        threads,
        events,
    };
    ensemble.fits().map_err(|error| of_system(error.into()))?;
    let times = ensemble::times(&ensemble.plan, ends);
    let note = declaration.with_model(py, |model| note(model, &ensemble));
    let mut members: Vec<Member> = Vec::new();
    let progress = Progress::new("members", progress);
    let take = |found: Result<_, Exceeded>| {
        members.extend(found?);
        Ok(())
    };
    let asked = (&compiled.work, Who::Apart);
    let outcome = py.detach(|| converse(asked, ensemble, progress, take))?;
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
    let length = starts.shape()[1];
    let names = &declaration.facts.events;
    let found = collected(times.len() * length, members, names).map_err(of_system)?;
    // of a family the coordinates of its sites, which are first
    let parameters = parameters.as_array();
    let first = parameters.rows().into_iter().next().map(|row| row.to_vec());
    let width = declaration.with_model(py, |model| {
        let family = model.family.as_ref()?;
        Some(count(family.sites(&first?)?) * model.dimension())
    });
    let (mut states, width) = (found.states, width.unwrap_or(length));
    if width < length {
        let rows = states.chunks_exact(length);
        states = rows.flat_map(|row| &row[..width]).copied().collect();
    }
    let shape = [starts.shape()[0], times.len(), width];
    let states = states.into_pyarray(py).reshape(shape)?;
    Ok((
        times.into_pyarray(py),
        states,
        found.failures,
        note,
        found.stops.events.into_pyarray(py),
        found.stops.times.into_pyarray(py),
        found.events.arrays(py, length)?,
    ))
}

/// What is to be noted of the starts.
fn note(model: &Structure, ensemble: &Ensemble) -> Option<String> {
    let names = model.parameters.iter().map(|parameter| &parameter.name);
    // a row for each member, or one for all
    let rows = ensemble
        .cast
        .parameters
        .iter()
        .cycle()
        .zip(&ensemble.cast.starts);
    let starts = rows.map(|(values, state)| Start {
        parameters: names.clone().cloned().zip(values.iter().copied()).collect(),
        initial: state.clone(),
    });
    signs::note(model, starts.collect::<Vec<_>>().iter())
}

/// States drawn around one: how many, by which seed, and how far they go, nothing for the whole orbit.
pub fn drawn<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    parameters: &PyReadonlyArray2<'py, f64>,
    around: &[f64],
    (count, seed, far): (usize, u64, Option<f64>),
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let orbits = declaration.with_model(py, |model| model.is_lie_poisson());
    let draw = Draw {
        count,
        seed,
        spread: far.map_or(Spread::Orbit, Spread::Normal),
    };
    let rows = parameters.as_array();
    let rows: Vec<Vec<f64>> = rows.rows().into_iter().map(|row| row.to_vec()).collect();
    let systems = rows.iter().map(|values| declaration.system(py, values));
    let systems: Vec<_> = systems.collect::<PyResult<_>>()?;
    if far.is_none() && !(orbits && systems.iter().all(keeps_norm)) {
        let text = "the orbits have no uniform distribution in these coordinates: the group does not keep their Euclidean norm\n  help: \
                    give a standard deviation, such as spread=0.1";
        return Err(PyValueError::new_err(text));
    }
    let within: Vec<_> = systems
        .iter()
        .map(|system| draw.within(system, orbits))
        .collect();
    let numbers =
        (0..count).flat_map(|member| within[member % within.len()].state(around, member as u64));
    let numbers: Vec<f64> = numbers.collect();
    numbers.into_pyarray(py).reshape([count, around.len()])
}
