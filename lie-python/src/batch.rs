//! Many trajectories on several threads. Each member is computed alone, so that the number of threads changes no bit.

use crate::choice;
use crate::declaration::Declaration;
use lie_codegen::methods::Choice;
use lie_dynamic::{Declared, Tolerances, method};
use lie_runtime::Poisson;
use lie_runtime::diagnostics::Forgotten;
use lie_runtime::driver::{
    Observer, OptionError, Options, Pace, Problem, Progress, Save, Solution, SolveError,
    solve_observed,
};
use numpy::{IntoPyArray, PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods as _};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The most members that a thread takes at a time.
const SHARE: usize = 64;
/// Shares of each thread, so that none waits long for another.
const SHARES: usize = 8;

/// Ends a member where the whole is to end.
struct Stop<'a>(&'a AtomicBool);

impl<P: Poisson<f64>> Observer<f64, P> for Stop<'_> {
    fn step(&mut self, _system: &P, _progress: Progress, _mu: &P::State) -> ControlFlow<()> {
        match self.0.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// A member that ended early: its number, the time, why.
pub type Failed = (usize, f64, String);

/// What is integrated.
pub struct Members<'a> {
    pub declared: &'a Declared,
    pub choice: &'a Choice,
    pub tolerances: Tolerances,
    /// A row for each member, or one for all.
    pub parameters: Vec<Vec<f64>>,
    pub starts: Vec<Vec<f64>>,
    pub options: Options,
    pub end: f64,
}

/// The rows of a member, as many as it came to: times and states.
#[derive(Default)]
struct Member {
    times: Vec<f64>,
    states: Vec<Vec<f64>>,
    failed: Option<Failed>,
    /// Options that suit no member.
    refused: Option<OptionError>,
}

/// What all members gave: the times, the states member after member and row after row, what failed in order. Rows to which a
/// member did not come are not numbers.
pub struct Found {
    times: Vec<f64>,
    states: Vec<f64>,
    failures: Vec<Failed>,
}

impl Members<'_> {
    /// All members, on so many threads.
    pub fn run(&self, threads: usize) -> PyResult<Found> {
        let threads = threads.clamp(1, self.starts.len().max(1));
        let share = (self.starts.len() / (threads * SHARES)).clamp(1, SHARE);
        let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
        let work = || {
            let mut done: Vec<(usize, Member)> = Vec::new();
            loop {
                let first = next.fetch_add(share, Ordering::Relaxed);
                if first >= self.starts.len() || stop.load(Ordering::Relaxed) {
                    return done;
                }
                for member in first..(first + share).min(self.starts.len()) {
                    done.push((member, self.member(member, &stop)));
                }
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
            let mut interrupted = Ok(());
            while threads.iter().any(|thread| !thread.is_finished()) {
                std::thread::sleep(std::time::Duration::from_millis(1));
                if interrupted.is_ok() {
                    interrupted = Python::attach(|py| py.check_signals());
                    stop.store(interrupted.is_err(), Ordering::Relaxed);
                }
            }
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
        Ok(self.collected(all.into_iter().map(|(_, member)| member).collect()))
    }

    fn collected(&self, members: Vec<Member>) -> Found {
        let width = self.starts.first().map_or(0, Vec::len);
        let longest = members.iter().map(|member| &member.times);
        let times = longest.max_by_key(|times| times.len());
        let times = times.cloned().unwrap_or_default();
        let mut states = Vec::with_capacity(members.len() * times.len() * width);
        let mut failures = Vec::new();
        for member in members {
            let missing = times.len() - member.states.len();
            states.extend(member.states.into_iter().flatten());
            states.extend(std::iter::repeat_n(f64::NAN, missing * width));
            failures.extend(member.failed);
        }
        Found {
            times,
            states,
            failures,
        }
    }

    fn member(&self, member: usize, stop: &AtomicBool) -> Member {
        let failed = |time: f64, why: String| Member {
            failed: Some((member, time, why)),
            ..Member::default()
        };
        let parameters = match self.parameters.as_slice() {
            [only] => only,
            all => &all[member],
        };
        let system = match self.declared.system(parameters) {
            Ok(system) => system,
            Err(error) => return failed(0.0, error.to_string()),
        };
        let Some(method) = method::<f64>(self.choice, self.tolerances) else {
            return failed(0.0, "there is no such method".to_owned());
        };
        let problem = Problem {
            system,
            mu0: self.starts[member].clone(),
            span: (0.0, self.end),
        };
        let outcome = solve_observed(
            &problem,
            Forgotten(method.as_ref()),
            &self.options,
            Stop(stop),
        );
        match outcome {
            Ok(solution) => self.rows(solution, None),
            Err(SolveError::Step { error, solution }) => {
                let failed = (member, error.time, error.to_string());
                self.rows(*solution, Some(failed))
            }
            Err(SolveError::Option(error @ OptionError::NoStep(_))) => {
                failed(0.0, error.to_string())
            }
            Err(SolveError::Option(error)) => {
                stop.store(true, Ordering::Relaxed);
                Member {
                    refused: Some(error),
                    ..Member::default()
                }
            }
        }
    }

    /// What is kept of a solution: of the ends the last alone, and nothing where it was not reached.
    fn rows(&self, mut solution: Solution<f64, Vec<f64>>, failed: Option<Failed>) -> Member {
        if self.options.save == Save::Ends {
            let reached = failed.is_none();
            let first = match reached {
                true => solution.t.len().saturating_sub(1),
                false => solution.t.len(),
            };
            solution.t.drain(..first);
            solution.mu.drain(..first);
        }
        Member {
            times: solution.t,
            states: solution.mu,
            failed,
            refused: None,
        }
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
) -> PyResult<Saved<'py>> {
    let (choice, declared) = declaration.method(py, &asked.label)?;
    let tolerances = choice::tolerances(py, &choice, asked.tolerances, asked.pace.1)?;
    method::<f64>(&choice, tolerances).ok_or_else(|| choice::unsupported(py, &asked.label))?;
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
    let found = py.detach(|| members.run(asked.threads))?;
    let shape = [
        members.starts.len(),
        found.times.len(),
        starts.shape()[1],
    ];
    let states = found.states.into_pyarray(py).reshape(shape)?;
    Ok((found.times.into_pyarray(py), states, found.failures))
}
