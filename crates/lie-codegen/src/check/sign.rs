//! A wrong sign of a bracket that leaves the Jacobi identity true makes a true Casimir false: the
//! message must not blame the Casimir alone.

use super::casimirs::{self, Candidate};
use super::matrix;
use crate::algebra::{StructureConstants, jacobi};
use lie_symbolic::exact::{Budget, Fraction};
use lie_symbolic::symbolic::{Graph, Symbol};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, Report};
use lie_syntax::linear::WORK;

/// Brackets whose signs are tried; each trial is a check of the algebra and of its Casimirs.
const MOST_TRIED: usize = 16;

/// Names the bracket whose other sign would keep the Jacobi identity and make every declared Casimir
/// true, in the remedies of the Casimirs that are false, if there is exactly one.
pub fn explain(
    declaration: &Declaration,
    constants: &StructureConstants<Fraction>,
    candidates: &[Candidate],
    graph: &mut Graph,
    diagnostics: &mut [Diagnostic],
) {
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for (i, j, ..) in constants.entries() {
        if pairs.last() != Some(&(*i, *j)) {
            pairs.push((*i, *j));
        }
    }
    if pairs.len() > MOST_TRIED {
        return;
    }
    let trials = pairs.into_iter();
    let found: Vec<_> = trials
        .filter(|pair| holds(&flipped(constants, *pair), candidates, graph))
        .collect();
    let [(i, j)] = found.as_slice() else { return };
    let basis = declaration.basis();
    let help = format!(
        "with the other sign of [{}, {}] the Jacobi identity and every declared Casimir hold: is that bracket right?",
        basis[*i].text, basis[*j].text
    );
    let false_ones = diagnostics.iter_mut().filter(|d| d.kind == Kind::Casimir);
    for diagnostic in false_ones.filter(|d| !d.warning) {
        diagnostic.help = Some(help.clone());
    }
}

fn flipped(
    constants: &StructureConstants<Fraction>,
    pair: (usize, usize),
) -> StructureConstants<Fraction> {
    let entries = constants.entries().iter().map(|(i, j, k, value)| {
        let turned = (*i, *j) == pair;
        let value = if turned { value.neg() } else { value.clone() };
        (*i, *j, *k, value)
    });
    StructureConstants::new(constants.dimension(), entries.collect())
}

/// Whether the constants satisfy the Jacobi identity and all candidates are Casimirs.
fn holds(
    constants: &StructureConstants<Fraction>,
    candidates: &[Candidate],
    graph: &mut Graph,
) -> bool {
    if !matches!(
        jacobi::first_failure(constants, &Budget::new(WORK)),
        Ok(None)
    ) {
        return false;
    }
    let symbolic = constants.map(|value| graph.rational_function(value));
    let poisson = matrix::of(graph, symbolic.dimension(), Some(&symbolic), &[]);
    let mut unheard = Report::new();
    let nameless = |_: Symbol| String::new();
    let all = candidates.iter().all(|candidate| {
        casimirs::check(candidate, graph, &poisson, &nameless, &mut unheard).is_some()
    });
    unheard.ignore("these brackets are a guess of ours, not what was declared");
    all
}
