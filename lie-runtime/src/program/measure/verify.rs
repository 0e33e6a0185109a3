//! The program behind `lie verify`.
//!
//! Further keys: `seed`, `step`. Lines: `ground <step> <span> <error of the references> <states> <linear
//! integrals> <quadratic integrals>`, then the kernels at the states (see [`super::kernels`]), the end of the reference
//! solution from each (`reference <span> <start> <end>`), one `broken <fact>` for each measurement that lets a spoiled map
//! pass, one `unsound <what>` for each part of the iteration that does not solve an equation with a known solution, and one `finding <label> <fact> <claim> <measured> <bound> <verdict> <note> <step>` for each fact of each method.

use super::super::{Build, Tolerances};
use super::kernels::{self, Kernels};
use super::{Ended, Request, Session, driven, main, prepare, serve};
use crate::diagnostics::AnyMethod;
use crate::diagnostics::random::Random;
use crate::diagnostics::verify::{
    Finding, Ground, PlainSteps, Subject, Verdict, broken_comparison, broken_measurements,
    unsound_iterations, verify,
};
use crate::lagrangian::{DiscreteLagrangianPoisson, LagrangianPoisson};
use crate::methods::Method;
use crate::newton::NewtonOptions;
use crate::parameter::ParameterError;
use crate::poisson::{CayleyPoisson, LiePoisson, Lift, Poisson};
use crate::scalar::Dual;
use crate::state::State;
use crate::structure::{MatrixGroup, RealizedPoisson};
use std::io::{BufRead, Write};
use std::process::ExitCode;

type MakeSubject<P> = Box<dyn Fn() -> Subject<P>>;
type MakePlain = Box<dyn Fn(&[f64]) -> Option<Box<PlainSteps>>>;

