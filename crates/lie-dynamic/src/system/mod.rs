//! A system made at run time: the traits of the numeric core by the codes of its plan, a file for each structure that a system may have.

mod algebra;
mod answers;
pub(crate) mod canonical;
pub(crate) mod family;
pub(crate) mod flows;
mod lagrangian;
mod names;
pub(crate) mod realization;
pub(crate) mod retraction;
pub(crate) mod series;
pub(crate) mod structure;
mod traits;

use crate::code::Code;
use crate::compiled::{Compiled, Values};
use crate::engine::{ARGUMENTS, Engine, Interpreter, Machine};
use crate::recording::PATIENCE;
use answers::{Families as _, without_loops};
use family::{FamilySite, sizes};
use lie_codegen::plan::{Code as Program, Data, Plan};
use lie_core::lattice::AXES;
use lie_core::parameter::{ParameterError, all_finite, all_positive};
use lie_runtime::Scalar;
use lie_runtime::family::{Family, bonds, unit_spheres, values};
use lie_symbolic::schedule::Operation;
use lie_symbolic::symbolic::{self, Symbol};
use std::sync::Arc;

/// As many steps as gain what an assembler takes.
const QUICK: u32 = 64;

/// A Lie–Poisson system made at run time, over states on the heap.
///
/// It implements the traits of the numeric core by the codes of its plan. Traits for structure that it does not have answer
/// with what is empty, or panic: [`method_over`](crate::method_over) is asked for methods that apply.
#[derive(Clone)]
pub struct Dynamic<S: Scalar> {
    pub(crate) values: Values<S>,
    /// A velocity of the branch of the Legendre transform; none for that which begins at rest.
    pub(crate) branch: Option<Vec<S>>,
    /// The loops over the sites of a family.
    pub(crate) family: Option<Family<FamilySite<S>>>,
    /// The systems that this one is, side by side in lanes.
    pub(crate) members: Arc<[Dynamic<f64>]>,
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

    /// So many steps, at least, pay for programs of the whole.
    pub fn patience(&self) -> u32 {
        match self.machine.compiles_quickly() {
            true => QUICK,
            false => PATIENCE,
        }
    }

    /// The system of these parameters, in the order of their names; those that are left out have their defaults. Nothing is
    /// compiled again.
    ///
    /// # Errors
    /// A parameter that must be positive is not, or a constant that the system needs is not finite.
    pub fn system(&self, parameters: &[f64]) -> Result<Dynamic<f64>, ParameterError> {
        let values = Values {
            compiled: Arc::clone(&self.compiled),
            machine: Arc::clone(&self.machine),
            parameters: Vec::new(),
            constants: Vec::new(),
            data: Arc::default(),
            hurry: false,
        };
        let system = Dynamic {
            values,
            branch: None,
            family: None,
            members: Arc::default(),
        };
        system.with_parameters(parameters)
    }
}

impl Dynamic<f64> {
    /// Whether systems can be made of a plan: not where H calls a function of Rust.
    pub fn supports(plan: &Plan) -> bool {
        let own = |operation: &Operation<_>| {
            matches!(operation, Operation::Call(symbolic::Function::Own(_), _))
        };
        let of_sites = plan.family.iter().flat_map(|family| family.functions());
        let mut functions = plan.system.functions().chain(of_sites);
        !functions.any(|function| function.program.operations.iter().any(own))
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
        let mut values = self.values.clone();
        values.parameters = parameters.to_vec();
        if parameters.len() < self.plan().parameters.len() {
            let defaults = self.constants_of(&self.plan().defaults).into_iter();
            values.parameters.extend(defaults.skip(parameters.len()));
        }
        check_signs(&values)?;
        let mut constants = vec![0.0; self.plan().constants.entries.len()];
        let frame = values.frame([&[]; ARGUMENTS], &[], &[]);
        values.run(values.compiled.constants, &frame, [&mut constants, &mut []]);
        values.constants = constants;
        check_constants(&values)?;
        let family = match &values.compiled.plan.family {
            Some(family) => {
                let sizes = sizes(&family.sizes, &values)?;
                values.data = data(&family.data, sizes)?;
                Some(Family::new(FamilySite::new(values.clone()), sizes))
            }
            None => None,
        };
        Ok(Self {
            values,
            branch: None,
            family,
            members: Arc::default(),
        })
    }

