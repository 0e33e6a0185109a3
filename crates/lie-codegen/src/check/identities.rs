//! What must hold identically: the Jacobi identity of the brackets, the Casimirs, and the realization.

use std::collections::HashSet;

use super::coordinates::Whole;
use super::system::System;
use super::{casimirs, events, integrals, jacobi, naming, poisson_map, sign};
use crate::model::{Bracket, Casimir, Event, Quantity, QuantityKind};
use lie_symbolic::prove::branches;
use lie_symbolic::symbolic::Symbol;
use lie_syntax::diagnostic::Diagnostic;

/// What is proven of a system.
pub struct Proven {
    /// The bracket.
    pub bracket: Bracket,
    /// The independent Casimirs.
    pub casimirs: Vec<Casimir>,
    /// The first integrals, and the other functions that are recorded.
    pub quantities: Vec<Quantity>,
    /// The functions whose zeros are found.
    pub events: Vec<Event>,
    /// The names that the declaration uses.
    pub taken: HashSet<String>,
}

/// Proves the identities; `None` if a Casimir is none.
pub fn identities(
    whole: &Whole<'_>,
    system: &mut System,
    name: &dyn Fn(Symbol) -> String,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Proven> {
    let declaration = &*whole.declaration;
    let on_algebra = whole.configuration.is_none() && system.lowered.brackets.is_empty();
    let matrix = &system.matrix;
    let brackets = &system.lowered.brackets;
    let scratch = &mut system.scratch;
    let bracket = match system.algebra.clone() {
        Some(algebra) => Bracket::Lie(algebra),
        None => {
            if declaration.algebra().is_none() && !declaration.is_constrained() {
                let identity = jacobi::jacobi_identity(declaration, brackets, scratch, name);
                mistakes.extend(identity);
            }
            Bracket::General(matrix.clone())
        }
    };
    let taken = casimirs::taken(declaration);
    let free = || casimirs::free_names(&taken);
    let candidates = casimirs::candidates(declaration, &system.lowered.casimirs, free());
    let violations = candidates.iter();
    let violations = violations.filter_map(|c| casimirs::refutation(c, scratch, matrix, name));
    let mut violations: Vec<Diagnostic> = violations.collect();
    if let Some(algebra) = system.algebra.as_ref().filter(|_| on_algebra)
        && !violations.is_empty()
    {
        sign::explain(
            declaration,
            &algebra.exact,
            matrix,
            &candidates,
            scratch,
            &mut violations,
        );
    }
    let proven = violations.is_empty();
    mistakes.extend(violations);
    let motion = integrals::Motion {
        matrix,
        energy: &system.energy,
        driving: system.driving.as_ref(),
        configuration: whole.configuration.as_ref(),
        name,
    };
    let functions = declaration.integrals.iter().zip(&system.lowered.integrals);
    let violations = functions.filter_map(|(f, expr)| motion.refutation(f, *expr, scratch));
    mistakes.extend(violations);
    if let Some(realization) = &mut system.lowered.realization {
        mistakes.extend(poisson_map::poisson_map(realization, matrix, scratch, name));
    }
    if !proven {
        return None;
    }
    let casimirs = naming::independent(
        declaration,
        &system.lowered.graph,
        candidates,
        free(),
        mistakes,
    );
    Some(Proven {
        bracket,
        casimirs,
        quantities: quantities(whole, system),
        events: events::events(whole, &system.lowered, mistakes),
        taken,
    })
}

/// What is recorded, in the order of the columns.
fn quantities(whole: &Whole<'_>, system: &mut System) -> Vec<Quantity> {
    let declaration = &*whole.declaration;
    let lowered = &mut system.lowered;
    // what the forces do is taken from the momentum of the time
    let clock = whole.configuration.as_ref().and_then(|c| c.clock());
    let work = clock.filter(|_| system.driving.is_some()).map(|clock| {
        let momentum = lowered.graph.symbol(Symbol::Coordinate(clock.momentum));
        Quantity::work(declaration.name.origin, lowered.graph.neg(momentum))
    });
    let held = whole.configuration.iter().flat_map(|c| c.held_places());
    let inputs = declaration.inputs.iter().zip(held);
    let inputs: Vec<Quantity> = inputs
        .map(|(input, place)| Quantity {
            name: input.name.text.clone(),
            origin: input.name.origin,
            expr: lowered.graph.symbol(Symbol::Coordinate(place)),
            kind: QuantityKind::Input,
            unwrap: false,
            multivalued: false,
        })
        .collect();
    let integrals = declaration.integrals.iter().zip(&lowered.integrals);
    let integrals = integrals.map(|((name, value), expr)| Quantity {
        name: name.text.clone(),
        origin: value.origin,
        expr: *expr,
        kind: QuantityKind::Integral,
        unwrap: false,
        multivalued: branches::jumps(&lowered.graph, *expr),
    });
    let observables = declaration.observables.iter().zip(&lowered.observables);
    let observables = observables.map(|(observable, expr)| Quantity {
        name: observable.name.text.clone(),
        origin: observable.value.origin,
        expr: *expr,
        kind: QuantityKind::Observable,
        unwrap: observable.unwrap,
        multivalued: branches::jumps(&lowered.graph, *expr),
    });
    let all = work.into_iter().chain(integrals);
    all.chain(observables).chain(inputs).collect()
}
