//! Straight-line programs.

use crate::exact::Rational;
use crate::symbolic::{ExprId, Function, Symbol};

/// An operand.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Value {
    /// A symbol of the kernel: a coordinate, an input.
    Symbol(Symbol),
    /// An expression in what is known beforehand: a prepared constant.
    Prepared(ExprId),
    /// An exact number.
    Number(Rational),
    /// The result of an earlier operation.
    Temporary(usize),
}

/// One operation; its result is the temporary of its position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operation {
    /// `a + b`
    Add(Value, Value),
    /// `a - b`
    Sub(Value, Value),
    /// `a * b`
    Mul(Value, Value),
    /// `a / b`
    Div(Value, Value),
    /// `-a`
    Neg(Value),
    /// The square root.
    Sqrt(Value),
    /// `a^exponent` for an exponent that is no multiple of 1/2.
    Power(Value, Rational),
    /// A function.
    Call(Function, Vec<Value>),
}

impl Operation {
    /// Its operands.
    pub fn operands(&self) -> Vec<&Value> {
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Additions, subtractions and sign changes.
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
    pub fn record(&mut self, operation: &Operation) {
        match operation {
            Operation::Add(..) | Operation::Sub(..) | Operation::Neg(_) => self.add += 1,
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
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Program {
    /// The operations, in order.
    pub operations: Vec<Operation>,
    /// The results.
    pub outputs: Vec<Value>,
    /// How many operations there are.
    pub counts: Counts,
}
