//! The main function of a program built for one system: requests on standard input, rows on
//! standard output.
//!
//! Requests are lines: `method <id>`, `step <h>`, `until <T>` or `at <t>` (repeated), `every <k>`,
//! `parameter <index> <value>`, `initial <v1> <v2> …`, `rtol <r>`, `atol <a>`, then `run`. When the
//! input ends after `run`, the run stops at the next step and keeps its rows; a program whose step does not
//! end within ten seconds ends then without it. So no program outlives the command that started it, however
//! that one was ended.
//!
//! Rows are little-endian f64: t, the coordinates, the energy, the Casimirs, and the group element where a
//! method reconstructs it; they are flushed at
//! least every 0.2 s while steps are being done. Messages are lines on standard error:
//!
//! | line | exit code |
//! |---|---|
//! | `progress <steps done> <steps in all>`, at most ten per second | |
//! | `done steps=… evaluations=… newton=… accepted=… rejected=…` | 0 |
//! | `output <text>`: rows could not be written | 1 |
//! | `request <text>`, `option <text>`, `parameter <name> <text>`, `initial <text>` | 2 |
//! | `failed step=… time=… iterations=… residual=… reason=<text> remedy=<text>` | 3 |
//! | `interrupted`, and the same figures | 130 |

pub mod measure;
mod request;
mod rows;

