//! The checks: from the syntax tree to a model in which nothing is wrong.
//!
//! One module per check. The stages are: names, sizes, the algebra and the lowering of all
//! expressions (their mistakes are reported together), then what needs a sound model: the
//! identities of other brackets, Casimirs and the domain.

mod algebra;
mod branches;
mod breadth;
mod casimirs;
mod cocycle;
pub mod configuration;
pub(crate) mod confirmation;
mod constant;
mod contradiction;
mod defaults;
mod degree;
mod descent;
mod discrete;
pub mod domain;
mod energy;
mod entries;
mod environment;
mod idle;
mod independence;
mod initial;
mod legendre;
mod lets;
mod lower;
mod matrix;
mod methods;
mod names;
mod naming;
pub(crate) mod normal;
mod parameters;
mod poisson;
mod proof;
mod ranks;
mod realization;
pub(crate) mod residues;
mod sample;
mod series;
mod sign;
mod size;
mod velocity;

#[cfg(test)]
mod tests;

use crate::algebra::{StructureConstants, rank};
use crate::ast::{self, Declaration, Energy, Invariance};
use crate::diagnostic::{Diagnostic, Report};
use crate::exact::{Fraction, Rational};
use crate::model::{Model, Parameter, PoissonMatrix, Realization, Structure, Transform};
use crate::structure::separable;
use crate::symbolic::{ExprId, Graph, Symbol};
use algebra::Algebra;
use casimirs::Candidate;
use configuration::Configuration;
use environment::{Allowed, Environment};
use lower::Lowering;

pub use constant::constant;
pub use names::is_reserved;
pub use size::MAX_DIMENSION;

/// Checks a declaration; `None` if any error was reported. Warnings go to the report and to the
/// model.
pub fn check(declaration: &Declaration, report: &mut Report) -> Option<Model> {
    let mut own = Report::new();
    contradiction::clear();
    let model = stages(declaration, &mut own);
    if let Some(diagnostic) = contradiction::diagnostic(declaration.name.origin) {
        own.push(diagnostic);
    }
    if let Some(model) = &model {
        idle::check(declaration, model, &mut own);
    }
    let failed = own.has_errors();
    let diagnostics = own.into_diagnostics();
    let warnings: Vec<Diagnostic> = diagnostics.iter().filter(|d| d.warning).cloned().collect();
    for diagnostic in diagnostics {
        report.push(diagnostic);
    }
    model
        .filter(|_| !failed)
        .map(|model| Model { warnings, ..model })
}

fn stages(declaration: &Declaration, report: &mut Report) -> Option<Model> {
    names::check(declaration, report);
    if !size::check(declaration, report) {
        return None;
    }
    if declaration.energy.has_step() && declaration.group.is_some() {
        return system(&entries::written_out(declaration, report)?, None, report);
    }
    match configuration::of(declaration, report) {
        Some(configuration) => {
            let whole = configuration::extended(declaration, &configuration, report);
            system(&whole, Some(&configuration), report)
        }
        None => system(declaration, None, report),
    }
}

/// All expressions of a declaration in one arena.
struct Lowered {
    graph: Graph,
    algebra: Algebra,
    parameters: Vec<Parameter>,
    brackets: Vec<poisson::Entry>,
    energy: ExprId,
    casimirs: Vec<ExprId>,
    realization: Option<Realization>,
    initial: Option<Vec<ExprId>>,
}

/// Lowers everything, so that the mistakes of all expressions are reported together.
fn lowered(
    declaration: &Declaration,
    configuration: Option<&Configuration>,
    report: &mut Report,
) -> Option<Lowered> {
    let algebra = match declaration.algebra() {
        Some(algebra) => algebra::check(declaration, algebra, report),
        None => Some(Algebra::none(declaration.dimension())),
    };
    cocycle::parameters(declaration, report);
    let mut graph = Graph::new();
    let mut environment = Environment::new(declaration);
    let parameters = parameters::check(declaration, &mut graph, &environment, report);
    lets::check(declaration, &mut graph, &mut environment, report);
    let brackets = poisson::check(declaration, &mut graph, &environment, report);
    let mut lower =
        |expr, allowed| Lowering::new(&mut graph, &environment, report, allowed).lower(expr);
    let energy = lower(
        declaration.energy.expression(),
        match declaration.energy {
            Energy::Hamiltonian(_) => Allowed::State,
            Energy::Lagrangian { .. } | Energy::DiscreteLagrangian { .. } => {
                Allowed::Velocity(configuration.map_or(usize::MAX, |c| c.momenta))
            }
        },
    );
    let casimirs = declaration.casimirs.iter();
    let casimirs: Vec<_> = casimirs.map(|c| lower(&c.value, Allowed::State)).collect();
    let realization =
        realization::lower(declaration, configuration, &mut graph, &environment, report);
    let initial = initial::check(declaration, &mut graph, &environment, report);
    if report.has_errors() {
        return None;
    }
    Some(Lowered {
        graph,
        algebra: algebra?,
        parameters: parameters?,
        brackets: brackets?,
        energy: energy?,
        casimirs: casimirs.into_iter().collect::<Option<_>>()?,
        realization: realization?,
        initial: initial?,
    })
}

