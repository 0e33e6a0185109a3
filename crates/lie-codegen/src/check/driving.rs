//! What acts beside the Hamiltonian: forces and dissipation, and what has to be proven of them.
//!
//! `mu' = Pi(mu) xi + F` with `F = forces - R grad H + K grad S` and `xi = grad H + c G v`, `v = Pi grad H`, so that
//! `H' = <F, grad H> - c <v, G v>`. The momentum p of the time, which is carried wherever something acts, gives that power, and H + p
//! stays constant.

pub mod held;
mod metric;
pub mod motion;
pub mod work;

use super::constant_value;
use super::coordinates::Whole;
use super::energy::Declared;
use super::environment::Allowed;
use super::matrix;
use super::poisson::Entry;
use crate::algebra::StructureConstants;
use crate::model::{Acting, Driving, Energy, Input, Model};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Declaration, DissipationKind, Expr, ExprKind, Metric, Name, Noise};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};
use metric::{Checks, Rows};
use motion::{Written, motion};
use work::Work;

/// Lowers what acts, functions of what is allowed; `None` where an expression is wrong, which is reported.
pub fn acting(
    declaration: &Declaration,
    allowed: Allowed,
    lower: &mut dyn FnMut(&Expr, Allowed) -> Option<ExprId>,
) -> Option<Vec<Acting>> {
    let mut all = Vec::new();
    let mut complete = true;
    // methods of single systems damp by a matrix that is constant
    let strengths = match allowed {
        Allowed::Site => Allowed::Strength,
        _ => Allowed::Parameters,
    };
    for (name, value) in &declaration.forces {
        let place = declaration.state.iter().position(|c| c.text == name.text);
        let force = place.zip(lower(value, allowed));
        complete &= force.is_some();
        all.extend(force.map(|(place, value)| Acting::Force(place, value)));
    }
    for dissipation in &declaration.dissipation {
        let mut rows = |rows: &[Vec<Expr>], allowed| -> Option<Rows> {
            let row =
                |row: &Vec<Expr>| -> Vec<_> { row.iter().map(|e| lower(e, allowed)).collect() };
            let lowered: Vec<Vec<Option<ExprId>>> = rows.iter().map(row).collect();
            lowered
                .into_iter()
                .map(|row| row.into_iter().collect())
                .collect()
        };
        let found = match &dissipation.kind {
            DissipationKind::DoubleBracket { strength, metric } => {
                let metric = metric.as_ref().map(|m| rows(m, Allowed::Parameters));
                let strength = lower(strength, strengths);
                match metric {
                    Some(metric) => strength
                        .zip(metric)
                        .map(|(c, g)| Acting::DoubleBracket(c, Some(g))),
                    None => strength.map(|c| Acting::DoubleBracket(c, None)),
                }
            }
            DissipationKind::Metriplectic { entropy, metric } => {
                let (Metric::Entries(given) | Metric::Factor(given)) = metric;
                let given = rows(given, allowed);
                let entropy = lower(entropy, allowed);
                entropy.zip(given).map(|(s, k)| Acting::Metriplectic(s, k))
            }
            DissipationKind::Rayleigh { matrix } => {
                rows(matrix, Allowed::Parameters).map(Acting::Rayleigh)
            }
        };
        complete &= found.is_some();
        all.extend(found);
        if let Some(temperature) = &dissipation.temperature {
            let temperature = lower(temperature, Allowed::Parameters);
            complete &= temperature.is_some();
            all.extend(temperature.map(Acting::Temperature));
        }
    }
    for noise in &declaration.noise {
        let found = match noise {
            Noise::Hamiltonian(value) => lower(value, allowed).map(Acting::HamiltonianNoise),
            Noise::Force(parts) => {
                let part = |(name, value): &(Name, Expr)| {
                    let place = declaration.state.iter().position(|c| c.text == name.text);
                    place.zip(lower(value, allowed))
                };
                let parts: Vec<Option<(usize, ExprId)>> = parts.iter().map(part).collect();
                let parts: Option<Vec<_>> = parts.into_iter().collect();
                parts.map(Acting::ForceNoise)
            }
        };
        complete &= found.is_some();
        all.extend(found);
    }
    complete.then_some(all)
}

