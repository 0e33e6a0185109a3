//! Taylor coefficients of a straight-line program along a solution: each operation's rule for order k.
//!
//! With `D u` for `t u'`, whose coefficients are `k u_k`, and `u v` for a sum of products (Hairer, Nørsett, Wanner, "Solving
//! Ordinary Differential Equations I", section I.8; Jorba, Zou 2005, doi:10.1080/10586458.2005.10128904):
//!
//! | operation | equation |
//! |---|---|
//! | `q = u/v` | `q v = u` |
//! | `y = sqrt(u)` | `y y = u` |
//! | `y = u^c` | `u Dy = c y Du` |
//! | `y = exp(u)`, `log(u)` | `Dy = y Du`, `u Dy = Du` |
//! | `s, c = sin(u), cos(u)` | `Ds = c Du`, `Dc = -s Du` (`sinh`, `cosh`: `+s`) |
//! | `y = tan(u)`, `tanh(u)` | `Dy = w Du`, `w = 1 ± y y` |
//! | `y = atan(u)`, `asin(u)` | `w Dy = Du`, `w = 1 + u u`, `w w = 1 - u u` |
//! | `y = atanh(u)`, `asinh(u)`, `acosh(u)` | `w Dy = Du`, `w = 1 - u u`, `w w = u u + 1`, `w w = u u - 1` |
//! | `y = cbrt(u)`, `log1p(u)` | as `u^(1/3)`, `log(1 + u)` from order 1 on |
//! | `y = expm1(u)` | `Dy = g Du`, `g = exp(u)` |
//! | `y = atan2(u, v)` | `w Dy = v Du - u Dv`, `w = u u + v v` |
//! | `y = below(g, u, v)` | `y = u` where `g_0 < 0`, else `y = v` |

mod functions;
mod rules;

use std::collections::HashMap;

use lie_core::functions::Curve;
use lie_symbolic::exact::Rational;
use lie_symbolic::schedule::{Counts, Operation, Program, Value};
use lie_symbolic::symbolic::ExprId;

/// What a program for order k reads beside the coefficients of the coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity<C = ExprId> {
    /// A constant of the system.
    Constant(C),
    /// The terms of the sum of a pair of series that hold no coefficient of order k: `sum_(0<j<k) u_j v_(k-j)`.
    Rest(usize),
    /// A value of order 0 that was kept.
    Kept(usize),
    /// k
    Order,
    /// 1/k
    InverseOrder,
}

type At = Value<Quantity>;

/// The programs by which a recurrence goes.
#[derive(Clone, Debug)]
pub struct Recurrences {
    /// Order 0: the results, then the conditions that choose branches, then the values that are kept.
    pub begin: Program,
    /// Order k from 1 on: the coefficients of the results, then those of the conditions, then the left and the right series
    /// of each pair.
    pub advance: Program<Quantity>,
    /// The number of conditions.
    pub conditions: usize,
    /// The number of pairs.
    pub pairs: usize,
    /// The number of kept values.
    pub kept: usize,
}

/// The recurrences of a program.
pub fn recurrences(program: &Program) -> Recurrences {
    let mut lowering = Lowering::default();
    for operation in &program.operations {
        let term = lowering.operation(operation);
        lowering.terms.push(term);
    }
    let outputs: Vec<Term> = program.outputs.iter().map(|v| lowering.term(v)).collect();
    lowering.finish(&outputs)
}

/// A value of the program: at order 0, and at order k.
#[derive(Clone, Debug)]
struct Term {
    zero: Value,
    /// None if it does not vary.
    row: Option<At>,
}

#[derive(Default)]
struct Lowering {
    terms: Vec<Term>,
    begin: Tape<ExprId>,
    advance: Tape<Quantity>,
    kept: Vec<Value>,
    pairs: Vec<(At, At)>,
    /// The conditions that vary.
    conditions: Vec<Term>,
    /// Sine and cosine of an argument.
    circular: HashMap<(Value, Curve), (Term, Term)>,
}

/// Operations, equal ones once.
struct Tape<P> {
    operations: Vec<Operation<P>>,
    places: HashMap<Operation<P>, usize>,
}

impl<P> Default for Tape<P> {
    fn default() -> Self {
        Self {
            operations: Vec::new(),
            places: HashMap::new(),
        }
    }
}

impl<P: Clone + Eq + std::hash::Hash> Tape<P> {
    fn push(&mut self, operation: Operation<P>) -> Value<P> {
        let next = self.operations.len();
        let place = *self.places.entry(operation.clone()).or_insert(next);
        if place == next {
            self.operations.push(operation);
        }
        Value::Temporary(place)
    }

