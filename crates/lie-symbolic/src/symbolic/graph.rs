//! The arena. Equal expressions are one node, and children always precede their parents, so that
//! every traversal is a loop over ascending ids and no depth of input can exhaust the stack.
//!
//! Normal form: a sum is a constant plus distinct terms with rational coefficients (`2*x` is a sum
//! of one term); a product is distinct bases with rational exponents and has no numeric
//! coefficient of its own. Sums are flat, products are flat; products of sums are not expanded.
//!
//! Beside it stands the form in which an expression was written (see the module `written`): it proves
//! nothing and is evaluated.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap as HashMap;

use super::{Function, chosen};
use crate::exact::Rational;

/// A node of a [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ExprId(u32);

impl ExprId {
    /// Position in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A free symbol; names belong to the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Symbol {
    /// A parameter of the system.
    Parameter(usize),
    /// The step size `h`.
    Step,
    /// The time `t`.
    Time,
    /// A coordinate of `mu`.
    Coordinate(usize),
    /// A further argument of a kernel (the unknown of a residual, an algebra element).
    Input(usize),
}

impl Symbol {
    /// The bit of a symbol in a set that takes several symbols for one.
    fn bit(self) -> u64 {
        let place = match self {
            Self::Coordinate(i) => i,
            Self::Parameter(i) => i.wrapping_add(21),
            Self::Input(i) => i.wrapping_add(42),
            Self::Step => 62,
            Self::Time => 63,
        };
        1 << (place % 64)
    }
}

/// The forms of an expression.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// An exact number.
    Number(Rational),
    /// The constant pi.
    Pi,
    /// A symbol.
    Symbol(Symbol),
    /// `constant + sum of coefficient * term`, sorted by term, no coefficient zero.
    Sum {
        /// The constant term.
        constant: Rational,
        /// The other terms.
        terms: Box<[(ExprId, Rational)]>,
    },
    /// Product of `base^exponent`, sorted by base, no exponent zero.
    Product(Box<[(ExprId, Rational)]>),
    /// A function of its arguments.
    Call(Function, Box<[ExprId]>),
    /// `sum of coefficient * term` from left to right, as it was written: no other sum takes its terms in.
    Written(Box<[(ExprId, Rational)]>),
}

/// An arena of expressions.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    /// Which symbols may occur in each node: a bit for those that share it.
    supports: Vec<u64>,
    index: HashMap<Node, ExprId>,
    pub(super) derivatives: HashMap<(ExprId, Symbol), ExprId>,
    /// The normal forms of expressions as they were written.
    pub(super) normal: HashMap<ExprId, ExprId>,
    /// How an expression in normal form was written.
    pub(super) written: HashMap<ExprId, ExprId>,
    operands: usize,
    positive: BTreeSet<Symbol>,
    /// Whether there are choices.
    pub(super) choices: bool,
}

/// A sum under construction.
#[derive(Default)]
struct Terms {
    constant: Option<Rational>,
    terms: BTreeMap<ExprId, Rational>,
}

impl Graph {
    /// An empty arena.
    pub fn new() -> Self {
        Self::default()
    }

    /// Declares a symbol positive.
    pub fn assume_positive(&mut self, symbol: Symbol) {
        self.positive.insert(symbol);
    }

    /// Whether a symbol was declared positive.
    pub fn is_positive(&self, symbol: Symbol) -> bool {
        self.positive.contains(&symbol)
    }

    /// The node of an id.
    pub fn node(&self, id: ExprId) -> &Node {
        &self.nodes[id.index()]
    }

    /// Number of nodes plus their operands: the measure for size limits.
    pub fn size(&self) -> usize {
        self.nodes.len() + self.operands
    }

    pub(super) fn intern(&mut self, node: Node) -> ExprId {
        if let Some(&id) = self.index.get(&node) {
            return id;
        }
        self.operands += match &node {
            Node::Sum { terms, .. } | Node::Written(terms) => terms.len(),
            Node::Product(factors) => factors.len(),
            _ => 0,
        };
        let id = ExprId(
            u32::try_from(self.nodes.len()).expect("fewer than 2^32 nodes by the size limit"),
        );
        let support = self.support(&node);
        self.supports.push(support);
        self.nodes.push(node.clone());
        self.index.insert(node, id);
        id
    }

    /// The bits of the symbols that occur in a node.
    fn support(&self, node: &Node) -> u64 {
        let of = |id: &ExprId| self.supports[id.index()];
        match node {
            Node::Number(_) | Node::Pi => 0,
            Node::Symbol(symbol) => symbol.bit(),
            Node::Sum { terms, .. } | Node::Written(terms) | Node::Product(terms) => {
                terms.iter().fold(0, |all, (id, _)| all | of(id))
            }
            Node::Call(_, arguments) => arguments.iter().fold(0, |all, id| all | of(id)),
        }
    }

    /// What an expression is made of and a symbol may occur in, in ascending order.
    pub(super) fn varying(&self, root: ExprId, symbol: Symbol) -> Vec<ExprId> {
        self.reached(&[root], |id| self.supports[id.index()] & symbol.bit() != 0)
    }

    /// An exact number.
    pub fn number(&mut self, value: Rational) -> ExprId {
        self.intern(Node::Number(value))
    }

    /// An integer.
    pub fn integer(&mut self, value: i64) -> ExprId {
        self.number(Rational::from(value))
    }

    /// The constant pi.
    pub fn pi(&mut self) -> ExprId {
        self.intern(Node::Pi)
    }