use crate::driver::{
    Chart, IntegrateError, Options, Problem, Reconstruction, Stats, Status, integrate,
};
use crate::methods::Method;
use crate::parameter::ParameterError;
#[cfg(test)]
use crate::parameter::ParameterFault;
use crate::poisson::Poisson;
use crate::state::State;
use crate::structure::MatrixGroup;
pub use request::Tolerances;
use request::{Request, RequestError};
use rows::{OnGroup, RowWriter};
use std::io::{self, BufRead, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How long a step may take after the input has ended.
const GRACE: Duration = Duration::from_secs(10);

type Build<P> = dyn Fn(&[f64]) -> Result<P, ParameterError>;

type Run<P> = dyn Fn(
    &Tolerances,
    &Problem<f64, P>,
    &Options,
    &mut RowWriter<'_>,
) -> Result<(Stats, Status), IntegrateError>;

/// A program for one system and some methods.
pub struct Program<P: Poisson<f64>> {
    defaults: Vec<f64>,
    build: Box<Build<P>>,
    methods: Vec<(&'static str, Box<Run<P>>)>,
}

impl<P: Poisson<f64>> Program<P> {
    /// A program from the default parameters and the function that makes a system of parameters.
    pub fn new(
        defaults: &[f64],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + 'static,
    ) -> Self {
        Self {
            defaults: defaults.to_vec(),
            build: Box::new(build),
            methods: Vec::new(),
        }
    }

    /// Adds a method under the name by which requests ask for it.
    #[must_use]
    pub fn method<M: Method<f64, P>>(
        mut self,
        id: &'static str,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self {
        let run: Box<Run<P>> = Box::new(move |tolerances, problem, options, rows| {
            integrate(problem, make(tolerances), options, rows)
        });
        self.methods.push((id, run));
        self
    }

    /// Adds a method that also moves the group element, whose entries follow in each row.
    #[must_use]
    pub fn on_group<M: Method<f64, P>>(
        mut self,
        id: &'static str,
        chart: Chart,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self
    where
        P: MatrixGroup<f64>,
    {
        let run: Box<Run<P>> = Box::new(move |tolerances, problem, options, rows| {
            let reconstruction = Reconstruction::new(&problem.system, chart);
            let mut rows = OnGroup {
                reconstruction,
                rows,
            };
            integrate(problem, make(tolerances), options, &mut rows)
        });
        self.methods.push((id, run));
        self
    }

    /// Serves the request on standard input.
    pub fn main(&self) -> ExitCode {
        let input = io::BufReader::new(io::stdin());
        let messages = io::stderr();
        ExitCode::from(self.serve_within(Some(GRACE), input, io::stdout().lock(), messages))
    }

    /// Serves one request; returns the exit code.
    pub fn serve(
        &self,
        input: impl BufRead + Send + 'static,
        output: impl Write,
        messages: impl Write,
    ) -> u8 {
        self.serve_within(None, input, output, messages)
    }

    fn serve_within(
        &self,
        grace: Option<Duration>,
        mut input: impl BufRead + Send + 'static,
        output: impl Write,
        mut messages: impl Write,
    ) -> u8 {
        let request = match Request::read(&mut input, &self.defaults) {
            Ok(request) => request,
            Err(RequestError::Ended) => return 130,
            Err(RequestError::Wrong(text)) => {
                return say(&mut messages, 2, &format!("request {text}"));
            }
        };
        let interrupted = lifeline(input, grace);
        let mut output = io::BufWriter::with_capacity(1 << 16, output);
        let (code, message) = self.run(&request, &mut output, &mut messages, &interrupted);
        say(&mut messages, code, &message)
    }

    fn run(
        &self,
        request: &Request,
        output: &mut dyn Write,
        messages: &mut dyn Write,
        interrupted: &AtomicBool,
    ) -> (u8, String) {
        let Some((_, run)) = self.methods.iter().find(|(id, _)| *id == request.method) else {
            return (
                2,
                format!("request no method `{}` in this program", request.method),
            );
        };
        let system = match (self.build)(&request.parameters) {
            Ok(system) => system,
            Err(error) => return (2, format!("parameter {} {error}", error.name)),
        };
        if request.initial.len() != system.dimension() {
            let given = request.initial.len();
            return (
                2,
                format!(
                    "initial {given} values where {} are needed",
                    system.dimension()
                ),
            );
        }
        let mut mu0 = system.zero_state();
        mu0.as_mut_slice().copy_from_slice(&request.initial);
        let problem = Problem {
            system,
            mu0,
            span: (0.0, request.end()),
        };
        let mut rows = RowWriter::new(&problem.system, output, messages, interrupted);
        let outcome = run(&request.tolerances, &problem, &request.options(), &mut rows);
        if let Err(error) = rows.finish() {
            return (1, format!("output {error}"));
        }
        match outcome {
            Ok((stats, Status::Finished)) => (0, format!("done {}", figures(&stats))),
            Ok((stats, _)) => (130, format!("interrupted {}", figures(&stats))),
            Err(IntegrateError::Option(error)) => (2, format!("option {error}")),
            Err(IntegrateError::Step(error)) => {
                let report = error.failure.report;
                let reason = error.failure.reason;
                let message = format!(
                    "failed step={} time={:?} iterations={} residual={:?} reason={reason} remedy={}",
                    error.step,
                    error.time,
                    report.iterations,
                    report.residual,
                    error.remedy(),
                );
                (3, message)
            }
        }
    }
}

/// Becomes true when the input ends. What is still running after the grace is ended with the process.
fn lifeline(mut input: impl BufRead + Send + 'static, grace: Option<Duration>) -> Arc<AtomicBool> {
    let ended = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&ended);
    std::thread::spawn(move || {
        // an error of the input ends the run as its end does
        let _ = io::copy(&mut input, &mut io::sink());
        flag.store(true, Ordering::Relaxed);
        if let Some(grace) = grace {
            std::thread::sleep(grace);
            std::process::exit(130);
        }
    });
    ended
}

fn figures(stats: &Stats) -> String {
    let Stats {
        steps,
        evaluations,
        newton,
        accepted,
        rejected,
        ..
    } = stats;
    format!(
        "steps={steps} evaluations={evaluations} newton={newton} accepted={accepted} rejected={rejected}"
    )
}

/// Prints the last line. Where nobody listens any more, the exit code has to do.
fn say(messages: &mut dyn Write, code: u8, text: &str) -> u8 {
    let _ = writeln!(messages, "{text}").and_then(|()| messages.flush());
    code
}

#[cfg(test)]
mod tests;
