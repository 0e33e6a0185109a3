//! The program behind `lie verify`: the kernels of the system for a judge, and every fact of each method.

mod controls;
mod driven;
mod found;
mod kernels;
mod outside;

pub use found::{Found, Ground as GroundFound, Kernel, Reference};

use crate::facts::{Ground, PlainSteps, Subject, Thermal, broken_comparison, verify};
use crate::random::Random;
use controls::controls;
use kernels::Kernels;
use lie_program::Tolerances;
use lie_program::blueprint::{Blueprint, Built};
use lie_program::protocol::{End, Obstacle};
use lie_program::session::{self, Session};
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::methods::Method;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{
    CayleyPoisson, DiscreteLagrangianPoisson, Dual, LagrangianPoisson, LiePoisson, Lift,
    MatrixGroup, ParameterError, Poisson, RealizedPoisson, State,
};
use serde::{Deserialize, Serialize};
use std::io::{BufRead, Write};
use std::process::ExitCode;
use std::rc::Rc;

/// What is measured.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// Of the states near the initial one, and of paths of noise.
    pub seed: u64,
    /// The step, where it is not found.
    pub step: Option<f64>,
    /// The largest order that is left where the motion crosses a joint of H; absent where H has none.
    #[serde(default)]
    pub reach: Option<u32>,
    /// The density that temperatures leave invariant; absent where none is declared.
    #[serde(default)]
    pub thermal: Option<Thermal>,
}

talk!(Options, Found);

type MakeSubject<P> = Box<dyn Fn() -> Subject<P>>;
type MakePlain = Box<dyn Fn(&[f64]) -> Option<Box<PlainSteps>>>;

/// A method over numbers and over dual numbers.
pub type AnyPair<P> = (
    Box<dyn AnyMethod<f64, P>>,
    Box<dyn AnyMethod<Dual<f64>, <P as Lift<f64>>::Lifted>>,
);

/// What a method is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Steps of its own, of the size that is asked for.
    Plain,
    /// Steps of another method.
    Composed,
    /// Steps that it chooses.
    Adaptive,
}

/// A program that verifies methods on one system.
pub struct Verify<P: Lift<f64>> {
    blueprint: Blueprint<P>,
    grounds: Vec<fn(Ground<P>) -> Ground<P>>,
    kernels: Vec<Kernels<P>>,
    subjects: Vec<(String, MakeSubject<P>)>,
    plain: Vec<(String, MakePlain)>,
    beside: Vec<String>,
}

