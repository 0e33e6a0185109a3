//! The checks: from the syntax tree to a model in which nothing is wrong.
//!
//! One module per check. The stages are: names, sizes, the algebra and the lowering of all
//! expressions (their mistakes are reported together), then what needs a sound model: the
//! identities of other brackets, Casimirs and the domain.

mod algebra;
mod breadth;
mod casimirs;
mod cocycle;
mod configuration;
mod constant;
mod defaults;
mod descent;
mod discrete;
pub mod domain;
mod energy;
mod entries;
mod environment;
mod family;
pub(crate) mod found;
mod idle;
mod initial;
mod legendre;
mod lets;
mod lower;
mod matrix;
mod methods;
pub mod motions;
mod names;
mod naming;
mod opaque;
mod parameters;
mod poisson;
mod realization;
mod series;
mod sign;
mod size;
mod smooth;
mod system;
mod velocity;

#[cfg(test)]
mod tests;

use crate::ast::Declaration;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::model::Model;
use crate::prove::contradiction;

pub use constant::constant;

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
    if let Some(text) = contradiction::take() {
        own.push(contradicted(&text, declaration.name.origin));
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

/// What is said of a verdict that numbers refute.
fn contradicted(text: &str, origin: Origin) -> Diagnostic {
    let message = format!(
        "the compiler contradicts itself: values at a point refute what it has proven about `{text}`"
    );
    let help = "this is a bug in the compiler, not in the declaration; please report it with the declaration";
    Diagnostic::new(Kind::Limit, origin, message).help(help)
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
