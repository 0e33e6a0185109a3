//! Lyapunov exponents, and the lines of a signal.

use crate::arguments;
use crate::declaration::Declaration;
use crate::progress::Progress;
use crate::talk::{Who, converse};
use lie_in_process::exponents::{Asked, Measurement};
use lie_in_process::request::{Request, Value};
use lie_program::protocol::End;
use lie_spectra::frequencies::{self, Options};
use pyo3::prelude::*;
use std::sync::Arc;

/// What was found of exponents.
#[derive(IntoPyObject)]
pub struct Found {
    /// As `lie exponents --json` says it; none where Ctrl-C came first.
    json: Option<String>,
    complete: bool,
    /// The step that failed, the time before it, why, and a remedy.
    stopped: Option<(u64, f64, String, String)>,
}

/// Lyapunov exponents along an orbit, but for a time at its start, all of them or so many.
pub fn exponents(
    py: Python<'_>,
    declaration: &Declaration,
    request: &Request,
    (transient, count): (f64, Option<u32>),
    progress: Option<Py<PyAny>>,
) -> PyResult<Found> {
    let asked = Asked {
        transient: Some(Value::Number(transient)),
        count: count.map(|count| Value::Number(count.into())),
    };
    let (measurement, work) = arguments::checked(py, declaration, request, |spec, request| {
        Measurement::new(spec, request, &asked)
    })?;
    let (spec, work) = (declaration.spec(), Arc::new(work));
    py.detach(|| {
        let mut json = None;
        let take = |spectrum| {
            json = Some(measurement.as_json(&spec, &spectrum).to_string());
            Ok(())
        };
        let progress = Progress::new("steps", progress);
        let outcome = converse((&work, Who::Apart), measurement.clone(), progress, take)?;
        let (complete, stopped) = match outcome.end {
            Some(End::Stopped(stop)) => {
                (true, Some((stop.step, stop.time, stop.reason, stop.remedy)))
            }
            _ => (outcome.whole(&spec.model)?, None),
        };
        Ok(Found {
            json,
            complete,
            stopped,
        })
    })
}

/// A line: angular frequency, amplitude, phase, the frequencies of both halves.
type Line = (f64, f64, f64, [f64; 2]);

/// The mean of a signal, its lines, and what is left of it; nothing where its times are at no equal distances.
#[pyfunction]
pub fn lines(
    py: Python<'_>,
    times: Vec<f64>,
    values: Vec<f64>,
    count: usize,
    window: u8,
) -> Option<(f64, Vec<Line>, f64)> {
    py.detach(|| {
        let (distance, samples) = frequencies::even(&times)?;
        let options = Options { count, window };
        let found = frequencies::frequencies(values.get(..samples)?, distance, options);
        let lines = found.lines.iter();
        let lines = lines.map(|line| (line.frequency, line.amplitude, line.phase, line.halves));
        Some((found.mean, lines.collect(), found.rest))
    })
}
