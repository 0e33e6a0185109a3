//! Runs, verifications and measurements of a declaration in the process that has read it, without a compiler of Rust.
//!
//! Requests and answers are those of [`lie_program`]: what is made here is served as a built program serves it, by
//! [`lie_program::session::serve`], or a request at a time by [`Work`]. What the command and the Python package say of the answers
//! alike is here too: [`verify`] with [`evidence`], [`stress`], [`report`], [`catalogue`].

#![warn(missing_docs)]

pub mod catalogue;
pub mod clock;
pub mod evidence;
pub mod families;
pub mod formula;
pub mod list;
pub mod members;
pub mod report;
pub mod stress;
pub mod table;
pub mod verify;
pub mod words;

use lie_codegen::methods::Choice;
use lie_codegen::model::{Model, Size};
use lie_codegen::plan::plan;
use lie_codegen::program::{Chart, Purpose, beside, compared};
use lie_dynamic::{Declared, Dynamic, Method, at_defaults, at_defaults_dual, method, method_dual};
use lie_jit::Jit;
use lie_measure::verify::Kind;
use lie_measure::{Bench, Stress, Verify};
use lie_program::Program;
use lie_program::protocol::{End, Tolerances};
use lie_program::session::Session;
use lie_runtime::{ParameterError, driver};

/// The text of [`clock`], which built programs have too.
pub const CLOCK: &str = include_str!("clock.rs");

