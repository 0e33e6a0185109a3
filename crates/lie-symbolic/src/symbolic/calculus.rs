//! Exact differentiation and substitution.

use rustc_hash::FxHashMap as HashMap;

use super::graph::{ExprId, Graph, Node, Symbol};
use super::slope::Slope;
use super::{Function, Opaque, chosen};
use crate::exact::Rational;

impl Graph {
    /// The partial derivative of an expression with respect to a symbol.
    pub fn derivative(&mut self, id: ExprId, symbol: Symbol) -> ExprId {
        self.derivative_within(id, symbol, usize::MAX).unwrap_or(id)
    }

    /// The partial derivative, or `None` if the arena would outgrow `most` (see [`Graph::size`]):
    /// products of many factors and deep compositions swell.
    pub fn derivative_within(&mut self, id: ExprId, symbol: Symbol, most: usize) -> Option<ExprId> {
        let zero = self.integer(0);
        for node in self.varying(id, symbol) {
            if !self.derivatives.contains_key(&(node, symbol)) {
                if self.size().saturating_add(self.swell(node, symbol)) > most {
                    return None;
                }
                let derivative = self.differentiate_node(node, symbol, zero);
                self.derivatives.insert((node, symbol), derivative);
            }
        }
        Some(self.tidy(self.slope(id, symbol, zero)))
    }

    /// The derivative of a node, which is known; `zero` of one in which the symbol does not occur.
    fn slope(&self, id: ExprId, symbol: Symbol, zero: ExprId) -> ExprId {
        let known = self.derivatives.get(&(id, symbol));
        known.copied().unwrap_or(zero)
    }

    /// An upper bound of what the derivative of one node adds to the size.
    fn swell(&self, id: ExprId, symbol: Symbol) -> usize {
        let inner = |child: &ExprId| {
            let known = self.derivatives.get(&(*child, symbol));
            known.map_or(0, |slope| match self.node(*slope) {
                Node::Sum { terms, .. } => terms.len(),
                Node::Product(factors) => factors.len(),
                Node::Number(zero) if zero.is_zero() => 0,
                _ => 1,
            })
        };
        match self.node(id) {
            Node::Sum { terms, .. } | Node::Written(terms) => {
                terms.iter().map(|(term, _)| inner(term)).sum()
            }
            Node::Product(factors) => {
                let all = factors.len();
                let varying = factors.iter().map(|(base, _)| inner(base));
                varying.filter(|n| *n > 0).map(|n| all + n).sum()
            }
            _ => 0,
        }
    }

    /// One node, the derivatives of whose children are known.
    fn differentiate_node(&mut self, id: ExprId, symbol: Symbol, zero: ExprId) -> ExprId {
        match self.node(id).clone() {
            Node::Number(_) | Node::Pi => self.number(Rational::ZERO),
            Node::Symbol(other) => self.integer(i64::from(other == symbol)),
            Node::Sum { terms, .. } => {
                let terms: Vec<_> = terms
                    .iter()
                    .map(|(t, c)| (self.slope(*t, symbol, zero), c.clone()))
                    .collect();
                self.linear(&terms)
            }
            Node::Written(terms) => {
                let terms: Vec<_> = terms
                    .iter()
                    .map(|(t, c)| (self.slope(*t, symbol, zero), c.clone()))
                    .collect();
                self.written_sum(&terms)
            }
            Node::Product(factors) => {
                let mut terms = Vec::new();
                for (position, (base, exponent)) in factors.iter().enumerate() {
                    let inner = self.slope(*base, symbol, zero);
                    if self.is_zero(inner) {
                        continue;
                    }
                    let mut rest = factors.to_vec();
                    rest[position].1 = exponent - &Rational::ONE;
                    rest.push((inner, Rational::ONE));
                    terms.push((self.power_product(&rest), exponent.clone()));
                }
                self.linear(&terms)
            }
            // on the joint the derivative is that of the branch that is taken there
            Node::Call(Function::Below, arguments) => {
                let [a, b] = [1, 2].map(|branch| self.slope(arguments[branch], symbol, zero));
                self.call(Function::Below, &[arguments[0], a, b])
            }
            Node::Call(Function::Own(own), arguments) => {
                let inner = arguments.iter().map(|a| self.slope(*a, symbol, zero));
                let inner: Vec<ExprId> = inner.collect();
                self.chain(own, &arguments, &inner)
            }
            Node::Call(function, arguments) => {
                let inner = self.slope(arguments[0], symbol, zero);
                if function == Function::Atan2 {
                    let inner_x = self.slope(arguments[1], symbol, zero);
                    return self
                        .differentiate_atan2([arguments[0], arguments[1]], [inner, inner_x]);
                }
                if self.is_zero(inner) {
                    return inner;
                }
                let outer = self.outer_derivative(function, arguments[0], id);
                self.mul(outer, inner)
            }
        }
    }

