//! Straight-line programs.

use crate::exact::Rational;
use crate::symbolic::{ExprId, Function, Symbol};

/// An operand; P says what is known before the program runs.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Value<P = ExprId> {
    /// A symbol of the kernel: a coordinate, an input.
    Symbol(Symbol),
    /// A prepared constant: in the arena, an expression in what is known beforehand.
    Prepared(P),
    /// An exact number.
    Number(Rational),
    /// The result of an earlier operation.
    Temporary(usize),
}

/// One operation; its result is the temporary of its position.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Operation<P = ExprId> {
    /// `a + b`
    Add(Value<P>, Value<P>),
    /// `a - b`
    Sub(Value<P>, Value<P>),
    /// `a * b`
    Mul(Value<P>, Value<P>),
    /// `a / b`
    Div(Value<P>, Value<P>),
    /// `-a`
    Neg(Value<P>),
    /// The square root.
    Sqrt(Value<P>),
    /// `a^exponent` for an exponent that is no multiple of 1/2.
    Power(Value<P>, Rational),
    /// A function.
    Call(Function, Vec<Value<P>>),
}

impl Value {
    /// The operand with the temporaries at other places.
    #[must_use]
    pub fn renumbered(self, place: &dyn Fn(usize) -> usize) -> Self {
        match self {
            Value::Temporary(index) => Value::Temporary(place(index)),
            other => other,
        }
    }
}

impl Operation {
    /// The operation with the temporaries at other places.
    #[must_use]
    pub fn renumbered(&self, place: &dyn Fn(usize) -> usize) -> Self {
        self.map(&mut |value| value.clone().renumbered(place))
    }
}

impl<P> Operation<P> {
    /// The operation with other operands, which are asked for in order.
    pub fn map<Q>(&self, at: &mut dyn FnMut(&Value<P>) -> Value<Q>) -> Operation<Q> {
        match self {
            Operation::Add(a, b) => Operation::Add(at(a), at(b)),
            Operation::Sub(a, b) => Operation::Sub(at(a), at(b)),
            Operation::Mul(a, b) => Operation::Mul(at(a), at(b)),
            Operation::Div(a, b) => Operation::Div(at(a), at(b)),
            Operation::Neg(a) => Operation::Neg(at(a)),
            Operation::Sqrt(a) => Operation::Sqrt(at(a)),
            Operation::Power(a, exponent) => Operation::Power(at(a), exponent.clone()),
            Operation::Call(function, arguments) => {
                Operation::Call(*function, arguments.iter().map(at).collect())
            }
        }
    }

    /// Its operands.
    pub fn operands(&self) -> Vec<&Value<P>> {
        match self {
            Operation::Add(a, b)
            | Operation::Sub(a, b)
            | Operation::Mul(a, b)
            | Operation::Div(a, b) => {
                vec![a, b]
            }
            Operation::Neg(a) | Operation::Sqrt(a) | Operation::Power(a, _) => vec![a],
            Operation::Call(_, arguments) => arguments.iter().collect(),
        }
    }
}

/// How many operations a program has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Counts {
    /// Additions, subtractions, sign changes and choices.
    pub add: usize,
    /// Multiplications.
    pub mul: usize,
    /// Divisions.
    pub div: usize,
    /// Square roots, powers and elementary functions.
    pub call: usize,
}

impl Counts {
    /// A cost in units of one multiplication, for choosing between programs.
    pub fn weight(self) -> usize {
        self.add + self.mul + 5 * self.div + 25 * self.call
    }

    /// Counts one operation.
    pub fn record<P>(&mut self, operation: &Operation<P>) {
        match operation {
            Operation::Add(..)
            | Operation::Sub(..)
            | Operation::Neg(_)
            | Operation::Call(Function::Below, _) => self.add += 1,
            Operation::Mul(..) => self.mul += 1,
            Operation::Div(..) => self.div += 1,
            Operation::Sqrt(_) | Operation::Power(..) | Operation::Call(..) => self.call += 1,
        }
    }
}

impl std::ops::Add for Counts {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            add: self.add + other.add,
            mul: self.mul + other.mul,
            div: self.div + other.div,
            call: self.call + other.call,
        }
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let parts = [
            (self.add, "addition"),
            (self.mul, "multiplication"),
            (self.div, "division"),
            (self.call, "function call"),
        ];
        let text: Vec<String> = parts
            .iter()
            .filter(|(n, _)| *n > 0)
            .map(|(n, name)| format!("{n} {name}{}", if *n == 1 { "" } else { "s" }))
            .collect();
        f.write_str(if text.is_empty() { "No operation" } else { "" })?;
        f.write_str(&text.join(", "))
    }
}

/// A straight-line program.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Program<P = ExprId> {
    /// The operations, in order.
    pub operations: Vec<Operation<P>>,
    /// The results.
    pub outputs: Vec<Value<P>>,
    /// How many operations there are.
    pub counts: Counts,
}

