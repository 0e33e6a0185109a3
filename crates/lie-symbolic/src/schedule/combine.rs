//! Combination: terms with powers of one sum are brought over its lowest power where that makes them fewer.
//! `1/r - z^2/r^3` with `r^2 = 1 + z^2` becomes `1/r^3`: the terms that cancel are gone before they are
//! computed.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap as HashMap;

use crate::exact::Rational;
use crate::symbolic::{ExprId, Graph, Node};

/// Sums longer than this are left as they are.
const LONGEST: usize = 64;
/// The highest power of a sum that is multiplied out above the common one.
const HIGHEST: i64 = 2;

/// How many terms are looked at in all; the sums after that are left as they are.
const MOST_WORK: usize = 200_000;

/// Terms of a sum with their coefficients.
type Terms = Vec<(ExprId, Rational)>;

/// The combined roots; `None` where nothing can be combined.
pub fn combine(graph: &mut Graph, roots: &[ExprId]) -> Option<Vec<ExprId>> {
    let mut image: HashMap<ExprId, ExprId> = HashMap::default();
    let mut left = MOST_WORK;
    for id in graph.dependencies(roots) {
        let of = |terms: &[(ExprId, Rational)]| -> Terms {
            terms.iter().map(|(t, c)| (image[t], c.clone())).collect()
        };
        let new = match graph.node(id).clone() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => id,
            Node::Sum { constant, terms } => {
                let terms = of(&terms);
                combine_sum(graph, &constant, terms, &mut left)
            }
            Node::Written(terms) => graph.rewritten(&of(&terms)),
            Node::Product(factors) => graph.power_product(&of(&factors)),
            Node::Call(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|a| image[a]).collect();
                graph.call(function, &arguments)
            }
        };
        image.insert(id, new);
    }
    let combined: Vec<ExprId> = roots.iter().map(|root| image[root]).collect();
    (combined != roots).then_some(combined)
}

fn combine_sum(
    graph: &mut Graph,
    constant: &Rational,
    mut terms: Terms,
    left: &mut usize,
) -> ExprId {
    let one = graph.integer(1);
    if !constant.is_zero() {
        terms.push((one, constant.clone()));
    }
    while terms.len() <= LONGEST {
        let found = bases(graph, &terms)
            .into_iter()
            .find_map(|base| over(graph, base, &terms, left));
        let Some(fewer) = found else { break };
        terms = fewer;
    }
    graph.linear(&terms)
}

/// The sums that some term is divided by.
fn bases(graph: &Graph, terms: &[(ExprId, Rational)]) -> Vec<ExprId> {
    let mut found = BTreeMap::new();
    for (term, _) in terms {
        for (base, exponent) in factors(graph, *term) {
            if exponent.is_negative() && addends(graph, base).is_some() {
                found.insert(base, ());
            }
        }
    }
    found.into_keys().collect()
}

/// The terms over the lowest power of the base, if they become fewer operations that way.
fn over(
    graph: &mut Graph,
    base: ExprId,
    terms: &[(ExprId, Rational)],
    left: &mut usize,
) -> Option<Terms> {
    let parts = addends(graph, base)?;
    let most = terms.len() * parts.len().saturating_pow(HIGHEST as u32);
    *left = left.checked_sub(most)?;
    let exponents: Vec<Rational> = terms
        .iter()
        .map(|(term, _)| exponent_of(graph, *term, base))
        .collect();
    let lowest = exponents.iter().min()?.clone();
    let (mut above, mut rest, mut count) = (Terms::new(), Terms::new(), 0);
    for ((term, coefficient), exponent) in terms.iter().zip(&exponents) {
        let height = (exponent - &lowest).to_integer();
        let Some(height) = height.filter(|height| *height <= HIGHEST) else {
            rest.push((*term, coefficient.clone()));
            continue;
        };
        count += 1;
        let stripped = graph.power_product(&[(*term, Rational::ONE), (base, -exponent)]);
        let mut expanded: Terms = vec![(stripped, coefficient.clone())];
        for _ in 0..height {
            expanded = times(graph, &expanded, &parts);
        }
        above.extend(expanded);
    }
    let numerator = graph.linear(&above);
    let length = match graph.node(numerator) {
        Node::Sum { constant, terms } => terms.len() + usize::from(!constant.is_zero()),
        _ => 1,
    };
    if count < 2 || length > count {
        return None;
    }
    let combined = graph.power_product(&[(numerator, Rational::ONE), (base, lowest)]);
    rest.push((combined, Rational::ONE));
    Some(rest)
}

fn times(graph: &mut Graph, terms: &Terms, parts: &Terms) -> Terms {
    let mut product = Terms::new();
    for (term, c) in terms {
        for (part, d) in parts {
            product.push((graph.mul(*term, *part), c * d));
        }
    }
    product
}

/// The terms of a sum of at least two, with its constant.
fn addends(graph: &Graph, base: ExprId) -> Option<Terms> {
    match graph.node(base) {
        Node::Written(terms) if terms.len() > 1 => Some(terms.to_vec()),
        Node::Sum { constant, terms } if constant.is_zero() && terms.len() > 1 => {
            Some(terms.to_vec())
        }
        _ => None,
    }
}

fn factors(graph: &Graph, term: ExprId) -> Vec<(ExprId, Rational)> {
    match graph.node(term) {
        Node::Product(factors) => factors.to_vec(),
        _ => vec![(term, Rational::ONE)],
    }
}

fn exponent_of(graph: &Graph, term: ExprId, base: ExprId) -> Rational {
    factors(graph, term)
        .into_iter()
        .find(|(b, _)| *b == base)
        .map_or(Rational::ZERO, |(_, exponent)| exponent)
}
