//! Folding: a product that contains the monomial of a definition uses the definition. With
//! `y = (h/(2 I)) m` defined, `(h/I) m z` becomes `2 y z`.

use rustc_hash::FxHashMap as HashMap;

use crate::exact::Rational;
use crate::symbolic::{ExprId, Graph, Node, Symbol};

/// A definition `symbol = coefficient * product of base^exponent`.
struct Monomial {
    symbol: ExprId,
    coefficient: Rational,
    factors: Vec<(ExprId, Rational)>,
}

/// The roots with definitions folded in; the first roots are the definitions themselves and stay.
/// `None` where nothing can be folded.
pub fn fold(graph: &mut Graph, symbols: &[Symbol], roots: &[ExprId]) -> Option<Vec<ExprId>> {
    let monomials: Vec<Monomial> = symbols
        .iter()
        .zip(roots)
        .filter_map(|(symbol, root)| monomial(graph, *symbol, *root))
        .collect();
    if monomials.is_empty() {
        return None;
    }
    let outputs = &roots[symbols.len()..];
    let mut image: HashMap<ExprId, ExprId> = HashMap::default();
    for id in graph.dependencies(outputs) {
        let new = match graph.node(id).clone() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => id,
            Node::Sum { constant, terms } => {
                let mut terms: Vec<_> = terms.iter().map(|(t, c)| (image[t], c.clone())).collect();
                terms.push((graph.number(constant), Rational::ONE));
                graph.linear(&terms)
            }
            Node::Written(terms) => {
                let terms: Vec<_> = terms.iter().map(|(t, c)| (image[t], c.clone())).collect();
                graph.rewritten(&terms)
            }
            Node::Product(factors) => {
                let factors: Vec<_> = factors.iter().map(|(b, e)| (image[b], e.clone())).collect();
                fold_product(graph, factors, &monomials)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|a| image[a]).collect();
                graph.call(function, &arguments)
            }
        };
        image.insert(id, new);
    }
    let mut folded = roots[..symbols.len()].to_vec();
    folded.extend(outputs.iter().map(|root| image[root]));
    (folded != roots).then_some(folded)
}

/// A definition of at least two factors.
fn monomial(graph: &mut Graph, symbol: Symbol, root: ExprId) -> Option<Monomial> {
    let (coefficient, rest) = graph.coefficient(root);
    let Node::Product(factors) = graph.node(rest) else {
        return None;
    };
    let factors = factors.to_vec();
    Some(Monomial {
        symbol: graph.symbol(symbol),
        coefficient,
        factors,
    })
}

fn fold_product(
    graph: &mut Graph,
    mut factors: Vec<(ExprId, Rational)>,
    monomials: &[Monomial],
) -> ExprId {
    let mut scale = Rational::ONE;
    for monomial in monomials {
        if !monomial
            .factors
            .iter()
            .all(|(base, exponent)| covers(&factors, *base, exponent))
        {
            continue;
        }
        factors.extend(
            monomial
                .factors
                .iter()
                .map(|(base, exponent)| (*base, -exponent)),
        );
        factors.push((monomial.symbol, Rational::ONE));
        scale = &scale / &monomial.coefficient;
    }
    let product = graph.power_product(&factors);
    graph.scale(product, &scale)
}

/// Whether `base^exponent` divides the product without changing the sign of an exponent.
fn covers(factors: &[(ExprId, Rational)], base: ExprId, exponent: &Rational) -> bool {
    factors
        .iter()
        .filter(|(b, _)| *b == base)
        .any(|(_, e)| e.is_negative() == exponent.is_negative() && e.abs() >= exponent.abs())
}