    /// `d f(a, …) = sum_i f_i(a, …) da_i`
    fn chain(&mut self, own: Opaque, arguments: &[ExprId], inner: &[ExprId]) -> ExprId {
        let mut terms = Vec::new();
        for (place, inner) in inner.iter().enumerate() {
            if !self.is_zero(*inner) {
                let outer = self.call(Function::Own(own.derivative(place)), arguments);
                terms.push(self.mul(outer, *inner));
            }
        }
        self.sum(&terms)
    }

    /// `d atan2(y, x) = (x dy - y dx) / (x^2 + y^2)`.
    fn differentiate_atan2(&mut self, [y, x]: [ExprId; 2], [dy, dx]: [ExprId; 2]) -> ExprId {
        if self.is_zero(dx) && self.is_zero(dy) {
            return dx;
        }
        let (a, b) = (self.mul(x, dy), self.mul(y, dx));
        let numerator = self.sub(a, b);
        let two = Rational::from(2);
        let (xx, yy) = (self.pow(x, &two), self.pow(y, &two));
        let square = self.add(xx, yy);
        self.div(numerator, square)
    }

    /// The derivative of a function of one argument; `value` is the function itself.
    fn outer_derivative(&mut self, function: Function, x: ExprId, value: ExprId) -> ExprId {
        match function {
            Function::Elementary(function) => function.rule(Slope::new(self, x, value)),
            Function::Stumpff(k) => {
                let [next, second] = [k + 1, k + 2].map(|k| self.call(Function::Stumpff(k), &[x]));
                let half = |n: i64| Rational::new(n, 2).unwrap_or(Rational::ONE);
                self.linear(&[(second, half(k.into())), (next, half(-1))])
            }
            Function::Phi(k) => {
                let next = self.call(Function::Phi(k + 1), &[x]);
                self.linear(&[
                    (value, Rational::ONE),
                    (next, Rational::from(-i64::from(k))),
                ])
            }
            Function::Atan2 | Function::Below | Function::Own(_) => {
                unreachable!("functions of several arguments have rules of their own")
            }
        }
    }

    /// Replaces symbols by expressions.
    pub fn substitute(
        &mut self,
        roots: &[ExprId],
        replace: &dyn Fn(Symbol) -> Option<ExprId>,
    ) -> Vec<ExprId> {
        let nodes = self.dependencies(roots).into_iter();
        let nodes: Vec<(ExprId, Node)> = nodes.map(|id| (id, self.node(id).clone())).collect();
        self.rebuild(roots, nodes, replace, &|_| None)
    }

    /// Expressions of another arena.
    pub fn import(&mut self, from: &Self, roots: &[ExprId]) -> Vec<ExprId> {
        let nodes = from.dependencies(roots).into_iter();
        let nodes: Vec<(ExprId, Node)> = nodes.map(|id| (id, from.node(id).clone())).collect();
        self.rebuild(roots, nodes, &|_| None, &|_| None)
    }

    /// The expressions on one side of joints: `side` says of a condition whether it is negative there.
    pub fn on_side(
        &mut self,
        roots: &[ExprId],
        side: &dyn Fn(ExprId) -> Option<bool>,
    ) -> Vec<ExprId> {
        let nodes = self.dependencies(roots).into_iter();
        let nodes: Vec<(ExprId, Node)> = nodes.map(|id| (id, self.node(id).clone())).collect();
        self.rebuild(roots, nodes, &|_| None, side)
    }

    /// Makes nodes again, children first, with symbols replaced, and branches where a side is known.
    fn rebuild(
        &mut self,
        roots: &[ExprId],
        nodes: Vec<(ExprId, Node)>,
        replace: &dyn Fn(Symbol) -> Option<ExprId>,
        side: &dyn Fn(ExprId) -> Option<bool>,
    ) -> Vec<ExprId> {
        let mut image: HashMap<ExprId, ExprId> = HashMap::default();
        for (id, node) in nodes {
            let new = match node {
                Node::Number(value) => self.number(value),
                Node::Pi => self.pi(),
                Node::Symbol(symbol) => match replace(symbol) {
                    Some(value) => value,
                    None => self.symbol(symbol),
                },
                Node::Sum { constant, terms } => {
                    let mut terms: Vec<_> =
                        terms.iter().map(|(t, c)| (image[t], c.clone())).collect();
                    terms.push((self.number(constant), Rational::ONE));
                    self.linear(&terms)
                }
                Node::Written(terms) => {
                    let terms: Vec<_> = terms.iter().map(|(t, c)| (image[t], c.clone())).collect();
                    self.rewritten(&terms)
                }
                Node::Product(factors) => {
                    let factors: Vec<_> =
                        factors.iter().map(|(b, e)| (image[b], e.clone())).collect();
                    self.power_product(&factors)
                }
                Node::Call(function, arguments) => {
                    let known = (function == Function::Below).then(|| side(arguments[0]));
                    match known.flatten() {
                        Some(negative) => image[&arguments[chosen(negative)]],
                        None => {
                            let arguments: Vec<_> = arguments.iter().map(|a| image[a]).collect();
                            self.call(function, &arguments)
                        }
                    }
                }
            };
            image.insert(id, new);
        }
        roots.iter().map(|root| image[root]).collect()
    }
}
