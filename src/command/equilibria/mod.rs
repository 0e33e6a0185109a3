//! `lie equilibria`: relative equilibria on a leaf, their spectra, their stability, and how they go on in a parameter.

mod declared;
mod json;
mod low_rank;
mod numbers;
mod picture;
mod words;

use lie_codegen::structure::Effort;
use lie_equilibria::exact::Prover;
use lie_equilibria::{At, Candidate, Equations, Equilibrium, Found, LowRank, Paths, Traced, trace};
use lie_in_process::request::{self, Parameter, Point, Request, Value};
use lie_syntax::diagnostic::Kind;

use super::files::{Inputs, unwritable};
use super::run::outputs;
use super::{args, print};
use crate::compiler::{self, Spec};
use crate::message::{Failure, Message};
use crate::render;

/// What was found on a leaf.
pub struct Leaf {
    /// The values of the Casimirs.
    pub levels: Vec<f64>,
    /// What the search found.
    pub found: Found,
    /// What is known of each.
    pub equilibria: Vec<Equilibrium>,
    /// States at rest where the rank of the bracket drops.
    pub low_rank: Vec<LowRank>,
}

/// What was followed over a range of a parameter.
pub struct Range {
    /// The parameter.
    pub name: String,
    /// Its values.
    pub values: Vec<f64>,
    /// The branches.
    pub traced: Traced,
}

/// Finds and prints.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Equilibria) -> Result<u8, Failure> {
    let spec = compiler::load_with(&arguments.spec, Effort::Report)?;
    declared::applies(&spec)?;
    let asked = arguments.start();
    let (ranges, fixed) = request::ranges(&asked).map_err(Failure::invalid)?;
    let range = one_range(arguments, ranges)?;
    outputs::picture("--plot", arguments.plot.as_deref())?;
    let fixed = Request {
        param: fixed,
        ..asked
    };
    let point = start(&spec, &fixed, range.as_ref())?;
    let varying = range.as_ref().and_then(|(name, _)| {
        let mut names = spec.model.parameters.iter();
        names.position(|parameter| parameter.name == *name)
    });
    let from_spec = arguments.initial.is_none();
    let system = declared::system(&spec.model, &point, from_spec, &arguments.casimir)
        .map_err(Failure::invalid)?;
    let equations = Equations::new(system, varying).map_err(|why| {
        let text = format!(
            "`lie equilibria` does not apply to {}: {why}",
            spec.model.name
        );
        let message = Message::new(Kind::Method, text).at_option("SPEC");
        message.help("write the function as an expression of the grammar; `lie run` takes any")
    })?;
    if !arguments.quiet {
        render::print(&spec.warnings());
    }
    let inputs = Inputs::of_spec(&arguments.spec, &spec);
    match (range, varying) {
        (Some((name, values)), Some(varying)) => {
            let plot = arguments.plot.as_deref();
            let destination = plot.map(|path| inputs.open("--plot", path)).transpose()?;
            for value in [values[0], values[values.len() - 1]] {
                let mut parameters = point.parameters.clone();
                parameters[varying] = value;
                regular(&spec, &equations, &parameters, arguments)?;
            }
            let (starts, seed) = (arguments.starts as usize, arguments.seed.into());
            let scaled = equations.at_level(&point.parameters);
            let equations = scaled.as_ref().unwrap_or(&equations);
            let traced = trace(equations, &point.parameters, varying, &values, starts, seed);
            let range = Range {
                name,
                values,
                traced,
            };
            match arguments.json {
                true => print(&format!(
                    "{:#}\n",
                    json::range(&spec.model.name, equations, &range)
                ))?,
                false => print(&words::range(&spec.model.name, equations, &range))?,
            }
            if let (Some(destination), Some(path)) = (destination, plot) {
                let picture = picture::svg(&spec.model.name, equations, &range);
                let written = destination.replace(picture.as_bytes());
                written.map_err(|error| unwritable(path, &error))?;
            }
        }
        _ => {
            let leaf = leaf(&spec, &equations, &point, arguments)?;
            match arguments.json {
                true => print(&format!(
                    "{:#}\n",
                    json::leaf(&spec.model.name, &equations, &leaf)
                ))?,
                false => print(&words::leaf(&spec.model.name, &equations, &leaf))?,
            }
        }
    }
    Ok(0)
}

/// The one parameter with a range, if there is one.
fn one_range(
    arguments: &args::Equilibria,
    ranges: Vec<(String, Vec<f64>)>,
) -> Result<Option<(String, Vec<f64>)>, Failure> {
    let mut ranges = ranges.into_iter();
    let range = ranges.next();
    if let Some((name, _)) = ranges.next() {
        let text =
            format!("`{name}` is a second range, and branches are followed in one parameter");
        let help = format!("give `{name}` one value, and call the command for each");
        return Err(Message::option("--param", text).help(help).into());
    }
    match &range {
        Some((name, values)) if values.len() < 2 => {
            let text = format!("one value of `{name}` is no range");
            let help = format!("give at least 2 values, or `--param {name}={}`", values[0]);
            Err(Message::option("--param", text).help(help).into())
        }
        None if arguments.plot.is_some() => {
            let text = "what is drawn are branches over a range of a parameter, and none is given";
            let help = "add a range such as `--param k=1:2:41`";
            Err(Message::option("--plot", text).help(help).into())
        }
        _ => Ok(range),
    }
}

