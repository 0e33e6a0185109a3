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
mod idle;
mod initial;
mod legendre;
mod lets;
mod lower;
mod matrix;
mod names;
mod naming;
mod opaque;
mod parameters;
mod poisson;
mod realization;
mod series;
mod sign;
mod size;
mod system;
mod velocity;

#[cfg(test)]
mod tests;

use crate::model::Model;
use lie_symbolic::prove::contradiction;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, Report};

pub use constant::constant_of;

/// Checks a declaration; `None` if there are mistakes. Those and warnings go to the report, which is empty.
pub fn check(declaration: &Declaration, report: &mut Report) -> Option<Model> {
    contradiction::clear();
    let model = stages(declaration, report);
    contradicted(declaration.name.origin, report);
    let model = model?;
    match &model.family {
        Some(_) => idle::unused(declaration, report),
        None => idle::check(declaration, &model, report),
    }
    (!report.has_errors()).then_some(model)
}

/// Reports a verdict that numbers refute.
pub fn contradicted(origin: Origin, report: &mut Report) {
    let Some(text) = contradiction::take() else {
        return;
    };
    let message = format!(
        "the compiler contradicts itself: values at a point refute what it has proven about `{text}`"
    );
    let help = "this is a bug in the compiler, not in the declaration; please report it with the declaration";
    report.push(Diagnostic::new(Kind::Limit, origin, message).help(help));
}

fn stages(declaration: &Declaration, report: &mut Report) -> Option<Model> {
    if let Some(family) = &declaration.family {
        return family::check(declaration, family, report);
    }
    names::check(declaration, report);
    if !size::check(declaration, report) {
        return None;
    }
    if declaration.energy.has_step() && declaration.group.is_some() {
        let written_out = entries::written_out(declaration, report)?;
        return system::check(&written_out, None, report);
    }
    match configuration::of(declaration, report) {
        Some(configuration) => {
            let whole = configuration::extended(declaration, &configuration, report);
            system::check(&whole, Some(&configuration), report)
        }
        None => system::check(declaration, None, report),
    }
}