impl<P> Default for Program<P> {
    fn default() -> Self {
        Self {
            operations: Vec::new(),
            outputs: Vec::new(),
            counts: Counts::default(),
        }
    }
}

impl<P> Program<P> {
    /// All operands and results, in order.
    pub fn values(&self) -> impl Iterator<Item = &Value<P>> {
        let operands = self.operations.iter().flat_map(Operation::operands);
        operands.chain(&self.outputs)
    }

    /// Whether it reads a symbol.
    pub fn reads(&self, symbol: Symbol) -> bool {
        self.values()
            .any(|value| matches!(value, Value::Symbol(read) if *read == symbol))
    }

    /// The program over other prepared constants, which are asked for in the order of their use.
    pub fn with_prepared<Q>(&self, prepared: &mut dyn FnMut(&P) -> Q) -> Program<Q> {
        let mut at = |value: &Value<P>| match value {
            Value::Symbol(symbol) => Value::Symbol(*symbol),
            Value::Prepared(constant) => Value::Prepared(prepared(constant)),
            Value::Number(number) => Value::Number(number.clone()),
            Value::Temporary(index) => Value::Temporary(*index),
        };
        let operations = self.operations.iter();
        Program {
            operations: operations.map(|operation| operation.map(&mut at)).collect(),
            outputs: self.outputs.iter().map(&mut at).collect(),
            counts: self.counts,
        }
    }
}

impl Program {
    /// The results in double precision.
    pub fn evaluate(
        &self,
        symbol: &dyn Fn(Symbol) -> f64,
        prepared: &dyn Fn(ExprId) -> f64,
    ) -> Vec<f64> {
        let mut done: Vec<f64> = Vec::with_capacity(self.operations.len());
        let get = |operand: &Value, done: &[f64]| match operand {
            Value::Symbol(s) => symbol(*s),
            Value::Prepared(id) => prepared(*id),
            Value::Number(number) => number.to_f64(),
            Value::Temporary(index) => done[*index],
        };
        for operation in &self.operations {
            let at = |operand: &Value| get(operand, &done);
            let result = match operation {
                Operation::Add(a, b) => at(a) + at(b),
                Operation::Sub(a, b) => at(a) - at(b),
                Operation::Mul(a, b) => at(a) * at(b),
                Operation::Div(a, b) => at(a) / at(b),
                Operation::Neg(a) => -at(a),
                Operation::Sqrt(a) => at(a).sqrt(),
                Operation::Power(a, exponent) => libm::pow(at(a), exponent.to_f64()),
                Operation::Call(function, arguments) => {
                    function.evaluate(&arguments.iter().map(at).collect::<Vec<_>>())
                }
            };
            done.push(result);
        }
        let outputs = self.outputs.iter();
        outputs.map(|output| get(output, &done)).collect()
    }

    /// The part of the program behind some of its results.
    #[must_use]
    pub fn part(&self, outputs: std::ops::Range<usize>) -> Self {
        let outputs = &self.outputs[outputs];
        let mut needed = vec![false; self.operations.len()];
        let mark = |value: &Value, needed: &mut Vec<bool>| {
            if let Value::Temporary(index) = value {
                needed[*index] = true;
            }
        };
        for value in outputs {
            mark(value, &mut needed);
        }
        for index in (0..self.operations.len()).rev() {
            if needed[index] {
                for value in self.operations[index].operands() {
                    mark(value, &mut needed);
                }
            }
        }
        let mut part = Self::default();
        let mut places = vec![0; self.operations.len()];
        for (index, operation) in self.operations.iter().enumerate() {
            if needed[index] {
                places[index] = part.operations.len();
                let operation = operation.renumbered(&|index| places[index]);
                part.counts.record(&operation);
                part.operations.push(operation);
            }
        }
        let moved = outputs.iter().cloned();
        part.outputs = moved
            .map(|value| value.renumbered(&|index| places[index]))
            .collect();
        part
    }

    /// Both programs one after the other.
    #[must_use]
    pub fn followed_by(mut self, other: &Self) -> Self {
        let first = self.operations.len();
        let shifted = |index| first + index;
        for operation in &other.operations {
            self.operations.push(operation.renumbered(&shifted));
        }
        let outputs = other.outputs.iter().cloned();
        self.outputs
            .extend(outputs.map(|value| value.renumbered(&shifted)));
        self.counts = self.counts + other.counts;
        self
    }

    /// The weight of the operations behind each result by itself.
    pub fn weights(&self) -> Vec<usize> {
        let mut weights = Vec::with_capacity(self.outputs.len());
        let mut seen = vec![usize::MAX; self.operations.len()];
        for (output, value) in self.outputs.iter().enumerate() {
            let (mut counts, mut stack) = (Counts::default(), vec![value]);
            while let Some(value) = stack.pop() {
                if let Value::Temporary(index) = value
                    && std::mem::replace(&mut seen[*index], output) != output
                {
                    counts.record(&self.operations[*index]);
                    stack.extend(self.operations[*index].operands());
                }
            }
            weights.push(counts.weight());
        }
        weights
    }
}