    fn program(self, outputs: Vec<Value<P>>) -> Program<P> {
        let mut counts = Counts::default();
        for operation in &self.operations {
            counts.record(operation);
        }
        Program {
            operations: self.operations,
            outputs,
            counts,
        }
    }

    fn add(&mut self, a: Value<P>, b: Value<P>) -> Value<P> {
        match (is(&a, 0), is(&b, 0)) {
            (true, _) => b,
            (_, true) => a,
            _ => self.push(Operation::Add(a, b)),
        }
    }

    fn sub(&mut self, a: Value<P>, b: Value<P>) -> Value<P> {
        match (is(&a, 0), is(&b, 0)) {
            (_, true) => a,
            (true, _) => self.neg(b),
            _ => self.push(Operation::Sub(a, b)),
        }
    }

    fn mul(&mut self, a: Value<P>, b: Value<P>) -> Value<P> {
        match (is(&a, 1), is(&b, 1)) {
            (true, _) => b,
            (_, true) => a,
            _ if is(&a, 0) || is(&b, 0) => number(0),
            _ => self.push(Operation::Mul(a, b)),
        }
    }

    fn neg(&mut self, a: Value<P>) -> Value<P> {
        if is(&a, 0) {
            return a;
        }
        self.push(Operation::Neg(a))
    }
}

fn number<P>(value: i64) -> Value<P> {
    Value::Number(Rational::from(value))
}

fn is<P>(value: &Value<P>, number: i64) -> bool {
    matches!(value, Value::Number(value) if *value == Rational::from(number))
}

impl Lowering {
    fn finish(self, outputs: &[Term]) -> Recurrences {
        let (pairs, kept) = (self.pairs.len(), self.kept.len());
        let conditions = self.conditions.len();
        let outputs = || outputs.iter().chain(&self.conditions);
        let zeros: Vec<Value> = outputs().map(|term| term.zero.clone()).collect();
        let rows: Vec<At> = outputs().map(Term::row).collect();
        let begin = zeros.into_iter().chain(self.kept).collect();
        let (left, right): (Vec<At>, Vec<At>) = self.pairs.into_iter().unzip();
        let advance = rows.into_iter().chain(left).chain(right).collect();
        Recurrences {
            begin: self.begin.program(begin),
            advance: self.advance.program(advance),
            conditions,
            pairs,
            kept,
        }
    }

    fn term(&self, value: &Value) -> Term {
        match value {
            Value::Temporary(index) => self.terms[*index].clone(),
            Value::Symbol(symbol) => Term {
                zero: value.clone(),
                row: Some(Value::Symbol(*symbol)),
            },
            known => Term {
                zero: known.clone(),
                row: None,
            },
        }
    }

    /// A value of order 0 where order k needs it.
    fn keep(&mut self, value: Value) -> At {
        match value {
            Value::Number(number) => Value::Number(number),
            Value::Prepared(constant) => Value::Prepared(Quantity::Constant(constant)),
            value => {
                let known = self.kept.iter().position(|kept| *kept == value);
                let place = known.unwrap_or_else(|| {
                    self.kept.push(value);
                    self.kept.len() - 1
                });
                Value::Prepared(Quantity::Kept(place))
            }
        }
    }

    /// The sum of a pair that is yet to be given, without the terms of order k.
    fn reserve(&mut self) -> (usize, At) {
        self.pairs.push((number(0), number(0)));
        let place = self.pairs.len() - 1;
        (place, Value::Prepared(Quantity::Rest(place)))
    }

    /// The sum of a pair without its terms of order k.
    fn rest(&mut self, left: &At, right: &At) -> At {
        let (place, rest) = self.reserve();
        self.pairs[place] = (left.clone(), right.clone());
        rest
    }

    /// `k u_k`
    fn slope(&mut self, row: &At) -> At {
        let order = Value::Prepared(Quantity::Order);
        self.advance.mul(order, row.clone())
    }

    /// `x/k`
    fn over_order(&mut self, value: At) -> At {
        let inverse = Value::Prepared(Quantity::InverseOrder);
        self.advance.mul(value, inverse)
    }

    /// `1/x` of order 0, kept.
    fn inverse(&mut self, value: Value) -> At {
        let inverse = self.begin.push(Operation::Div(number(1), value));
        self.keep(inverse)
    }

