//! A plan as codes: each of its programs, by its place; its eliminations; and the values of its parameters.

pub(crate) mod elimination;
mod values;

pub(crate) use values::Values;

use crate::cache::Cache;
use crate::code::Code;
use crate::engine::ARGUMENTS;
use crate::recording::{SeriesCodes, SeriesKind, StageCodes, Step, Traces};
use elimination::Elimination;
use lie_codegen::methods::{Choice, Gradient};
use lie_codegen::plan::{Constants, Function, Fused, Generating, Item, Method, Plan, Solver};
use lie_core::generic::StageSlopes;
use smallvec::SmallVec;
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
    pub joints: Place,
    /// Of the force and of the generator, each with its slope.
    pub driving: [Place; 5],
    /// The entropy, its gradient and Hessian, the metric and its slope.
    pub metriplectic: [Place; 5],
    pub quantities: Place,
    pub events: Place,
    pub casimir_gradients: Vec<Place>,
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
pub(crate) struct StepConstants {
    /// The program of the constants.
    pub constants: usize,
    /// How many they are.
    pub count: usize,
}

/// What a kernel of an equation has as an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CallArgument {
    /// The state from which the step starts.
    Base,
    /// What is solved for.
    Unknown,
    /// The inverse length of the step.
    Inverse,
    /// The ratios of spins.
    Ratios,
}

/// A kernel of an equation.
#[derive(Clone, Debug)]
pub(crate) struct Call {
    pub code: usize,
    pub arguments: SmallVec<[CallArgument; ARGUMENTS]>,
}

/// A fused equation: its codes, and its row in the plan.
#[derive(Clone, Debug)]
pub(crate) struct FusedCodes {
    pub item: usize,
    pub residual: Call,
    pub linearize: Call,
    /// The update of Newton's iteration, with the residual behind it, and the factors.
    pub update: Option<Call>,
    pub guess: Option<Call>,
    pub result: Option<Call>,
    /// What completes the unknown, where the iteration leaves some of it out.
    pub completed: Option<Call>,
    /// Those of it.
    pub left_out: Vec<usize>,
    pub step: StepConstants,
    pub elimination: Elimination,
    /// The cost of an iteration with a Jacobian in those without.
    pub cost: Option<f64>,
}

/// A generating function in code.
#[derive(Clone, Debug)]
pub(crate) struct GeneratingCodes {
    pub gradient: usize,
    pub linearize: Place,
    pub step: StepConstants,
}

/// The codes of a plan, which systems of all parameters and scalars share.
#[derive(Debug)]
pub(crate) struct Compiled {
    pub plan: Plan,
    pub codes: Arc<[Code]>,
    pub kernels: Kernels,
    /// The program of the constants.
    pub constants: usize,
    pub fused: HashMap<&'static str, FusedCodes>,
    pub generating: HashMap<&'static str, GeneratingCodes>,
    /// Discrete gradients in closed form: codes and kernels.
    pub gradients: HashMap<Gradient, (Vec<usize>, Vec<Function>)>,
    pub eliminations: HashMap<String, Elimination>,
    /// The equation of each method.
    pub solvers: HashMap<Choice, Solver>,
    pub taylor: Option<crate::system::series::Codes>,
    pub lie_taylor: Option<crate::system::series::Codes>,
    pub flows: crate::system::flows::Codes,
    pub structure: crate::system::structure::Codes,
    pub realization: Option<crate::system::realization::Codes>,
    /// The declared retraction.
    pub retraction: Option<crate::system::retraction::Codes>,
    /// Coordinates in which the bracket is constant.
    pub canonical: Option<crate::system::canonical::Codes>,
    pub family: Option<crate::system::family::Codes>,
    pub casimir_degrees: Vec<Option<u32>>,
    /// Steps as one program.
    pub steps: Cache<Step, Choice>,
    /// What steps of methods with a solver do, for one number alone or for lanes, by the options of the solver.
    pub traces: Cache<Traces, ((Choice, bool), String)>,
    /// Taylor series.
    pub series: Cache<SeriesCodes, SeriesKind>,
    /// Iterations over stages side by side, by their slopes and whether they are more than four.
    pub stages: Cache<StageCodes, (StageSlopes, bool)>,
}

/// Codes in the making.
pub(crate) struct CodeBuilder {
    codes: Vec<Code>,
    size: usize,
}

