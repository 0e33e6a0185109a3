//! The system of a spec as the search for equilibria takes it.

use lie_codegen::model::{Energy, Model};
use lie_codegen::structure::Structure;
use lie_codegen::structure::integrals::integrals;
use lie_equilibria::{Named, System, shortest};
use lie_in_process::request::{OptionValue, Point};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::{Kind, Origin};
use lie_syntax::suggest::did_you_mean;

use crate::compiler::Spec;
use crate::message::{Message, Place};

/// Refuses systems that have no relative equilibria in this sense, or none that can be looked for.
///
/// # Errors
/// `method`, with the reason and a remedy.
pub fn applies(spec: &Spec) -> Result<(), Message> {
    let model = &spec.model;
    let refused = |text: &str, help: &str| {
        let text = format!("`lie equilibria` does not apply to {}: {text}", model.name);
        let message = Message::new(Kind::Method, text).help(help);
        Err(match model.energy_origin {
            Origin::Text { start, end } => {
                message.at_place(Place::Text(spec.source.clone(), start..end))
            }
            Origin::Span(_) => message.at_option("SPEC"),
        })
    };
    if model.family.is_some() {
        return refused(
            "it is a family, whose sites have no equations of their own",
            "write a system of a few coordinates out, without `sites`",
        );
    }
    if model.driving.is_some() || model.holds() {
        return refused(
            "forces, dissipation, noise or inputs act beside H, and the motion leaves the leaf or its energy",
            "leave them out of the spec: what stands still without them is found",
        );
    }
    if model.is_timed() {
        return refused(
            "H depends on the time, so that no state stands still",
            "put a constant, or a parameter, in place of `t`",
        );
    }
    if let Energy::Legendre(..) = model.energy {
        return refused(
            "its H is no expression: the velocity of a momentum is found by iteration",
            "declare the Hamiltonian itself, with `\"hamiltonian\"`",
        );
    }
    let (known, all) = (model.casimirs.len(), model.casimirs_to_find());
    if known < all {
        let text = format!(
            "{known} of its {all} independent Casimirs are known, and the leaf is where all have their values"
        );
        return refused(
            &text,
            "declare the others in `casimirs`; `lie check --deep` looks for them as long as it takes",
        );
    }
    Ok(())
}

/// The exact values that parameters stand for: declared constants where they are rational, else the shortest decimal.
pub fn exact(model: &Model, values: &[f64]) -> Option<Vec<Rational>> {
    let exact = |(parameter, value): (&lie_codegen::model::Parameter, &f64)| {
        let declared = || {
            let found = model
                .graph
                .evaluate_exactly(&[parameter.default], &|_| None)?;
            found.into_iter().next()
        };
        match *value == parameter.default_value {
            true => declared().or_else(|| shortest(*value)),
            false => shortest(*value),
        }
    };
    model.parameters.iter().zip(values).map(exact).collect()
}

/// The system at a point; `from_spec` says whether the initial state is that of the spec, a function of the parameters.
///
/// # Errors
/// `option` for a value of a Casimir that there is not.
pub fn system(
    model: &Structure,
    point: &Point,
    from_spec: bool,
    casimirs: &[String],
) -> Result<System, Vec<Message>> {
    let mut graph = model.graph.clone();
    let shown = model.shown_coordinates();
    let replaced = replacements(model, &shown, &mut graph);
    let moved = |graph: &mut Graph, expressions: &[ExprId]| {
        graph.substitute(expressions, &|symbol| match symbol {
            Symbol::Coordinate(i) => Some(replaced[i]),
            _ => None,
        })
    };
    let hamiltonian = match model.energy.expression() {
        Some(hamiltonian) => hamiltonian.energy,
        None => model.hamiltonian(),
    };
    let hamiltonian = moved(&mut graph, &[hamiltonian])[0];
    let named = |graph: &mut Graph, name: &str, value: ExprId| Named {
        name: name.to_owned(),
        value: moved(graph, &[value])[0],
    };
    let all = model.casimirs.iter();
    let functions = all.map(|casimir| named(&mut graph, &casimir.name, casimir.expr));
    let functions: Vec<Named> = functions.collect();
    let quantities: Vec<(String, ExprId)> = integrals(model)
        .map(|integral| (integral.name.clone(), integral.expr))
        .chain(found(model, &mut graph))
        .collect();
    let quantities = quantities.iter();
    let quantities = quantities.map(|(name, value)| named(&mut graph, name, *value));
    let quantities = quantities.collect();
    let entries = model.bracket.entries(&mut graph).into_iter();
    let place = |i: usize| shown.iter().position(|k| *k == i);
    let entries = entries.filter_map(|(i, j, value)| Some((place(i)?, place(j)?, value)));
    let entries: Vec<(usize, usize, ExprId)> = entries.collect();
    let bracket = entries
        .into_iter()
        .map(|(i, j, value)| (i, j, moved(&mut graph, &[value])[0]));
    let bracket = bracket.collect();
    let state = state(model, point, from_spec, &shown, &mut graph);
    let levels: Vec<ExprId> = functions.iter().map(|casimir| casimir.value).collect();
    let mut levels = graph.substitute(&levels, &|symbol| match symbol {
        Symbol::Coordinate(i) => Some(state[i]),
        _ => None,
    });
    set_levels(casimirs, &functions, &mut levels, &mut graph)?;
    let name = |i: &usize| model.coordinates[*i].text.clone();
    Ok(System {
        coordinates: shown.iter().map(name).collect(),
        parameters: model.parameters.iter().map(|p| p.name.clone()).collect(),
        graph,
        hamiltonian,
        casimirs: functions,
        levels,
        bracket,
        has_leaves: !model.is_almost_poisson(),
        integrals: quantities,
        state,
    })
}

