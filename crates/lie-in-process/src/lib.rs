//! Runs, verifications and measurements of a declaration in the process that has read it, without a compiler of Rust.
//!
//! What a person asks of a run is a [`request::Request`], which is checked once. Questions and answers are those of
//! [`lie_program`] and [`lie_measure`]: a [`Question`] is answered by [`Work`], in a thread whose words come by a channel
//! ([`converse`](mod@converse)). What the command and the Python package say of the answers alike is here too: [`verify`]
//! with [`evidence`], [`stress`], [`exponents`], [`report`], [`catalogue`].

#![warn(missing_docs)]

pub mod canonical;
pub mod catalogue;
pub mod checkpoint;
pub mod clock;
pub mod converse;
pub mod draw;
pub mod ensemble;
pub mod evidence;
pub mod exponents;
pub mod families;
pub mod formula;
pub mod key;
pub mod list;
pub mod members;
pub mod memory;
pub mod message;
pub mod reduce;
pub mod report;
pub mod request;
pub mod share;
pub mod spec;
pub mod stress;
pub mod table;
pub mod verify;
pub mod words;

use lie_codegen::methods::Choice;
use lie_codegen::model::Size;
use lie_codegen::plan::plan;
use lie_codegen::program::{Chart, Purpose, beside, compared, confirming};
use lie_codegen::structure::Structure;
use lie_dynamic::{Declared, Dynamic};
use lie_jit::Jit;
use lie_measure::verify::Kind;
use lie_measure::{Bench, Request, Stress, Verify, bench, stress as limits, verify as claims};
use lie_methods::{at_defaults, method};
use lie_program::Program;
use lie_program::protocol::{End, Found, Milestones, Run, Tolerances};
use lie_program::session::Session;
use lie_runtime::ParameterError;

/// The text of [`clock`], which built programs have too.
pub const CLOCK: &str = include_str!("clock.rs");

/// What can be asked of methods on a system.
pub trait Question: Send + 'static {
    /// What is found.
    type Found: Send + 'static;

    /// Has it answered.
    ///
    /// # Errors
    /// Why not everything was found.
    fn put(self, work: &Work, session: &mut Session<'_, Self::Found>) -> Result<(), End>;
}

impl Question for Run {
    type Found = Found;

    fn put(self, work: &Work, session: &mut Session<'_, Found>) -> Result<(), End> {
        work.run(&self, session)
    }
}

impl Question for Request<claims::Options> {
    type Found = claims::Found;

    fn put(self, work: &Work, session: &mut Session<'_, claims::Found>) -> Result<(), End> {
        work.verify(&self, session)
    }
}

impl Question for Request<bench::Options> {
    type Found = bench::Found;

    fn put(self, work: &Work, session: &mut Session<'_, bench::Found>) -> Result<(), End> {
        work.bench(&self, session)
    }
}

impl Question for Request<limits::Options> {
    type Found = limits::Found;

    fn put(self, work: &Work, session: &mut Session<'_, limits::Found>) -> Result<(), End> {
        work.stress(&self, session)
    }
}

/// The system of a spec before its parameters have values; none where H calls functions of Rust.
pub fn declared(model: &Structure) -> Option<Declared> {
    let plan = plan(model, &[]);
    Dynamic::supports(&plan).then(|| Declared::new(plan, &Jit))
}

/// What answers questions on methods of a system in this process.
pub struct Work {
    declared: Declared,
    /// Without fused equations, where steps are compared.
    plain: Option<Declared>,
    /// How a run writes the group element, if it does.
    chart: Option<Chart>,
    /// Reads the seconds of the processor, if it can.
    clock: fn() -> Option<f64>,
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

/// Makes the system of values of the parameters.
fn maker(
    declared: &Declared,
) -> impl Fn(&[f64]) -> Result<Dynamic<f64>, ParameterError> + Send + Sync + use<> {
    let declared = declared.clone();
    move |values| declared.system(values)
}

impl Work {
    /// What answers questions of one purpose on methods of a system; none where H calls functions of Rust. Where times are
    /// measured, `clock` reads the seconds of the processor, if it can.
    pub fn new(
        model: &Structure,
        choices: &[Choice],
        purpose: Purpose,
        clock: fn() -> Option<f64>,
    ) -> Option<Self> {
        let plan = plan(model, choices);
        if !Dynamic::supports(&plan) {
            return None;
        }
        let parameters = model.parameters.iter();
        let parameters = parameters.map(|p| (p.name.clone(), p.default_value));
        Some(Self {
            plain: (purpose == Purpose::Verify)
                .then(|| Declared::new(lie_codegen::plan::plan(model, &[]), &Jit)),
            chart: match purpose {
                Purpose::OnGroup(chart) => Some(chart),
                _ => None,
            },
            clock,
            with_group: plan.structure.group.is_some(),
            with_cayley: plan.system.triple.is_some(),
            with_lagrangian: !plan.system.lagrangian.is_empty(),
            with_discrete: !plan.system.discrete.is_empty(),
            with_realization: plan.structure.realization.is_some(),
            declared: Declared::new(plan, &Jit),
            choices: choices.to_vec(),
            parameters: parameters.collect(),
            compared: compared(model, choices).into_iter().cloned().collect(),
            confirming: confirming(model),
            sizes: sizes(model),
            orbits: model.is_lie_poisson(),
        })
    }