/// What dissipation promises and does not hold at values of the parameters: why, as text with a remedy.
pub fn violation(model: &Model, values: &[f64]) -> Option<Diagnostic> {
    let driving = model.driving.as_ref()?;
    let name = |symbol| model.acting_name(symbol);
    let own = (model.configuration.as_ref()).map_or(model.dimension(), |c| c.own_momenta());
    let checks = Checks {
        origin: model.name_origin,
        own,
        defaults: values,
        sites: model.family.as_ref().map(|family| (family, &*model.inputs)),
        name: &name,
    };
    let mut declared = driving.declared.iter();
    let wrong = declared.find_map(|acting| match acting {
        Acting::DoubleBracket(strength, metric) => {
            let wrong = checks.strength(&model.graph, *strength);
            let metric = metric.as_ref();
            wrong.or_else(|| checks.damps(&model.graph, "the metric G", metric?))
        }
        Acting::Rayleigh(rows) => checks.damps(&model.graph, "the matrix R", rows),
        Acting::Temperature(temperature) => checks.temperature(&model.graph, *temperature),
        _ => None,
    })?;
    let message = wrong
        .message
        .replace("at the default parameters", "at these parameters");
    Some(Diagnostic { message, ..wrong })
}

/// What the motion of a driven system is made of.
pub struct Sources<'a> {
    /// The declaration in all its coordinates.
    pub whole: &'a Whole<'a>,
    /// The structure constants, and the central element that is 1.
    pub constants: Option<(&'a StructureConstants<ExprId>, Option<usize>)>,
    /// The brackets of coordinates.
    pub brackets: &'a [Entry],
    /// The Hamiltonian.
    pub energy: &'a Energy<Declared>,
    /// The defaults of the parameters.
    pub defaults: &'a [f64],
    /// The names of symbols.
    pub name: &'a dyn Fn(Symbol) -> String,
}

/// What acts on a system; `None` where nothing does, or something is wrong, which is reported.
pub fn driving(
    graph: &mut Graph,
    sources: &Sources<'_>,
    declared: Vec<Acting>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Driving> {
    let declaration = &*sources.whole.declaration;
    if !declaration.is_driven() {
        return None;
    }
    if let Some(mistake) = refused(declaration, sources) {
        mistakes.push(mistake);
        return None;
    }
    let (configuration, energy) = sources
        .whole
        .configuration
        .as_ref()
        .zip(sources.energy.expression())?;
    let (own, clock) = (configuration.own_momenta(), configuration.clock()?);
    let matrix = matrix::poisson_matrix(
        graph,
        declaration.dimension(),
        sources.constants,
        sources.brackets,
    );
    let first = declaration.dimension() - configuration.held.len() + declaration.inputs.len();
    let rate = |process| Symbol::Coordinate(first + process);
    let mut work = Work {
        own,
        first: 0,
        time: clock.time,
        slopes: slopes(graph, energy.value, declaration.dimension()),
        matrix,
        rate: &rate,
        graph,
    };
    let written = Written {
        declaration,
        defaults: sources.defaults,
        sites: None,
        name: sources.name,
    };
    let driving = motion(&mut work, &written, declared, mistakes)?;
    Some(Driving {
        noises: held::with_coin(driving.noises),
        ..driving
    })
}

/// What no driven system is yet, or can be.
fn refused(declaration: &Declaration, sources: &Sources<'_>) -> Option<Diagnostic> {
    let origin = declaration.place_of_driving();
    let origin = origin.unwrap_or(declaration.name.origin);
    let mistake = |origin: Origin, message: &str, help: &str| {
        Some(Diagnostic::new(Kind::Dissipation, origin, message).help(help))
    };
    if sources.energy.expression().is_none() {
        let message = "forces, dissipation, noise and inputs need H as an expression, and the Legendre transform of the Lagrangian is by iteration";
        return mistake(origin, message, "declare the `hamiltonian`");
    }
    let along = |kind: &DissipationKind| matches!(kind, DissipationKind::DoubleBracket { .. });
    let mut along = declaration.dissipation.iter().filter(|d| along(&d.kind));
    if declaration.group.is_some()
        && let Some(bracket) = along.next()
    {
        let message = "a double bracket moves along the coadjoint orbit, and beside a group element that is all of T*G: \
                       the velocity of the group element would not be grad H";
        let help = "leave `group` out, or use `rayleigh` or `forces`, which change mu alone";
        return mistake(bracket.origin, message, help);
    }
    None
}

fn slopes(graph: &mut Graph, energy: ExprId, dimension: usize) -> Vec<ExprId> {
    let slopes = (0..dimension).map(|i| graph.derivative(energy, Symbol::Coordinate(i)));
    slopes.collect()
}
