//! Realizations: a map J from canonical coordinates with `{J_a, J_b} = Pi_ab(J)`, proven by a normal form.

use super::descent::{self, Component};
use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use crate::model::configuration::Configuration;
use crate::model::{CANONICAL, Descent, PoissonMatrix, Realization};
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::prove::proof::{Proof, examine};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{self, Declaration, Expr};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, Report, plural};

/// Work allowed for all brackets of one realization.
const WORK: u64 = 5_000_000;

/// Lowers a realization; `Some(None)` where none is declared.
pub fn lower(
    declaration: &Declaration,
    configuration: Option<&Configuration>,
    graph: &mut Graph,
    environment: &Environment<'_>,
    report: &mut Report,
) -> Option<Option<Realization>> {
    let Some(declared) = &declaration.realization else {
        return Some(None);
    };
    let points = canonical_coordinates(declared, configuration, report)?;
    let map = components(declaration, declared, report);
    if let Some(start) = &declared.start
        && start.len() != points
    {
        let place = start.last().map_or(declared.origin, |value| value.origin);
        let message = format!(
            "the start has {} {}, but there are {points} canonical coordinates",
            start.len(),
            plural(start.len(), "value")
        );
        report.push(
            Diagnostic::new(Kind::StateLength, place, message)
                .help("write the positions, then the momenta"),
        );
        return None;
    }
    let mut value = |expr, allowed| Lowering::new(graph, environment, report, allowed).lower(expr);
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
    report: &mut Report,
) -> Option<usize> {
    if configuration.is_some() {
        report.push(mistake(
            declared.origin,
            "a realization is for systems without a group element and without the time",
            "remove it, or the group element and the time",
        ));
        return None;
    }
    let (positions, momenta) = (declared.positions.len(), declared.momenta.len());
    if positions != momenta || positions == 0 {
        let plural = plural(positions, "position");
        report.push(mistake(
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
    report: &mut Report,
) -> Vec<Option<&'a Expr>> {
    let mut map: Vec<Option<&Expr>> = vec![None; declaration.state.len()];
    let mut complete = true;
    for (name, value) in &declared.map {
        let place = declaration.state.iter().position(|c| c.text == name.text);
        let Some(place) = place else {
            report.push(
                Diagnostic::new(
                    Kind::UnknownSymbol,
                    name.origin,
                    format!("`{}` is not a coordinate of the state", name.text),
                )
                .help("write `STATE = expression` for each name of the state"),
            );
            complete = false;
            continue;
        };
        if map[place].replace(value).is_some() {
            report.push(
                Diagnostic::new(
                    Kind::DuplicateName,
                    name.origin,
                    format!("`{}` has a component already", name.text),
                )
                .help("keep one of the two"),
            );
            complete = false;
        }
    }
    let missing = declaration.state.iter().zip(&map);
    let missing: Vec<&str> = missing
        .filter(|(_, value)| value.is_none())
        .map(|(name, _)| name.text.as_str())
        .collect();
    if complete && !missing.is_empty() {
        report.push(mistake(
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

/// Verifies the brackets, and says whether Gauss methods over the realization descend.
pub fn check(
    realization: &mut Realization,
    poisson: &PoissonMatrix,
    scratch: &mut Graph,
    name: &dyn Fn(Symbol) -> String,
    report: &mut Report,
) {
    let points = realization.names.len();
    let map = realization.map.clone();
    let slopes: Vec<Vec<ExprId>> = map.iter().map(|&j| slopes(scratch, j, points)).collect();
    let differences = differences(scratch, &map, &slopes, poisson);
    let (components, thirds) = higher_derivatives(scratch, &map, &slopes);
    let scratch = &*scratch;
    let budget = Budget::new(WORK);
    let mut normal = NormalForm::with_domain(scratch, &budget, &map);
    for (a, b, difference) in differences {
        let shown = |k| name(Symbol::Coordinate(k));
        let proof = examine(&mut normal, scratch, difference, name);
        if let Some(message) = message(&proof, &shown(a), &shown(b)) {
            report.push(mistake(
                realization.origins[b],
                message,
                "{f, g} = sum df/dq dg/dp - df/dp dg/dq must be the bracket of the system; often a sign is wrong",
            ));
            return;
        }
    }
    let quadratic = thirds
        .iter()
        .all(|third| matches!(normal.verdict(*third), Verdict::Zero));
    realization.descent = match quadratic {
        true => descent::of(scratch, &components, points),
        false => Descent::Degree,
    };
}

/// The derivatives of a function by the canonical coordinates.
fn slopes(graph: &mut Graph, function: ExprId, points: usize) -> Vec<ExprId> {
    let symbols = (0..points).map(|i| Symbol::Input(CANONICAL + i));
    let slopes = symbols.map(|symbol| graph.derivative(function, symbol));
    slopes.collect()
}

/// What must vanish: `(a, b, {J_a, J_b} - Pi_ab(J))`, a < b.
fn differences(
    scratch: &mut Graph,
    map: &[ExprId],
    slopes: &[Vec<ExprId>],
    poisson: &PoissonMatrix,
) -> Vec<(usize, usize, ExprId)> {
    let mut differences = Vec::new();
    for a in 0..map.len() {
        for b in a + 1..map.len() {
            let half = slopes[a].len() / 2;
            let mut terms = Vec::new();
            for i in 0..half {
                terms.push(scratch.mul(slopes[a][i], slopes[b][half + i]));
                let other = scratch.mul(slopes[a][half + i], slopes[b][i]);
                terms.push(scratch.neg(other));
            }
            let mut entries = poisson.entries.iter();
            if let Some(&(_, _, value)) = entries.find(|entry| (entry.0, entry.1) == (a, b)) {
                let over = scratch.substitute(&[value], &|symbol| match symbol {
                    Symbol::Coordinate(k) => Some(map[k]),
                    _ => None,
                });
                terms.push(scratch.neg(over[0]));
            }
            differences.push((a, b, scratch.sum(&terms)));
        }
    }
    differences
}

/// The components with their second derivatives, and all third ones.
fn higher_derivatives(
    scratch: &mut Graph,
    map: &[ExprId],
    slopes: &[Vec<ExprId>],
) -> (Vec<Component>, Vec<ExprId>) {
    let (mut components, mut thirds) = (Vec::new(), Vec::new());
    for (&value, slopes) in map.iter().zip(slopes) {
        let mut seconds = Vec::new();
        for slope in slopes {
            for i in 0..slopes.len() {
                let second = scratch.derivative(*slope, Symbol::Input(CANONICAL + i));
                seconds.push(second);
                for j in i..slopes.len() {
                    thirds.push(scratch.derivative(second, Symbol::Input(CANONICAL + j)));
                }
            }
        }
        components.push(Component {
            value,
            slopes: slopes.clone(),
            seconds,
        });
    }
    thirds.sort_unstable();
    thirds.dedup();
    (components, thirds)
}

/// Why two components do not have the bracket of the system.
fn message(proof: &Proof, left: &str, right: &str) -> Option<String> {
    match proof {
        Proof::Zero => None,
        Proof::Nonzero(shown) => Some(format!(
            "the realization is not a Poisson map: {{{left}, {right}}} of its components is not the bracket of the \
             system; the difference is {shown}"
        )),
        Proof::Unproven { .. } => Some(format!(
            "it could not be shown that {{{left}, {right}}} of the components is the bracket of the system"
        )),
    }
}
