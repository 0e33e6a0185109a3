//! H with symbols in the place of Casimirs that it contains: `(x^2 + y^2 + z^2) z` is `c z`, `sqrt(x^2 + y^2 + z^2) z` too.
//!
//! In every sum, that of H itself and those inside of functions and powers, multiples `q C` of a Casimir C are taken away and `q c` is added
//! where that leaves fewer terms, with q any term of the sum over a term of C. Nothing is lost: with C for c the sum is
//! what it was.

use super::additive;
use super::invariants::Invariant;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Node};

/// Multiples that are tried in one sum.
const MULTIPLES: usize = 400;

/// H with the symbols; `None` where it contains none of these Casimirs.
pub(super) fn substitute_casimirs(
    graph: &mut Graph,
    h: ExprId,
    casimirs: &[Invariant],
) -> Option<ExprId> {
    let mut value = inside(graph, h, casimirs);
    if let Some(other) = of_sum(graph, value, casimirs, false) {
        value = other;
    }
    let value = graph.normal(value);
    (value != h).then_some(value)
}

/// The expression with what is in its functions and powers rewritten.
fn inside(graph: &mut Graph, root: ExprId, casimirs: &[Invariant]) -> ExprId {
    let mut images = std::collections::HashMap::new();
    for id in graph.dependencies(&[root]) {
        let image = match graph.node(id).clone() {
            Node::Sum { constant, terms } => {
                let mut terms: Vec<(ExprId, Rational)> =
                    terms.iter().map(|(t, c)| (images[t], c.clone())).collect();
                terms.push((graph.number(constant), Rational::ONE));
                graph.linear(&terms)
            }
            Node::Product(factors) => {
                let mut all = Vec::new();
                for (base, exponent) in &factors {
                    let image: ExprId = images[base];
                    all.push((rewritten(graph, image, casimirs), exponent.clone()));
                }
                graph.power_product(&all)
            }
            Node::Call(function, arguments) => {
                let mut all = Vec::new();
                for argument in &arguments {
                    let image: ExprId = images[argument];
                    all.push(rewritten(graph, image, casimirs));
                }
                graph.call(function, &all)
            }
            _ => id,
        };
        images.insert(id, image);
    }
    images[&root]
}

/// A base or an argument, rewritten where it is a sum.
fn rewritten(graph: &mut Graph, id: ExprId, casimirs: &[Invariant]) -> ExprId {
    match graph.node(id) {
        Node::Sum { .. } => of_sum(graph, id, casimirs, true).unwrap_or(id),
        _ => id,
    }
}

/// A sum with multiples of Casimirs replaced; of H itself (`constants` is false) none by a factor that is constant, which is decided by
/// the pieces that are left.
fn of_sum(
    graph: &mut Graph,
    sum: ExprId,
    casimirs: &[Invariant],
    constants: bool,
) -> Option<ExprId> {
    let (constant, mut terms) = additive::collected(graph, sum)?;
    let mut changed = false;
    let mut tries = MULTIPLES;
    'again: loop {
        for casimir in casimirs {
            let parts = additive::terms(graph, casimir.value)?;
            for &term in &terms {
                for &part in &parts {
                    if tries == 0 {
                        break 'again;
                    }
                    let Some(factor) = quotient(graph, term, part) else {
                        continue;
                    };
                    if !constants && graph.coordinates(factor).is_empty() {
                        continue;
                    }
                    tries -= 1;
                    let Some(others) = replaced(graph, &terms, factor, casimir) else {
                        continue;
                    };
                    if weight(graph, &others) < weight(graph, &terms) {
                        terms = others;
                        changed = true;
                        continue 'again;
                    }
                }
            }
        }
        break;
    }
    changed.then(|| {
        terms.push(graph.number(constant));
        graph.sum(&terms)
    })
}

/// How many terms contain coordinates.
fn weight(graph: &Graph, terms: &[ExprId]) -> usize {
    let contain = |term: &&ExprId| !graph.coordinates(**term).is_empty();
    terms.iter().filter(contain).count()
}

/// The quotient of two terms where it has no negative power of a coordinate that the first one lacks.
fn quotient(graph: &mut Graph, term: ExprId, part: ExprId) -> Option<ExprId> {
    let shared = graph.coordinates(part);
    let within = graph.coordinates(term);
    if !shared.iter().all(|i| within.contains(i)) {
        return None;
    }
    let ((above, term), (below, part)) = (graph.coefficient(term), graph.coefficient(part));
    let bare = graph.power_product(&[(term, Rational::ONE), (part, Rational::MINUS_ONE)]);
    let negative = |graph: &Graph, base: ExprId, exponent: &Rational| {
        exponent.is_negative() && shared.iter().any(|i| graph.coordinates(base).contains(i))
    };
    let fails = match graph.node(bare) {
        Node::Product(factors) => factors
            .iter()
            .any(|(base, exponent)| negative(graph, *base, exponent)),
        _ => false,
    };
    (!fails).then(|| graph.scale(bare, &(&above / &below)))
}

/// `sum - q C + q c`
fn replaced(
    graph: &mut Graph,
    terms: &[ExprId],
    factor: ExprId,
    casimir: &Invariant,
) -> Option<Vec<ExprId>> {
    let symbol = graph.symbol(casimir.symbol);
    let difference = graph.sub(symbol, casimir.value);
    let change = graph.mul(factor, difference);
    let change = additive::terms(graph, change)?;
    let all = [terms, &change].concat();
    let sum = graph.sum(&all);
    additive::terms(graph, sum)
}
