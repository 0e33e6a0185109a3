//! A system made at run time.

use crate::code::Code;
use crate::compiled::{Compiled, Kernels, OfStep};
use crate::interpreter::Interpreter;
use crate::kernels::{ARGUMENTS, Engine, Frame, Machine};
use crate::names;
use lie_codegen::plan::Plan;
use lie_codegen::schedule::Operation;
use lie_codegen::symbolic::{self, Symbol};
use lie_core::parameter::{ParameterError, all_finite, all_positive};
use lie_runtime::Scalar;
use std::sync::Arc;

/// A Lie–Poisson system made at run time, over states on the heap.
///
/// It implements the traits of the numeric core by the codes of its plan. Traits for structure that it does not have answer
/// with what is empty, or panic: [`method`](crate::method) is asked for methods that apply.
pub struct Dynamic<S> {
    pub(crate) compiled: Arc<Compiled>,
    pub(crate) machine: Arc<dyn Machine<S>>,
    parameters: Vec<S>,
    constants: Vec<S>,
    /// A velocity of the branch of the Legendre transform; none for that which begins at rest.
    pub(crate) branch: Option<Vec<S>>,
}

impl<S: Scalar> Clone for Dynamic<S> {
    fn clone(&self) -> Self {
        Self {
            compiled: Arc::clone(&self.compiled),
            machine: Arc::clone(&self.machine),
            parameters: self.parameters.clone(),
            constants: self.constants.clone(),
            branch: self.branch.clone(),
        }
    }
}

/// A plan whose codes are ready to run, before its parameters have values.
#[derive(Clone)]
pub struct Declared {
    compiled: Arc<Compiled>,
    machine: Arc<dyn Machine<f64>>,
}

impl Declared {
    /// Makes the codes of a plan ready.
    ///
    /// # Panics
    /// [`Dynamic::supports`] is false of the plan.
    pub fn new(plan: Plan, engine: &dyn Engine) -> Self {
        let supported = Dynamic::supports(&plan);
        assert!(supported, "no system can be made of this plan");
        let compiled = Arc::new(Compiled::new(plan));
        let machine = engine.machine(&compiled.codes);
        Self { compiled, machine }
    }

    /// The system of these parameters, in the order of their names; those that are left out have their defaults. Nothing is
    /// compiled again.
    ///
    /// # Errors
    /// A parameter that must be positive is not, or a constant that the system needs is not finite.
    pub fn system(&self, parameters: &[f64]) -> Result<Dynamic<f64>, ParameterError> {
        let system = Dynamic {
            compiled: Arc::clone(&self.compiled),
            machine: Arc::clone(&self.machine),
            parameters: Vec::new(),
            constants: Vec::new(),
            branch: None,
        };
        system.with_parameters(parameters)
    }
}

impl Dynamic<f64> {
    /// Whether systems can be made of a plan: not of a family, nor where H calls a function of Rust.
    pub fn supports(plan: &Plan) -> bool {
        let own = |operation: &Operation<_>| {
            matches!(operation, Operation::Call(symbolic::Function::Own(_), _))
        };
        let mut functions = plan.system.functions();
        let calls_rust = functions.any(|function| function.program.operations.iter().any(own));
        !calls_rust && plan.family.is_none()
    }

    /// The system of a plan and of these parameters, see [`Declared`].
    ///
    /// # Errors
    /// As of [`Declared::system`].
    ///
    /// # Panics
    /// As [`Declared::new`].
    pub fn new(
        plan: Plan,
        parameters: &[f64],
        engine: &dyn Engine,
    ) -> Result<Self, ParameterError> {
        Declared::new(plan, engine).system(parameters)
    }

    /// The same system with other parameters: nothing is compiled again.
    ///
    /// # Errors
    /// As of [`Dynamic::new`].
    pub fn with_parameters(&self, parameters: &[f64]) -> Result<Self, ParameterError> {
        let mut system = self.clone();
        let defaults = self.defaults();
        let given = parameters.iter().copied();
        system.parameters = given
            .chain(defaults.into_iter().skip(parameters.len()))
            .collect();
        system.branch = None;
        system.check_signs()?;
        let plan = &self.compiled.plan;
        let mut constants = vec![0.0; plan.constants.entries.len()];
        let frame = system.frame([&[]; ARGUMENTS], &[], [0.0; 2]);
        self.machine
            .run(self.compiled.constants, &frame, [&mut constants, &mut []]);
        system.constants = constants;
        system.check_constants()?;
        Ok(system)
    }

