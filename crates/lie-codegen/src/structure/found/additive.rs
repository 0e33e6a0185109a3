//! Expressions as sums of terms that are taken apart as far as that goes: `a*(x + y)^2` has three.

use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Node};

/// More terms are not looked at.
const MOST: usize = 2000;
/// Nor more factors in all of them: a tower of powers has few terms at a time, each longer than the last.
const MOST_FACTORS: usize = 20_000;

/// The terms of an expression in normal form, like terms collected, without a constant number; `None` where there are
/// too many.
pub(crate) fn terms(graph: &mut Graph, id: ExprId) -> Option<Vec<ExprId>> {
    collected(graph, id).map(|(_, terms)| terms)
}

/// The same with the constant number.
pub(crate) fn collected(graph: &mut Graph, id: ExprId) -> Option<(Rational, Vec<ExprId>)> {
    let normal = graph.normal(id);
    let mut open = vec![normal];
    let mut atoms = Vec::new();
    let (mut work, mut factors) = (0, 0);
    while let Some(id) = open.pop() {
        work += 1;
        if let Node::Product(all) = graph.node(id) {
            factors += all.len();
        }
        if work > MOST || open.len() > MOST || factors > MOST_FACTORS {
            return None;
        }
        match apart(graph, id) {
            Some(parts) => open.extend(parts),
            None => atoms.push(id),
        }
    }
    let sum = graph.sum(&atoms);
    Some(match graph.node(sum).clone() {
        Node::Number(constant) => (constant, Vec::new()),
        Node::Sum { constant, terms } => {
            let terms = terms.iter().map(|(term, scale)| graph.scale(*term, scale));
            (constant, terms.collect())
        }
        _ => (Rational::ZERO, vec![sum]),
    })
}

/// The terms of a sum, or of a product one of whose factors is a sum of coordinates.
fn apart(graph: &mut Graph, id: ExprId) -> Option<Vec<ExprId>> {
    match graph.node(id).clone() {
        Node::Sum { constant, terms } if terms.len() > 1 || !constant.is_zero() => {
            let mut parts: Vec<ExprId> = Vec::new();
            for (term, scale) in &terms {
                parts.push(graph.scale(*term, scale));
            }
            if !constant.is_zero() {
                parts.push(graph.number(constant));
            }
            Some(parts)
        }
        Node::Sum { terms, .. } => {
            let (term, scale) = terms.first()?;
            let parts = apart(graph, *term)?;
            Some(parts.iter().map(|part| graph.scale(*part, scale)).collect())
        }
        Node::Product(factors) => {
            let whole = |exponent: &Rational| exponent.to_integer().is_some_and(|e| e > 0);
            let place = factors.iter().position(|(base, exponent)| {
                whole(exponent)
                    && matches!(graph.node(*base), Node::Sum { .. })
                    && !graph.coordinates(*base).is_empty()
            })?;
            let (base, exponent) = factors[place].clone();
            let mut rest = factors.to_vec();
            rest[place].1 = &exponent - &Rational::ONE;
            rest.retain(|(_, exponent)| !exponent.is_zero());
            let rest = graph.power_product(&rest);
            let parts = apart(graph, base)?;
            Some(parts.iter().map(|part| graph.mul(*part, rest)).collect())
        }
        _ => None,
    }
}