    /// The system before its parameters have values.
    pub fn declared(&self) -> &Declared {
        &self.declared
    }

    fn parameters(&self) -> Vec<(&str, f64)> {
        let parameters = self.parameters.iter();
        parameters
            .map(|(name, value)| (name.as_str(), *value))
            .collect()
    }

    fn run(&self, run: &Run, session: &mut Session<'_, Found>) -> Result<(), End> {
        // steppers that are made anew at milestones would wait again
        let (make, hurries) = (maker(&self.declared), run.milestones != Milestones::None);
        let mut program = Program::new(&self.parameters(), move |values| {
            let system = make(values)?;
            Ok(if hurries {
                system.without_patience()
            } else {
                system
            })
        });
        for choice in &self.choices {
            let (label, choice) = (choice.label(), choice.clone());
            let make = move |tolerances: &Tolerances| method(&choice, *tolerances);
            program = match self.chart {
                None => program.any_method(&label, make),
                Some(chart) => program.any_on_group(&label, chart, make),
            };
        }
        program.run(run, session)
    }

    fn verify(
        &self,
        request: &Request<claims::Options>,
        session: &mut Session<'_, claims::Found>,
    ) -> Result<(), End> {
        let mut program = Verify::new(&self.parameters(), maker(&self.declared));
        for choice in &self.choices {
            let (label, choice) = (choice.label(), choice.clone());
            let series = matches!(choice, Choice::Taylor | Choice::LieTaylor);
            let kind = if choice.is_composed() {
                Kind::Composed
            } else if choice.is_adaptive() && !series {
                Kind::Adaptive
            } else {
                Kind::Plain
            };
            program = program.any_method(&label, kind, move |tolerances| match series {
                true => (at_defaults(&choice), lie_tangents::at_defaults(&choice)),
                false => (
                    method(&choice, *tolerances),
                    lie_tangents::method(&choice, *tolerances),
                ),
            });
        }
        for choice in &self.compared {
            let Some(plain) = &self.plain else { break };
            let (label, build) = (choice.label(), maker(plain));
            let choice = choice.clone();
            let make = move |tolerances: &Tolerances| method(&choice, *tolerances);
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
        program.work(request, session)
    }

    fn bench(
        &self,
        request: &Request<bench::Options>,
        session: &mut Session<'_, bench::Found>,
    ) -> Result<(), End> {
        // what is compiled is compiled before a time is taken
        let (declared, parameters) = (self.declared.clone(), self.parameters());
        let build = move |values: &[f64]| Ok(declared.system(values)?.without_patience());
        let confirming = method(&self.confirming, Tolerances::default());
        let mut program = Bench::with_any(&parameters, build, confirming).clock(self.clock);
        for choice in &self.choices {
            let (label, choice) = (choice.label(), choice.clone());
            program = match choice.is_adaptive() {
                true => {
                    program.any_adaptive(&label, move |tolerances| method(&choice, *tolerances))
                }
                false => program.any_method(&label, move || method(&choice, Tolerances::default())),
            };
        }
        program.work(request, session)
    }

    fn stress(
        &self,
        request: &Request<limits::Options>,
        session: &mut Session<'_, limits::Found>,
    ) -> Result<(), End> {
        let program = Stress::new(&self.parameters(), maker(&self.declared));
        let mut program = program.leaving(&self.sizes);
        for choice in &self.choices {
            let (label, choice) = (choice.label(), choice.clone());
            program = program.any_method(&label, move || method(&choice, Tolerances::default()));
        }
        program.work(request, session)
    }
}

/// The parameters of a family that say how many sites it has.
fn sizes(model: &Structure) -> Vec<String> {
    let sizes = model.family.iter().flat_map(|family| &family.sizes);
    let named = sizes.filter_map(|size| match size {
        Size::Parameter(place) => Some(model.parameters[*place].name.clone()),
        Size::Number(_) => None,
    });
    named.collect()
}
