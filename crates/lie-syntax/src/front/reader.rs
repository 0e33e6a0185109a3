//! The reader behind both front ends: entries, by the keys of the spec, become a declaration.
//!
//! What is read when is the order in which the mistakes of a macro are reported; those of a spec are sorted.

use super::entries::{Awaited, Entries, Line, Parameters, Read, Recorded};
use super::tables::Tables;
use super::vectors;
use super::{Body, Names, Parsed, driving, equations, expression, item, retraction};
use crate::ast::{
    Algebra, Declaration, Energy, Event, Expr, Family, Invariance, Name, Observable, Parameter,
    SiteData, Size, Structure,
};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// What belongs to an algebra, and stands beside no `poisson`.
const OF_ALGEBRA: [&str; 8] = [
    "lagrangian",
    "discrete_lagrangian",
    "invariance",
    "group",
    "attitude",
    "realization",
    "retraction",
    "constraint",
];

/// Reads what is left when the names of the system, its state and its parameters are known: the body.
pub fn finish<E: Entries>(
    entries: &E,
    mut parsed: Parsed,
    parameters: Parameters,
    report: &mut Report,
) -> Parsed {
    parsed.parameters = parameters.names;
    let data = parameters.sites;
    if parsed.indices.is_empty() {
        let mistakes = data.iter().map(without_sites);
        mistakes.for_each(|mistake| report.push(mistake));
    }
    let constants: Vec<String> = texts(&parsed.parameters).collect();
    let place = entries.place("algebra");
    let read = place.map(|place| (place, entries.algebra(&constants, report)));
    if let Some((place, Some(Read { state, .. }))) = &read
        && let Some(state) = state
        && entries.place("state").is_none()
    {
        parsed.dimension = state.len();
        parsed.state.clone_from(state);
        if state.is_empty() {
            report.push(item::missing_state(E::FORM, *place));
        }
    }
    let sizes = read.iter().filter_map(|(_, read)| read.as_ref());
    let sizes: Vec<Size> = sizes.flat_map(|read| read.sizes.clone()).collect();
    let algebra = read.map(|(place, read)| (place, read.map(|read| read.algebra)));
    let declaration = remainder(entries, &parsed, algebra, parameters.whole, report);
    let indices = parsed.indices.clone();
    let start = (!indices.is_empty()).then(|| entries.start(report));
    let bonds = entries.bonds(report);
    if let (Some(bonds), true) = (&bonds, indices.is_empty()) {
        let message = "`bonds` join the sites of a family, and this declaration is none";
        let help = "a family has an algebra such as `so(3)^N` and a state such as `x[i]`";
        report.push(Diagnostic::new(Kind::Schema, bonds.origin, message).help(help));
    }
    let declaration = declaration.map(|declaration| Declaration {
        family: (!indices.is_empty()).then(|| Family {
            sizes,
            indices,
            data,
            bonds,
            start: start.flatten(),
        }),
        ..declaration
    });
    if !report.has_errors() {
        parsed.body = declaration.map(|d| Body::Declaration(Box::new(d)));
    }
    parsed
}

