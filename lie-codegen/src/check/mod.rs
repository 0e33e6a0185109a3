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

use std::collections::HashSet;

use crate::algebra::{StructureConstants, rank};
use crate::ast::{self, Declaration, Energy, Invariance};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::exact::{Fraction, Rational};
use crate::model::{Casimir, Model, Structure, Transform};
use crate::structure::separable;
use crate::symbolic::{ExprId, Graph, Symbol};
use algebra::Algebra;
use casimirs::Candidate;
use configuration::Configuration;
use environment::{Allowed, Environment};
use independence::Standing;
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

/// Everything behind names and sizes; of a system on `T*G` the declaration is the one with all coordinates.
fn system(
    declaration: &Declaration,
    configuration: Option<&Configuration>,
    report: &mut Report,
) -> Option<Model> {
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
    let lowered: Vec<Option<ExprId>> = declaration
        .casimirs
        .iter()
        .map(|c| lower(&c.value, Allowed::State))
        .collect();
    let realization =
        realization::lower(declaration, configuration, &mut graph, &environment, report);
    let initial = initial::check(declaration, &mut graph, &environment, report);
    if report.has_errors() {
        return None;
    }
    let (algebra, parameters, initial) = (algebra?, parameters?, initial?);
    let (brackets, mut realization) = (brackets?, realization?);
    let constants = algebra.constants;
    let defaults = defaults::check(declaration, &constants, &parameters, report)?;
    // The right-invariant system is the left-invariant one of the opposite algebra.
    let (exact_constants, representation) = match declaration.invariance {
        Invariance::Left => (constants, algebra.representation),
        Invariance::Right => (
            constants.map(Fraction::neg),
            algebra.representation.map(|mut representation| {
                // The triple product of three matrices changes its sign with them.
                let dual = representation.dual.iter_mut().flatten();
                for matrix in representation.matrices.iter_mut().chain(dual) {
                    for entry in matrix.iter_mut().flatten() {
                        *entry = -&*entry;
                    }
                }
                representation
            }),
        ),
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
    let candidates: Vec<Candidate> = named(
        declaration,
        &lowered.into_iter().collect::<Option<Vec<_>>>()?,
    );
    let on_algebra = configuration.is_none() && structure == Structure::Lie;
    let motion = energy::Motion {
        declaration,
        parameters: &parameters,
        configuration,
        on_algebra,
    };
    let (hamiltonian, lagrangian) = motion.hamiltonian(&mut graph, energy?, report)?;
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
    let mut degrees = Vec::new();
    let mut found = Report::new();
    for candidate in &candidates {
        degrees.push(casimirs::check(
            candidate,
            &mut scratch,
            &poisson,
            &symbol_name,
            &mut found,
        ));
    }
    let failed = found.has_errors();
    let mut found = found.into_diagnostics();
    if failed && on_algebra {
        sign::explain(
            declaration,
            &exact_constants,
            &candidates,
            &mut scratch,
            &mut found,
        );
    }
    found.into_iter().for_each(|d| report.push(d));
    if let Some(realization) = &mut realization {
        realization::check(realization, &poisson, &mut scratch, &symbol_name, report);
    }
    let degrees: Vec<Option<u32>> = degrees.into_iter().collect::<Option<_>>()?;
    let casimirs = independent(declaration, &graph, candidates, &degrees, report);
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

/// The Casimirs with names: unnamed ones are C1, C2, …, skipping what is taken.
fn named(declaration: &Declaration, lowered: &[ExprId]) -> Vec<Candidate> {
    let mut free = free_names(declaration);
    let casimirs = declaration.casimirs.iter().zip(lowered);
    casimirs
        .map(|(casimir, expr)| {
            let name = casimir
                .name
                .as_ref()
                .map(|n| n.text.clone())
                .or_else(|| free.next())
                .unwrap_or_default();
            Candidate {
                name,
                origin: casimir.value.origin,
                expr: *expr,
            }
        })
        .collect()
}

/// C1, C2, … without the names that are taken.
fn free_names(declaration: &Declaration) -> impl Iterator<Item = String> + use<> {
    let names = declaration
        .state
        .iter()
        .chain(declaration.basis())
        .chain(declaration.lets.iter().map(|(n, _)| n));
    let names = names.chain(declaration.parameters.iter().map(|p| &p.name));
    let names = names.chain(declaration.casimirs.iter().filter_map(|c| c.name.as_ref()));
    let taken: HashSet<String> = names.map(|n| n.text.clone()).collect();
    (1..)
        .map(|i| format!("C{i}"))
        .filter(move |name| !taken.contains(name))
}

/// Leaves out, with a warning, what depends on earlier Casimirs; the unnamed rest is numbered anew.
fn independent(
    declaration: &Declaration,
    graph: &Graph,
    candidates: Vec<Candidate>,
    degrees: &[Option<u32>],
    report: &mut Report,
) -> Vec<Casimir> {
    let functions: Vec<ExprId> = candidates.iter().map(|c| c.expr).collect();
    let standings = independence::check(graph, &functions, declaration.dimension());
    let mut free = free_names(declaration);
    let mut kept = Vec::new();
    for (((candidate, standing), degree), declared) in candidates
        .into_iter()
        .zip(standings)
        .zip(degrees)
        .zip(&declaration.casimirs)
    {
        let why = match standing {
            Standing::Independent => {
                let name = declared
                    .name
                    .as_ref()
                    .map(|n| n.text.clone())
                    .or_else(|| free.next())
                    .unwrap_or(candidate.name);
                let multivalued = branches::jumps(graph, candidate.expr);
                if multivalued {
                    report.push(multivalued_casimir(&name, candidate.origin));
                }
                kept.push(Casimir {
                    name,
                    origin: candidate.origin,
                    expr: candidate.expr,
                    degree: *degree,
                    multivalued,
                });
                continue;
            }
            Standing::Dependent => "depends on the Casimirs before it",
            Standing::Constant => "does not depend on the state",
        };
        report.push(
            Diagnostic::new(
                Kind::Casimir,
                candidate.origin,
                format!("the Casimir `{}` {why} and is left out", candidate.name),
            )
            .help("remove it")
            .warning(),
        );
    }
    kept
}

fn multivalued_casimir(name: &str, origin: crate::diagnostic::Origin) -> Diagnostic {
    let message = format!(
        "the Casimir `{name}` is multi-valued: an angle in it jumps, and `{name}` with it, although it is constant between \
         the jumps"
    );
    Diagnostic::new(Kind::Casimir, origin, message)
        .help("its column is written, but no drift is measured; a function of it without jumps, such as its sine, would be followed")
        .warning()
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