    /// The defaults of the parameters.
    fn defaults(&self) -> Vec<f64> {
        let code = Code::of_program(&self.compiled.plan.defaults);
        let mut values = vec![0.0; code.stores.len()];
        let frame = self.frame([&[]; ARGUMENTS], &[], [0.0; 2]);
        let interpreter = Interpreter::new(Arc::from(vec![code]));
        interpreter.run(0, &frame, [&mut values, &mut []]);
        values
    }

    /// The declared initial state for the parameters of the system.
    pub fn initial_state(&self) -> Option<Vec<f64>> {
        let code = Code::of_program(self.compiled.plan.initial.as_ref()?);
        let mut values = vec![0.0; code.stores.len()];
        let frame = self.frame([&[]; ARGUMENTS], &[], [0.0; 2]);
        let interpreter = Interpreter::new(Arc::from(vec![code]));
        interpreter.run(0, &frame, [&mut values, &mut []]);
        Some(values)
    }

    fn check_signs(&self) -> Result<(), ParameterError> {
        let plan = &self.compiled.plan;
        let all = plan
            .parameters
            .iter()
            .zip(&plan.names.parameters)
            .zip(&self.parameters);
        let positive = all.filter(|((parameter, _), _)| parameter.positive);
        let positive: Vec<_> = positive
            .map(|((_, name), value)| (*value, names::text(name)))
            .collect();
        all_positive(&positive)
    }

    fn check_constants(&self) -> Result<(), ParameterError> {
        let plan = &self.compiled.plan;
        let entries = plan.constants.entries.iter().zip(&self.constants);
        let failing = entries.filter(|(_, value)| !value.is_finite());
        let failing: Vec<_> = failing
            .map(|(entry, value)| {
                let symbol = entry.parameter.map(Symbol::Parameter);
                let name = symbol
                    .map(|symbol| plan.names.shown(symbol))
                    .unwrap_or_default();
                (*value, names::text(&name), names::text(&entry.text))
            })
            .collect();
        all_finite(&failing)
    }
}

impl<S: Scalar> Dynamic<S> {
    /// The plan that it was made of.
    pub fn plan(&self) -> &Plan {
        &self.compiled.plan
    }

    /// The values of the parameters.
    pub fn parameters(&self) -> &[S] {
        &self.parameters
    }

    pub(crate) fn frame<'a>(
        &'a self,
        arguments: [&'a [S]; ARGUMENTS],
        of_step: &'a [S],
        scalars: [S; 2],
    ) -> Frame<'a, S> {
        Frame {
            arguments,
            system: &self.constants,
            of_step,
            parameters: &self.parameters,
            scalars,
        }
    }

    pub(crate) fn run(&self, code: usize, frame: &Frame<'_, S>, targets: [&mut [S]; 2]) {
        self.machine.run(code, frame, targets);
    }

    /// Runs a kernel of one or two vectors.
    #[inline]
    pub(crate) fn call(
        &self,
        code: usize,
        arguments: [&[S]; 2],
        vector: &mut [S],
        matrix: &mut [S],
    ) {
        let [a, b] = arguments;
        let frame = self.frame([a, b, &[], &[]], &[], [S::zero(); 2]);
        self.machine.run(code, &frame, [vector, matrix]);
    }

    /// The value of a program without arguments.
    pub(crate) fn value(&self, code: usize) -> S {
        let mut value = [S::zero()];
        self.call(code, [&[], &[]], &mut value, &mut []);
        value[0]
    }

    /// The constants of a step size.
    pub(crate) fn of_step(&self, step: &OfStep, h: S) -> Vec<S> {
        let mut constants = vec![S::zero(); step.count];
        let frame = self.frame([&[]; ARGUMENTS], &[], [h, S::zero()]);
        self.machine
            .run(step.constants, &frame, [&mut constants, &mut []]);
        constants
    }

    /// The same with its constants as other scalars.
    pub(crate) fn over<T: Scalar>(
        &self,
        constant: impl Fn(S) -> T,
        machine: Option<Arc<dyn Machine<T>>>,
    ) -> Dynamic<T> {
        let all = |values: &[S]| values.iter().map(|value| constant(*value)).collect();
        let interpreter = || Arc::new(Interpreter::new(Arc::clone(&self.compiled.codes)));
        Dynamic {
            compiled: Arc::clone(&self.compiled),
            machine: machine.unwrap_or_else(|| interpreter()),
            parameters: all(&self.parameters),
            constants: all(&self.constants),
            branch: self.branch.as_deref().map(all),
        }
    }

    pub(crate) fn kernels(&self) -> &Kernels {
        &self.compiled.kernels
    }
}