/// Everything behind names and sizes; of a system on `T*G` the declaration is the one with all coordinates.
fn system(
    declaration: &Declaration,
    configuration: Option<&Configuration>,
    report: &mut Report,
) -> Option<Model> {
    let Lowered {
        mut graph,
        algebra,
        parameters,
        brackets,
        energy,
        casimirs,
        mut realization,
        initial,
    } = lowered(declaration, configuration, report)?;
    let defaults = defaults::check(declaration, &algebra.constants, &parameters, report)?;
    let Algebra {
        constants: exact_constants,
        representation,
    } = match declaration.invariance {
        Invariance::Left => algebra,
        Invariance::Right => algebra.opposite(),
    };
    let constants = exact_constants.map(|value| expression(&mut graph, value));
    if declaration.algebra().is_some() {
        cocycle::values(&brackets, &graph, &parameters, report);
    }
    let structure = match &declaration.structure {
        ast::Structure::General { .. } => Structure::General,
        ast::Structure::Lie { .. } if brackets.is_empty() => Structure::Lie,
        ast::Structure::Lie { .. } => Structure::Extended,
    };
    let symbol_name = |symbol| poisson::symbol_name(declaration, symbol);
    let candidates = naming::named(declaration, &casimirs);
    let on_algebra = configuration.is_none() && structure == Structure::Lie;
    let motion = energy::Motion {
        declaration,
        parameters: &parameters,
        configuration,
        on_algebra,
    };
    let (hamiltonian, lagrangian) = motion.hamiltonian(&mut graph, energy, report)?;
    let exact = lagrangian
        .as_ref()
        .is_none_or(|lagrangian| lagrangian.transform == Transform::Exact);
    let autonomous = hamiltonian;
    let hamiltonian = match configuration {
        Some(configuration) if configuration.time => {
            let momentum = graph.symbol(Symbol::Coordinate(configuration.momenta - 1));
            graph.add(hamiltonian, momentum)
        }
        _ => hamiltonian,
    };
    // The matrix of an algebra is looked at here and no more: it leaves the arena as it is.
    let mut scratch = graph.clone();
    let arena = match structure {
        Structure::Lie => &mut scratch,
        _ => &mut graph,
    };
    let mut poisson = matrix::of(arena, structure, &constants, &brackets);
    if structure != Structure::Lie {
        scratch = graph.clone();
    }
    let functions: Vec<_> = candidates.iter().map(|c| (c.expr, c.origin)).collect();
    let energy = (hamiltonian, declaration.energy.expression().origin);
    let place = declaration
        .algebra()
        .map_or(declaration.place(), |algebra| algebra.origin);
    if breadth::check(&scratch, (&poisson, place), energy, report) {
        size::derived(&scratch, &poisson, energy, &functions, report);
    }
    if report.has_errors() {
        return None;
    }
    match structure {
        Structure::Lie => {}
        Structure::Extended => {
            cocycle::check(declaration, &brackets, &constants, &mut scratch, report);
        }
        Structure::General => {
            poisson::jacobi(declaration, &brackets, &mut scratch, report);
            let degrees = poisson.entries.iter();
            let mut degrees = degrees.map(|(.., value)| degree::degree(&graph, *value));
            poisson.degree = degrees.try_fold(0, |most, degree| Some(most.max(degree?)));
        }
    }
    let turned = on_algebra.then_some(&exact_constants);
    let degrees = verified(
        declaration,
        &candidates,
        (&poisson, turned),
        &mut scratch,
        report,
    );
    if let Some(realization) = &mut realization {
        realization::check(realization, &poisson, &mut scratch, &symbol_name, report);
    }
    let casimirs = naming::independent(declaration, &graph, candidates, &degrees?, report);
    let dimension = declaration.dimension();
    let bound = (dimension - casimirs.len().min(dimension)) & !1;
    let generic_rank = match structure {
        Structure::Lie => Some(rank::generic(&exact_constants, bound)),
        _ => matrix::generic_rank(&mut scratch, &poisson, bound),
    };
    if structure == Structure::Lie {
        poisson.entries.clear();
    }
    let (pieces, hamiltonian_degree) = if exact {
        let pieces = separable::coordinates(&mut scratch, hamiltonian, dimension);
        (pieces, degree::degree(&scratch, hamiltonian))
    } else {
        (Err((0, dimension - 1)), None)
    };
    let mut model = Model {
        name: declaration.name.text.clone(),
        name_origin: declaration.name.origin,
        visibility: declaration.visibility.clone(),
        description: declaration.description.clone(),
        references: declaration.references.clone(),
        graph,
        structure,
        poisson,
        basis: declaration.basis().to_vec(),
        coordinates: declaration.state.clone(),
        parameters,
        constants,
        exact_constants,
        invariance: declaration.invariance,
        hamiltonian,
        lagrangian,
        energy: autonomous,
        configuration: configuration.cloned(),
        hamiltonian_degree,
        pieces,
        realization,
        casimirs,
        representation,
        methods: declaration.methods.clone(),
        initial,
        initial_origins: declaration
            .initial
            .iter()
            .flatten()
            .map(|e| e.origin)
            .collect(),
        run: declaration.run.clone(),
        warnings: Vec::new(),
        generic_rank: generic_rank.unwrap_or(bound),
        initial_rank: None,
    };
    domain::check(&model, declaration.initial_origin, report);
    methods::check(&model, report);
    if report.has_errors() {
        return None;
    }
    model.initial_rank = model.initial_values(&model.defaults()).and_then(|mu| {
        if structure != Structure::Lie {
            return matrix::initial_rank(&model, &mut scratch, &mu);
        }
        let mu: Option<Vec<Rational>> = mu.into_iter().map(Rational::from_f64).collect();
        rank::at(&model.exact_constants, &mu?, &defaults, model.generic_rank)
    });
    // where no sample is in the domain, what is known is the rank at the initial state
    if generic_rank.is_none() {
        model.generic_rank = model.initial_rank.unwrap_or(bound);
    }
    Some(model)
}

