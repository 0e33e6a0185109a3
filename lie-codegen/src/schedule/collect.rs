//! Collection: every root as a polynomial in what the kernel varies, with coefficients in what is
//! known beforehand. `y*z/I3 - z*y/I2` becomes `(1/I3 - 1/I2)*y*z`: one prepared coefficient.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap as HashMap;

use super::Known;
use crate::exact::Rational;
use crate::symbolic::{ExprId, Graph, Node};

/// A polynomial with more terms is not worth collecting.
const MOST_TERMS: usize = 800;
/// A prepared coefficient of more terms is not worth collecting either: each of its partial sums is an
/// expression of its own.
const MOST_SUMMANDS: usize = 1000;
/// Factors of monomials after which the expansion of a kernel has gone too far.
const MOST_WORK: usize = 250_000;

/// Bases with positive integer exponents, sorted.
type Monomial = Vec<(ExprId, i64)>;
type Polynomial = BTreeMap<Monomial, ExprId>;

/// The collected roots; `None` where expansion swells.
pub fn collect(graph: &mut Graph, roots: &[ExprId], known: Known) -> Option<Vec<ExprId>> {
    let mut collector = Collector {
        known,
        prepared: HashMap::default(),
        rebuilt: HashMap::default(),
        work: 0,
    };
    let mut polynomials: HashMap<ExprId, Polynomial> = HashMap::default();
    for id in graph.dependencies(roots) {
        let polynomial = collector.expand(graph, id, &polynomials)?;
        polynomials.insert(id, polynomial);
    }
    Some(
        roots
            .iter()
            .map(|root| collector.rebuild(graph, *root, &polynomials))
            .collect(),
    )
}

/// Whether an expression contains only what is known beforehand.
pub(super) fn is_known(
    graph: &Graph,
    id: ExprId,
    known: Known,
    cache: &mut HashMap<ExprId, bool>,
) -> bool {
    // What was answered before is not walked through again.
    let mut stack = vec![id];
    while let Some(node) = stack.pop() {
        if cache.contains_key(&node) {
            continue;
        }
        let children = graph.children(node);
        let open: Vec<ExprId> = children
            .iter()
            .copied()
            .filter(|child| !cache.contains_key(child))
            .collect();
        if !open.is_empty() {
            stack.push(node);
            stack.extend(open);
            continue;
        }
        let answer = match graph.node(node) {
            Node::Number(_) | Node::Pi => true,
            Node::Symbol(symbol) => known.covers(*symbol),
            // What is prepared itself is computed from numbers.
            _ => known != Known::Nothing && children.iter().all(|child| cache[child]),
        };
        cache.insert(node, answer);
    }
    cache[&id]
}

struct Collector {
    known: Known,
    prepared: HashMap<ExprId, bool>,
    rebuilt: HashMap<ExprId, ExprId>,
    work: usize,
}

impl Collector {
    fn expand(
        &mut self,
        graph: &mut Graph,
        id: ExprId,
        done: &HashMap<ExprId, Polynomial>,
    ) -> Option<Polynomial> {
        if is_known(graph, id, self.known, &mut self.prepared) {
            return Some(if graph.is_zero(id) {
                Polynomial::new()
            } else {
                Polynomial::from([(Monomial::new(), id)])
            });
        }
        match graph.node(id).clone() {
            Node::Number(_) | Node::Pi => Some(Polynomial::from([(Monomial::new(), id)])),
            Node::Symbol(_) | Node::Written(_) => Some(self.atom(graph, id, 1)),
            Node::Sum { constant, terms } => {
                let mut sum = Polynomial::new();
                let constant = graph.number(constant);
                add_to(graph, &mut sum, Monomial::new(), constant);
                for (term, coefficient) in &terms {
                    self.spend(done[term].keys().map(Vec::len).sum())?;
                    for (monomial, inner) in &done[term] {
                        let scaled = graph.scale(*inner, coefficient);
                        let earlier = sum.get(monomial).map(|known| graph.node(*known));
                        if let Some(Node::Sum { terms, .. }) = earlier
                            && terms.len() > MOST_SUMMANDS
                        {
                            return None;
                        }
                        add_to(graph, &mut sum, monomial.clone(), scaled);
                    }
                }
                (sum.len() <= MOST_TERMS).then_some(sum)
            }
            Node::Product(factors) => {
                let one = graph.integer(1);
                let mut product = Polynomial::from([(Monomial::new(), one)]);
                for (base, exponent) in &factors {
                    let factor = self.power(graph, *base, exponent, done)?;
                    product = self.multiply(graph, &product, &factor)?;
                }
                Some(product)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<ExprId> = arguments
                    .iter()
                    .map(|a| self.rebuild(graph, *a, done))
                    .collect();
                let call = graph.call(function, &arguments);
                Some(self.atom(graph, call, 1))
            }
        }
    }

