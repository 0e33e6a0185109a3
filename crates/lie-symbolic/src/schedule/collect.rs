//! Collection: every root as a polynomial in what the kernel varies, with coefficients in what is
//! known beforehand. `y*z/I3 - z*y/I2` becomes `(1/I3 - 1/I2)*y*z`: one prepared coefficient.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::rc::Rc;

use rustc_hash::FxHashMap as HashMap;

use super::KnownSymbols;
use crate::exact::Rational;
use crate::symbolic::{ExprId, Graph, Node};

/// A polynomial with more terms is not worth collecting.
const MOST_TERMS: usize = 800;
/// A prepared coefficient of more terms is not worth collecting either: each of its partial sums is an
/// expression of its own.
const MOST_SUMMANDS: usize = 1000;
/// Factors of monomials after which the expansion of a kernel has gone too far.
const MOST_WORK: usize = 20_000;

/// Bases with positive integer exponents, sorted.
type Monomial = Vec<(ExprId, i64)>;
type Polynomial = BTreeMap<Monomial, ExprId>;

/// Whether expressions contain only what is known beforehand, as far as it was asked.
pub type Answers = HashMap<ExprId, bool>;

/// Collection with what it has found out about the expressions of one arena.
pub struct Collector {
    known: KnownSymbols,
    /// What is prepared.
    pub answers: Answers,
    expanded: HashMap<ExprId, Expanded>,
    rebuilt: HashMap<ExprId, ExprId>,
    products: HashMap<(ExprId, ExprId), ExprId>,
    work: usize,
}

/// An expression as a polynomial, and the work that this took.
struct Expanded {
    work: usize,
    /// None where it took too much.
    polynomial: Option<Rc<Polynomial>>,
}

/// Whether an expression contains only what is known beforehand.
pub(super) fn is_known(
    graph: &Graph,
    id: ExprId,
    known: KnownSymbols,
    cache: &mut Answers,
) -> bool {
    if let Some(answer) = cache.get(&id) {
        return *answer;
    }
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
            _ => known != KnownSymbols::Nothing && children.iter().all(|child| cache[child]),
        };
        cache.insert(node, answer);
    }
    cache[&id]
}

impl Collector {
    pub fn new(known: KnownSymbols) -> Self {
        Self {
            known,
            answers: Answers::default(),
            expanded: HashMap::default(),
            rebuilt: HashMap::default(),
            products: HashMap::default(),
            work: 0,
        }
    }

    /// What is known beforehand.
    pub fn known(&self) -> KnownSymbols {
        self.known
    }

    /// The collected roots; `None` where expansion swells. What was expanded before counts as work too, so that
    /// the answer does not depend on it.
    pub fn collect(&mut self, graph: &mut Graph, roots: &[ExprId]) -> Option<Vec<ExprId>> {
        self.work = 0;
        for id in graph.dependencies(roots) {
            if let Some(expanded) = self.expanded.get(&id) {
                let (work, failed) = (expanded.work, expanded.polynomial.is_none());
                self.spend(work)?;
                if failed {
                    return None;
                }
                continue;
            }
            let before = self.work;
            let polynomial = self.expand(graph, id).map(Rc::new);
            let failed = polynomial.is_none();
            let work = self.work - before;
            self.expanded.insert(id, Expanded { work, polynomial });
            if failed {
                return None;
            }
        }

        let roots = roots.iter();
        Some(roots.map(|root| self.rebuild(graph, *root)).collect())
    }

    /// What the expression is made of has been expanded.
    fn of(&self, id: ExprId) -> Rc<Polynomial> {
        self.expanded[&id].polynomial.clone().unwrap_or_default()
    }

    fn expand(&mut self, graph: &mut Graph, id: ExprId) -> Option<Polynomial> {
        if is_known(graph, id, self.known, &mut self.answers) {
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
                    let term = self.of(*term);
                    self.spend(term.keys().map(Vec::len).sum())?;
                    for (monomial, inner) in term.iter() {
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
                    let factor = self.power(graph, *base, exponent)?;
                    product = self.multiply(graph, &product, &factor)?;
                }
                Some(product)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<ExprId> =
                    arguments.iter().map(|a| self.rebuild(graph, *a)).collect();
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
    ) -> Option<Polynomial> {
        if is_known(graph, base, self.known, &mut self.answers) {
            let power = graph.pow(base, exponent);
            return Some(Polynomial::from([(Monomial::new(), power)]));
        }
        let expanded = self.of(base);
        match exponent.to_integer().filter(|e| *e > 0) {
            Some(power) if expanded.len() == 1 || power <= 8 => {
                let one = graph.integer(1);
                let mut product = Polynomial::from([(Monomial::new(), one)]);
                if let Some((monomial, coefficient)) = single(&expanded) {
                    let coefficient = graph.pow(coefficient, exponent);
                    let monomial = monomial.iter().map(|(b, e)| (*b, e * power)).collect();
                    return Some(Polynomial::from([(monomial, coefficient)]));
                }
                for _ in 0..power {
                    product = self.multiply(graph, &product, &expanded)?;
                }
                Some(product)
            }
            _ => {
                let base = self.rebuild(graph, base);
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
                let coefficient = self.product(graph, *c, *d);
                add_to(graph, &mut product, merged(left, right), coefficient);
            }
        }
        (product.len() <= MOST_TERMS).then_some(product)
    }

    /// The product of two coefficients: few of them occur in many monomials.
    fn product(&mut self, graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
        let pair = (a.min(b), a.max(b));
        let known = self.products.entry(pair);
        *known.or_insert_with(|| graph.mul(a, b))
    }

    fn atom(&self, graph: &mut Graph, id: ExprId, exponent: i64) -> Polynomial {
        let one = graph.integer(1);
        Polynomial::from([(vec![(id, exponent)], one)])
    }

    fn rebuild(&mut self, graph: &mut Graph, id: ExprId) -> ExprId {
        if let Some(&known) = self.rebuilt.get(&id) {
            return known;
        }
        let terms: Vec<ExprId> = self
            .of(id)
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

/// The product of two monomials.
fn merged(left: &Monomial, right: &Monomial) -> Monomial {
    let mut product = Monomial::with_capacity(left.len() + right.len());
    let (mut i, mut j) = (0, 0);
    while i < left.len() && j < right.len() {
        let ((a, n), (b, m)) = (left[i], right[j]);
        match a.cmp(&b) {
            Ordering::Less => product.push((a, n)),
            Ordering::Greater => product.push((b, m)),
            Ordering::Equal if n + m != 0 => product.push((a, n + m)),
            Ordering::Equal => {}
        }
        i += usize::from(a <= b);
        j += usize::from(b <= a);
    }
    product.extend_from_slice(&left[i..]);
    product.extend_from_slice(&right[j..]);
    product
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
    match polynomial.entry(monomial) {
        Entry::Vacant(place) if !graph.is_zero(coefficient) => {
            place.insert(coefficient);
        }
        Entry::Vacant(_) => {}
        Entry::Occupied(mut known) => {
            let sum = graph.add(*known.get(), coefficient);
            if graph.is_zero(sum) {
                known.remove();
            } else {
                known.insert(sum);
            }
        }
    }
}