/// The degrees of the Casimirs, `None` if one is none. With the constants of an algebra it is said which bracket
/// seems to have the wrong sign.
fn verified(
    declaration: &Declaration,
    candidates: &[Candidate],
    (poisson, constants): (&PoissonMatrix, Option<&StructureConstants<Fraction>>),
    scratch: &mut Graph,
    report: &mut Report,
) -> Option<Vec<Option<u32>>> {
    let name = |symbol| poisson::symbol_name(declaration, symbol);
    let mut found = Report::new();
    let degrees = candidates.iter();
    let degrees = degrees.map(|c| casimirs::check(c, scratch, poisson, &name, &mut found));
    let degrees: Vec<Option<Option<u32>>> = degrees.collect();
    let failed = found.has_errors();
    let mut found = found.into_diagnostics();
    if let Some(constants) = constants.filter(|_| failed) {
        sign::explain(declaration, constants, candidates, scratch, &mut found);
    }
    found.into_iter().for_each(|d| report.push(d));
    degrees.into_iter().collect()
}

/// A rational function of the parameters in the arena.
pub(crate) fn expression(graph: &mut Graph, value: &Fraction) -> ExprId {
    let polynomial = |graph: &mut Graph, p: &crate::exact::Polynomial| {
        let mut terms = Vec::new();
        for (monomial, coefficient) in p.terms() {
            let mut powers = Vec::new();
            for (v, e) in monomial.powers() {
                powers.push((
                    graph.symbol(Symbol::Parameter(v)),
                    Rational::from(i64::from(e)),
                ));
            }
            terms.push((graph.power_product(&powers), coefficient.clone()));
        }
        graph.linear(&terms)
    };
    let mut factors = vec![(polynomial(graph, value.numerator()), Rational::ONE)];
    for (factor, exponent) in value.denominator() {
        factors.push((
            polynomial(graph, factor),
            Rational::from(-i64::from(exponent)),
        ));
    }
    graph.power_product(&factors)
}

/// The structure constants as numbers at the default parameters, for tests and tables.
pub fn default_constants(model: &Model) -> Option<StructureConstants<Rational>> {
    let value = |p: usize| model.parameters[p].exact.clone().unwrap_or(Rational::ZERO);
    model
        .exact_constants
        .try_map(|constant| constant.evaluate(&value))
}
