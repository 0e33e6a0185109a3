//! The program behind `lie verify`.
//!
//! Further keys: `seed`, `step`. Lines: `ground <step> <span> <error of the references> <states> <linear
//! integrals> <quadratic integrals>`, then one `finding <label> <fact> <claim> <measured> <bound> <verdict> <note> <step>`
//! for each fact of each method.

use super::super::{Build, Tolerances};
use super::{Ended, Request, Session, main, prepare, serve};
use crate::diagnostics::AnyMethod;
use crate::diagnostics::verify::{Ground, Subject, Verdict, verify};
use crate::methods::Method;
use crate::parameter::ParameterError;
use crate::poisson::{LiePoisson, Lift};
use crate::scalar::Dual;
use std::io::{BufRead, Write};
use std::process::ExitCode;

type MakeSubject<P> = Box<dyn Fn() -> Subject<P>>;

/// A program that verifies methods on one system.
pub struct Verify<P: Lift<f64>> {
    defaults: Vec<f64>,
    build: Box<Build<P>>,
    with_orbits: fn(Ground<P>) -> Ground<P>,
    subjects: Vec<(&'static str, MakeSubject<P>)>,
}

impl<P: Lift<f64> + 'static> Verify<P> {
    /// A program from the default parameters and the function that makes a system of parameters.
    pub fn new(
        defaults: &[f64],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + 'static,
    ) -> Self {
        Self {
            defaults: defaults.to_vec(),
            build: Box::new(build),
            with_orbits: |ground| ground,
            subjects: Vec::new(),
        }
    }

    /// Measures the distance from coadjoint orbits too.
    #[must_use]
    pub fn with_orbits(self) -> Self
    where
        P: LiePoisson<f64>,
    {
        Self {
            with_orbits: Ground::with_orbits,
            ..self
        }
    }

    /// Adds a method under the name by which requests ask for it.
    #[must_use]
    pub fn method<M>(self, label: &'static str, make: impl Fn(&Tolerances) -> M + 'static) -> Self
    where
        M: Method<f64, P> + Method<Dual<f64>, P::Lifted> + 'static,
    {
        self.add(label, move || subject(&make, false))
    }

    /// Adds a method whose step consists of steps of another.
    #[must_use]
    pub fn composed<M>(self, label: &'static str, make: impl Fn(&Tolerances) -> M + 'static) -> Self
    where
        M: Method<f64, P> + Method<Dual<f64>, P::Lifted> + 'static,
    {
        self.add(label, move || subject(&make, true))
    }

    /// Adds a method that chooses its own steps.
    #[must_use]
    pub fn adaptive<M>(
        self,
        label: &'static str,
        make: impl Fn(&Tolerances) -> M + Copy + 'static,
    ) -> Self
    where
        M: Method<f64, P> + Method<Dual<f64>, P::Lifted> + 'static,
    {
        self.add(label, move || {
            let with_tolerance = move |tolerance| -> Box<dyn AnyMethod<f64, P>> {
                Box::new(make(&Tolerances {
                    rtol: tolerance,
                    atol: tolerance,
                }))
            };
            Subject {
                with_tolerance: Some(Box::new(with_tolerance)),
                ..subject(&make, false)
            }
        })
    }

    fn add(mut self, label: &'static str, make: impl Fn() -> Subject<P> + 'static) -> Self {
        self.subjects.push((label, Box::new(make)));
        self
    }

    /// Serves the request on standard input.
    pub fn main(&self) -> ExitCode {
        main(&self.defaults, &|request, session| {
            self.work(request, session)
        })
    }

    /// Serves one request; returns the exit code.
    pub fn serve(
        &self,
        input: impl BufRead + Send + 'static,
        mut output: impl Write,
        mut messages: impl Write,
    ) -> u8 {
        let work = |request: &Request, session: &mut Session<'_>| self.work(request, session);
        serve(
            None,
            &self.defaults,
            input,
            &mut output,
            &mut messages,
            &work,
        )
    }

    fn work(&self, request: &Request, session: &mut Session<'_>) -> Ended {
        let (system, mu) = prepare(&*self.build, &request.parameters, &request.initial)?;
        let seed = request.number("seed").unwrap_or(1.0) as u64;
        session.stage(0, request.methods.len() as u64, "the reference solution")?;
        let ground = Ground::new(&system, &mu, seed, request.number("step"))
            .map_err(|text| (2, format!("ground {text}")))?;
        let ground = (self.with_orbits)(ground);
        session.line(&[
            "ground",
            &format!("{:?}", ground.step),
            &format!("{:?}", ground.exact[0].span),
            &format!("{:?}", ground.exact[0].error),
            &ground.states.len().to_string(),
            &ground.linear.len().to_string(),
            &ground.quadratic.len().to_string(),
        ]);
        let lifted = system.lift();
        let all = request.methods.len() as u64;
        for (done, label) in request.methods.iter().enumerate() {
            session.stage(done as u64, all, label)?;
            let Some((_, make)) = self.subjects.iter().find(|(known, _)| known == label) else {
                return Err((2, format!("request no method `{label}` in this program")));
            };
            for finding in verify(&system, &lifted, &ground, &make()) {
                let verdict = match finding.verdict {
                    Verdict::Holds => "holds",
                    Verdict::Fails => "fails",
                    Verdict::NotClaimed => "not-claimed",
                    Verdict::Absent => "absent",
                };
                session.line(&[
                    "finding",
                    label,
                    finding.fact,
                    &format!("{:?}", finding.claim),
                    &format!("{:?}", finding.measured),
                    &format!("{:?}", finding.bound),
                    verdict,
                    &finding.note,
                    &format!("{:?}", finding.step),
                ]);
            }
        }
        Ok(())
    }
}

fn subject<P, M>(make: &impl Fn(&Tolerances) -> M, composed: bool) -> Subject<P>
where
    P: Lift<f64>,
    M: Method<f64, P> + Method<Dual<f64>, P::Lifted> + 'static,
{
    let tolerances = Tolerances::default();
    Subject {
        method: Box::new(make(&tolerances)),
        lifted: Box::new(make(&tolerances)),
        composed,
        with_tolerance: None,
    }
}
