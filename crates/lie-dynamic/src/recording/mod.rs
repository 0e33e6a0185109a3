//! Steps as programs. A step of an explicit method is one program, its kernels and the sums between them; of a method with a solver
//! there are traces ([`trace`]); an iteration over stages side by side ([`stages`]) and a Taylor series ([`development`]) are programs too.
//!
//! Nobody writes these programs. The method makes one step over a scalar that records its operations; the code of a kernel stands in
//! place of its call. The operations and their order are those of the step kernel by
//! kernel, so the bits are the same. What depends on the step size alone is a program of its own, run once.

mod development;
mod followed;
mod mask;
mod program;
mod ready;
mod record;
mod recorded;
mod stages;
mod trace;
mod traced;
mod traced_lanes;
mod traces;
mod tree;

use crate::code::{Code, Source};
use crate::compiled::{Compiled, Values};
use crate::methods::{Method, explicit};
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_runtime::Scalar;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims, Forgotten, ForgottenStepper};
use lie_runtime::methods::{FactorSink, Method as _, StepFailure, StepReport, Stepper};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::scalar::Mask;
use ready::Ready;
use record::written;
use recorded::Inlined;
use std::rc::Rc;
use std::sync::Arc;

pub(crate) use development::{Development, SeriesCodes, SeriesKind};
pub(crate) use program::program;
pub(crate) use recorded::Recorded;
pub(crate) use stages::StageCodes;
pub use traced::TracedMethod;
pub use traced_lanes::TracedInLanes;
pub(crate) use traces::Traces;

/// Steps that a stepper makes kernel by kernel before it compiles a program of the whole; one whose program has more instructions
/// makes as many steps as that. So many steps gain more than the compilation costs.
pub const PATIENCE: u32 = 4000;

/// Numbers of these sources.
fn source_numbers(count: usize, source: impl Fn(u32) -> Source) -> Vec<Recorded> {
    (0..count as u32)
        .map(|place| Recorded::from_source(source(place)))
        .collect()
}

/// A system of these codes that writes down what it does.
fn recording(compiled: &Arc<Compiled>) -> Dynamic<Recorded> {
    let plan = &compiled.plan;
    let parameters = source_numbers(plan.parameters.len(), Source::Parameter);
    let constants = source_numbers(plan.constants.entries.len(), Source::System);
    inlined(compiled, parameters, constants)
}

/// The same, of the values of a system.
fn following<const LANES: usize>(system: &Dynamic<f64>) -> Dynamic<Recorded<LANES>> {
    let numbers = |values: &[f64], source: fn(u32) -> Source| {
        let numbers = (0..).zip(values);
        let numbers = numbers.map(|(place, value)| Recorded::of_value(source(place), *value));
        numbers.collect()
    };
    let parameters = numbers(&system.values.parameters, Source::Parameter);
    let constants = numbers(&system.values.constants, Source::System);
    inlined(&system.values.compiled, parameters, constants)
}

fn inlined<const LANES: usize>(
    compiled: &Arc<Compiled>,
    parameters: Vec<Recorded<LANES>>,
    constants: Vec<Recorded<LANES>>,
) -> Dynamic<Recorded<LANES>> {
    Dynamic {
        values: Values {
            compiled: Arc::clone(compiled),
            machine: Arc::new(Inlined(Arc::clone(&compiled.codes))),
            parameters,
            constants,
            data: Arc::default(),
            hurry: true,
        },
        branch: None,
        family: None,
        members: Arc::default(),
    }
}

/// A step as two codes. The second computes the state at the end, then numbers that are all finite where the step is good. It reads
/// mu, parameters, constants and the results of the first, which reads the step size.
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
            let mut mu = source_numbers(compiled.plan.dimension(), |place| {
                Source::Argument(0, place)
            });
            let h = Recorded::from_source(Source::Step);
            let mut stepper = method.any_stepper(&system, h, &NewtonOptions::default());
            let report = stepper.step(&mut mu).ok()?;
            Some((mu, report))
        })?;
        let stored = [mu, written.finiteness_tests()].concat();
        Some(Self {
            codes: Arc::from(written.codes(&stored, &[])),
            report,
        })
    }
}