    fn operation(&mut self, operation: &Operation) -> Term {
        let operands = operation.operands();
        let terms: Vec<Term> = operands.into_iter().map(|v| self.term(v)).collect();
        let mut at = terms.iter();
        let zero = operation.map(&mut |_| at.next().map_or(number(0), |term| term.zero.clone()));
        let varies = terms.iter().any(|term| term.row.is_some());
        if let (Operation::Call(function, _), true) = (operation, varies) {
            return self.call(*function, &terms);
        }
        let zero = self.begin.push(zero);
        if !varies {
            return Term { zero, row: None };
        }
        let row = match (operation, terms.as_slice()) {
            (Operation::Add(..), [a, b]) => self.advance.add(a.row(), b.row()),
            (Operation::Sub(..), [a, b]) => self.advance.sub(a.row(), b.row()),
            (Operation::Neg(_), [a]) => self.advance.neg(a.row()),
            (Operation::Mul(..), [a, b]) => self.product(a, b),
            (Operation::Div(..), [a, b]) => self.quotient(a, b, &zero),
            (Operation::Sqrt(_), [a]) => self.square_root(a, &zero),
            (Operation::Power(_, exponent), [a]) => self.power(a, exponent, &zero),
            _ => unreachable!("each operation has its operands"),
        };
        Term {
            zero,
            row: Some(row),
        }
    }

    /// `(a b)_k`
    fn product(&mut self, a: &Term, b: &Term) -> At {
        let (Some(left), Some(right)) = (&a.row, &b.row) else {
            let (constant, varying) = if a.row.is_none() { (a, b) } else { (b, a) };
            let constant = self.keep(constant.zero.clone());
            return self.advance.mul(constant, varying.row());
        };
        let ends = if a.zero == b.zero {
            let twice = self.begin.add(a.zero.clone(), a.zero.clone());
            let twice = self.keep(twice);
            self.advance.mul(twice, left.clone())
        } else {
            let (first, second) = (self.keep(a.zero.clone()), self.keep(b.zero.clone()));
            let first = self.advance.mul(first, right.clone());
            let second = self.advance.mul(left.clone(), second);
            self.advance.add(first, second)
        };
        let rest = self.rest(left, right);
        self.advance.add(ends, rest)
    }

    /// `q_k = (a_k - b_k q_0 - sum_(0<j<k) b_j q_(k-j))/b_0`
    fn quotient(&mut self, a: &Term, b: &Term, zero: &Value) -> At {
        let Some(below) = b.row.clone() else {
            let constant = self.keep(b.zero.clone());
            return self.advance.push(Operation::Div(a.row(), constant));
        };
        let first = self.keep(zero.clone());
        let inverse = self.inverse(b.zero.clone());
        let ends = self.advance.mul(below.clone(), first);
        let known = self.advance.sub(a.row(), ends);
        let (place, rest) = self.reserve();
        let known = self.advance.sub(known, rest);
        let row = self.advance.mul(known, inverse);
        self.pairs[place] = (below, row.clone());
        row
    }

    /// `y_k = (a_k - sum_(0<j<k) y_j y_(k-j))/(2 y_0)`
    fn square_root(&mut self, a: &Term, zero: &Value) -> At {
        let twice = self.begin.add(zero.clone(), zero.clone());
        let inverse = self.inverse(twice);
        let (place, rest) = self.reserve();
        let known = self.advance.sub(a.row(), rest);
        let row = self.advance.mul(known, inverse);
        self.pairs[place] = (row.clone(), row.clone());
        row
    }

    /// `a Dy = c y Da`
    fn power(&mut self, a: &Term, exponent: &Rational, zero: &Value) -> At {
        let base = a.row();
        let first = self.keep(zero.clone());
        let inverse = self.inverse(a.zero.clone());
        let slope = self.slope(&base);
        let (of_slope, with_slope) = self.reserve();
        let (of_base, with_base) = self.reserve();
        let ends = self.advance.mul(base.clone(), first);
        let with_slope = self.over_order(with_slope);
        let right = self.advance.add(ends, with_slope);
        let right = self.advance.mul(Value::Number(exponent.clone()), right);
        let with_base = self.over_order(with_base);
        let known = self.advance.sub(right, with_base);
        let row = self.advance.mul(known, inverse);
        self.pairs[of_slope] = (slope, row.clone());
        self.pairs[of_base] = (base, self.slope(&row));
        row
    }
}

impl Term {
    fn varying(zero: Value, row: At) -> Self {
        Self {
            zero,
            row: Some(row),
        }
    }

    /// At order k.
    fn row(&self) -> At {
        self.row.clone().unwrap_or(number(0))
    }
}
