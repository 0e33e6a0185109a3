//! All expressions of a declaration in one arena.

use super::algebra::{self, Algebra};
use super::constraint::forms::{self, Distribution};
use super::coordinates::Whole;
use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use super::poisson::{self, Entry};
use super::{
    attitude, defaults, driving, entries, exactness, initial, lets, opaque, parameters,
    realization, retraction,
};
use crate::model::{Acting, Attitude, Parameter, Realization, Retraction};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast;
use lie_syntax::diagnostic::Diagnostic;

/// The expressions of a declaration, none of which is wrong by itself.
pub struct Lowered {
    /// The arena.
    pub graph: Graph,
    /// The algebra as it was declared, until it is that of the system.
    pub algebra: Option<Algebra>,
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// Their exact values, zero for those that are not exact.
    pub defaults: Vec<Rational>,
    /// The brackets of coordinates.
    pub brackets: Vec<Entry>,
    /// The Hamiltonian or the Lagrangian.
    pub energy: ExprId,
    /// What the constraints leave of the algebra.
    pub distribution: Option<Distribution>,
    /// What acts beside the Hamiltonian.
    pub acting: Vec<Acting>,
    /// The Casimirs.
    pub casimirs: Vec<ExprId>,
    /// The first integrals.
    pub integrals: Vec<ExprId>,
    /// The observables.
    pub observables: Vec<ExprId>,
    /// The functions of the events.
    pub events: Vec<ExprId>,
    /// The realization.
    pub realization: Option<Realization>,
    /// The retraction of the user's own.
    pub retraction: Option<Retraction>,
    /// The initial state.
    pub initial: Option<Vec<ExprId>>,
    /// The initial group element.
    pub attitude: Option<Attitude>,
}

/// Lowers everything, so that the mistakes of all expressions are found together.
pub fn lower(
    whole: &Whole<'_>,
    name: &dyn Fn(Symbol) -> String,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Lowered> {
    let (declaration, configuration) = (&*whole.declaration, whole.configuration.as_ref());
    let algebra = match declaration.algebra() {
        Some(algebra) => algebra::lie_algebra(declaration, algebra, mistakes).map(Some),
        None => Some(None),
    };
    mistakes.extend(exactness::exactness(declaration));
    let mut graph = Graph::new();
    let entries = entries::names(declaration);
    let mut environment = Environment::new(declaration);
    entries::bind(&entries, &mut graph, &mut environment);
    let parameters =
        parameters::parameter_defaults(declaration, &mut graph, &environment, mistakes);
    lets::abbreviations(declaration, &mut graph, &mut environment, mistakes);
    let brackets =
        poisson::coordinate_brackets(declaration, &mut graph, &environment, name, mistakes);
    let distribution = forms::distribution(
        whole,
        &mut graph,
        &environment,
        parameters.as_deref().unwrap_or_default(),
        mistakes,
    );
    let mut lower = |expr: &ast::Expr, allowed| {
        Lowering::new(&mut graph, &environment, mistakes, allowed).lower(expr)
    };
    let energy = lower(
        declaration.energy.expression(),
        match declaration.energy {
            ast::Energy::Hamiltonian(_) => Allowed::State,
            ast::Energy::Lagrangian { .. } | ast::Energy::DiscreteLagrangian { .. } => {
                Allowed::Velocity(configuration.map_or(usize::MAX, |c| c.momenta))
            }
        },
    );
    let acting = driving::acting(&whole.declaration, Allowed::State, &mut lower);
    let casimirs = declaration.casimirs.iter();
    let casimirs: Vec<_> = casimirs.map(|c| lower(&c.value, Allowed::State)).collect();
    let integrals = declaration.integrals.iter();
    let integrals: Vec<_> = integrals.map(|(_, f)| lower(f, Allowed::State)).collect();
    let observables = declaration.observables.iter();
    let observables: Vec<_> = observables
        .map(|o| lower(&o.value, Allowed::State))
        .collect();
    let events = declaration.events.iter();
    let events: Vec<_> = events.map(|e| lower(&e.when, Allowed::State)).collect();
    let realization = realization::lowered_map(
        declaration,
        configuration,
        &mut graph,
        &environment,
        mistakes,
    );
    let retraction = retraction::lowered_map(whole, &mut graph, &environment, mistakes);
    let initial = initial::initial_state(
        declaration,
        &mut graph,
        &environment,
        distribution.as_ref().is_some_and(Option::is_some),
        mistakes,
    );
    let attitude = attitude::initial_element(whole, &mut graph, &environment, mistakes);
    mistakes.extend(opaque::own_functions(
        declaration,
        &graph,
        brackets.as_deref(),
        energy,
    ));
    if super::has_errors(mistakes) {
        return None;
    }
    let (algebra, parameters, attitude) = (algebra?, parameters?, attitude?);
    let defaults = defaults::exact_defaults(declaration, algebra.as_ref(), &parameters);
    Some(Lowered {
        graph,
        defaults: defaults.map_err(|mistake| mistakes.push(mistake)).ok()?,
        algebra,
        parameters,
        brackets: brackets?,
        energy: energy?,
        distribution: distribution?,
        acting: acting?,
        casimirs: casimirs.into_iter().collect::<Option<_>>()?,
        integrals: integrals.into_iter().collect::<Option<_>>()?,
        observables: observables.into_iter().collect::<Option<_>>()?,
        events: events.into_iter().collect::<Option<_>>()?,
        realization: realization?,
        retraction: retraction?,
        initial: attitude::among_coordinates(configuration, initial?, attitude.as_ref()),
        attitude,
    })
}
