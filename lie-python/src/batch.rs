//! Many trajectories on several threads. The bits of a member depend neither on the number of threads nor on the members
//! beside it.

use crate::choice;
use crate::declaration::Declaration;
use crate::progress::Progress;
use lie_dynamic::method;
use lie_in_process::members::{LANES, Member, Members, Watch};
use lie_runtime::driver::{Options, Pace, Save};
use numpy::{
    IntoPyArray, PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods as _,
};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The most members that a thread takes at a time.
const SHARE: usize = 64;
/// Shares of each thread, so that none waits long for another.
const SHARES: usize = 8;

/// A member that ended early: its number, the time, why.
pub type Failed = (usize, f64, String);

/// What all members gave: the times, the states member after member and row after row, what failed in order. Rows to which a
/// member did not come are not numbers.
pub struct Found {
    times: Vec<f64>,
    states: Vec<f64>,
    failures: Vec<Failed>,
}

/// How many of so many members a thread takes at a time: as many as there are lanes, or less where some threads had none.
fn share(count: usize, threads: usize) -> usize {
    let lanes = count.div_ceil(threads).clamp(1, LANES);
    let groups = count / (threads * SHARES * lanes);
    lanes * groups.clamp(1, SHARE / LANES)
}

/// All members, on so many threads.
fn run(members: &Members<'_>, threads: usize, mut progress: Progress) -> PyResult<Found> {
    let threads = threads.clamp(1, members.starts.len().max(1));
    let share = share(members.starts.len(), threads);
    let (next, watch) = (AtomicUsize::new(0), Watch::default());
    let work = || {
        let mut done: Vec<(usize, Member)> = Vec::new();
        loop {
            let first = next.fetch_add(share, Ordering::Relaxed);
            if first >= members.starts.len() || watch.stop.load(Ordering::Relaxed) {
                return done;
            }
            let last = (first + share).min(members.starts.len());
            done.extend((first..last).zip(members.run(first..last, &watch)));
        }
    };
    let (found, interrupted) = std::thread::scope(|scope| {
        // where the machine gives fewer threads, these do it all
        let spawn = |_| std::thread::Builder::new().spawn_scoped(scope, work).ok();
        let threads: Vec<_> = (0..threads).map_while(spawn).collect();
        if threads.is_empty() {
            let error = PyRuntimeError::new_err("the machine gives no thread");
            return (Ok(Vec::new()), Err(error));
        }
        let all = members.starts.len() as u64;
        let mut interrupted = progress.say(0, all);
        while threads.iter().any(|thread| !thread.is_finished()) {
            std::thread::sleep(std::time::Duration::from_millis(1));
            if interrupted.is_ok() {
                let done = watch.done.load(Ordering::Relaxed) as u64;
                interrupted = Python::attach(|py| py.check_signals());
                interrupted = interrupted.and_then(|()| progress.tell(done, all));
            }
            watch.stop.fetch_or(interrupted.is_err(), Ordering::Relaxed);
        }
        let interrupted = interrupted.and_then(|()| progress.end());
        let found = threads.into_iter().map(|thread| thread.join());
        (found.collect::<Result<Vec<_>, _>>(), interrupted)
    });
    interrupted?;
    let found = found.map_err(|_| PyValueError::new_err("a thread of the ensemble failed"))?;
    let mut all: Vec<_> = found.into_iter().flatten().collect();
    all.sort_by_key(|(member, _)| *member);
    if let Some(error) = all.iter().find_map(|(_, member)| member.refused.as_ref()) {
        return Err(PyValueError::new_err(error.to_string()));
    }
    Ok(collected(
        members.starts.first().map_or(0, Vec::len),
        all.into_iter().map(|(_, member)| member).collect(),
    ))
}

fn collected(width: usize, members: Vec<Member>) -> Found {
    let longest = members.iter().map(|member| &member.times);
    let times = longest.max_by_key(|times| times.len());
    let times = times.cloned().unwrap_or_default();
    let mut states = Vec::with_capacity(members.len() * times.len() * width);
    let mut failures = Vec::new();
    for (index, member) in members.into_iter().enumerate() {
        let missing = width * times.len() - member.states.len();
        states.extend(member.states);
        states.extend(std::iter::repeat_n(f64::NAN, missing));
        failures.extend(member.failed.map(|(time, why)| (index, time, why)));
    }
    Found {
        times,
        states,
        failures,
    }
}
/// What is asked for: a dictionary of Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    label: String,
    /// The step, or the tolerance in its place.
    pace: (Option<f64>, Option<f64>),
    end: f64,
    /// The ends alone where neither of the two is given.
    every: Option<u64>,
    at: Option<Vec<f64>>,
    threads: usize,
    tolerances: (Option<f64>, Option<f64>),
    solver: choice::Solver,
}

/// The times, the states of members by rows, and why some ended early.
pub type Saved<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray3<f64>>,
    Vec<Failed>,
);

/// Many trajectories.
pub fn ensemble<'py>(
    py: Python<'py>,
    declaration: &Declaration,
    parameters: &PyReadonlyArray2<'py, f64>,
    starts: &PyReadonlyArray2<'py, f64>,
    asked: Asked,
    progress: Option<Py<PyAny>>,
) -> PyResult<Saved<'py>> {
    let (choice, declared) = declaration.method(py, &asked.label)?;
    let tolerances = choice::tolerances(py, &choice, asked.tolerances, asked.pace.1)?;
    method(&choice, tolerances).ok_or_else(|| choice::unsupported(py, &asked.label))?;
    let rows = |array: &PyReadonlyArray2<'py, f64>| -> Vec<Vec<f64>> {
        let rows = array.as_array();
        rows.rows().into_iter().map(|row| row.to_vec()).collect()
    };
    let options = Options {
        pace: match asked.pace {
            (_, Some(tolerance)) => Pace::Tolerance(tolerance),
            (step, None) => Pace::Step(step.unwrap_or(0.01)),
        },
        save: match (asked.every, asked.at) {
            (_, Some(times)) => Save::At(times),
            (Some(every), None) => Save::Every(every),
            (None, None) => Save::Ends,
        },
        newton: asked.solver.options(py, &choice, asked.pace.1.is_some())?,
        assess: false,
    };
    let members = Members {
        declared: &declared,
        choice: &choice,
        tolerances,
        parameters: rows(parameters),
        starts: rows(starts),
        options,
        end: asked.end,
    };
    let found = py.detach(|| run(&members, asked.threads, Progress::of("members", progress)))?;
    let shape = [members.starts.len(), found.times.len(), starts.shape()[1]];
    let states = found.states.into_pyarray(py).reshape(shape)?;
    Ok((found.times.into_pyarray(py), states, found.failures))
}