    /// Positive integer powers of sums are expanded, everything else is an atom.
    fn power(
        &mut self,
        graph: &mut Graph,
        base: ExprId,
        exponent: &Rational,
        done: &HashMap<ExprId, Polynomial>,
    ) -> Option<Polynomial> {
        if is_known(graph, base, self.known, &mut self.prepared) {
            let power = graph.pow(base, exponent);
            return Some(Polynomial::from([(Monomial::new(), power)]));
        }
        match exponent.to_integer().filter(|e| *e > 0) {
            Some(power) if done[&base].len() == 1 || power <= 8 => {
                let one = graph.integer(1);
                let mut product = Polynomial::from([(Monomial::new(), one)]);
                if let Some((monomial, coefficient)) = single(&done[&base]) {
                    let coefficient = graph.pow(coefficient, exponent);
                    let monomial = monomial.iter().map(|(b, e)| (*b, e * power)).collect();
                    return Some(Polynomial::from([(monomial, coefficient)]));
                }
                for _ in 0..power {
                    product = self.multiply(graph, &product, &done[&base])?;
                }
                Some(product)
            }
            _ => {
                let base = self.rebuild(graph, base, done);
                let power = graph.pow(base, exponent);
                Some(self.atom(graph, power, 1))
            }
        }
    }

    /// Counts work; `None` when it is too much.
    fn spend(&mut self, work: usize) -> Option<()> {
        self.work += work;
        (self.work <= MOST_WORK).then_some(())
    }

    fn multiply(
        &mut self,
        graph: &mut Graph,
        a: &Polynomial,
        b: &Polynomial,
    ) -> Option<Polynomial> {
        if a.len().saturating_mul(b.len()) > 4 * MOST_TERMS {
            return None;
        }
        let mut product = Polynomial::new();
        for (left, c) in a {
            for (right, d) in b {
                self.spend(1 + left.len() + right.len())?;
                let mut exponents: BTreeMap<ExprId, i64> = left.iter().copied().collect();
                for (base, exponent) in right {
                    *exponents.entry(*base).or_insert(0) += exponent;
                }
                let coefficient = graph.mul(*c, *d);
                let monomial = exponents.into_iter().filter(|(_, e)| *e != 0).collect();
                add_to(graph, &mut product, monomial, coefficient);
            }
        }
        (product.len() <= MOST_TERMS).then_some(product)
    }

    fn atom(&self, graph: &mut Graph, id: ExprId, exponent: i64) -> Polynomial {
        let one = graph.integer(1);
        Polynomial::from([(vec![(id, exponent)], one)])
    }

    fn rebuild(
        &mut self,
        graph: &mut Graph,
        id: ExprId,
        done: &HashMap<ExprId, Polynomial>,
    ) -> ExprId {
        if let Some(&known) = self.rebuilt.get(&id) {
            return known;
        }
        let terms: Vec<ExprId> = done[&id]
            .iter()
            .map(|(monomial, coefficient)| {
                let mut factors: Vec<_> = monomial
                    .iter()
                    .map(|(b, e)| (*b, Rational::from(*e)))
                    .collect();
                factors.push((*coefficient, Rational::ONE));
                graph.power_product(&factors)
            })
            .collect();
        let result = graph.sum(&terms);
        self.rebuilt.insert(id, result);
        result
    }
}

fn single(polynomial: &Polynomial) -> Option<(Monomial, ExprId)> {
    let mut terms = polynomial.iter();
    let (monomial, coefficient) = terms.next()?;
    terms
        .next()
        .is_none()
        .then(|| (monomial.clone(), *coefficient))
}

fn add_to(graph: &mut Graph, polynomial: &mut Polynomial, monomial: Monomial, coefficient: ExprId) {
    let sum = match polynomial.get(&monomial) {
        Some(&known) => graph.add(known, coefficient),
        None => coefficient,
    };
    if graph.is_zero(sum) {
        polynomial.remove(&monomial);
    } else {
        polynomial.insert(monomial, sum);
    }
}
