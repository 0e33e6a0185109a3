//! Steps as one program: of a method without a solver all kernels of a step, and the sums between them, run as one code.
//!
//! The step is written down once: the method makes it over a scalar that records its operations, and a kernel that it calls is put
//! in its place. The operations and their order are those of the step itself, so that the bits are.

mod record;

use crate::code::{Code, Source};
use crate::compiled::Compiled;
use crate::interpreter::Interpreter;
use crate::kernels::Machine;
use crate::methods::{Method, explicit};
use crate::system::Dynamic;
use crate::values::Values;
use lie_codegen::methods::Choice;
use lie_runtime::Scalar;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims, Forgotten, ForgottenStepper};
use lie_runtime::methods::{FactorSink, Method as _, StepFailure, StepReport, Stepper};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::scalar::Mask;
use record::{Inlined, Recorded, recorded};
use std::sync::Arc;

/// So many steps of a run are made kernel by kernel, before the step is compiled as a whole: what that costs is less than what
/// as many steps gain.
pub const PATIENCE: u32 = 1500;

/// A step as one code: of mu, the step size, parameters and constants it makes the state at the end, and behind it numbers that
/// are all finite where the step is good.
#[derive(Debug)]
pub(crate) struct Step {
    codes: Arc<[Code]>,
    report: StepReport,
    results: usize,
}

impl Step {
    /// The step of a method for systems of these codes; none where it is not one program.
    fn new(choice: &Choice, compiled: &Arc<Compiled>) -> Option<Self> {
        let plan = &compiled.plan;
        let (dimension, parameters) = (plan.dimension(), plan.parameters.len());
        let method = explicit::<Recorded>(choice)?;
        let all = |count: usize, source: fn(u32) -> Source| -> Vec<Recorded> {
            (0..count as u32)
                .map(|place| Recorded::of(source(place)))
                .collect()
        };
        let (code, report) = recorded(|| {
            let mut mu = all(dimension, |place| Source::Argument(0, place));
            let system = Dynamic {
                values: Values {
                    compiled: Arc::clone(compiled),
                    machine: Arc::new(Inlined(Arc::clone(&compiled.codes))),
                    parameters: all(parameters, Source::Parameter),
                    constants: all(plan.constants.entries.len(), Source::System),
                },
                branch: None,
                family: None,
            };
            let h = Recorded::of(Source::Step);
            let mut stepper = method.any_stepper(&system, h, &NewtonOptions::default());
            let report = stepper.step(&mut mu).ok()?;
            Some((mu, report))
        })?;
        Some(Self {
            results: code.stores.len(),
            codes: Arc::from([code]),
            report,
        })
    }
}

impl<S: Scalar> Dynamic<S> {
    /// The step of a method as one code; none where it is not one.
    pub(crate) fn step_of(&self, choice: &Choice) -> Option<Arc<Step>> {
        if self.family.is_some() || self.is_by_legendre() {
            return None;
        }
        self.values.compiled.step_of(choice, Step::new)
    }

    /// The step of a method without a solver as one code, which stores the state at the end and, behind it, numbers that are all
    /// finite where the step is good; none where the step is not one program.
    pub fn step_code(&self, choice: &Choice) -> Option<Code> {
        self.step_of(choice).map(|step| step.codes[0].clone())
    }
}

/// A method whose steps become one program.
pub(crate) struct Straight<S: Scalar> {
    choice: Choice,
    claims: Claims,
    /// What makes steps kernel by kernel; none where all are made as a whole.
    apart: Option<Method<S>>,
}

impl<S: Scalar> Straight<S> {
    /// The method, made kernel by kernel at first.
    pub fn patient(choice: &Choice, apart: Method<S>) -> Self {
        Self {
            choice: choice.clone(),
            claims: apart.claims(),
            apart: Some(apart),
        }
    }

    /// The method with these claims, for systems whose steps are one program.
    pub fn at_once(choice: &Choice, claims: Claims) -> Self {
        Self {
            choice: choice.clone(),
            claims,
            apart: None,
        }
    }
}

