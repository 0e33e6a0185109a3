//! Lyapunov exponents of a declared system along an orbit: what is asked for, checked, and what is found.

use lie_codegen::model::Energy;
use lie_codegen::program::Purpose;
use lie_dynamic::Dynamic;
use lie_program::blueprint::{Blueprint, Built};
use lie_program::protocol::{End, Start, Stop};
use lie_program::session::Session;
use lie_runtime::driver::{Density, Pace};
use lie_runtime::methods::Keep;
use lie_runtime::{Dual, Lift as _};
use lie_spectra::exponents::{Options, Spectrum, exponents};
use lie_syntax::diagnostic::{Kind, Origin};
use serde_json::{Value as Json, json};

use crate::message::{Message, Place};
use crate::request::{self, OptionValue, Plan, Request, Value};
use crate::spec::Spec;
use crate::words::number;
use crate::{Question, Work, clock, maker};

/// What is asked for beside a method, its steps, a start and a seed.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// The time before the sums begin.
    pub transient: Option<Value>,
    /// How many exponents; all without it.
    pub count: Option<Value>,
}

/// A measurement, checked.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// The method, its step and its solver.
    pub plan: Plan,
    /// Where the orbit starts.
    pub start: Start,
    /// Steps and vectors.
    pub options: Options,
}

impl Measurement {
    /// What a request asks for, and what measures it.
    ///
    /// # Errors
    /// Every mistake, and what has no exponents in this sense.
    pub fn new(
        spec: &Spec,
        request: &Request,
        asked: &Asked,
    ) -> Result<(Self, Work), Vec<Message>> {
        applies(spec).map_err(|message| vec![message])?;
        let mut mistakes = missing(spec, request);
        let mut keep = |found: Vec<Message>| mistakes.extend(found);
        let plan = request::plan(spec, request).map_err(&mut keep).ok();
        let start = request::start(spec, request).map_err(&mut keep).ok();
        let (Some(plan), Some(start), true) = (plan, start, mistakes.is_empty()) else {
            return Err(mistakes);
        };
        let options = options(spec, request, asked, &plan).map_err(|message| vec![message])?;
        let methods = std::slice::from_ref(&plan.method);
        let work = Work::new(&spec.model, methods, Purpose::Run, clock::processor);
        let work = work.ok_or_else(|| {
            vec![refused(
                spec,
                "it calls functions of Rust, whose derivatives are not known here",
                "write the function as an expression of the grammar",
            )]
        })?;
        let measurement = Self {
            start: start.named(spec),
            options,
            plan,
        };
        Ok((measurement, work))
    }

    /// What was found, for programs.
    pub fn as_json(&self, spec: &Spec, spectrum: &Spectrum) -> Json {
        let optional = |value: Option<f64>| value.map_or(Json::Null, number);
        let of = |part: fn(&lie_spectra::exponents::Exponent) -> f64| -> Json {
            spectrum
                .exponents
                .iter()
                .map(|one| number(part(one)))
                .collect()
        };
        json!({
            "system": spec.model.name,
            "method": self.plan.method.label(),
            "step": number(self.options.step),
            "transient": number(spectrum.transient as f64 * self.options.step.abs()),
            "time": number(spectrum.time),
            "steps": spectrum.steps,
            "seed": self.options.seed,
            "exponents": of(|one| one.value),
            "errors": of(|one| one.error),
            "sum": optional(spectrum.sum()),
            "dimension": spectrum.dimension,
            "leaf_dimension": 2 * spectrum.pairs,
            "pairing_defect": optional(spectrum.pairing()),
            "casimir_exponents": optional(spectrum.casimirs()),
            "stopped": spectrum.failure.map(|(_, failure)| failure.reason.to_string()),
        })
    }
}

impl Question for Measurement {
    type Found = Spectrum;

    fn put(self, work: &Work, session: &mut Session<'_, Spectrum>) -> Result<(), End> {
        let blueprint = Blueprint::new(&work.parameters(), maker(&work.declared));
        let Built { system, mu } = blueprint.build(&self.start)?;
        let lifted: Dynamic<Dual<f64>> = system.lift();
        let Plan {
            method,
            tolerances,
            newton,
            ..
        } = &self.plan;
        let tangent = lie_tangents::method(method, *tolerances);
        let all = self.options.transient + self.options.steps;
        let mut end = Ok(());
        let mut goes_on = |done: u64| {
            end = session.progress(done, all);
            end.is_ok()
        };
        let spectrum = exponents(&lifted, &*tangent, newton, &mu, &self.options, &mut goes_on);
        let failure = spectrum.failure;
        session.found(spectrum);
        match failure {
            None => end,
            Some((step, failure)) => Err(End::Stopped(Stop {
                step,
                time: self.options.from + (step - 1) as f64 * self.options.step,
                iterations: failure.report.iterations,
                residual: failure.report.residual,
                reason: failure.reason.to_string(),
                remedy: failure.reason.remedy().to_owned(),
            })),
        }
    }
}

