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
mod system;
mod velocity;

#[cfg(test)]
mod tests;

use crate::ast::Declaration;
use crate::diagnostic::{Diagnostic, Report};
use crate::exact::{Fraction, Rational};
use crate::model::Model;
use crate::symbolic::{ExprId, Graph, Symbol};

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
        return system::check(&entries::written_out(declaration, report)?, None, report);
    }
    match configuration::of(declaration, report) {
        Some(configuration) => {
            let whole = configuration::extended(declaration, &configuration, report);
            system::check(&whole, Some(&configuration), report)
        }
        None => system::check(declaration, None, report),
    }
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
