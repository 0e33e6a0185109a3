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
mod family;
pub(crate) mod found;
mod idle;
mod independence;
mod initial;
mod legendre;
mod lets;
mod lower;
mod matrix;
mod methods;
pub mod motions;
mod names;
mod naming;
pub(crate) mod normal;
mod opaque;
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
mod smooth;
mod system;
mod velocity;

#[cfg(test)]
mod tests;

use std::collections::HashMap;

use crate::ast::Declaration;
use crate::diagnostic::{Diagnostic, Report};
use crate::exact::{Budget, Fraction, Rational};
use crate::model::Model;
use crate::symbolic::{ExprId, Graph, Node, Symbol};

pub use constant::constant;
pub use names::is_reserved;
pub use size::MAX_DIMENSION;

/// How much work is done to find what nobody declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// So much that a declaration is not slow to compile.
    Declaration,
    /// So much that a report on a system is there within seconds.
    Report,
    /// So much as somebody waits for who asks for it.
    Deep,
}

/// Checks a declaration; `None` if any error was reported. Warnings go to the report and to the
/// model.
pub fn check(declaration: &Declaration, report: &mut Report) -> Option<Model> {
    check_with(declaration, Effort::Declaration, report)
}

/// The same with as much work on what is searched for as is said.
pub fn check_with(declaration: &Declaration, effort: Effort, report: &mut Report) -> Option<Model> {
    let mut own = Report::new();
    contradiction::clear();
    let model = stages(declaration, effort, &mut own);
    if let Some(diagnostic) = contradiction::diagnostic(declaration.name.origin) {
        own.push(diagnostic);
    }
    if model.as_ref().is_some_and(|model| model.family.is_some()) {
        idle::unused(declaration, &mut own);
    } else if let Some(model) = &model {
        idle::check(declaration, model, &mut own);
    }
    if let Some(model) = &model {
        smooth::check(declaration, model, &mut own);
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

fn stages(declaration: &Declaration, effort: Effort, report: &mut Report) -> Option<Model> {
    if let Some(family) = &declaration.family {
        return family::check(declaration, family, effort, report);
    }
    names::check(declaration, report);
    if !size::check(declaration, report) {
        return None;
    }
    if declaration.energy.has_step() && declaration.group.is_some() {
        let written_out = entries::written_out(declaration, report)?;
        return system::check(&written_out, None, effort, report);
    }
    match configuration::of(declaration, report) {
        Some(configuration) => {
            let whole = configuration::extended(declaration, &configuration, report);
            system::check(&whole, Some(&configuration), effort, report)
        }
        None => system::check(declaration, None, effort, report),
    }
}

/// Work allowed for one rational function of the parameters.
const WORK_OF_FRACTIONS: u64 = 10_000;

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

/// An expression as a rational function of the parameters, where it is one, or is where all coordinates have a value.
pub(crate) fn fraction(
    graph: &Graph,
    id: ExprId,
    coordinates: Option<Rational>,
) -> Option<Fraction> {
    let budget = &Budget::new(WORK_OF_FRACTIONS);
    let mut values: HashMap<ExprId, Fraction> = HashMap::new();
    for id in graph.dependencies(&[id]) {
        let value = match graph.node(id) {
            Node::Number(value) => Fraction::from(value.clone()),
            Node::Symbol(Symbol::Parameter(p)) => Fraction::variable(*p),
            Node::Symbol(Symbol::Coordinate(_)) => Fraction::from(coordinates.clone()?),
            Node::Sum { constant, terms } => {
                let mut sum = Fraction::from(constant.clone());
                for (term, coefficient) in terms {
                    sum = sum.add(&values[term].scale(coefficient), budget).ok()?;
                }
                sum
            }
            Node::Product(factors) => {
                let mut product = Fraction::from(Rational::ONE);
                for (base, exponent) in factors {
                    let exponent = i32::try_from(exponent.to_integer()?).ok()?;
                    let power = values[base].pow(exponent, budget).ok()??;
                    product = product.mul(&power, budget).ok()?;
                }
                product
            }
            _ => return None,
        };
        values.insert(id, value);
    }
    values.remove(&id)
}
