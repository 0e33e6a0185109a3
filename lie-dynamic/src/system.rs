//! A system made at run time.

use crate::code::Code;
use crate::elimination::Table;
use crate::interpreter::Interpreter;
use crate::kernels::{ARGUMENTS, Engine, Frame, Machine};
use crate::names;
use lie_codegen::methods::{Choice, Gradient};
use lie_codegen::plan::{Constants, Function, Fused, Generating, Item, Method, Plan, Solver};
use lie_codegen::schedule::Operation;
use lie_codegen::symbolic::{self, Symbol};
use lie_core::parameter::{ParameterError, all_finite, all_positive};
use lie_runtime::Scalar;
use std::collections::HashMap;
use std::sync::Arc;

/// A code by its place; none where the plan has no such kernel.
pub(crate) type Place = Option<usize>;

/// The kernels of the traits.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kernels {
    pub hamiltonian: Place,
    pub energy: Place,
    pub gradient: Place,
    pub hessian: Place,
    pub poisson_matrix: Place,
    pub poisson_slope: Place,
    pub vector_field: Place,
    pub jacobian: Place,
    pub linearize: Place,
    pub casimirs: Place,
    pub casimir_gradients: Vec<usize>,
    pub ad: Place,
    pub ad_star: Place,
    pub ad_star_matrix: Place,
    pub coadjoint_action: Place,
    pub dexp_dual: Place,
    pub dexp_dual_slope: Place,
    pub triple: Place,
    /// Of the Lagrangian, its slope and its second derivative.
    pub lagrangian: [Place; 3],
    /// The same of the discrete Lagrangian.
    pub discrete: [Place; 3],
}

/// Codes of what depends on the step size, and what is computed once for a step size.
#[derive(Clone, Debug)]
pub(crate) struct OfStep {
    /// The program of the constants.
    pub constants: usize,
    /// How many they are.
    pub count: usize,
}

/// A fused equation: its codes, and its row in the plan.
#[derive(Clone, Debug)]
pub(crate) struct FusedCodes {
    pub item: usize,
    pub residual: usize,
    pub linearize: usize,
    pub guess: Place,
    pub result: Place,
    /// What completes the unknown, where the iteration leaves some of it out.
    pub completed: Place,
    /// Those of it.
    pub left_out: Vec<usize>,
    pub step: OfStep,
    pub table: Table,
    /// The cost of an iteration with a Jacobian in those without.
    pub cost: Option<f64>,
}

/// A generating function in code.
#[derive(Clone, Debug)]
pub(crate) struct GeneratingCodes {
    pub gradient: usize,
    pub linearize: Place,
    pub step: OfStep,
}

/// The codes of a plan, which systems of all parameters and scalars share.
#[derive(Debug)]
pub(crate) struct Compiled {
    pub plan: Plan,
    pub codes: Arc<[Code]>,
    kernels: Kernels,
    constants: usize,
    pub fused: HashMap<&'static str, FusedCodes>,
    pub generating: HashMap<&'static str, GeneratingCodes>,
    /// Discrete gradients in closed form: codes and kernels.
    pub gradients: HashMap<Gradient, (Vec<usize>, Vec<Function>)>,
    pub eliminations: HashMap<String, Table>,
    /// The equation of each method.
    pub solvers: HashMap<Choice, Solver>,
    pub taylor: Option<crate::series::Codes>,
    pub lie_taylor: Option<crate::series::Codes>,
    pub flows: crate::flows::Codes,
    pub structure: crate::structure::Codes,
    pub casimir_degrees: Vec<Option<u32>>,
}

/// Codes in the making.
pub(crate) struct Making {
    codes: Vec<Code>,
    size: usize,
}

impl Making {
    pub fn push(&mut self, code: Code) -> usize {
        self.codes.push(code);
        self.codes.len() - 1
    }

    pub fn kernel(&mut self, function: &Function) -> usize {
        let code = Code::of_kernel(function, self.size);
        self.push(code)
    }

    fn step(&mut self, constants: &Constants) -> OfStep {
        OfStep {
            constants: self.push(Code::of_program(&constants.program)),
            count: constants.entries.len(),
        }
    }

    fn fused(&mut self, item: usize, fused: &Fused) -> Option<FusedCodes> {
        let named = |name: &str| fused.functions.iter().find(|f| f.name == name);
        let residual = self.kernel(named("residual")?);
        let linearize = Code::of_kernel(named("linearize")?, self.size);
        let linearize = Code {
            clear: [linearize.clear[0], None],
            ..linearize.with_zeros(&fused.elimination.fill, self.size)
        };
        let costs = fused.costs();
        Some(FusedCodes {
            item,
            residual,
            linearize: self.push(linearize),
            guess: named("initial_guess").map(|function| self.kernel(function)),
            result: named("result").map(|function| self.kernel(function)),
            completed: fused.completed().map(|function| self.kernel(function)),
            left_out: fused.left_out(),
            step: self.step(&fused.step),
            table: Table::new(&fused.elimination),
            cost: costs.map(|[with, without]| with as f64 / without as f64),
        })
    }

