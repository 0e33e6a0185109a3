//! Atoms into binary operations, each just before its first use.

use rustc_hash::FxHashMap as HashMap;

use super::formula::{Atom, AtomId, Formula, Signed};
use super::program::{Operation, Program, Value};
use crate::symbolic::Symbol;

/// The straight-line program of a formula.
pub fn linearise(formula: &Formula) -> Program {
    let definitions = formula.definitions.iter().copied().collect();
    let mut writer = Writer {
        formula,
        definitions,
        program: Program::default(),
        values: HashMap::default(),
        negatives: HashMap::default(),
    };
    for signed in &formula.outputs {
        let value = writer.signed(*signed);
        writer.program.outputs.push(value);
    }
    let mut program = writer.program;
    for operation in &program.operations {
        program.counts.record(operation);
    }
    program
}

struct Writer<'a> {
    formula: &'a Formula,
    definitions: HashMap<Symbol, Signed>,
    program: Program,
    values: HashMap<AtomId, Value>,
    negatives: HashMap<Value, Value>,
}

impl Writer<'_> {
    fn push(&mut self, operation: Operation) -> Value {
        self.program.operations.push(operation);
        Value::Temporary(self.program.operations.len() - 1)
    }

    fn signed(&mut self, (negative, atom): Signed) -> Value {
        let value = self.value(atom);
        if negative { self.negate(value) } else { value }
    }

    /// The negative of a value, computed once.
    fn negate(&mut self, value: Value) -> Value {
        if let Some(known) = self.negatives.get(&value) {
            return known.clone();
        }
        let negative = self.push(Operation::Neg(value.clone()));
        self.negatives.insert(value, negative.clone());
        negative
    }

    /// The value of an atom; an explicit stack stands in for recursion.
    fn value(&mut self, root: AtomId) -> Value {
        let mut stack = vec![root];
        while let Some(&atom) = stack.last() {
            if self.values.contains_key(&atom) {
                stack.pop();
                continue;
            }
            let missing: Vec<AtomId> = self
                .children(atom)
                .into_iter()
                .filter(|child| !self.values.contains_key(child))
                .rev()
                .collect();
            if missing.is_empty() {
                let value = self.write(atom);
                self.values.insert(atom, value);
                stack.pop();
            } else {
                stack.extend(missing);
            }
        }
        self.values[&root].clone()
    }

    fn children(&self, atom: AtomId) -> Vec<AtomId> {
        match &self.formula.atoms[atom] {
            Atom::Leaf(value) => self
                .definition(value)
                .map(|(_, atom)| atom)
                .into_iter()
                .collect(),
            other => other.operands(),
        }
    }

    fn write(&mut self, atom: AtomId) -> Value {
        match self.formula.atoms[atom].clone() {
            Atom::Leaf(leaf) => match self.definition(&leaf) {
                Some((negative, atom)) => {
                    let value = self.values[&atom].clone();
                    if negative { self.negate(value) } else { value }
                }
                None => leaf,
            },
            Atom::Sum(terms) => self.sum(terms),
            Atom::Product(factors) => self.product(&factors),
            Atom::Quotient(a, b) => {
                let (a, b) = (self.values[&a].clone(), self.values[&b].clone());
                self.push(Operation::Div(a, b))
            }
            Atom::Root(a) => {
                let a = self.values[&a].clone();
                self.push(Operation::Sqrt(a))
            }
            Atom::Power(a, exponent) => {
                let a = self.values[&a].clone();
                self.push(Operation::Power(a, exponent))
            }
            Atom::Call(function, arguments) => {
                let arguments = arguments.iter().map(|a| self.values[a].clone()).collect();
                self.push(Operation::Call(function, arguments))
            }
        }
    }

    fn sum(&mut self, mut terms: Vec<(bool, AtomId)>) -> Value {
        // What was written first stands first.
        let sum = |atom: &AtomId| matches!(self.formula.atoms[*atom], Atom::Sum(_));
        let first = terms
            .iter()
            .position(|(negative, atom)| !negative && sum(atom))
            .or_else(|| terms.iter().position(|(negative, _)| !negative));
        if let Some(first) = first {
            let term = terms.remove(first);
            terms.insert(0, term);
        }
        let mut terms = terms.into_iter();
        let Some((negative, first)) = terms.next() else {
            return Value::Number(crate::exact::Rational::ZERO);
        };
        let mut sum = self.values[&first].clone();
        if negative {
            sum = self.negate(sum);
        }
        for (negative, term) in terms {
            let term = self.values[&term].clone();
            sum = self.push(if negative {
                Operation::Sub(sum, term)
            } else {
                Operation::Add(sum, term)
            });
        }
        sum
    }

    fn product(&mut self, factors: &[AtomId]) -> Value {
        let values = factors.iter().map(|factor| self.values[factor].clone());
        let mut factors = values.collect::<Vec<_>>().into_iter();
        let Some(mut product) = factors.next() else {
            return Value::Number(crate::exact::Rational::ONE);
        };
        for factor in factors {
            product = self.push(Operation::Mul(product, factor));
        }
        product
    }

    /// What a defined symbol stands for; a definition that nothing uses costs nothing.
    fn definition(&self, leaf: &Value) -> Option<Signed> {
        let Value::Symbol(symbol) = leaf else {
            return None;
        };
        self.definitions.get(symbol).copied()
    }
}