/// What each coordinate becomes: those that carry the time of a cocycle rest.
fn replacements(model: &Model, shown: &[usize], graph: &mut Graph) -> Vec<ExprId> {
    let replacement = |i: usize| match (
        shown.iter().position(|k| *k == i),
        model.configuration.as_ref(),
    ) {
        (None, Some(configuration)) => {
            let at_rest = i64::from(configuration.at_rest(i) != 0.0);
            graph.integer(at_rest)
        }
        (place, _) => graph.symbol(Symbol::Coordinate(place.unwrap_or(i))),
    };
    (0..model.dimension()).map(replacement).collect()
}

/// The constants of the motion that were found, under their formulas.
fn found(model: &Structure, graph: &mut Graph) -> Vec<(String, ExprId)> {
    let Some(Ok(motions)) = &model.motions else {
        return Vec::new();
    };
    let n = model.dimension();
    let symbol = |v: usize| match v.checked_sub(n) {
        Some(p) => Symbol::Parameter(p),
        None => Symbol::Coordinate(v),
    };
    let mut expression = |motion: &lie_codegen::structure::motions::Motion| {
        let mut terms = Vec::new();
        for (monomial, coefficient) in motion.function.terms() {
            let mut powers = Vec::new();
            for (v, exponent) in monomial.powers() {
                powers.push((graph.symbol(symbol(v)), Rational::from(i64::from(exponent))));
            }
            terms.push((graph.power_product(&powers), coefficient.clone()));
        }
        let value = graph.linear(&terms);
        (
            graph.display(value, &|symbol| model.symbol_name(symbol)),
            value,
        )
    };
    motions.found.iter().map(&mut expression).collect()
}

/// The initial state in the shown coordinates.
fn state(
    model: &Model,
    point: &Point,
    from_spec: bool,
    shown: &[usize],
    graph: &mut Graph,
) -> Vec<ExprId> {
    match &model.initial {
        Some(initial) if from_spec && initial.len() == shown.len() => initial.clone(),
        Some(initial) if from_spec && initial.len() == model.dimension() => {
            shown.iter().map(|i| initial[*i]).collect()
        }
        _ => {
            let number = |value: f64| shortest(value).unwrap_or(Rational::ZERO);
            let values = shown.iter().map(|i| number(point.initial[*i]));
            values.map(|value| graph.number(value)).collect()
        }
    }
}

/// Values of Casimirs that are given.
fn set_levels(
    given: &[String],
    casimirs: &[Named],
    levels: &mut [ExprId],
    graph: &mut Graph,
) -> Result<(), Vec<Message>> {
    let mut mistakes = Vec::new();
    let mut set = vec![false; casimirs.len()];
    for text in given {
        let option = OptionValue::flag("--casimir", text);
        let Some(equals) = text.find('=') else {
            let message = option.wrong(format!("`{text}` is not NAME=VALUE"));
            mistakes.push(message.help("write it like `--casimir norm2=1`"));
            continue;
        };
        let name = text[..equals].trim();
        let names: Vec<&str> = casimirs
            .iter()
            .map(|casimir| casimir.name.as_str())
            .collect();
        let Some(place) = names.iter().position(|known| *known == name) else {
            let message = option
                .part(0..equals)
                .wrong(format!("unknown Casimir `{name}`"));
            mistakes.push(message.help(
                match (did_you_mean(name, names.iter().copied()), names.is_empty()) {
                    (Some(near), _) => format!("did you mean `{near}`?"),
                    (None, false) => format!("the Casimirs are {}", names.join(", ")),
                    (None, true) => "the system has no Casimirs".to_owned(),
                },
            ));
            continue;
        };
        let value = option.part(equals + 1..text.len());
        if std::mem::replace(&mut set[place], true) {
            mistakes.push(
                value
                    .wrong(format!("`{name}` is set twice"))
                    .help("set it once"),
            );
        }
        match value.number() {
            Ok(number) => levels[place] = graph.number(shortest(number).unwrap_or(Rational::ZERO)),
            Err(message) => mistakes.push(message),
        }
    }
    match mistakes.is_empty() {
        true => Ok(()),
        false => Err(mistakes),
    }
}