    fn generating(&mut self, function: &Generating) -> GeneratingCodes {
        let linearize = function.linearize.as_ref();
        GeneratingCodes {
            gradient: self.kernel(&function.gradient),
            linearize: linearize.map(|linearize| self.kernel(linearize)),
            step: self.step(&function.step),
        }
    }

    fn kernels(&mut self, plan: &Plan) -> Kernels {
        let system = &plan.system;
        let functions = system.poisson.iter().chain(&system.algebra);
        let functions = functions.chain(&system.exponential).chain(&system.triple);
        let functions = functions.chain(&system.lagrangian).chain(&system.discrete);
        let mut places: HashMap<&str, usize> = HashMap::new();
        for function in functions {
            places.insert(function.name, self.kernel(function));
        }
        let place = |name: &str| places.get(name).copied();
        let gradients = system.casimirs.iter();
        Kernels {
            hamiltonian: place("hamiltonian"),
            energy: place("energy"),
            gradient: place("gradient"),
            hessian: place("hessian"),
            poisson_matrix: place("poisson_matrix"),
            poisson_slope: place("poisson_slope"),
            vector_field: place("vector_field"),
            jacobian: place("jacobian"),
            linearize: place("linearize"),
            casimirs: place("casimirs"),
            ad: place("ad"),
            ad_star: place("ad_star"),
            ad_star_matrix: place("ad_star_matrix"),
            coadjoint_action: place("coadjoint_action"),
            dexp_dual: place("dexp_dual"),
            dexp_dual_slope: place("dexp_dual_slope"),
            triple: place("triple"),
            lagrangian: ["lagrangian", "momentum", "inertia"].map(place),
            discrete: [
                "discrete_lagrangian",
                "discrete_slope",
                "discrete_curvature",
            ]
            .map(place),
            casimir_gradients: gradients
                .map(|casimir| self.kernel(&casimir.gradient))
                .collect(),
        }
    }
}

impl Compiled {
    fn new(plan: Plan) -> Self {
        let mut making = Making {
            codes: Vec::new(),
            size: plan.dimension(),
        };
        let kernels = making.kernels(&plan);
        let constants = making.push(Code::of_program(&plan.constants.program));
        let (mut fused, mut generating) = (HashMap::new(), HashMap::new());
        let (mut eliminations, mut solvers) = (HashMap::new(), HashMap::new());
        let mut gradients = HashMap::new();
        let (mut taylor, mut lie_taylor) = (None, None);
        for (place, item) in plan.items.iter().enumerate() {
            match item {
                Item::Fused(equation) => {
                    if let Some(codes) = making.fused(place, equation) {
                        fused.insert(equation.suffix, codes);
                    }
                }
                Item::Generating(function) => {
                    generating.insert(function.suffix, making.generating(function));
                }
                Item::Sparse(sparse) => {
                    let table = Table::new(&sparse.elimination);
                    eliminations.insert(sparse.suffix.clone(), table);
                }
                Item::Method(Method::Catalogue(choice), solver) => {
                    solvers.insert(choice.clone(), solver.clone());
                }
                Item::Gradient(gradient) => {
                    let functions = gradient.functions.clone();
                    let codes = functions
                        .iter()
                        .map(|function| making.kernel(function))
                        .collect();
                    gradients.insert(gradient.gradient, (codes, functions));
                }
                Item::Recurrence(recurrence) => {
                    let codes = crate::series::Codes::new(recurrence, &mut making);
                    match recurrence.gradient {
                        None => taylor = Some(codes),
                        Some(_) => lie_taylor = Some(codes),
                    }
                }
                Item::Collective(_) | Item::Method(Method::Own(_), _) => {}
            }
        }
        let flows = crate::flows::Codes::new(&plan, &mut making);
        let structure = crate::structure::Codes::new(&plan, &mut making);
        let casimir_degrees = plan.system.casimirs.iter().map(|c| c.degree).collect();
        Self {
            codes: making.codes.into(),
            plan,
            kernels,
            constants,
            fused,
            generating,
            gradients,
            eliminations,
            solvers,
            taylor,
            lie_taylor,
            flows,
            structure,
            casimir_degrees,
        }
    }
}

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
    /// Whether systems can be made of a plan: not of a family, nor where H calls a function of Rust, nor over a realization.
    pub fn supports(plan: &Plan) -> bool {
        let own = |operation: &Operation<_>| {
            matches!(operation, Operation::Call(symbolic::Function::Own(_), _))
        };
        let mut functions = plan.system.functions();
        let calls_rust = functions.any(|function| function.program.operations.iter().any(own));
        !calls_rust && plan.family.is_none() && plan.structure.realization.is_none()
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
