//! The checks: from the syntax tree to a model in which nothing is wrong.
//!
//! One module per check, which returns its mistakes or adds them to the list of its stage. The stages are: names and sizes, the coordinates, the
//! expressions (their mistakes are found together), the system that they make, its identities, the model and its domain.

mod algebra;
mod assembly;
mod attitude;
mod breadth;
mod casimirs;
mod central;
mod cocycle;
mod configuration;
mod constant;
mod constraint;
mod coordinates;
mod defaults;
mod derivatives;
mod descent;
mod discrete;
pub mod domain;
mod driving;
mod energy;
mod entries;
mod environment;
mod events;
mod exactness;
mod expressions;
mod family;
mod identities;
mod idle;
mod initial;
mod integrals;
mod jacobi;
mod legendre;
mod lets;
mod lower;
mod matrix;
mod names;
mod naming;
mod opaque;
mod parameters;
mod poisson;
mod poisson_map;
mod rank;
mod realization;
mod recorded;
mod refuted_verdict;
mod retraction;
mod series;
mod sign;
mod size;
mod symbols;
mod system;
mod velocity;

#[cfg(test)]
mod tests;

use crate::model::Model;
use lie_symbolic::prove::contradiction;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Report};

pub use constant::constant_value;
pub use driving::violation;
pub use refuted_verdict::refuted_verdict;

/// Checks a declaration; `None` if there are mistakes. Those and warnings go to the report.
pub fn check(declaration: &Declaration, report: &mut Report) -> Option<Model> {
    contradiction::clear();
    let mut mistakes = Vec::new();
    let model = stages(declaration, &mut mistakes);
    mistakes.extend(refuted_verdict(declaration.name.origin));
    if let Some(model) = &model {
        mistakes.extend(idle::without_effect(declaration, model));
    }
    report.extend(mistakes);
    model.filter(|_| !report.has_errors())
}

/// Whether there are more than warnings.
fn has_errors(mistakes: &[Diagnostic]) -> bool {
    mistakes.iter().any(|mistake| !mistake.warning)
}

fn stages(declaration: &Declaration, mistakes: &mut Vec<Diagnostic>) -> Option<Model> {
    let family = declaration.family.as_ref();
    if let Some(family) = family {
        mistakes.extend(family::limits::violations(declaration, family));
    }
    mistakes.extend(names::name_spaces(declaration));
    if family.is_some() && !mistakes.is_empty() {
        return None;
    }
    if let Some(mistake) = size::dimension(declaration) {
        mistakes.push(mistake);
        return None;
    }
    mistakes.extend(size::lengths(declaration));
    let refused = constraint::refused(declaration);
    if !refused.is_empty() {
        mistakes.extend(refused);
        return None;
    }
    let mut whole = coordinates::whole(declaration, mistakes)?;
    let name = |symbol| symbols::symbol_name(&whole.declaration, symbol);
    let lowered = expressions::lower(&whole, &name, mistakes)?;
    let mut system = system::system(&whole, lowered, &name, mistakes)?;
    if declaration.is_constrained() {
        (whole, system) = constraint::reduced(whole, system, mistakes)?;
    }
    let name = |symbol| symbols::symbol_name(&whole.declaration, symbol);
    let proven = identities::identities(&whole, &mut system, &name, mistakes)?;
    let model = assembly::assemble(&whole, system, proven);
    let off = constraint::initial_violation(&model, declaration);
    mistakes.extend(
        off.or_else(|| attitude::mistake(&model))
            .or_else(|| retraction::mistake(&model))
            .or_else(|| {
                let place = whole.declaration.initial_origin;
                domain::initial_domain(&model, place)
            }),
    );
    if has_errors(mistakes) {
        return None;
    }
    match family.zip(whole.sums) {
        Some((family, sums)) => {
            family::coupling::couple(declaration, family, &sums, model, mistakes)
        }
        None => Some(model),
    }
}
