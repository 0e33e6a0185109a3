//! Expressions as they were written. The normal form of the arena takes sums apart and puts them together
//! anew, which proves identities and loses digits: `3*(x - y)` is exact to three roundings where x is
//! near y, `3*x - 3*y` is not. So the sums and quotients that somebody wrote in parentheses are kept as
//! quantities of their own, through differentiation and substitution, beside the normal form.

use rustc_hash::FxHashMap as HashMap;

use super::graph::{ExprId, Graph, Node};
use crate::exact::Rational;

impl Graph {
    /// `sum of coefficient * term`, kept as a quantity with its terms in this order.
    pub fn written_sum(&mut self, terms: &[(ExprId, Rational)]) -> ExprId {
        let one = self.integer(1);
        let mut kept: Vec<(ExprId, Rational)> = Vec::with_capacity(terms.len());
        let mut places: HashMap<ExprId, usize> =
            HashMap::with_capacity_and_hasher(terms.len(), Default::default());
        for (id, scale) in terms {
            let (inner, term) = self.coefficient(*id);
            let (term, coefficient) = match self.as_number(term) {
                Some(number) => (one, number * scale),
                None => (term, &inner * scale),
            };
            match places.get(&term) {
                Some(&place) => kept[place].1 = &kept[place].1 + &coefficient,
                None => {
                    places.insert(term, kept.len());
                    kept.push((term, coefficient));
                }
            }
        }
        kept.retain(|(_, c)| !c.is_zero());
        match kept.as_slice() {
            [] => self.integer(0),
            [(term, c)] => self.scale(*term, &c.clone()),
            [(a, _), (b, _)] => {
                // Two terms have no order.
                if a > b {
                    kept.swap(0, 1);
                }
                self.quantity(kept)
            }
            _ => self.quantity(kept),
        }
    }

    /// `b - a` is `-(a - b)`: a change of sign loses nothing.
    fn quantity(&mut self, mut terms: Vec<(ExprId, Rational)>) -> ExprId {
        let negative = terms[0].1.is_negative();
        if negative {
            for (_, c) in &mut terms {
                *c = -&*c;
            }
        }
        let id = self.intern(Node::Written(terms.into()));
        if negative { self.neg(id) } else { id }
    }

    /// A product as a quantity of its own, so that its powers are not those of its factors: `(s/x)^12` stays
    /// in range where `s^12` does not.
    pub fn written_product(&mut self, id: ExprId) -> ExprId {
        let (coefficient, product) = self.coefficient(id);
        match self.node(product) {
            Node::Product(_) => self.intern(Node::Written(Box::new([(product, coefficient)]))),
            _ => id,
        }
    }

    /// A quantity with other terms.
    pub fn rewritten(&mut self, terms: &[(ExprId, Rational)]) -> ExprId {
        match terms {
            [(only, c)] => {
                let product = self.scale(*only, c);
                self.written_product(product)
            }
            _ => self.written_sum(terms),
        }
    }

    /// The normal form of an expression.
    pub fn normal(&mut self, id: ExprId) -> ExprId {
        if let Some(&known) = self.normal.get(&id) {
            return known;
        }
        for id in self.dependencies(&[id]) {
            if self.normal.contains_key(&id) {
                continue;
            }
            let normal = match self.node(id).clone() {
                Node::Number(_) | Node::Pi | Node::Symbol(_) => id,
                Node::Sum { constant, terms } => {
                    let mut terms = self.normal_terms(&terms);
                    terms.push((self.number(constant), Rational::ONE));
                    self.linear(&terms)
                }
                Node::Written(terms) => {
                    let terms = self.normal_terms(&terms);
                    self.linear(&terms)
                }
                Node::Product(factors) => {
                    let factors = self.normal_terms(&factors);
                    self.power_product(&factors)
                }
                Node::Call(function, arguments) => {
                    let arguments: Vec<_> = arguments.iter().map(|a| self.normal[a]).collect();
                    self.call(function, &arguments)
                }
            };
            self.normal.insert(id, normal);
            self.normal.insert(normal, normal);
        }
        self.normal[&id]
    }

    fn normal_terms(&self, terms: &[(ExprId, Rational)]) -> Vec<(ExprId, Rational)> {
        terms
            .iter()
            .map(|(t, c)| (self.normal[t], c.clone()))
            .collect()
    }

    /// The expression, or a number or a symbol that it is equal to.
    pub fn tidy(&mut self, id: ExprId) -> ExprId {
        let normal = self.normal(id);
        match self.node(normal) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => normal,
            _ => id,
        }
    }

    /// Remembers how an expression in normal form was written; the first time counts.
    pub fn remember_written(&mut self, normal: ExprId, written: ExprId) {
        let simple = matches!(
            self.node(normal),
            Node::Number(_) | Node::Pi | Node::Symbol(_)
        );
        if normal != written && !simple {
            self.written.entry(normal).or_insert(written);
            self.normal.insert(written, normal);
        }
    }

    /// The expression as it was written, or as it is where nobody wrote it.
    pub fn as_written(&self, id: ExprId) -> ExprId {
        self.written.get(&id).copied().unwrap_or(id)
    }
}
