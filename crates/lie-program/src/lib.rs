//! Programs that the command builds for one system: that of `lie run`, and what it shares with others.
//!
//! [`protocol`] is what command and programs say to each other, as types of both sides; [`listen`](mod@listen) is the
//! side of the command, [`session`] that of the programs. Nobody who integrates with `lie-runtime` depends on this crate.
//!
//! | the program ends with | exit code |
//! |---|---|
//! | all rows | 0 |
//! | rows that could not be written | 1 |
//! | a request that cannot be served | 2 |
//! | a step that failed: the rows so far are written | 3 |
//! | its input, before the run was over | 130 |

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod blueprint;
pub mod listen;
pub mod protocol;
mod rows;
pub mod session;
#[cfg(feature = "sources")]
pub mod sources;

use blueprint::{Blueprint, Built};
use lie_runtime::diagnostics::{AnyMethod, Forgotten};
use lie_runtime::driver::{
    Chart, IntegrateError, Milestone, Observer, OptionError, Options, Problem, Reconstruction,
    Stats, Status, integrate, take_up,
};
use lie_runtime::methods::Method;
use lie_runtime::{MatrixGroup, ParameterError, Poisson};
pub use protocol::Tolerances;
use protocol::{End, Found, Milestones, Obstacle, Run, Stop, Work};
use rows::OnGroup;
pub use rows::{RowWriter, shown};
use session::Session;
use std::io::{BufRead, Write};
use std::process::ExitCode;
use std::time::Duration;

/// How long a step may take after the input has ended.
const GRACE: Duration = Duration::from_secs(10);

type Integrate<P> = dyn Fn(
    &Tolerances,
    &Problem<f64, P>,
    &Options,
    Option<Option<&TakenUp<P>>>,
    &[f64],
    &mut RowWriter<'_, '_>,
) -> Result<(Stats, Status), IntegrateError>;

/// Where a run is taken up, with the memory of what follows the group element.
type TakenUp<P> = (Milestone<<P as Poisson<f64>>::State>, Vec<f64>);

/// A program for one system and some methods.
pub struct Program<P: Poisson<f64>> {
    blueprint: Blueprint<P>,
    methods: Vec<(String, Box<Integrate<P>>)>,
}

impl<P: Poisson<f64>> Program<P> {
    /// A program from the parameters with their defaults and the function that makes a system of their values.
    pub fn new(
        parameters: &[(&str, f64)],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync + 'static,
    ) -> Self {
        Self {
            blueprint: Blueprint::new(parameters, build),
            methods: Vec::new(),
        }
    }