fn remainder<E: Entries>(
    entries: &E,
    parsed: &Parsed,
    algebra: Option<(Origin, Option<Algebra>)>,
    parameters: Vec<Parameter>,
    report: &mut Report,
) -> Option<Declaration> {
    let constants: Vec<String> = texts(&parsed.parameters).collect();
    let velocity = entries.names("velocity", report);
    let inputs = entries.inputs(report);
    let lets = entries.lines("let", report);
    let basis = algebra.iter().filter_map(|(_, algebra)| algebra.as_ref());
    let held = inputs.iter().map(|input| input.name.text.clone());
    let names = in_functions(entries, parsed, &velocity, &lets, held)
        .with_elsewhere(basis.flat_map(|algebra| texts(&algebra.basis)));
    let names = with_vectors(entries, parsed, names, report);
    let tables = Tables::new(entries.tables(report), &names, report);
    let functions = entries.own_functions(report);
    let tables = tables.with_own(&functions, &names, report);
    let names = names.with_tables(tables);
    let structure = structure(entries, algebra, &names, report);
    let lets = lets.iter();
    let lets = lets.filter_map(|line| abbreviation(line, &names, report));
    let lets = lets.collect();
    let energy = energy(entries, velocity, &names, report);
    let forces = entries.definitions("forces", report);
    let state = (&*parsed.state, &*parsed.indices);
    let forces = driving::forces(&forces, state, &names, report);
    let dissipation = entries.dissipation(&names, report).into_iter();
    let dissipation = dissipation.filter_map(|entry| {
        let read = entry.kind(E::FORM);
        read.map_err(|mistake| report.push(*mistake)).ok()
    });
    let dissipation = dissipation.collect();
    let noise = entries.noise(report).into_iter();
    let noise = noise.filter_map(|noisy| noisy.noise(state, &names, report));
    let noise = noise.collect();
    let constraint = entries.lines("constraint", report);
    let constraint = constraint.iter();
    let constraint = constraint
        .filter_map(|line| equations::constraint(&line.tokens, line.place, &names, report));
    let constraint = constraint.collect();
    let realization = entries.place("realization");
    let realization = realization.map(|_| entries.realization(&constants, report));
    let retraction = entries.place("retraction").map(|place| {
        let fields = entries.retraction(&names, report)?;
        let read = retraction::retraction(fields, place, E::FORM);
        read.map_err(|mistake| report.push(*mistake)).ok()
    });
    let casimirs = entries.lines("casimirs", report);
    let casimirs = casimirs.iter();
    let casimirs =
        casimirs.filter_map(|line| item::casimir(&line.tokens, line.place, &names, report));
    let casimirs = casimirs.collect();
    let integrals = entries.lines("integrals", report);
    let integrals = integrals.iter();
    let integrals = integrals.filter_map(|line| integral(line, &names, report));
    let integrals = integrals.collect();
    let observables = entries.observables(report).into_iter();
    let observables = observables.filter_map(|recorded| observable(recorded, &names, report));
    let observables = observables.collect();
    let events = entries.events(report).into_iter();
    let events = events.filter_map(|awaited| event(awaited, &names, report));
    let events = events.collect();
    let methods = entries.methods(report);
    let group = entries.place("group").map(|_| {
        let line = entries.line("group", report)?;
        item::name(&line.tokens, line.place, report)
    });
    let invariance = invariance(entries, report);
    let constants: Names = constants.into_iter().collect();
    let initial_origin = entries.place("initial");
    let listed = initial_origin.filter(|_| parsed.indices.is_empty());
    let initial = listed.map(|_| entries.initial(&parsed.state, &constants, report));
    let attitude = entries.place("attitude").map(|_| {
        let written = entries.attitude(&constants, report)?;
        let read = written.attitude(E::FORM);
        read.map_err(|mistake| report.push(*mistake)).ok()
    });
    let (description, references) = entries.prose(report);
    let run = entries.run(report);
    Some(Declaration {
        visibility: parsed.visibility.clone(),
        name: parsed.name.clone()?,
        description,
        references,
        structure: structure?,
        group: without_mistake(group)?,
        state: parsed.state.clone(),
        family: None,
        parameters,
        functions,
        lets,
        energy: energy?,
        forces,
        dissipation,
        noise,
        inputs,
        constraint,
        realization: without_mistake(realization)?,
        retraction: without_mistake(retraction)?,
        casimirs,
        integrals,
        observables,
        events,
        methods,
        invariance: invariance?,
        initial,
        initial_origin,
        attitude: without_mistake(attitude)?,
        run,
    })
}

/// What is said of a list of values where there are no sites.
fn without_sites(data: &SiteData) -> Diagnostic {
    let name = &data.name.text;
    let message =
        format!("`{name}` has a value for each site of a family, and this declaration is none");
    let help = format!(
        "declare a parameter for each entry, such as `{name}1`, `{name}2`, or a family: `\"algebra\": \"so(3)^N\"` with a state such as `x[i]`, and write `{name}[i]`"
    );
    Diagnostic::new(Kind::Schema, data.origin, message).help(help)
}

fn texts(names: &[Name]) -> impl Iterator<Item = String> {
    names.iter().map(|name| name.text.clone())
}

/// What may be absent: `None` only where it is there and could not be read.
fn without_mistake<T>(read: Option<Option<T>>) -> Option<Option<T>> {
    match read {
        None => Some(None),
        Some(read) => read.map(Some),
    }
}

/// The names with those of vectors and matrices.
fn with_vectors<E: Entries>(
    entries: &E,
    parsed: &Parsed,
    names: Names,
    report: &mut Report,
) -> Names {
    let mut found = Report::new();
    let declared = entries.vectors(&names, &mut found);
    // entries of the group element are names that only the algebra tells
    let closed = entries.place("group").is_none();
    let vectors = vectors::collect(declared, &names, closed, &mut found);
    let vectors = vectors.with_mistake(found.has_errors());
    let vectors = match parsed.indices.is_empty() {
        true => vectors,
        false => vectors.with_sites(texts(&parsed.state)),
    };
    let found = found.into_diagnostics();
    found.into_iter().for_each(|mistake| report.push(mistake));
    names.with_vectors(vectors)
}

