//! How much of a result is round-off: the first-order bound of the rounding errors of a straight-line
//! program at a point, each operation adding half a unit in its last place (Higham, Accuracy and
//! Stability of Numerical Algorithms, 2002, section 3.3). It depends on the program alone and not on how the
//! errors happen to fall, so that forms of one expression can be compared by it.

use rustc_hash::FxHashMap as HashMap;

use super::program::{Operation, Program, Value};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Function, Graph, Node, Symbol};

/// A value with the bound of its error, in units of the unit round-off.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    pub value: f64,
    pub error: f64,
}

/// Beyond `2^±RANGE` single precision overflows, or loses digits, soon after.
const RANGE: i32 = 100;

impl Rounded {
    fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    fn number(number: &Rational) -> Self {
        let value = number.to_f64();
        let short = number
            .to_words()
            .is_some_and(|(n, d)| d & (d - 1) == 0 && n.unsigned_abs() < 1 << 24);
        Self {
            value,
            error: if short { 0.0 } else { value.abs() },
        }
    }

    fn sum(self, other: Self, sign: f64) -> Self {
        let value = self.value + sign * other.value;
        let exact = self.value == 0.0 || other.value == 0.0;
        let own = if exact { 0.0 } else { value.abs() };
        Self {
            value,
            error: self.error + other.error + own,
        }
    }

    fn product(self, other: Self) -> Self {
        let value = self.value * other.value;
        let own = if is_power_of_two(self.value) || is_power_of_two(other.value) {
            0.0
        } else {
            value.abs()
        };
        Self {
            value,
            error: self.value.abs() * other.error + other.value.abs() * self.error + own,
        }
    }

    fn quotient(self, other: Self) -> Self {
        let value = self.value / other.value;
        let own = if is_power_of_two(other.value) {
            0.0
        } else {
            value.abs()
        };
        Self {
            value,
            error: (self.error + value.abs() * other.error) / other.value.abs() + own,
        }
    }

    fn function(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            error: slope.abs() * self.error + value.abs(),
        }
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.function(root, 0.5 / root)
    }

    fn power(self, exponent: &Rational) -> Self {
        let exponent = exponent.to_f64();
        let value = self.value.powf(exponent);
        self.function(value, exponent * value / self.value)
    }

    fn call(function: Function, arguments: &[Self]) -> Self {
        let values: Vec<f64> = arguments.iter().map(|a| a.value).collect();
        let value = function.evaluate(&values);
        let x = values[0];
        let slope = match function {
            Function::Exp => value,
            Function::Log => 1.0 / x,
            Function::Sin => x.cos(),
            Function::Cos => x.sin(),
            Function::Tan => 1.0 + value * value,
            Function::Asin | Function::Acos => 1.0 / (1.0 - x * x).sqrt(),
            Function::Atan => 1.0 / (1.0 + x * x),
            Function::Sinh => x.cosh(),
            Function::Cosh => x.sinh(),
            Function::Tanh => 1.0 - value * value,
            Function::Atan2 => {
                let [y, x] = [arguments[0], arguments[1]];
                let square = y.value * y.value + x.value * x.value;
                let error = (x.value.abs() * y.error + y.value.abs() * x.error) / square;
                return Self {
                    value,
                    error: error + value.abs(),
                };
            }
        };
        arguments[0].function(value, slope)
    }

    fn leaves_range(self) -> bool {
        let size = self.value.abs();
        size != 0.0 && !(2f64.powi(-RANGE)..=2f64.powi(RANGE)).contains(&size)
    }
}

fn is_power_of_two(value: f64) -> bool {
    value.is_normal() && value.to_bits().trailing_zeros() >= 52
}

/// What a program does at a point.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its results.
    pub results: Vec<Rounded>,
    /// Whether an intermediate result is far out.
    pub leaves_range: bool,
}

/// The values of the symbols at one point, and of the prepared constants.
pub struct Place<'a> {
    graph: &'a Graph,
    value: &'a dyn Fn(Symbol) -> f64,
    constants: HashMap<ExprId, Rounded>,
}

impl<'a> Place<'a> {
    pub fn new(graph: &'a Graph, value: &'a dyn Fn(Symbol) -> f64) -> Self {
        Self {
            graph,
            value,
            constants: HashMap::default(),
        }
    }

    /// The results of a program with the bounds of their errors.
    pub fn run(&mut self, program: &Program) -> Outcome {
        let mut done: Vec<Rounded> = Vec::with_capacity(program.operations.len());
        let mut leaves_range = false;
        for operation in &program.operations {
            let mut at = |operand: &Value| self.operand(operand, &done);
            let result = match operation {
                Operation::Add(a, b) => at(a).sum(at(b), 1.0),
                Operation::Sub(a, b) => at(a).sum(at(b), -1.0),
                Operation::Mul(a, b) => at(a).product(at(b)),
                Operation::Div(a, b) => at(a).quotient(at(b)),
                Operation::Neg(a) => {
                    let a = at(a);
                    Rounded {
                        value: -a.value,
                        ..a
                    }
                }
                Operation::Sqrt(a) => at(a).sqrt(),
                Operation::Power(a, exponent) => at(a).power(exponent),
                Operation::Call(function, arguments) => {
                    let arguments: Vec<Rounded> = arguments.iter().map(at).collect();
                    Rounded::call(*function, &arguments)
                }
            };
            leaves_range |= result.leaves_range();
            done.push(result);
        }
        let outputs = program.outputs.iter();
        Outcome {
            results: outputs.map(|output| self.operand(output, &done)).collect(),
            leaves_range: leaves_range || self.constants.values().any(|c| c.leaves_range()),
        }
    }

    fn operand(&mut self, operand: &Value, done: &[Rounded]) -> Rounded {
        match operand {
            Value::Symbol(symbol) => Rounded::exact((self.value)(*symbol)),
            Value::Number(number) => Rounded::number(number),
            Value::Temporary(index) => done[*index],
            Value::Prepared(id) => self.constant(*id),
        }
    }

    /// A prepared constant, computed as its expression stands.
    fn constant(&mut self, id: ExprId) -> Rounded {
        if let Some(known) = self.constants.get(&id) {
            return *known;
        }
        for node in self.graph.dependencies(&[id]) {
            if !self.constants.contains_key(&node) {
                let value = self.node(node);
                self.constants.insert(node, value);
            }
        }
        self.constants[&id]
    }

    fn node(&self, id: ExprId) -> Rounded {
        let sum = |start: &Rational, terms: &[(ExprId, Rational)]| {
            terms.iter().fold(Rounded::number(start), |sum, (term, c)| {
                sum.sum(self.constants[term].product(Rounded::number(c)), 1.0)
            })
        };
        match self.graph.node(id) {
            Node::Number(number) => Rounded::number(number),
            Node::Pi => Rounded {
                value: std::f64::consts::PI,
                error: std::f64::consts::PI,
            },
            Node::Symbol(symbol) => Rounded::exact((self.value)(*symbol)),
            Node::Sum { constant, terms } => sum(constant, terms),
            Node::Written(terms) => sum(&Rational::ZERO, terms),
            Node::Product(factors) => {
                let mut product = Rounded::exact(1.0);
                for (base, exponent) in factors {
                    let base = self.constants[base];
                    product = match exponent.to_integer() {
                        Some(1) => product.product(base),
                        Some(-1) => product.quotient(base),
                        _ => product.product(base.power(exponent)),
                    };
                }
                product
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<Rounded> = arguments.iter().map(|a| self.constants[a]).collect();
                Rounded::call(*function, &arguments)
            }
        }
    }
}