/// Parameters and initial state, checked at both ends of a range; those of its first value.
fn start(
    spec: &Spec,
    fixed: &Request,
    range: Option<&(String, Vec<f64>)>,
) -> Result<Point, Failure> {
    let Some((name, values)) = range else {
        return request::start(spec, fixed).map_err(Failure::invalid);
    };
    let at = |value: f64| {
        let mut request = fixed.clone();
        let set = Parameter::Set(name.clone(), Value::Number(value));
        request.param.push(set);
        request::start(spec, &request).map_err(Failure::invalid)
    };
    at(values[values.len() - 1])?;
    at(values[0])
}

/// Refuses Casimirs that depend on each other, and an initial state whose leaf they do not describe.
fn regular(
    spec: &Spec,
    equations: &Equations,
    parameters: &[f64],
    arguments: &args::Equilibria,
) -> Result<(), Failure> {
    let at = At {
        equations,
        parameters,
    };
    let (sizes, name) = (equations.sizes, &spec.model.name);
    // values that are not finite are said of later
    let Some([own, generic]) = at.ranks() else {
        return Ok(());
    };
    if generic.gradients < sizes.m {
        let casimirs = equations.system.casimirs.iter();
        let casimirs: Vec<&str> = casimirs.map(|casimir| casimir.name.as_str()).collect();
        let text = format!(
            "at these values of the parameters the gradients of the Casimirs {} of {name} depend on each other in all states, so that their values tell no leaf",
            casimirs.join(", ")
        );
        let message = Message::new(Kind::Domain, text).at_option("SPEC");
        let help = "give other values of the parameters, or declare Casimirs in `casimirs` that are independent at these";
        return Err(message.help(help).into());
    }
    let all_given = arguments.casimir.len() >= sizes.m && sizes.m > 0;
    let full = own.bracket == generic.bracket && own.gradients == sizes.m;
    if full || all_given || !equations.system.has_leaves {
        return Ok(());
    }
    let text = match own.bracket < generic.bracket {
        true => format!(
            "the initial state lies on a leaf of {name} of {} dimensions, for the rank of the bracket is {} there and {} generically, and the Casimirs tell leaves of {} dimensions alone",
            own.bracket, own.bracket, generic.bracket, generic.bracket
        ),
        false => format!(
            "at the initial state of {name} the gradients of the Casimirs depend on each other, and their values do not tell its leaf"
        ),
    };
    let message = Message::new(Kind::Domain, text).at_option("--initial");
    let help =
        "give a state on a leaf of full dimension, or the values of all Casimirs with `--casimir`";
    Err(message.help(help).into())
}

fn leaf(
    spec: &Spec,
    equations: &Equations,
    point: &Point,
    arguments: &args::Equilibria,
) -> Result<Leaf, Failure> {
    let parameters = &point.parameters;
    regular(spec, equations, parameters, arguments)?;
    // values of Casimirs that are far from those of the initial state have a scale of their own
    let scaled = equations.at_level(parameters);
    let equations = scaled.as_ref().unwrap_or(equations);
    let at = At {
        equations,
        parameters,
    };
    let none = || {
        let text = "the values of the Casimirs are not finite at the initial state";
        let message = Message::new(Kind::Domain, text).at_option("--initial");
        message.help("give another initial state with `--initial`")
    };
    let (levels, _) = equations.leaf(parameters).ok_or_else(none)?;
    let (starts, seed) = (arguments.starts as usize, arguments.seed.into());
    let found = at.search(starts, seed, true);
    let mut found = found.ok_or_else(none)?;
    let exact = declared::exact(&spec.model, parameters);
    let exact = exact.unwrap_or_default();
    let prover = Prover::new(equations);
    let known = |candidate: &Candidate| Equilibrium::new(&prover, at, &exact, candidate);
    let beyond = equations.beyond(parameters, &found.candidates, starts, seed);
    let own = found.candidates.iter();
    let own = own.filter(|candidate| {
        let mut scales = beyond.iter();
        !scales.any(|scale| scale.replaces(parameters, candidate))
    });
    let mut equilibria: Vec<Equilibrium> = own.filter_map(known).collect();
    for scale in &beyond {
        let prover = Prover::new(&scale.equations);
        let at = At {
            equations: &scale.equations,
            parameters,
        };
        let known = |candidate: &Candidate| Equilibrium::new(&prover, at, &exact, candidate);
        equilibria.extend(scale.candidates.iter().filter_map(known));
        found.starts += scale.starts[0];
        found.converged += scale.starts[1];
        // paths tell solutions of their own scale
        let real = |paths: &Option<Paths>| paths.map_or(0, |paths| paths.real);
        if real(&scale.paths) > real(&found.paths) {
            found.paths = scale.paths;
        }
    }
    Ok(Leaf {
        levels,
        equilibria: Equilibrium::merged(equilibria),
        low_rank: at.low_rank(starts, seed),
        found,
    })
}
