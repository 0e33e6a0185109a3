//! From expressions to the atoms of a formula: coefficients split off, signs pulled out, divisions
//! chosen.

mod product;

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap as HashMap;

use super::KnownSymbols;
use super::collect::{Answers, is_known};
use super::formula::{Atom, AtomId, Formula, Signed};
use super::inverse::Inverse;
use super::program::Value;
use crate::exact::Rational;
use crate::symbolic::{ExprId, Graph, Node, Symbol};

/// Bases with their exponents.
type Powers = Vec<(ExprId, Rational)>;

pub(super) struct Builder<'a> {
    pub(super) graph: &'a mut Graph,
    known: KnownSymbols,
    group: bool,
    /// Coefficients that are prepared with the opposite sign.
    flipped: BTreeSet<ExprId>,
    answers: &'a mut Answers,
    pub(super) inverse: BTreeMap<ExprId, Inverse>,
    pub(super) converted: HashMap<ExprId, Signed>,
    pub(super) formula: Formula,
}

/// A formula, and the coefficients that more results need negative than positive.
pub fn build(
    graph: &mut Graph,
    symbols: &[Symbol],
    roots: &[ExprId],
    (known, answers): (KnownSymbols, &mut Answers),
    group: bool,
    flipped: BTreeSet<ExprId>,
) -> (Formula, BTreeSet<ExprId>) {
    let formula = Formula {
        atoms: Vec::new(),
        index: HashMap::default(),
        definitions: Vec::new(),
        outputs: Vec::new(),
        can_group: false,
    };
    let mut builder = Builder {
        graph,
        known,
        group,
        flipped,
        answers,
        inverse: BTreeMap::new(),
        converted: HashMap::default(),
        formula,
    };
    let order = builder.graph.dependencies(roots);
    builder.choose_inverses(&order);
    for id in order {
        let signed = builder.convert(id, false);
        builder.converted.insert(id, signed);
    }
    let mut wanted: BTreeMap<ExprId, i64> = BTreeMap::new();
    for (position, root) in roots.iter().enumerate() {
        let mut signed = builder.converted[root];
        if let Some(coefficient) = builder.coefficient_of(signed.1) {
            *wanted.entry(coefficient).or_insert(0) += if signed.0 { -1 } else { 1 };
        }
        if signed.0 {
            // A minus sign in front of a whole result goes into its coefficient.
            signed = builder.convert(*root, true);
        }
        match symbols.get(position) {
            Some(symbol) => builder.formula.definitions.push((*symbol, signed)),
            None => builder.formula.outputs.push(signed),
        }
    }
    let negative = wanted
        .into_iter()
        .filter(|(_, balance)| *balance < 0)
        .map(|(id, _)| id)
        .collect();
    (builder.formula, negative)
}