impl CodeBuilder {
    pub fn push(&mut self, code: Code) -> usize {
        self.codes.push(code);
        self.codes.len() - 1
    }

    pub fn kernel(&mut self, function: &Function) -> usize {
        let code = Code::from_kernel(function, self.size);
        self.push(code)
    }

    /// A kernel of an equation.
    fn call(&mut self, function: &Function) -> Call {
        self.call_of(Code::from_kernel(function, self.size), function)
    }

    /// A code with the arguments of a kernel.
    fn call_of(&mut self, code: Code, function: &Function) -> Call {
        let arguments = function.arguments.iter();
        let arguments = arguments.map(|argument| match argument.name {
            "mu" => CallArgument::Base,
            "inverse" => CallArgument::Inverse,
            "ratios" => CallArgument::Ratios,
            _ => CallArgument::Unknown,
        });
        Call {
            arguments: arguments.collect(),
            code: self.push(code),
        }
    }

    fn step(&mut self, constants: &Constants) -> StepConstants {
        StepConstants {
            constants: self.push(Code::from_program(&constants.program)),
            count: constants.entries.len(),
        }
    }

    fn fused(&mut self, item: usize, fused: &Fused) -> Option<FusedCodes> {
        let named = |name: &str| fused.functions.iter().find(|f| f.name == name);
        let jacobian = named("linearize")?;
        let linearize = Code::from_kernel(jacobian, self.size);
        let linearize = Code {
            clear: [linearize.clear[0], None],
            ..linearize.with_zeros(&fused.elimination.fill, self.size)
        };
        let elimination = Elimination::new(&fused.elimination, self.size, self);
        let update = elimination.update(&linearize, self.size);
        let costs = fused.costs();
        Some(FusedCodes {
            item,
            residual: self.call(named("residual")?),
            linearize: self.call_of(linearize, jacobian),
            update: update.map(|code| self.call_of(code, jacobian)),
            guess: named("initial_guess").map(|function| self.call(function)),
            result: named("result").map(|function| self.call(function)),
            completed: fused.completed().map(|function| self.call(function)),
            left_out: fused.left_out(),
            step: self.step(&fused.step),
            elimination,
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
            joints: place("joints"),
            driving: [
                "force",
                "force_slope",
                "generator",
                "generator_slope",
                "damping",
            ]
            .map(place),
            metriplectic: [
                "entropy",
                "entropy_gradient",
                "entropy_hessian",
                "metric",
                "metric_slope",
            ]
            .map(place),
            quantities: place("quantities"),
            events: place("events"),
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
                .map(|casimir| Some(self.kernel(casimir.gradient.as_ref()?)))
                .collect(),
        }
    }
}

impl Compiled {
    pub fn new(plan: Plan) -> Self {
        let mut making = CodeBuilder {
            codes: Vec::new(),
            size: plan.dimension(),
        };
        let kernels = making.kernels(&plan);
        let constants = making.push(Code::from_program(&plan.constants.program));
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
                    let size = making.size;
                    let elimination = Elimination::new(&sparse.elimination, size, &mut making);
                    eliminations.insert(sparse.suffix.clone(), elimination);
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
                    let codes = crate::system::series::Codes::new(recurrence, &mut making);
                    match recurrence.gradient {
                        None => taylor = Some(codes),
                        Some(_) => lie_taylor = Some(codes),
                    }
                }
                Item::Method(Method::Own(_), _) => {}
            }
        }
        let flows = crate::system::flows::Codes::new(&plan, &mut making);
        let structure = crate::system::structure::Codes::new(&plan, &mut making);
        let realization = plan.structure.realization.as_ref();
        let realization =
            realization.map(|r| crate::system::realization::Codes::new(r, &mut making));
        let retraction = crate::system::retraction::Codes::new(&plan.structure, &mut making);
        let canonical = crate::system::canonical::Codes::new(&plan.structure, &mut making);
        let family = plan.family.as_ref();
        let family = family.map(|family| crate::system::family::Codes::new(family, &mut making));
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
            realization,
            retraction,
            canonical,
            family,
            casimir_degrees,
            steps: Cache::default(),
            traces: Cache::default(),
            series: Cache::default(),
            stages: Cache::default(),
        }
    }
}
