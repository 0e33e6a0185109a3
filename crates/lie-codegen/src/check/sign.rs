//! A wrong sign of a bracket that leaves the Jacobi identity true makes a true Casimir false: the
//! message must not blame the Casimir alone.

use super::casimirs::{self, Candidate};
use crate::algebra::{StructureConstants, jacobi};
use crate::model::PoissonMatrix;
use lie_symbolic::exact::{Budget, Fraction};
use lie_symbolic::symbolic::{Graph, Symbol};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::Diagnostic;
use lie_syntax::linear::WORK;

/// Brackets whose signs are tried; each trial is a check of the algebra and of its Casimirs.
const MOST_TRIED: usize = 16;

/// Names the bracket whose other sign would keep the Jacobi identity and make every declared Casimir
/// true, in the remedies of the Casimirs that are false, if there is exactly one.
pub fn explain(
    declaration: &Declaration,
    constants: &StructureConstants<Fraction>,
    poisson: &PoissonMatrix,
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
    let nameless = |_: Symbol| String::new();
    let mut holds = |pair: &(usize, usize)| {
        let identity = jacobi::first_failure(&flipped(constants, *pair), &Budget::new(WORK));
        let mut poisson = poisson.clone();
        for (i, j, value) in &mut poisson.entries {
            if (*i, *j) == *pair {
                *value = graph.neg(*value);
            }
        }
        let mut all = candidates.iter();
        matches!(identity, Ok(None))
            && all.all(|c| casimirs::refutation(c, graph, &poisson, &nameless).is_none())
    };
    let found: Vec<_> = pairs.into_iter().filter(|pair| holds(pair)).collect();
    let [(i, j)] = found.as_slice() else { return };
    let basis = declaration.basis();
    let help = format!(
        "with the other sign of [{}, {}] the Jacobi identity and every declared Casimir hold: is that bracket right?",
        basis[*i].text, basis[*j].text
    );
    for diagnostic in diagnostics {
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