impl Builder<'_> {
    pub(super) fn is_known(&mut self, id: ExprId) -> bool {
        is_known(self.graph, id, self.known, self.answers)
    }

    /// Whether a power of a known quantity goes into a prepared coefficient. Where nothing is known but
    /// numbers, only what is a rational number again does: nobody prepares the rest.
    fn goes_before(&mut self, base: ExprId, exponent: &Rational) -> bool {
        if self.known != KnownSymbols::Nothing {
            return self.is_known(base);
        }
        self.graph.as_number(base).is_some() && exponent.to_integer().is_some()
    }

    /// The atom of an expression and its sign; `settle` asks for the sign inside the atom.
    fn convert(&mut self, id: ExprId, settle: bool) -> Signed {
        if self.is_known(id) {
            return (false, self.leaf(id));
        }
        match self.graph.node(id).clone() {
            Node::Number(_) | Node::Pi => (false, self.leaf(id)),
            Node::Symbol(symbol) => (
                false,
                self.formula.intern(Atom::Leaf(Value::Symbol(symbol))),
            ),
            Node::Call(function, arguments) => {
                let arguments = arguments.iter().map(|a| self.unsigned(*a)).collect();
                (false, self.formula.intern(Atom::Call(function, arguments)))
            }
            Node::Product(factors) => {
                let signed = self.term(&factors, &Rational::ONE);
                self.settle(signed, settle)
            }
            Node::Sum { constant, terms } => self.convert_sum(&constant, &terms, settle),
            Node::Written(terms) => {
                let signed = self.convert_written(&terms);
                self.settle(signed, settle)
            }
        }
    }

    /// A sum from left to right, two terms at a time.
    fn convert_written(&mut self, terms: &[(ExprId, Rational)]) -> Signed {
        let mut sum: Option<Signed> = None;
        for (term, coefficient) in terms {
            let whole = [(*term, Rational::ONE)];
            let factors = match self.graph.node(*term) {
                Node::Product(factors) => factors.to_vec(),
                _ => whole.to_vec(),
            };
            let next = self.term(&factors, coefficient);
            sum = Some(match sum {
                Some(sum) => self.two(sum, next),
                None => next,
            });
        }
        sum.unwrap_or_else(|| {
            let zero = self.graph.integer(0);
            (false, self.leaf(zero))
        })
    }

    /// The sum of two terms; `b - a` and `a - b` are one quantity.
    fn two(&mut self, a: Signed, b: Signed) -> Signed {
        let mut terms = vec![a, b];
        terms.sort_by_key(|(negative, atom)| (*atom, *negative));
        let flip = terms[0].0;
        for term in &mut terms {
            term.0 ^= flip;
        }
        (flip, self.formula.intern(Atom::Sum(terms)))
    }

    fn convert_sum(
        &mut self,
        constant: &Rational,
        terms: &[(ExprId, Rational)],
        settle: bool,
    ) -> Signed {
        let (known, varying): (Vec<_>, Vec<_>) = terms
            .iter()
            .cloned()
            .partition(|(term, _)| self.goes_before(*term, &Rational::ONE));
        let mut known = known;
        known.push((self.graph.number(constant.clone()), Rational::ONE));
        let fixed = self.graph.linear(&known);
        let mut signed = self.terms(&varying);
        if !self.graph.is_zero(fixed) {
            let negative = self
                .graph
                .as_number(fixed)
                .is_some_and(Rational::is_negative);
            let fixed = if negative {
                self.graph.neg(fixed)
            } else {
                fixed
            };
            signed.push((negative, self.leaf(fixed)));
        }
        if let [only] = signed[..] {
            return self.settle(only, settle);
        }
        signed.sort_by_key(|(negative, atom)| (*atom, *negative));
        // `b - a` and `a - b` are one quantity.
        let flip = signed[0].0 && !settle;
        if flip {
            for term in &mut signed {
                term.0 = !term.0;
            }
        }
        (flip, self.formula.intern(Atom::Sum(signed)))
    }

    /// The varying terms of a sum; those with one coefficient in common are grouped behind it.
    fn terms(&mut self, varying: &[(ExprId, Rational)]) -> Vec<Signed> {
        let mut groups: BTreeMap<ExprId, Vec<(Powers, bool)>> = BTreeMap::new();
        let mut order: Vec<ExprId> = Vec::new();
        for (term, coefficient) in varying {
            let factors = match self.graph.node(*term) {
                Node::Product(factors) => factors.to_vec(),
                _ => vec![(*term, Rational::ONE)],
            };
            let (negative, coefficient, rest) = self.split(&factors, coefficient);
            if !groups.contains_key(&coefficient) {
                order.push(coefficient);
            }
            groups
                .entry(coefficient)
                .or_default()
                .push((rest, negative));
        }
        let one = self.graph.integer(1);
        let mut signed = Vec::new();
        for coefficient in order {
            let group = groups.remove(&coefficient).unwrap_or_default();
            let common = coefficient != one && group.len() > 1;
            self.formula.can_group |= common;
            if self.group && common {
                let mut inner: Vec<Signed> = group
                    .iter()
                    .map(|(rest, negative)| {
                        let (sign, atom) = self.assemble(one, rest);
                        (sign != *negative, atom)
                    })
                    .collect();
                inner.sort_by_key(|(negative, atom)| (*atom, *negative));
                let flip = inner[0].0;
                for term in &mut inner {
                    term.0 ^= flip;
                }
                let sum = self.formula.intern(Atom::Sum(inner));
                let leaf = self.leaf(coefficient);
                signed.push((flip, self.multiply(vec![leaf, sum])));
            } else {
                for (rest, negative) in group {
                    let (sign, atom) = self.assemble(coefficient, &rest);
                    signed.push((sign != negative, atom));
                }
            }
        }
        signed
    }

    /// A sign that must not stay outside is applied.
    fn settle(&mut self, (negative, atom): Signed, settle: bool) -> Signed {
        if negative && settle {
            (false, self.negative(atom))
        } else {
            (negative, atom)
        }
    }

    fn negative(&mut self, atom: AtomId) -> AtomId {
        if let Atom::Leaf(Value::Number(value)) = &self.formula.atoms[atom] {
            let value = -value;
            return self.formula.intern(Atom::Leaf(Value::Number(value)));
        }
        if let Atom::Product(factors) = self.formula.atoms[atom].clone() {
            for (position, &factor) in factors.iter().enumerate() {
                let coefficient = match &self.formula.atoms[factor] {
                    // pi stands for itself where nothing is prepared
                    Atom::Leaf(Value::Prepared(id)) if self.known != KnownSymbols::Nothing => *id,
                    Atom::Leaf(Value::Number(value)) => {
                        let value = value.clone();
                        self.graph.number(value)
                    }
                    _ => continue,
                };
                let negated = self.graph.neg(coefficient);
                let mut factors = factors;
                factors[position] = self.leaf(negated);
                factors.sort_unstable();
                return self.formula.intern(Atom::Product(factors));
            }
        }
        self.formula.intern(Atom::Sum(vec![(true, atom)]))
    }

    pub(super) fn unsigned(&mut self, id: ExprId) -> AtomId {
        let (negative, atom) = self.converted[&id];
        if negative { self.negative(atom) } else { atom }
    }

    fn leaf(&mut self, id: ExprId) -> AtomId {
        let value = match self.graph.as_number(id) {
            Some(value) => Value::Number(value.clone()),
            None => Value::Prepared(id),
        };
        self.formula.intern(Atom::Leaf(value))
    }
}
