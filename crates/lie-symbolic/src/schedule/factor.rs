//! Factoring: `a*x + b*x + c` becomes `x*(a + b) + c`, greedily by the factor that most terms share.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap as HashMap;

use super::KnownSymbols;
use super::collect::{Answers, is_known};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Graph, Node};

/// Sums longer than this are left as they are.
const LONGEST: usize = 400;

/// The factored roots; `None` where nothing can be factored.
pub fn factor(
    graph: &mut Graph,
    roots: &[ExprId],
    known: KnownSymbols,
    answers: &mut Answers,
) -> Option<Vec<ExprId>> {
    let mut image: HashMap<ExprId, ExprId> = HashMap::default();
    let mut changed = false;
    for id in graph.dependencies(roots) {
        let new = if is_known(graph, id, known, answers) {
            id
        } else {
            match graph.node(id).clone() {
                Node::Number(_) | Node::Pi | Node::Symbol(_) => id,
                Node::Sum { constant, terms } => {
                    let terms: Vec<_> = terms.iter().map(|(t, c)| (image[t], c.clone())).collect();
                    let (sum, factored) =
                        factor_sum(graph, constant, terms, DEEPEST, &mut |graph, base| {
                            is_known(graph, base, known, answers)
                        });
                    changed |= factored;
                    sum
                }
                Node::Written(terms) => {
                    let terms: Vec<_> = terms.iter().map(|(t, c)| (image[t], c.clone())).collect();
                    graph.rewritten(&terms)
                }
                Node::Product(factors) => {
                    let factors: Vec<_> =
                        factors.iter().map(|(b, e)| (image[b], e.clone())).collect();
                    graph.power_product(&factors)
                }
                Node::Call(function, arguments) => {
                    let arguments: Vec<_> = arguments.iter().map(|a| image[a]).collect();
                    graph.call(function, &arguments)
                }
            }
        };
        image.insert(id, new);
    }
    changed.then(|| roots.iter().map(|root| image[root]).collect())
}

/// Sums inside factored sums are factored again, to this depth.
const DEEPEST: usize = 12;

fn factor_sum(
    graph: &mut Graph,
    constant: Rational,
    terms: Vec<(ExprId, Rational)>,
    depth: usize,
    known: &mut dyn FnMut(&Graph, ExprId) -> bool,
) -> (ExprId, bool) {
    let mut pieces = vec![(graph.number(constant), Rational::ONE)];
    let mut rest = terms;
    let mut factored = false;
    while depth > 0 && rest.len() <= LONGEST {
        let Some(base) = most_shared(graph, &rest, known) else {
            break;
        };
        let (with, without): (Vec<_>, Vec<_>) = rest
            .into_iter()
            .partition(|(term, _)| bases(graph, *term).contains(&base));
        let quotients = with
            .into_iter()
            .map(|(term, c)| {
                (
                    graph.power_product(&[(term, Rational::ONE), (base, Rational::MINUS_ONE)]),
                    c,
                )
            })
            .collect();
        let (inner, _) = factor_sum(graph, Rational::ZERO, quotients, depth - 1, known);
        pieces.push((graph.mul(base, inner), Rational::ONE));
        rest = without;
        factored = true;
    }
    pieces.extend(rest);
    (graph.linear(&pieces), factored)
}

/// The base that occurs with a positive integer power in the most terms, in at least two; what is
/// known beforehand stays in the prepared coefficients.
fn most_shared(
    graph: &Graph,
    terms: &[(ExprId, Rational)],
    known: &mut dyn FnMut(&Graph, ExprId) -> bool,
) -> Option<ExprId> {
    let mut counts: BTreeMap<ExprId, usize> = BTreeMap::new();
    for (term, _) in terms {
        for base in bases(graph, *term) {
            *counts.entry(base).or_insert(0) += 1;
        }
    }
    let best = counts
        .into_iter()
        .filter(|(base, n)| *n >= 2 && !known(graph, *base))
        .max_by_key(|(base, n)| (*n, std::cmp::Reverse(*base)))?;
    Some(best.0)
}

fn bases(graph: &Graph, term: ExprId) -> Vec<ExprId> {
    match graph.node(term) {
        Node::Product(factors) => factors
            .iter()
            .filter(|(_, e)| e.to_integer().is_some_and(|e| e > 0))
            .map(|(b, _)| *b)
            .collect(),
        Node::Number(_) => Vec::new(),
        _ => vec![term],
    }
}