fn refused(spec: &Spec, text: &str, help: &str) -> Message {
    let text = format!("no Lyapunov exponents of {}: {text}", spec.model.name);
    let message = Message::new(Kind::Method, text).help(help);
    match spec.model.energy_origin {
        Origin::Text { start, end } => {
            message.at_place(Place::Text(spec.source.clone(), start..end))
        }
        Origin::Span(_) => message.at_option("SPEC"),
    }
}

/// Refuses systems along whose orbits no tangent is carried here.
fn applies(spec: &Spec) -> Result<(), Message> {
    let model = &spec.model;
    if model.family.is_some() {
        return Err(refused(
            spec,
            "it is a family, whose steps over all sites have no tangents here",
            "write a system of a few coordinates out, without `sites`",
        ));
    }
    if model.holds() {
        return Err(refused(
            spec,
            "noise or inputs are held over its steps, and the tangent of a step does not know them",
            "leave them out of the spec, or write an input as a function of `t`",
        ));
    }
    if let Energy::Legendre(..) = model.energy {
        return Err(refused(
            spec,
            "its H is no expression: the velocity of a momentum is found by iteration",
            "declare the Hamiltonian itself, with `\"hamiltonian\"`",
        ));
    }
    Ok(())
}

/// What neither the request nor the spec says, and for which no default makes sense.
fn missing(spec: &Spec, request: &Request) -> Vec<Message> {
    let in_spec = |name: &str| spec.model.run.iter().any(|o| o.name.text == name);
    let said = |name: &str| request.get(name).is_some() || in_spec(name);
    let lacks = |name: &str, text: &str, example: &str| {
        let message = Message::option(&request.front.option(name), text);
        let example = request.front.assignment(name, example);
        message.help(format!(
            "give it, such as {example}, or in `run` of the spec"
        ))
    };
    let mut mistakes = Vec::new();
    if !said("step") && !said("tol") {
        mistakes.push(lacks(
            "step",
            "no step is given, and its tangent is measured",
            "0.05",
        ));
    }
    if !said("until") && !in_spec("at") {
        let text = "no end is given, and exponents are means over a long time";
        mistakes.push(lacks("until", text, "1000"));
    }
    mistakes
}

/// Steps, vectors and the seed.
fn options(spec: &Spec, request: &Request, asked: &Asked, plan: &Plan) -> Result<Options, Message> {
    let front = request.front;
    let mistake = |name: &str, text: String, help: &str| {
        Err(Message::option(&front.option(name), text).help(help))
    };
    let Pace::Step(step) = plan.pace.0 else {
        let text = "the tangent of steps of one size is measured, and a tolerance is given";
        return mistake("step", text.to_owned(), "give a step, such as 0.05");
    };
    if plan.keep != Keep::default() || plan.density != Density::Constant {
        let text = "the spec's `run` projects steps, or lets their size follow the motion, and their tangent is not that of the method";
        let help = "leave `keep` and `density` out of the spec's `run`";
        return mistake("method", text.to_owned(), help);
    }
    let transient = match &asked.transient {
        None => 0.0,
        Some(value) => OptionValue::value(&front.option("transient"), value).number()?,
    };
    let whole = ((plan.end() - plan.from) / step).round();
    let before = (transient / step.abs()).round();
    if whole < 1.0 {
        let text = "the run has no step".to_owned();
        return mistake("until", text, "give an end some steps behind the start");
    }
    if before < 0.0 || before >= whole {
        let text = format!(
            "the sums begin after a time of {transient}, and the run takes {}",
            (plan.end() - plan.from).abs()
        );
        let help = "give a time of 0 or more, and an end some steps behind it";
        return mistake("transient", text, help);
    }
    let dimension = spec.model.shown_coordinates().len();
    let count = match &asked.count {
        None => dimension as f64,
        Some(value) => OptionValue::value(&front.option("count"), value).number()?,
    };
    if count.fract() != 0.0 || !(1.0..=dimension as f64).contains(&count) {
        let text = format!("{count} exponents of a system of {dimension} coordinates");
        let help = format!("give a whole number from 1 to {dimension}, or leave it out for all");
        return mistake("count", text, &help);
    }
    Ok(Options {
        step,
        from: plan.from,
        transient: before as u64,
        steps: (whole - before) as u64,
        count: count as usize,
        seed: request::seed(request)?,
    })
}