    /// Adds a method under the name by which requests ask for it.
    #[must_use]
    pub fn method<M: Method<f64, P>>(
        mut self,
        id: &str,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self {
        let run: Box<Integrate<P>> =
            Box::new(move |tolerances, problem, options, from, _, rows| {
                let from = milestone::<P>(from);
                go(problem, make(tolerances), options, from, rows)
            });
        self.methods.push((id.to_owned(), run));
        self
    }

    /// Adds a method whose type is forgotten.
    #[must_use]
    pub fn any_method(
        mut self,
        id: &str,
        make: impl Fn(&Tolerances) -> Box<dyn AnyMethod<f64, P>> + 'static,
    ) -> Self {
        let run: Box<Integrate<P>> =
            Box::new(move |tolerances, problem, options, from, _, rows| {
                let method = make(tolerances);
                let from = milestone::<P>(from);
                go(problem, Forgotten(method.as_ref()), options, from, rows)
            });
        self.methods.push((id.to_owned(), run));
        self
    }

    /// Adds a method that also moves the group element, whose entries follow in each row.
    #[must_use]
    pub fn on_group<M: Method<f64, P>>(
        mut self,
        id: &str,
        chart: Chart,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self
    where
        P: MatrixGroup<f64>,
    {
        let run: Box<Integrate<P>> =
            Box::new(move |tolerances, problem, options, from, element, rows| {
                let mut rows = on_group(&problem.system, chart, (from, element), rows)?;
                let from = milestone::<P>(from);
                go(problem, make(tolerances), options, from, &mut rows)
            });
        self.methods.push((id.to_owned(), run));
        self
    }

    /// The same of a method whose type is forgotten.
    #[must_use]
    pub fn any_on_group(
        mut self,
        id: &str,
        chart: Chart,
        make: impl Fn(&Tolerances) -> Box<dyn AnyMethod<f64, P>> + 'static,
    ) -> Self
    where
        P: MatrixGroup<f64>,
    {
        let run: Box<Integrate<P>> =
            Box::new(move |tolerances, problem, options, from, element, rows| {
                let mut rows = on_group(&problem.system, chart, (from, element), rows)?;
                let from = milestone::<P>(from);
                let method = make(tolerances);
                go(
                    problem,
                    Forgotten(method.as_ref()),
                    options,
                    from,
                    &mut rows,
                )
            });
        self.methods.push((id.to_owned(), run));
        self
    }

    /// Serves the request on standard input.
    pub fn main(&self) -> ExitCode {
        main(&|request, session| self.run(&request, session))
    }

    /// Serves one request; returns the exit code.
    pub fn serve(&self, input: impl BufRead + Send + 'static, output: &mut dyn Write) -> u8 {
        serve(Box::new(input), output, &|request, session| {
            self.run(&request, session)
        })
    }

    /// Does what is asked for.
    ///
    /// # Errors
    /// Why the run did not come to its end.
    pub fn run(&self, request: &Run, session: &mut Session<'_, Found>) -> Result<(), End> {
        let known = self.methods.iter().find(|(id, _)| id == &request.method);
        let (_, run) = known.ok_or_else(|| session::no_method(&request.method))?;
        let Built { system, mu } = self.blueprint.build(&request.start)?;
        let problem = Problem {
            system,
            mu0: mu,
            span: request.span(),
        };
        let from = match &request.from_milestone {
            Some(written) => {
                let milestone = written.of(&problem.system).ok_or_else(foreign)?;
                Some((milestone, written.element()))
            }
            None => None,
        };
        let last = from.as_ref().map_or(0, |(milestone, _)| milestone.index);
        let mut rows = RowWriter::new(&problem.system, session)
            .saying(request.milestones, last)
            .holding(
                request
                    .held
                    .of(&problem.system, problem.span.0, &request.sources),
            )
            .curve(request.curve);
        if let Some(milestone) = &request.from_milestone {
            rows.take_up(milestone);
        }
        let options = request.options();
        let wanted = from.is_some() || request.milestones != Milestones::None;
        let outcome = run(
            &request.tolerances,
            &problem,
            &options,
            wanted.then_some(from.as_ref()),
            &request.element,
            &mut rows,
        );
        rows.finish();
        session.intact()?;
        let (stats, status) = outcome.map_err(refusal)?;
        session.mentions(Found::Work(Work::from(&stats)));
        match status {
            Status::Finished | Status::Event(_) => Ok(()),
            Status::Stopped | Status::Failed => Err(End::Interrupted),
        }
    }
}

/// What reads requests and writes messages, compiled here and not with every system.
fn main(work: &session::Work<'_, Run, Found>) -> ExitCode {
    session::main(GRACE, work)
}

fn serve(
    input: Box<dyn BufRead + Send>,
    output: &mut dyn Write,
    work: &session::Work<'_, Run, Found>,
) -> u8 {
    session::serve(None, input, output, work)
}

/// Where a run with milestones begins: at one of them, or at the start; none of a run without.
type Beginning<'f, V> = Option<Option<&'f Milestone<V>>>;

/// Makes a run with milestones, from one of them, or without.
fn go<P: Poisson<f64>, M: Method<f64, P>>(
    problem: &Problem<f64, P>,
    method: M,
    options: &Options,
    from: Beginning<'_, P::State>,
    rows: &mut impl Observer<f64, P>,
) -> Result<(Stats, Status), IntegrateError> {
    match from {
        Some(milestone) => take_up(problem, method, options, milestone, rows),
        None => integrate(problem, method, options, rows),
    }
}

/// What writes rows with the group element, which begins where it was at a milestone, else at the element that is given for the
/// start.
fn on_group<'r, 's, 'o, P: MatrixGroup<f64>>(
    system: &P,
    chart: Chart,
    (from, element): (Option<Option<&TakenUp<P>>>, &[f64]),
    rows: &'r mut RowWriter<'s, 'o>,
) -> Result<OnGroup<'r, 's, 'o, P::State>, IntegrateError> {
    let mut reconstruction = Reconstruction::new(system, chart);
    if let Some(Some((_, memory))) = from {
        let there = reconstruction.beginning_at(memory);
        reconstruction = there.ok_or(OptionError::Milestone("its group element is another one"))?;
    } else if !element.is_empty() {
        let there = reconstruction.at(element);
        reconstruction = there.ok_or(OptionError::Element)?;
    }
    Ok(OnGroup {
        reconstruction,
        rows,
    })
}

/// The milestone without the group element.
fn milestone<P: Poisson<f64>>(from: Option<Option<&TakenUp<P>>>) -> Beginning<'_, P::State> {
    from.map(|from| from.map(|(milestone, _)| milestone))
}

/// The refusal of a milestone of another system.
fn foreign() -> End {
    let error = OptionError::Milestone("its state has another length");
    End::refused(Obstacle::Milestone, error.to_string())
}

/// Why a run did not come to its end.
fn refusal(error: IntegrateError) -> End {
    match error {
        IntegrateError::Option(error @ OptionError::Milestone(_)) => {
            End::refused(Obstacle::Milestone, error.to_string())
        }
        IntegrateError::Option(error @ OptionError::Keep(_)) => {
            End::refused(Obstacle::Keep, error.to_string())
        }
        IntegrateError::Option(error) => End::refused(Obstacle::Option, error.to_string()),
        IntegrateError::Step(error) => End::Stopped(Stop {
            step: error.step,
            time: error.time,
            iterations: error.failure.report.iterations,
            residual: error.failure.report.residual,
            reason: error.failure.reason.to_string(),
            remedy: error.remedy().to_string(),
        }),
    }
}

#[cfg(test)]
mod tests;