/// A program that verifies methods on one system.
pub struct Verify<P: Lift<f64>> {
    defaults: Vec<f64>,
    build: Box<Build<P>>,
    grounds: Vec<fn(Ground<P>) -> Ground<P>>,
    kernels: Vec<Kernels<P>>,
    subjects: Vec<(&'static str, MakeSubject<P>)>,
    plain: Vec<(&'static str, MakePlain)>,
    beside: Vec<&'static str>,
}

impl<P: Lift<f64> + Clone + 'static> Verify<P> {
    /// A program from the default parameters and the function that makes a system of parameters.
    pub fn new(
        defaults: &[f64],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + 'static,
    ) -> Self {
        Self {
            defaults: defaults.to_vec(),
            build: Box::new(build),
            grounds: Vec::new(),
            kernels: vec![kernels::poisson],
            subjects: Vec::new(),
            plain: Vec::new(),
            beside: Vec::new(),
        }
    }

    /// Measures the distance from coadjoint orbits too, and writes the kernels of the algebra.
    #[must_use]
    pub fn with_orbits(mut self) -> Self
    where
        P: LiePoisson<f64>,
    {
        self.grounds.push(Ground::with_orbits);
        self.kernels.push(kernels::algebra);
        self
    }

    /// Follows the group element too.
    #[must_use]
    pub fn with_group(mut self) -> Self
    where
        P: MatrixGroup<f64>,
    {
        self.grounds.push(Ground::with_group);
        self
    }

    /// Writes the kernel of the Cayley map.
    #[must_use]
    pub fn with_cayley(mut self) -> Self
    where
        P: CayleyPoisson<f64>,
    {
        self.kernels.push(kernels::cayley);
        self
    }

    /// Writes the kernels of the Lagrangian.
    #[must_use]
    pub fn with_lagrangian(mut self) -> Self
    where
        P: LagrangianPoisson<f64>,
    {
        self.kernels.push(kernels::lagrangian);
        self
    }

    /// Writes the kernels of the discrete Lagrangian.
    #[must_use]
    pub fn with_discrete(mut self) -> Self
    where
        P: DiscreteLagrangianPoisson<f64>,
    {
        self.kernels.push(kernels::discrete);
        self
    }

    /// Writes the kernels of the realization.
    #[must_use]
    pub fn with_realization(mut self) -> Self
    where
        P: RealizedPoisson<f64>,
    {
        self.kernels.push(kernels::realization);
        self
    }

    /// Compares the steps of a method with those on another system, the same one without fused equations.
    #[must_use]
    pub fn plain<Q, M>(
        mut self,
        label: &'static str,
        build: impl Fn(&[f64]) -> Result<Q, ParameterError> + 'static,
        make: impl Fn(&Tolerances) -> M + Copy + 'static,
    ) -> Self
    where
        Q: Poisson<f64> + 'static,
        M: Method<f64, Q> + 'static,
    {
        let steps = move |parameters: &[f64]| -> Option<Box<PlainSteps>> {
            let system = build(parameters).ok()?;
            let method: Box<dyn AnyMethod<f64, Q>> = Box::new(make(&Tolerances::default()));
            Some(Box::new(move |start, h, steps| {
                let mut mu = system.zero_state();
                mu.as_mut_slice().copy_from_slice(start);
                let mut stepper = method.any_stepper(&system, h, &NewtonOptions::default());
                let mut iterations = 0;
                for _ in 0..steps {
                    iterations += stepper.step(&mut mu)?.iterations;
                }
                Ok((mu.as_slice().to_vec(), iterations))
            }))
        };
        self.plain.push((label, Box::new(steps)));
        self
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

    /// Says of a method that the group element goes along with its steps to their order, not exactly.
    #[must_use]
    pub fn beside(mut self, label: &'static str) -> Self {
        self.beside.push(label);
        self
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
        let ground = self
            .grounds
            .iter()
            .fold(ground, |ground, more| more(ground));
        session.line(&[
            "ground",
            &format!("{:?}", ground.step),
            &format!("{:?}", ground.exact[0].span),
            &format!("{:?}", ground.exact[0].error),
            &ground.states.len().to_string(),
            &ground.linear.len().to_string(),
            &ground.quadratic.len().to_string(),
        ]);
        let all = request.methods.len() as u64;
        session.stage(0, all, "the kernels")?;
        self.evidence(&system, &ground, seed, session);
        let lifted = system.lift();
        for (done, label) in request.methods.iter().enumerate() {
            session.stage(done as u64, all, label)?;
            let Some((_, make)) = self.subjects.iter().find(|(known, _)| known == label) else {
                return Err((2, format!("request no method `{label}` in this program")));
            };
            let mut subject = make();
            let plain = self.plain.iter().find(|(known, _)| known == label);
            subject.plain = plain.and_then(|(_, make)| make(&request.parameters));
            subject.beside = self.beside.contains(&label.as_str());
            if done == 0 {
                session.stage(0, all, "the measurements on a spoiled map")?;
                let mut broken = broken_measurements(&system, &lifted, &ground, &subject);
                if driven::is_blind(&system, &ground, &subject) {
                    broken.push("rows");
                }
                for fact in broken {
                    session.line(&["broken", fact]);
                }
                for what in unsound_iterations() {
                    session.line(&["unsound", what]);
                }
            }
            if broken_comparison(&system, &ground, &subject) {
                session.line(&["broken", "generic form"]);
            }
            let rows = driven::finding(&system, &ground, &subject);
            let mut ended = Ok(());
            let mut next = |fact: &str| {
                if ended.is_ok() {
                    ended = session.stage(done as u64, all, &format!("{label}, {fact}"));
                }
            };
            let findings = verify(&system, &lifted, &ground, &subject, &mut next);
            ended?;
            for finding in findings.into_iter().chain([rows]) {
                report(label, &finding, session);
            }
        }
        Ok(())
    }

    /// What a judge may look at: kernels at the states, and the ends of the reference solution.
    fn evidence(&self, system: &P, ground: &Ground<P>, seed: u64, session: &mut Session<'_>) {
        let mut random = Random::new(seed.wrapping_add(1));
        for mu in &ground.states {
            for kernels in &self.kernels {
                let mut line = |fields: &[&str]| session.line(fields);
                let mut writer = kernels::Writer::new(system, mu, &mut random, &mut line);
                kernels(system, &mut writer);
            }
        }
        let exact = &ground.exact[0];
        for (mu, end) in ground.states.iter().zip(&exact.ends) {
            let span = format!("{:?}", exact.span);
            let [mu, end] = [mu, end].map(|state| kernels::text(state.as_slice()));
            session.line(&["reference", &span, &mu, &end]);
        }
    }
}

fn report(label: &str, finding: &Finding, session: &mut Session<'_>) {
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
        plain: None,
        beside: false,
    }
}
