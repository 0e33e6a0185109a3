//! Many trajectories on several threads. Each member is computed alone, so that the number of threads changes no bit.

use lie_codegen::methods::Choice;
use lie_dynamic::{Declared, Tolerances, method};
use lie_runtime::Poisson;
use lie_runtime::diagnostics::Forgotten;
use lie_runtime::driver::{
    Grid, Observer, Options, Problem, Progress, Save, SolveError, solve_observed,
};
use lie_runtime::newton::NewtonOptions;
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
type Failed = (usize, f64, String);

/// What is integrated.
pub struct Members<'a> {
    pub declared: &'a Declared,
    pub choice: &'a Choice,
    pub tolerances: Tolerances,
    pub newton: NewtonOptions,
    /// A row for each member, or one for all.
    pub parameters: Vec<Vec<f64>>,
    pub starts: Vec<Vec<f64>>,
    pub step: f64,
    pub end: f64,
}

impl Members<'_> {
    /// The ends one after the other, not numbers where a member failed, and the failures in order.
    pub fn run(&self, threads: usize) -> PyResult<(Vec<f64>, Vec<Failed>)> {
        Grid::new((0.0, self.end), self.step)
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        let threads = threads.clamp(1, self.starts.len().max(1));
        let share = (self.starts.len() / (threads * SHARES)).clamp(1, SHARE);
        let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
        let work = || {
            let mut done: Vec<(usize, Result<Vec<f64>, Failed>)> = Vec::new();
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
        let width = self.starts.first().map_or(0, Vec::len);
        let (mut ends, mut failures) = (Vec::with_capacity(all.len() * width), Vec::new());
        for (_, end) in all {
            match end {
                Ok(end) => ends.extend(end),
                Err(failed) => {
                    ends.extend(std::iter::repeat_n(f64::NAN, width));
                    failures.push(failed);
                }
            }
        }
        Ok((ends, failures))
    }

    fn member(&self, member: usize, stop: &AtomicBool) -> Result<Vec<f64>, Failed> {
        let failed = |time: f64, why: String| (member, time, why);
        let parameters = match self.parameters.as_slice() {
            [only] => only,
            all => &all[member],
        };
        let system = self.declared.system(parameters);
        let system = system.map_err(|error| failed(0.0, error.to_string()))?;
        let Some(method) = method::<f64>(self.choice, self.tolerances) else {
            return Err(failed(0.0, "there is no such method".to_owned()));
        };
        let problem = Problem {
            system,
            mu0: self.starts[member].clone(),
            span: (0.0, self.end),
        };
        let options = Options {
            newton: self.newton,
            ..Options::new(self.step).save(Save::Ends)
        };
        match solve_observed(&problem, Forgotten(method.as_ref()), &options, Stop(stop)) {
            Ok(mut solution) => solution
                .mu
                .pop()
                .ok_or_else(|| failed(0.0, "nothing was computed".to_owned())),
            Err(SolveError::Step { error, .. }) => Err(failed(error.time, error.to_string())),
            Err(SolveError::Option(error)) => Err(failed(0.0, error.to_string())),
        }
    }
}