/// Does what the line of a request asks for.
pub type Work = dyn Fn(&str, &mut Session<'_>) -> Result<(), End> + Send + Sync;

/// The system of a spec before its parameters have values; none where H calls functions of Rust.
pub fn declared(model: &Model) -> Option<Declared> {
    let plan = plan(model, &[]);
    Dynamic::supports(&plan).then(|| Declared::new(plan, &Jit))
}

/// What serves requests for methods on a system in this process; none where H calls functions of Rust. Where times are
/// measured, `clock` reads the seconds of the processor, if it can.
pub fn work(
    model: &Model,
    choices: &[Choice],
    purpose: Purpose,
    clock: fn() -> Option<f64>,
) -> Option<Box<Work>> {
    let plan = plan(model, choices);
    let known = |choice: &Choice| method(choice, lie_dynamic::Tolerances::default()).is_some();
    if !Dynamic::supports(&plan) || !choices.iter().all(known) {
        return None;
    }
    let parameters = model.parameters.iter();
    let parameters = parameters.map(|p| (p.name.clone(), p.default_value));
    let declared = Declaration {
        plain: (purpose == Purpose::Verify)
            .then(|| Declared::new(lie_codegen::plan::plan(model, &[]), &Jit)),
        with_group: plan.structure.group.is_some(),
        with_cayley: plan.system.triple.is_some(),
        with_lagrangian: !plan.system.lagrangian.is_empty(),
        with_discrete: !plan.system.discrete.is_empty(),
        with_realization: plan.structure.realization.is_some(),
        declared: Declared::new(plan, &Jit),
        choices: choices.to_vec(),
        parameters: parameters.collect(),
        compared: compared(model, choices).into_iter().cloned().collect(),
        confirming: families::confirming(model),
        sizes: sizes(model),
        orbits: model.is_lie_poisson(),
    };
    Some(match purpose {
        Purpose::Run => Box::new(move |line, session| declared.run(None, line, session)),
        Purpose::OnGroup(chart) => {
            Box::new(move |line, session| declared.run(Some(chart), line, session))
        }
        Purpose::Verify => Box::new(move |line, session| declared.verify(line, session)),
        Purpose::Bench => Box::new(move |line, session| declared.bench(clock, line, session)),
        Purpose::Stress => Box::new(move |line, session| declared.stress(line, session)),
    })
}

/// What a thread needs of a declaration.
struct Declaration {
    declared: Declared,
    /// Without fused equations, where steps are compared.
    plain: Option<Declared>,
    with_group: bool,
    with_cayley: bool,
    with_lagrangian: bool,
    with_discrete: bool,
    with_realization: bool,
    choices: Vec<Choice>,
    parameters: Vec<(String, f64)>,
    compared: Vec<Choice>,
    /// Confirms the reference solution.
    confirming: Choice,
    /// The parameters that say how many sites there are.
    sizes: Vec<String>,
    orbits: bool,
}

/// What is known to be there: whether there is a method depends neither on tolerances nor on the scalar.
fn there<M>(method: Option<M>) -> M {
    method.unwrap_or_else(|| unreachable!("the method was there before"))
}

fn of_dynamic(tolerances: &Tolerances) -> lie_dynamic::Tolerances {
    let (rtol, atol) = (tolerances.rtol, tolerances.atol);
    lie_dynamic::Tolerances { rtol, atol }
}

fn made(choice: &Choice, tolerances: &Tolerances) -> Method {
    there(method(choice, of_dynamic(tolerances)))
}

/// Makes the system of values of the parameters.
fn maker(
    declared: &Declared,
) -> impl Fn(&[f64]) -> Result<Dynamic<f64>, ParameterError> + Send + Sync + use<> {
    let declared = declared.clone();
    move |values| declared.system(values)
}

impl Declaration {
    fn parameters(&self) -> Vec<(&str, f64)> {
        let parameters = self.parameters.iter();
        parameters
            .map(|(name, value)| (name.as_str(), *value))
            .collect()
    }

    fn run(&self, chart: Option<Chart>, line: &str, session: &mut Session<'_>) -> Result<(), End> {
        let mut program = Program::new(&self.parameters(), maker(&self.declared));
        for choice in &self.choices {
            let (label, choice) = (choice.label(), choice.clone());
            let make = move |tolerances: &Tolerances| made(&choice, tolerances);
            program = match chart {
                None => program.any_method(&label, make),
                Some(chart) => program.any_on_group(&label, of_driver(chart), make),
            };
        }
        program.run(line, session)
    }

    fn verify(&self, line: &str, session: &mut Session<'_>) -> Result<(), End> {
        let mut program = Verify::new(&self.parameters(), maker(&self.declared));
        for choice in &self.choices {
            let (label, choice) = (choice.label(), choice.clone());
            let series = matches!(choice, Choice::Taylor | Choice::LieTaylor);
            let kind = if choice.solved() != &choice {
                Kind::Composed
            } else if choice.is_adaptive() && !series {
                Kind::Adaptive
            } else {
                Kind::Plain
            };
            program = program.any_method(&label, kind, move |tolerances| match series {
                true => (
                    there(at_defaults(&choice)),
                    there(at_defaults_dual(&choice)),
                ),
                false => (
                    made(&choice, tolerances),
                    there(method_dual(&choice, of_dynamic(tolerances))),
                ),
            });
        }
        for choice in &self.compared {
            let Some(plain) = &self.plain else { break };
            let (label, build) = (choice.label(), maker(plain));
            let choice = choice.clone();
            let make = move |tolerances: &Tolerances| made(&choice, tolerances);
            program = program.any_plain(&label, build, make);
        }
        if self.orbits {
            program = program.with_orbits();
        }
        if self.with_group {
            program = program.with_group();
        }
        if self.with_cayley {
            program = program.with_cayley();
        }
        if self.with_lagrangian {
            program = program.with_lagrangian();
        }
        if self.with_discrete {
            program = program.with_discrete();
        }
        if self.with_realization {
            program = program.with_realization();
        }
        for label in beside(&self.choices) {
            program = program.beside(&label);
        }
        program.work(line, session)
    }

    fn bench(
        &self,
        clock: fn() -> Option<f64>,
        line: &str,
        session: &mut Session<'_>,
    ) -> Result<(), End> {
        // what is compiled is compiled before a time is taken
        let (declared, parameters) = (self.declared.clone(), self.parameters());
        let build = move |values: &[f64]| Ok(declared.system(values)?.without_patience());
        let program = Bench::new(&parameters, build);
        let confirming = made(&self.confirming, &Tolerances::default());
        let mut program = program.clock(clock).confirmed_by(confirming);
        for choice in &self.choices {
            let (label, choice) = (choice.label(), choice.clone());
            program = match choice.is_adaptive() {
                true => program.any_adaptive(&label, move |tolerances| made(&choice, tolerances)),
                false => program.any_method(&label, move || made(&choice, &Tolerances::default())),
            };
        }
        program.work(line, session)
    }

    fn stress(&self, line: &str, session: &mut Session<'_>) -> Result<(), End> {
        let program = Stress::new(&self.parameters(), maker(&self.declared));
        let mut program = program.leaving(&self.sizes);
        for choice in &self.choices {
            let (label, choice) = (choice.label(), choice.clone());
            program = program.any_method(&label, move || made(&choice, &Tolerances::default()));
        }
        program.work(line, session)
    }
}

/// The parameters of a family that say how many sites it has.
fn sizes(model: &Model) -> Vec<String> {
    let sizes = model.family.iter().flat_map(|family| &family.sizes);
    let named = sizes.filter_map(|size| match size {
        Size::Parameter(place) => Some(model.parameters[*place].name.clone()),
        Size::Number(_) => None,
    });
    named.collect()
}

/// The chart of the driver.
fn of_driver(chart: Chart) -> driver::Chart {
    match chart {
        Chart::Matrix => driver::Chart::Matrix,
        Chart::Quaternion => driver::Chart::Quaternion,
    }
}