    /// The same system without the wait of [`PATIENCE`](crate::PATIENCE) steps: its steppers compile programs of the whole when they
    /// are made. That pays where many runs are short.
    #[must_use]
    pub fn without_patience(mut self) -> Self {
        self.values.hurry = true;
        self
    }

    /// The declared initial state for the parameters of the system.
    pub fn initial_state(&self) -> Option<Vec<f64>> {
        let Some(family) = &self.family else {
            return Some(self.constants_of(self.plan().initial.as_ref()?));
        };
        let seed = self.plan().family.as_ref()?.seed?;
        let dimension = self.plan().family.as_ref()?.coordinates.len();
        Some(family.state(unit_spheres(family.count(), dimension, seed)))
    }

    /// The state of a family for the coordinates of its sites; of other systems it is the state.
    #[must_use]
    pub fn completed(&self, state: Vec<f64>) -> Vec<f64> {
        match &self.family {
            Some(family) => family.state(state),
            None => state,
        }
    }

    /// What a program makes of the parameters.
    fn constants_of(&self, program: &Program) -> Vec<f64> {
        let code = Code::from_program(program);
        let mut values = vec![0.0; code.stores.len()];
        let frame = self.values.frame([&[]; ARGUMENTS], &[], &[]);
        let interpreter = Interpreter::new(Arc::from(vec![code]));
        interpreter.run(0, &frame, [&mut values, &mut []]);
        values
    }
}

/// What has a value for each site.
fn data(all: &[Data], sizes: [usize; AXES]) -> Result<Arc<[Vec<f64>]>, ParameterError> {
    let columns = all.iter().map(|data| {
        let given: Vec<f64> = data.values().collect();
        let name = names::text(&data.name);
        if data.bonds {
            return bonds(&given, name, sizes);
        }
        match data.sizes.is_some_and(|of_values| of_values != sizes) {
            // the rows of another lattice
            true => values(&[], name, sizes, 0),
            false => values(&given, name, sizes, data.unused),
        }
    });
    columns.collect()
}

fn check_signs(values: &Values<f64>) -> Result<(), ParameterError> {
    let plan = &values.compiled.plan;
    let all = plan
        .parameters
        .iter()
        .zip(&plan.names.parameters)
        .zip(&values.parameters);
    let positive = all.filter(|((parameter, _), _)| parameter.positive);
    let positive: Vec<_> = positive
        .map(|((_, name), value)| (*value, names::text(name)))
        .collect();
    all_positive(&positive)
}

fn check_constants(values: &Values<f64>) -> Result<(), ParameterError> {
    let plan = &values.compiled.plan;
    let entries = plan.constants.entries.iter().zip(&values.constants);
    let failing = entries.filter(|(_, value)| !value.is_finite());
    let failing: Vec<_> = failing
        .map(|(entry, value)| {
            let symbol = entry.parameter.map(Symbol::Parameter);
            let name = symbol
                .map(|symbol| plan.names.display_name(symbol))
                .unwrap_or_default();
            (*value, names::text(&name), names::text(&entry.text))
        })
        .collect();
    all_finite(&failing)
}
impl<S: Scalar> Dynamic<S> {
    /// The plan that it was made of.
    pub fn plan(&self) -> &Plan {
        &self.values.compiled.plan
    }

    /// The values of the parameters.
    pub fn parameters(&self) -> &[S] {
        &self.values.parameters
    }

    /// The number of layers, rows and columns of sites, of a family; a chain is one row, a square lattice one layer.
    pub fn sizes(&self) -> Option<[usize; AXES]> {
        self.family.as_ref().map(Family::sizes)
    }

    /// The same with its constants as other scalars, by this machine.
    pub(crate) fn with_scalar<T: Scalar>(
        &self,
        constant: impl Fn(S) -> T,
        machine: Arc<dyn Machine<T>>,
    ) -> Dynamic<T> {
        let branch = self.branch.as_deref();
        let branch = branch.map(|values| values.iter().map(|value| constant(*value)).collect());
        let values = self.values.with_scalar(constant, machine);
        let family = match self.sizes() {
            Some(sizes) if T::FAMILIES => Some(Family::new(FamilySite::new(values.clone()), sizes)),
            Some(_) if T::LOOPS => without_loops(),
            _ => None,
        };
        Dynamic {
            values,
            branch,
            family,
            members: Arc::default(),
        }
    }
}