impl<S: Scalar> Dynamic<S> {
    /// Whether anything of it can be recorded: loops over sites cannot, nor can an iteration within a kernel.
    fn is_recordable(&self) -> bool {
        self.family.is_none() && !self.is_by_legendre()
    }

    /// Whether steps of methods with a solver are run by traces.
    pub(crate) fn is_traced(&self) -> bool {
        !cfg!(target_arch = "wasm32") && self.is_recordable() && self.values.machine.compiles()
    }

    /// Whether steppers compile programs of the whole when they are made: where the engine has these, or nobody waits.
    fn compiles_at_once(&self, known: Option<&Arc<[Code]>>) -> bool {
        let machine = &self.values.machine;
        let there = known.is_some_and(|codes| machine.has_compiled(codes));
        machine.compiles() && (self.values.hurry || there || machine.compiles_quickly())
    }

    /// The step of a method as one program; none where it is not one, nor where nothing would compile it.
    pub(crate) fn step_program(&self, choice: &Choice) -> Option<Arc<Step>> {
        if cfg!(target_arch = "wasm32") || !self.is_recordable() {
            return None;
        }
        let compiled = &self.values.compiled;
        compiled.steps.get(choice, || Step::new(choice, compiled))
    }

    /// How many steps of a method were made by traces, by steppers that are there no more.
    pub fn steps_by_traces(&self, choice: &Choice) -> u64 {
        let traces = &self.values.compiled.traces;
        let traces = traces.all_of(|((known, _), _)| known == choice.solved());
        traces.iter().map(|traces| traces.steps()).sum()
    }

    /// How many programs of the whole there are for a method by now: its step, or the traces of it.
    pub fn programs(&self, choice: &Choice) -> usize {
        let compiled = &self.values.compiled;
        let step = compiled.steps.cached(choice);
        let step = step.filter(|step| self.values.machine.compile(&step.codes).is_some());
        // a composition has those of its base
        let traces = compiled
            .traces
            .all_of(|((known, _), _)| known == choice.solved());
        let traces = traces.iter().map(|traces| traces.count());
        usize::from(step.is_some()) + traces.sum::<usize>()
    }
}

/// How long a stepper waits for its program of the whole.
struct Countdown {
    left: u32,
    patience: u32,
    each: u32,
    /// Whether the program was recorded, so that its length is known.
    recorded: bool,
}

impl Countdown {
    /// For so many steps at first, 0 where there is nothing to wait for, and then as many as the program has of these instructions.
    fn new(patience: u32, each: u32) -> Self {
        Self {
            patience,
            each,
            left: patience,
            recorded: patience == 0,
        }
    }

    /// Counts; whether the program is due. `record` tells its instructions.
    #[inline]
    fn is_over(&mut self, record: impl FnOnce() -> usize) -> bool {
        if self.left == 0 {
            return false;
        }
        self.left -= 1;
        if self.left == 0 && !self.recorded {
            self.recorded = true;
            self.left = (record() as u32 / self.each).saturating_sub(self.patience);
        }
        self.left == 0
    }
}

/// A method whose steps become one program.
pub struct RecordedMethod<S: Scalar> {
    choice: Choice,
    claims: Claims,
    /// What makes steps kernel by kernel; none where all are made as a whole.
    apart: Option<Rc<Method<S>>>,
}