impl<S: Scalar> AnyMethod<S, Dynamic<S>> for Straight<S> {
    fn claims(&self) -> Claims {
        self.claims
    }

    fn any_stepper<'a>(
        &self,
        system: &'a Dynamic<S>,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<S, Vec<S>> + 'a> {
        let apart = self.apart.as_ref();
        let apart = apart.map(|method| Forgotten(method.as_ref()).stepper(system, h, newton));
        let known = system.values.compiled.knows_step(&self.choice);
        let mut stepper = StraightStepper {
            system,
            choice: self.choice.clone(),
            step_size: [h],
            waits: if known { 0 } else { PATIENCE },
            whole: None,
            apart,
        };
        if known || stepper.apart.is_none() {
            stepper.compile();
        }
        Box::new(stepper)
    }
}

/// A step that is ready to run.
struct Whole<S> {
    step: Arc<Step>,
    machine: Arc<dyn Machine<S>>,
    results: Vec<S>,
}

/// The stepper of a [`Straight`] method.
struct StraightStepper<'a, S: Scalar> {
    system: &'a Dynamic<S>,
    choice: Choice,
    step_size: [S; 1],
    /// Steps to be made until the step is compiled.
    waits: u32,
    whole: Option<Whole<S>>,
    apart: Option<ForgottenStepper<'a, Vec<S>, S>>,
}

impl<S: Scalar> StraightStepper<'_, S> {
    fn compile(&mut self) {
        let Some(step) = self.system.step_of(&self.choice) else {
            return;
        };
        let machine = self.system.values.machine.of(&step.codes);
        let interpreter =
            || -> Arc<dyn Machine<S>> { Arc::new(Interpreter::new(Arc::clone(&step.codes))) };
        // no faster than kernel by kernel, but for who has nothing else
        let machine = machine.or_else(|| self.apart.is_none().then(interpreter));
        let Some(machine) = machine else { return };
        self.whole = Some(Whole {
            machine,
            results: vec![S::zero(); step.results],
            step,
        });
    }
}

impl<S: Scalar> Whole<S> {
    /// Runs the step from mu: in which lanes it is good. The state at its end comes first among the results.
    fn run(&mut self, system: &Dynamic<S>, step_size: &[S], mu: &[S]) -> S::Mask {
        let frame = system.values.frame([mu, &[], &[], &[]], &[], step_size);
        self.machine.run(0, &frame, [&mut self.results, &mut []]);
        let asked = self.results[mu.len()..].iter();
        asked.fold(S::Mask::splat(true), |all, number| all & number.finite())
    }

    /// Takes over what the last run gave, in the lanes in which it is good.
    fn accept(&self, good: S::Mask, mu: &mut [S]) -> Result<StepReport, StepFailure> {
        let report = self.step.report;
        if good.all() {
            mu.copy_from_slice(&self.results[..mu.len()]);
            return Ok(report);
        }
        for (mine, theirs) in mu.iter_mut().zip(&self.results) {
            *mine = S::select(good, *theirs, *mine);
        }
        Err(StepFailure {
            reason: FailureReason::NotFinite,
            lanes: (!good).bits(),
            report,
        })
    }
}

impl<S: Scalar> Stepper<S> for StraightStepper<'_, S> {
    type State = Vec<S>;

    fn step<K: FactorSink<Vec<S>>>(
        &mut self,
        mu: &mut Vec<S>,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        if self.waits > 0 {
            self.waits -= 1;
            if self.waits == 0 {
                self.compile();
            }
        }
        let whole = self.whole.as_mut().filter(|_| !K::ACTIVE);
        let whole = whole.map(|whole| (whole.run(self.system, &self.step_size, mu), whole));
        match (whole, &mut self.apart) {
            (Some((good, whole)), None) => whole.accept(good, mu),
            (Some((good, whole)), _) if good.all() => whole.accept(good, mu),
            // what a step that fails reports is for the method to say
            (_, Some(apart)) => Stepper::step(apart, mu, sink),
            (None, None) => unreachable!("systems side by side show no motion on the group"),
        }
    }
}