    /// A symbol.
    pub fn symbol(&mut self, symbol: Symbol) -> ExprId {
        self.intern(Node::Symbol(symbol))
    }

    /// The exact value of a constant rational expression.
    pub fn as_number(&self, id: ExprId) -> Option<&Rational> {
        match self.node(id) {
            Node::Number(value) => Some(value),
            _ => None,
        }
    }

    /// Whether the expression is the exact number zero.
    pub fn is_zero(&self, id: ExprId) -> bool {
        self.as_number(id).is_some_and(Rational::is_zero)
    }

    /// Splits `c * rest`; the coefficient of anything but a one-term sum is one.
    pub fn coefficient(&self, id: ExprId) -> (Rational, ExprId) {
        match self.node(id) {
            Node::Sum { constant, terms } if constant.is_zero() && terms.len() == 1 => {
                (terms[0].1.clone(), terms[0].0)
            }
            _ => (Rational::ONE, id),
        }
    }

    /// `sum of coefficient * term`.
    pub fn linear(&mut self, terms: &[(ExprId, Rational)]) -> ExprId {
        let mut sum = Terms::default();
        for (id, coefficient) in terms {
            self.collect(&mut sum, *id, coefficient);
        }
        let constant = sum.constant.unwrap_or(Rational::ZERO);
        let mut terms: Vec<_> = sum
            .terms
            .into_iter()
            .filter(|(_, c)| !c.is_zero())
            .collect();
        match terms.as_slice() {
            [] => self.number(constant),
            [(_, c)] if constant.is_zero() && c.is_one() => terms.remove(0).0,
            _ => self.intern(Node::Sum {
                constant,
                terms: terms.into(),
            }),
        }
    }

    fn collect(&self, sum: &mut Terms, id: ExprId, scale: &Rational) {
        let mut constant = |value: Rational| {
            sum.constant = Some(&sum.constant.take().unwrap_or(Rational::ZERO) + &value);
        };
        match self.node(id) {
            Node::Number(value) => constant(value * scale),
            Node::Sum {
                constant: value,
                terms,
            } => {
                constant(value * scale);
                for (term, coefficient) in terms {
                    let entry = sum.terms.entry(*term).or_insert(Rational::ZERO);
                    *entry = &*entry + &(coefficient * scale);
                }
            }
            _ => {
                let entry = sum.terms.entry(id).or_insert(Rational::ZERO);
                *entry = &*entry + scale;
            }
        }
    }

    /// The sum of the terms.
    pub fn sum(&mut self, terms: &[ExprId]) -> ExprId {
        let terms: Vec<_> = terms.iter().map(|&id| (id, Rational::ONE)).collect();
        self.linear(&terms)
    }

    /// `a + b`.
    pub fn add(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if let (Node::Number(a), Node::Number(b)) = (self.node(a), self.node(b)) {
            let sum = a + b;
            return self.number(sum);
        }
        self.sum(&[a, b])
    }

    /// `a - b`.
    pub fn sub(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.linear(&[(a, Rational::ONE), (b, Rational::MINUS_ONE)])
    }

    /// `-a`.
    pub fn neg(&mut self, a: ExprId) -> ExprId {
        self.scale(a, &Rational::MINUS_ONE)
    }

    /// `factor * a`.
    pub fn scale(&mut self, a: ExprId, factor: &Rational) -> ExprId {
        if factor.is_one() {
            return a;
        }
        self.linear(&[(a, factor.clone())])
    }

    /// `a * b`.
    pub fn mul(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if let (Node::Number(left), Node::Number(right)) = (self.node(a), self.node(b))
            && left.to_words().is_some()
            && right.to_words().is_some()
        {
            let product = left * right;
            return self.number(product);
        }
        self.product(&[a, b])
    }

    /// `a / b`; a division by the exact zero stays as `0^-1`, which evaluates to infinity.
    pub fn div(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let inverse = self.pow(b, &Rational::MINUS_ONE);
        self.mul(a, inverse)
    }

    /// The function of its arguments; exact values at 0 and 1 are folded.
    pub fn call(&mut self, function: impl Into<Function>, arguments: &[ExprId]) -> ExprId {
        let function = function.into();
        if let [argument] = arguments
            && let Some(value) = self.as_number(*argument)
        {
            let folded = match function {
                Function::Elementary(function) => {
                    let exact = value.to_integer().and_then(|x| function.exact(x));
                    exact.map(Rational::from)
                }
                Function::Stumpff(k) | Function::Phi(k) if value.is_zero() => {
                    let factorial: i64 = (1..=i64::from(k)).product();
                    Rational::new(1, factorial)
                }
                _ => None,
            };
            if let Some(value) = folded {
                return self.number(value);
            }
        }
        if let (Function::Below, [condition, branches @ ..]) = (function, arguments)
            && let Some(place) = self.settled(*condition, branches)
        {
            return branches[place];
        }
        self.choices |= function == Function::Below;
        self.intern(Node::Call(function, arguments.into()))
    }

    /// Which branch is taken, where that is known by the form of the condition.
    fn settled(&self, condition: ExprId, branches: &[ExprId]) -> Option<usize> {
        if branches[0] == branches[1] {
            return Some(0);
        }
        let (coefficient, rest) = self.coefficient(condition);
        let negative = match self.node(rest) {
            Node::Number(value) => value.is_negative(),
            Node::Symbol(symbol) if self.is_positive(*symbol) => coefficient.is_negative(),
            _ => return None,
        };
        Some(chosen(negative) - 1)
    }
}