impl<S: Scalar> RecordedMethod<S> {
    /// The method, made kernel by kernel at first.
    pub fn patient(choice: &Choice, apart: Method<S>) -> Self {
        Self {
            choice: choice.clone(),
            claims: apart.claims(),
            apart: Some(Rc::new(apart)),
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

impl<S: Scalar> AnyMethod<S, Dynamic<S>> for RecordedMethod<S> {
    fn claims(&self) -> Claims {
        self.claims
    }

    fn any_stepper<'a>(
        &self,
        system: &'a Dynamic<S>,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<S, Vec<S>> + 'a> {
        let stepper = |method: &Rc<Method<S>>| {
            let stepper = Forgotten(method.as_ref().as_ref()).stepper(system, h, newton);
            (Rc::clone(method), stepper)
        };
        let apart = self.apart.as_ref().map(stepper);
        let known = system.values.compiled.steps.cached(&self.choice);
        let known = known.as_ref().map(|step| &step.codes);
        let at_once = apart.is_none() || system.compiles_at_once(known);
        let mut stepper = RecordedStepper {
            system,
            choice: self.choice.clone(),
            step_size: [h],
            wait: match at_once || !system.values.machine.compiles() {
                true => Countdown::new(0, 1),
                false => Countdown::new(PATIENCE, 1),
            },
            whole: None,
            apart,
            is_stale: false,
        };
        if at_once {
            stepper.compile();
        }
        let makes_steps = stepper.apart.is_some() || stepper.whole.is_some();
        assert!(makes_steps, "the system does not take lanes by this method");
        Box::new(stepper)
    }
}

/// A step that is ready to run.
struct CompiledStep<S> {
    step: Arc<Step>,
    ready: Ready<S>,
    results: Vec<S>,
}

/// A method and a stepper of it.
type Apart<'a, S> = (Rc<Method<S>>, ForgottenStepper<'a, Vec<S>, S>);

/// The stepper of a [`RecordedMethod`].
struct RecordedStepper<'a, S: Scalar> {
    system: &'a Dynamic<S>,
    choice: Choice,
    step_size: [S; 1],
    wait: Countdown,
    whole: Option<CompiledStep<S>>,
    /// What makes steps kernel by kernel, and its stepper.
    apart: Option<Apart<'a, S>>,
    /// Whether the other steps have another size by now.
    is_stale: bool,
}

impl<S: Scalar> RecordedStepper<'_, S> {
    /// Makes anew what makes steps kernel by kernel, where these have another size.
    #[cold]
    fn renew(&mut self) {
        self.is_stale = false;
        if let Some((method, stepper)) = &mut self.apart {
            let [h] = self.step_size;
            let options = NewtonOptions::default();
            *stepper = Forgotten(method.as_ref().as_ref()).stepper(self.system, h, &options);
        }
    }

    fn compile(&mut self) {
        let Some(step) = self.system.step_program(&self.choice) else {
            return;
        };
        // interpreted, a program is no faster than kernels; it is used only where there is nothing else
        let alone = self.apart.is_none();
        let [h] = self.step_size;
        if let Some(ready) = Ready::new(self.system, &step.codes, h, alone) {
            self.whole = Some(CompiledStep {
                ready,
                results: vec![S::zero(); step.codes[1].stores.len()],
                step,
            });
        }
    }
}

impl<S: Scalar> CompiledStep<S> {
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

impl<S: Scalar> Stepper<S> for RecordedStepper<'_, S> {
    type State = Vec<S>;

    fn step<K: FactorSink<Vec<S>>>(
        &mut self,
        mu: &mut Vec<S>,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let (system, choice) = (self.system, &self.choice);
        let length = || {
            let step = system.step_program(choice);
            step.map_or(0, |step| step.codes[1].instructions.len())
        };
        if self.wait.is_over(length) {
            self.compile();
        }
        if self.is_stale && (self.whole.is_none() || sink.is_active()) {
            self.renew();
        }
        let whole = self.whole.as_mut().filter(|_| !sink.is_active());
        let whole = whole.map(|whole| (whole.run(self.system, &self.step_size, mu), whole));
        match (whole, &mut self.apart) {
            (Some((good, whole)), None) => whole.accept(good, mu),
            (Some((good, whole)), _) if good.all() || self.is_stale => whole.accept(good, mu),
            // what a step that fails reports is for the method to say
            (_, Some((_, stepper))) => Stepper::step(stepper, mu, sink),
            (None, None) => unreachable!("systems side by side show no motion on the group"),
        }
    }

    fn set_step(&mut self, h: S) -> bool {
        self.step_size = [h];
        if let Some(whole) = &mut self.whole {
            whole.ready.set_step(self.system, h);
        }
        self.is_stale = self.apart.is_some();
        true
    }
}