/// The names that the functions may use.
fn in_functions<E: Entries>(
    entries: &E,
    parsed: &Parsed,
    velocity: &[Name],
    lets: &[Line<'_>],
    held: impl Iterator<Item = String>,
) -> Names {
    let [.., discrete] = item::FUNCTIONS;
    let step = entries.place(discrete).map(|_| "h".to_owned());
    let defined = lets.iter().filter_map(|line| line.tokens.first());
    texts(&parsed.state)
        .chain(texts(velocity))
        .chain(texts(&parsed.parameters))
        .chain(defined.filter_map(|name| Some(name.identifier()?.to_owned())))
        .chain(step)
        .chain(held)
        .collect::<Names>()
        .with_indices(!parsed.indices.is_empty())
}

fn structure<E: Entries>(
    entries: &E,
    algebra: Option<(Origin, Option<Algebra>)>,
    names: &Names,
    report: &mut Report,
) -> Option<Structure> {
    let [poisson, cocycle] = ["poisson", "cocycle"].map(|key| {
        let place = entries.place(key)?;
        let lines = entries.lines(key, report);
        let brackets = lines
            .iter()
            .filter_map(|line| item::poisson(&line.tokens, line.place, names, report));
        Some((place, brackets.collect()))
    });
    let of_algebra = OF_ALGEBRA.iter();
    let of_algebra: Vec<_> = of_algebra
        .filter_map(|key| Some((entries.place(key)?, *key)))
        .collect();
    item::structure(algebra, poisson, cocycle, &of_algebra, E::FORM, report)
}

fn abbreviation(line: &Line<'_>, names: &Names, report: &mut Report) -> Option<(Name, Expr)> {
    let (name, value) = item::definition(&line.tokens, "an abbreviation", line.place, report)?;
    let example = ("its value", "x^2/2");
    let value = item::formula(value, example, line.place, names, report)?;
    Some((name, value))
}

fn integral(line: &Line<'_>, names: &Names, report: &mut Report) -> Option<(Name, Expr)> {
    let (name, value) = item::definition(&line.tokens, "a first integral", line.place, report)?;
    if !equations::one_side(value, "a first integral", report) {
        return None;
    }
    let example = ("its value", "x^2/2");
    let value = item::formula(value, example, line.place, names, report)?;
    Some((name, value))
}

fn observable(recorded: Recorded<'_>, names: &Names, report: &mut Report) -> Option<Observable> {
    let Recorded {
        name,
        value,
        unwrap,
    } = recorded;
    let example = ("the observable", "x^2/2");
    let value = item::formula(&value.tokens, example, value.place, names, report)?;
    Some(Observable {
        name,
        value,
        unwrap,
    })
}

fn event(awaited: Awaited<'_>, names: &Names, report: &mut Report) -> Option<Event> {
    let (line, example) = (awaited.when, ("the function of the event", "z - 1/2"));
    if !equations::one_side(&line.tokens, "an event", report) {
        return None;
    }
    let when = item::formula(&line.tokens, example, line.place, names, report)?;
    Some(Event {
        name: awaited.name,
        when,
        direction: awaited.direction,
        stop: awaited.stop,
    })
}

/// `hamiltonian`, or one of the Lagrangians with `velocity`.
fn energy<E: Entries>(
    entries: &E,
    velocity: Vec<Name>,
    names: &Names,
    report: &mut Report,
) -> Option<Energy> {
    let functions = item::FUNCTIONS.map(|key| {
        let place = entries.place(key)?;
        let line = entries.line(key, report);
        Some((place, line.and_then(|l| function(&l, key, names, report))))
    });
    let velocity = (entries.place("velocity"), velocity);
    item::energy(functions, velocity, E::FORM, report)
}

fn function(line: &Line<'_>, key: &str, names: &Names, report: &mut Report) -> Option<Expr> {
    if line.tokens.is_empty() {
        report.push(item::empty_function(key, line.place));
        return None;
    }
    expression::parse(&line.tokens, names, report)
}

fn invariance<E: Entries>(entries: &E, report: &mut Report) -> Option<Invariance> {
    if entries.place("invariance").is_none() {
        return Some(Invariance::Left);
    }
    let (word, place) = entries.invariance(report)?;
    item::invariance(&word, place, E::FORM, report)
}
