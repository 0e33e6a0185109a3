//! Steps and equations as one program: of a method without a solver all kernels of a step, and the sums between them, run as one
//! code, and so do the residual and the Jacobian of an equation that the plan does not fuse.
//!
//! What is to be one program is written down once: the method makes its step, or the equation computes its residual, over a
//! scalar that records its operations, and a kernel that is called is put in its place. The operations and their order are those
//! of the step itself, so that the bits are. What depends on the step size alone is a program of its own, run once.

mod equation;
mod record;
mod recorded;

use crate::code::{Code, Source};
use crate::compiled::Compiled;
use crate::interpreter::Interpreter;
use crate::kernels::{ARGUMENTS, Machine};
use crate::methods::{Method, explicit};
use crate::system::Dynamic;
use crate::values::Values;
use lie_codegen::methods::Choice;
use lie_runtime::Scalar;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims, Forgotten, ForgottenStepper};
use lie_runtime::methods::{FactorSink, Method as _, StepFailure, StepReport, Stepper};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::scalar::Mask;
use record::written;
use recorded::Inlined;
use std::sync::Arc;

pub(crate) use equation::{Programs, Running, Write, write};
pub(crate) use recorded::Recorded;

/// So many steps of a run are made kernel by kernel before a program of the whole is compiled: what that costs is less than what as
/// many gain.
pub const PATIENCE: u32 = 4000;

/// Numbers of these sources.
fn all(count: usize, source: impl Fn(u32) -> Source) -> Vec<Recorded> {
    (0..count as u32)
        .map(|place| Recorded::of(source(place)))
        .collect()
}

/// A system of these codes that writes down what it does.
fn recording(compiled: &Arc<Compiled>) -> Dynamic<Recorded> {
    let plan = &compiled.plan;
    Dynamic {
        values: Values {
            compiled: Arc::clone(compiled),
            machine: Arc::new(Inlined(Arc::clone(&compiled.codes))),
            parameters: all(plan.parameters.len(), Source::Parameter),
            constants: all(plan.constants.entries.len(), Source::System),
        },
        branch: None,
        family: None,
    }
}

/// A step as two codes. Of mu, parameters, constants and what the first makes of the step size, the second makes the state at the
/// end, and behind it numbers that are all finite where the step is good.
#[derive(Debug)]
pub(crate) struct Step {
    codes: Arc<[Code]>,
    report: StepReport,
}

impl Step {
    /// The step of a method for systems of these codes; none where it is not one program.
    fn new(choice: &Choice, compiled: &Arc<Compiled>) -> Option<Self> {
        let method = explicit::<Recorded>(choice)?;
        let ((mu, report), written) = written(|| {
            let system = recording(compiled);
            let mut mu = all(compiled.plan.dimension(), |place| {
                Source::Argument(0, place)
            });
            let h = Recorded::of(Source::Step);
            let mut stepper = method.any_stepper(&system, h, &NewtonOptions::default());
            let report = stepper.step(&mut mu).ok()?;
            Some((mu, report))
        })?;
        let stored = [mu, written.asked()].concat();
        Some(Self {
            codes: Arc::from(written.codes(&stored, &[])),
            report,
        })
    }
}

impl<S: Scalar> Dynamic<S> {
    /// Whether anything of it can be written down: not loops over sites, nor an iteration within a kernel.
    fn is_written(&self) -> bool {
        self.family.is_none() && !self.is_by_legendre()
    }

    /// The step of a method as one program; none where it is not one.
    pub(crate) fn step_of(&self, choice: &Choice) -> Option<Arc<Step>> {
        if !self.is_written() {
            return None;
        }
        let compiled = &self.values.compiled;
        compiled.steps.get(choice, || Step::new(choice, compiled))
    }

    /// How many programs of the whole a method has by now: its step, or the residual of its equation and the residual with the
    /// Jacobian. 0 as well where the plan fuses its equation.
    pub fn programs(&self, choice: &Choice) -> usize {
        let compiled = &self.values.compiled;
        let step = compiled.steps.known(choice);
        let equation = compiled.equations.known(choice);
        usize::from(step.is_some()) + equation.map_or(0, |programs| programs.count())
    }
}

/// Two codes that are ready to run, with the results of the first.
struct Ready<S> {
    machine: Arc<dyn Machine<S>>,
    of_step: Vec<S>,
}

impl<S: Scalar> Ready<S> {
    /// By the engine of a system, or by the interpreter where that is asked for; none where there is no engine.
    fn new(system: &Dynamic<S>, codes: &Arc<[Code]>, h: S, interpret: bool) -> Option<Self> {
        let interpreter =
            || -> Arc<dyn Machine<S>> { Arc::new(Interpreter::new(Arc::clone(codes))) };
        let machine = system.values.machine.of(codes);
        let machine = machine.or_else(|| interpret.then(interpreter))?;
        let mut of_step = vec![S::zero(); codes[0].stores.len()];
        let scalars = [h];
        let frame = system.values.frame([&[]; ARGUMENTS], &[], &scalars);
        machine.run(0, &frame, [&mut of_step, &mut []]);
        Some(Self { machine, of_step })
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
        let at_once = system.values.compiled.steps.at_once(&self.choice);
        let mut stepper = StraightStepper {
            system,
            choice: self.choice.clone(),
            step_size: [h],
            waits: if at_once { 0 } else { PATIENCE },
            whole: None,
            apart,
        };
        if at_once || stepper.apart.is_none() {
            stepper.compile();
        }
        Box::new(stepper)
    }
}

/// A step that is ready to run.
struct Whole<S> {
    step: Arc<Step>,
    ready: Ready<S>,
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
        // interpreted it is no faster than kernel by kernel, but for who has nothing else
        let alone = self.apart.is_none();
        let [h] = self.step_size;
        if let Some(ready) = Ready::new(self.system, &step.codes, h, alone) {
            self.whole = Some(Whole {
                ready,
                results: vec![S::zero(); step.codes[1].stores.len()],
                step,
            });
        }
    }
}

impl<S: Scalar> Whole<S> {
    /// Runs the step from mu: in which lanes it is good. The state at its end comes first among the results.
    fn run(&mut self, system: &Dynamic<S>, step_size: &[S], mu: &[S]) -> S::Mask {
        let Ready { machine, of_step } = &self.ready;
        let frame = system.values.frame([mu, &[], &[], &[]], of_step, step_size);
        machine.run(1, &frame, [&mut self.results, &mut []]);
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