impl<P: Lift<f64> + Clone + 'static> Verify<P> {
    /// A program from the parameters with their defaults and the function that makes a system of their values.
    pub fn new(
        parameters: &[(&str, f64)],
        build: impl Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync + 'static,
    ) -> Self {
        Self {
            blueprint: Blueprint::new(parameters, build),
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
        self,
        label: &str,
        build: impl Fn(&[f64]) -> Result<Q, ParameterError> + 'static,
        make: impl Fn(&Tolerances) -> M + 'static,
    ) -> Self
    where
        Q: Poisson<f64> + 'static,
        M: Method<f64, Q> + 'static,
    {
        self.any_plain(label, build, move |tolerances| Box::new(make(tolerances)))
    }

    /// The same with a method whose type is forgotten.
    #[must_use]
    pub fn any_plain<Q: Poisson<f64> + 'static>(
        mut self,
        label: &str,
        build: impl Fn(&[f64]) -> Result<Q, ParameterError> + 'static,
        make: impl Fn(&Tolerances) -> Box<dyn AnyMethod<f64, Q>> + 'static,
    ) -> Self {
        let steps = move |parameters: &[f64]| -> Option<Box<PlainSteps>> {
            let system = build(parameters).ok()?;
            let method = make(&Tolerances::default());
            Some(Box::new(move |start, h, steps| {
                let mut mu = system.zero_state();
                mu.as_mut_slice().copy_from_slice(start);
                let mut stepper = method.any_stepper(&system, h, &NewtonOptions::newton());
                let mut iterations = 0;
                for _ in 0..steps {
                    iterations += stepper.step(&mut mu)?.iterations;
                }
                Ok((mu.as_slice().to_vec(), iterations))
            }))
        };
        self.plain.push((label.to_owned(), Box::new(steps)));
        self
    }

    /// Adds a method whose type is forgotten, over numbers and over dual numbers.
    #[must_use]
    pub fn any_method(
        mut self,
        label: &str,
        kind: Kind,
        make: impl Fn(&Tolerances) -> AnyPair<P> + 'static,
    ) -> Self {
        let make = Rc::new(make);
        let subject = move || {
            let (method, lifted) = make(&Tolerances::default());
            let make = Rc::clone(&make);
            let with_tolerance = move |tolerance| make(&Tolerances::both(tolerance)).0;
            Subject {
                method,
                lifted,
                composed: kind == Kind::Composed,
                with_tolerance: (kind == Kind::Adaptive)
                    .then(|| -> Box<dyn Fn(f64) -> _> { Box::new(with_tolerance) }),
                plain: None,
                beside: false,
            }
        };
        self.subjects.push((label.to_owned(), Box::new(subject)));
        self
    }

    fn pair<M>(self, label: &str, kind: Kind, make: impl Fn(&Tolerances) -> M + 'static) -> Self
    where
        M: Method<f64, P> + Method<Dual<f64>, P::Lifted> + 'static,
    {
        let made = move |tolerances: &Tolerances| -> AnyPair<P> {
            (Box::new(make(tolerances)), Box::new(make(tolerances)))
        };
        self.any_method(label, kind, made)
    }

    /// Adds a method under the name by which requests ask for it.
    #[must_use]
    pub fn method<M>(self, label: &str, make: impl Fn(&Tolerances) -> M + 'static) -> Self
    where
        M: Method<f64, P> + Method<Dual<f64>, P::Lifted> + 'static,
    {
        self.pair(label, Kind::Plain, make)
    }

    /// Adds a method whose step consists of steps of another.
    #[must_use]
    pub fn composed<M>(self, label: &str, make: impl Fn(&Tolerances) -> M + 'static) -> Self
    where
        M: Method<f64, P> + Method<Dual<f64>, P::Lifted> + 'static,
    {
        self.pair(label, Kind::Composed, make)
    }

    /// Adds a method that chooses its own steps.
    #[must_use]
    pub fn adaptive<M>(self, label: &str, make: impl Fn(&Tolerances) -> M + 'static) -> Self
    where
        M: Method<f64, P> + Method<Dual<f64>, P::Lifted> + 'static,
    {
        self.pair(label, Kind::Adaptive, make)
    }

    /// Says of a method that the group element goes along with its steps to their order, not exactly.
    #[must_use]
    pub fn beside(mut self, label: &str) -> Self {
        self.beside.push(label.to_owned());
        self
    }

    /// Serves the request on standard input.
    pub fn main(&self) -> ExitCode {
        main(&|request, session| self.work(&request, session))
    }

    /// Serves one request; returns the exit code.
    pub fn serve(&self, input: impl BufRead + Send + 'static, output: &mut dyn Write) -> u8 {
        session::serve(None, Box::new(input), output, &|request, session| {
            self.work(&request, session)
        })
    }

    /// Does what is asked for.
    ///
    /// # Errors
    /// Why not everything was measured.
    pub fn work(
        &self,
        request: &crate::Request<Options>,
        session: &mut Session<'_, Found>,
    ) -> Result<(), End> {
        let Built { system, mu } = self.blueprint.build(&request.start)?;
        let Options {
            seed,
            step,
            reach,
            ref thermal,
        } = request.options;
        let all = request.methods.len() as u64;
        session.stage(0, all, "the reference solution")?;
        let ground = Ground::new(&system, &mu, seed, step)
            .map_err(|why| End::refused(Obstacle::Ground, why))?;
        let more = self.grounds.iter();
        let ground = Ground { reach, ..ground };
        let ground = more.fold(ground, |ground, more| more(ground));
        let lifted = system.lift();
        let ground = ground.with_noise(&system, &lifted, (seed, thermal.as_ref()));
        session.found(Found::Ground(GroundFound {
            step: ground.step,
            span: ground.exact[0].span,
            error: ground.exact[0].error,
            states: ground.states.len(),
            linear: ground.linear.len(),
            quadratic: ground.quadratic.len(),
        }));
        session.stage(0, all, "the kernels")?;
        self.evidence(&system, &ground, seed, session);
        let values = self.blueprint.values(&request.start)?;
        for (done, label) in request.methods.iter().enumerate() {
            let done = done as u64;
            session.stage(done, all, label)?;
            let subject = self.subject(label, &values)?;
            if done == 0 {
                session.stage(0, all, "the measurements on a spoiled map")?;
                controls(&system, &lifted, &ground, &subject, session);
            }
            let mut next = |fact: &str| session.stage(done, all, &format!("{label}, {fact}"));
            let findings = verify(&system, &lifted, &ground, &subject, &mut next)?;
            if broken_comparison(&system, &ground, &subject) {
                let fact = "generic form".to_owned();
                session.found(Found::Broken { fact });
            }
            let rows = driven::finding(&system, &ground, &subject);
            for finding in findings.into_iter().chain([rows]) {
                let method = label.clone();
                session.found(Found::Finding { method, finding });
            }
            let method = label.clone();
            session.found(Found::Measured { method });
        }
        Ok(())
    }

    /// A method by its label, for these parameters.
    fn subject(&self, label: &str, values: &[f64]) -> Result<Subject<P>, End> {
        let known = self.subjects.iter().find(|(known, _)| known == label);
        let (_, make) = known.ok_or_else(|| session::no_method(label))?;
        let plain = self.plain.iter().find(|(known, _)| known == label);
        Ok(Subject {
            plain: plain.and_then(|(_, make)| make(values)),
            beside: self.beside.iter().any(|known| known == label),
            ..make()
        })
    }

    /// What a judge may look at: kernels at the states, and the ends of the reference solution.
    fn evidence(
        &self,
        system: &P,
        ground: &Ground<P>,
        seed: u64,
        session: &mut Session<'_, Found>,
    ) {
        let mut random = Random::new(seed.wrapping_add(1));
        for mu in &ground.states {
            for kernels in &self.kernels {
                let mut show = |kernel| session.found(Found::Kernel(kernel));
                let mut writer = kernels::Writer::new(system, mu, &mut random, &mut show);
                kernels(system, &mut writer);
            }
        }
        let exact = &ground.exact[0];
        for (mu, end) in exact.starts.iter().zip(&exact.ends) {
            session.found(Found::Reference(Reference {
                span: exact.span,
                start: mu.as_slice().to_vec(),
                end: end.as_slice().to_vec(),
            }));
        }
    }
}
