//! Realizations: a map from canonical coordinates to the state.

use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use crate::model::configuration::Configuration;
use crate::model::{Descent, Realization};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph};
use lie_syntax::ast::{self, Declaration, Expr};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, plural};

/// Lowers a realization; `Some(None)` where none is declared.
pub fn lowered_map(
    declaration: &Declaration,
    configuration: Option<&Configuration>,
    graph: &mut Graph,
    environment: &Environment<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Option<Realization>> {
    let Some(declared) = &declaration.realization else {
        return Some(None);
    };
    let points = canonical_coordinates(declared, configuration, mistakes)?;
    let map = components(declaration, declared, mistakes);
    if let Some(start) = &declared.start
        && start.len() != points
    {
        let place = start.last().map_or(declared.origin, |value| value.origin);
        let message = format!(
            "the start has {} {}, but there are {points} canonical coordinates",
            start.len(),
            plural(start.len(), "value")
        );
        mistakes.push(
            Diagnostic::new(Kind::StateLength, place, message)
                .help("write the positions, then the momenta"),
        );
        return None;
    }
    let mut value =
        |expr, allowed| Lowering::new(graph, environment, mistakes, allowed).lower(expr);
    let origins = map.iter().flatten().map(|expr| expr.origin).collect();
    let map: Vec<Option<ExprId>> = map
        .into_iter()
        .map(|expr| value(expr?, Allowed::Canonical))
        .collect();
    let start: Option<Vec<Option<ExprId>>> = declared.start.as_ref().map(|start| {
        let entries = start.iter();
        entries
            .map(|expr| value(expr, Allowed::Parameters))
            .collect()
    });
    let start = match start {
        Some(start) => start.into_iter().collect::<Option<Vec<_>>>()?,
        None => generic_point(points, graph),
    };
    Some(Some(Realization {
        names: declared.names().cloned().collect(),
        map: map.into_iter().collect::<Option<Vec<_>>>()?,
        origins,
        start,
        given: declared.start.is_some(),
        descent: Descent::Degree,
    }))
}

fn mistake(place: Origin, message: impl Into<String>, help: &str) -> Diagnostic {
    Diagnostic::new(Kind::Representation, place, message).help(help)
}

/// The number of canonical coordinates.
fn canonical_coordinates(
    declared: &ast::Realization,
    configuration: Option<&Configuration>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<usize> {
    if configuration.is_some() {
        mistakes.push(mistake(
            declared.origin,
            "a realization is for systems without a group element and without the time",
            "remove it, or the group element and the time",
        ));
        return None;
    }
    let (positions, momenta) = (declared.positions.len(), declared.momenta.len());
    if positions != momenta || positions == 0 {
        let plural = plural(positions, "position");
        mistakes.push(mistake(
            declared.origin,
            format!("there are {positions} {plural} and {momenta} momenta"),
            "name one momentum for each position",
        ));
        return None;
    }
    Some(positions + momenta)
}

/// The component of each coordinate of the state, `None` where there is none, which is reported.
fn components<'a>(
    declaration: &Declaration,
    declared: &'a ast::Realization,
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<Option<&'a Expr>> {
    let mut map: Vec<Option<&Expr>> = vec![None; declaration.state.len()];
    let mut complete = true;
    for (name, value) in &declared.map {
        let place = declaration.state.iter().position(|c| c.text == name.text);
        let wrong = match place {
            None => Diagnostic::new(
                Kind::UnknownSymbol,
                name.origin,
                format!("`{}` is not a coordinate of the state", name.text),
            )
            .help("write `STATE = expression` for each name of the state"),
            Some(place) => {
                if map[place].replace(value).is_none() {
                    continue;
                }
                let message = format!("`{}` has a component already", name.text);
                Diagnostic::new(Kind::DuplicateName, name.origin, message)
                    .help("keep one of the two")
            }
        };
        mistakes.push(wrong);
        complete = false;
    }
    let missing = declaration.state.iter().zip(&map);
    let missing: Vec<&str> = missing
        .filter(|(_, value)| value.is_none())
        .map(|(name, _)| name.text.as_str())
        .collect();
    if complete && !missing.is_empty() {
        mistakes.push(mistake(
            declared.origin,
            format!(
                "the realization has no component for {}",
                missing.join(", ")
            ),
            "write `STATE = expression` for each name of the state",
        ));
    }
    map
}

/// A point to start from: no two entries are alike, and they point in many directions.
fn generic_point(points: usize, graph: &mut Graph) -> Vec<ExprId> {
    let entry = |k: i64| {
        let whole = Rational::from((3 * k * k + 5 * k + 2) % 7 - 3);
        graph.number(&whole + &(&Rational::ONE / &Rational::from(k + 2)))
    };
    (0..points as i64).map(entry).collect()
}
