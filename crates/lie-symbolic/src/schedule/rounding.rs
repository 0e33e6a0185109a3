//! How much of a result is round-off: the first-order bound of the rounding errors of a straight-line
//! program at a point, each operation adding half a unit in its last place (Higham, Accuracy and
//! Stability of Numerical Algorithms, 2002, section 3.3). It depends on the program alone and not on how the
//! errors happen to fall, so that forms of one expression can be compared by it.

use rustc_hash::FxHashMap as HashMap;

use super::points::Point;
use super::program::{Operation, Program, Value};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Function, Graph, Node, Symbol, chosen};

/// A value with the bound of its error, in units of the unit round-off.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    pub value: f64,
    pub error: f64,
}

/// Beyond these sizes single precision overflows, or loses digits, soon after.
const RANGE: std::ops::RangeInclusive<f64> = 1.0 / (1u128 << 100) as f64..=(1u128 << 100) as f64;

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

    fn negative(self) -> Self {
        Self {
            value: -self.value,
            ..self
        }
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.function(root, 0.5 / root)
    }

    fn power(self, exponent: &Rational) -> Self {
        let exponent = exponent.to_f64();
        let value = libm::pow(self.value, exponent);
        self.function(value, exponent * value / self.value)
    }

    fn call(function: Function, arguments: &[Self]) -> Self {
        let values: Vec<f64> = arguments.iter().map(|a| a.value).collect();
        let value = function.evaluate(&values);
        let x = values[0];
        let slope = match function {
            Function::Below => return arguments[chosen(x < 0.0)],
            Function::Elementary(function) => function.slope(x, value),
            Function::Stumpff(_) | Function::Phi(_) => {
                function.slope_of_closed(x).unwrap_or(f64::NAN)
            }
            Function::Own(own) => {
                let parts = arguments.iter().enumerate();
                let errors = parts.map(|(place, argument)| {
                    own.derivative(place).stand_in(&values).abs() * argument.error
                });
                let error = errors.sum::<f64>() + value.abs();
                return Self { value, error };
            }
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
        size != 0.0 && !RANGE.contains(&size)
    }
}

fn is_power_of_two(value: f64) -> bool {
    value.is_normal() && value.to_bits().trailing_zeros() >= 52
}

/// A quantity at all points.
type Column = Vec<Rounded>;

/// What a program does at all points.
pub struct Outcome {
    /// Its results.
    pub results: Vec<Column>,
    /// Whether an intermediate result is far out, at each point.
    pub leaves_range: Vec<bool>,
}

/// Points with the values of the symbols, and those of the constants that programs have asked for.
pub struct Places {
    count: usize,
    symbols: HashMap<Symbol, Column>,
    constants: HashMap<ExprId, Constant>,
}

/// A prepared constant, or a part of one.
struct Constant {
    column: Column,
    /// Whether it or a part of it is far out.
    leaves_range: Vec<bool>,
}

/// An operand at all points.
enum Operand<'a> {
    Column(&'a [Rounded]),
    Same(Rounded),
}

impl Operand<'_> {
    fn at(&self, place: usize) -> Rounded {
        match self {
            Operand::Column(column) => column[place],
            Operand::Same(value) => *value,
        }
    }
}

impl Places {
    pub fn new(points: &[Point]) -> Self {
        let mut symbols: HashMap<Symbol, Column> = HashMap::default();
        for (place, point) in points.iter().enumerate() {
            for (symbol, value) in point {
                let column = symbols
                    .entry(*symbol)
                    .or_insert_with(|| vec![Rounded::exact(f64::NAN); points.len()]);
                column[place] = Rounded::exact(*value);
            }
        }
        Self {
            count: points.len(),
            symbols,
            constants: HashMap::default(),
        }
    }

    /// The results of a program with the bounds of their errors.
    pub fn run(&mut self, graph: &Graph, program: &Program) -> Outcome {
        let mut leaves_range = vec![false; self.count];
        for value in program.values() {
            if let Value::Prepared(id) = value {
                let constant = self.constant(graph, *id);
                mark(&mut leaves_range, &constant.leaves_range);
            }
        }
        let mut done: Vec<Column> = Vec::with_capacity(program.operations.len());
        for operation in &program.operations {
            let column = self.operation(operation, &done);
            for (out, value) in leaves_range.iter_mut().zip(&column) {
                *out |= value.leaves_range();
            }
            done.push(column);
        }
        let outputs = program.outputs.iter();
        let results = outputs.map(|output| {
            let operand = self.operand(output, &done);
            (0..self.count).map(|place| operand.at(place)).collect()
        });
        Outcome {
            results: results.collect(),
            leaves_range,
        }
    }

    fn operation(&self, operation: &Operation, done: &[Column]) -> Column {
        let one = |a: &Value, f: &dyn Fn(Rounded) -> Rounded| {
            let a = self.operand(a, done);
            (0..self.count).map(|place| f(a.at(place))).collect()
        };
        let two = |a: &Value, b: &Value, f: fn(Rounded, Rounded) -> Rounded| {
            let (a, b) = (self.operand(a, done), self.operand(b, done));
            let places = 0..self.count;
            places.map(|place| f(a.at(place), b.at(place))).collect()
        };
        match operation {
            Operation::Add(a, b) => two(a, b, |a, b| a.sum(b, 1.0)),
            Operation::Sub(a, b) => two(a, b, |a, b| a.sum(b, -1.0)),
            Operation::Mul(a, b) => two(a, b, Rounded::product),
            Operation::Div(a, b) => two(a, b, Rounded::quotient),
            Operation::Neg(a) => one(a, &Rounded::negative),
            Operation::Sqrt(a) => one(a, &Rounded::sqrt),
            Operation::Power(a, exponent) => one(a, &|a| a.power(exponent)),
            Operation::Call(function, arguments) => {
                let operands = arguments.iter().map(|value| self.operand(value, done));
                let operands: Vec<Operand> = operands.collect();
                self.call(*function, &operands)
            }
        }
    }

    fn call(&self, function: Function, operands: &[Operand]) -> Column {
        let at = |place| {
            let arguments: Vec<Rounded> = operands.iter().map(|a| a.at(place)).collect();
            Rounded::call(function, &arguments)
        };
        (0..self.count).map(at).collect()
    }

    /// An operand whose constants are known.
    fn operand<'a>(&'a self, operand: &Value, done: &'a [Column]) -> Operand<'a> {
        match operand {
            Value::Symbol(symbol) => self.symbol(*symbol),
            Value::Number(number) => Operand::Same(Rounded::number(number)),
            Value::Temporary(index) => Operand::Column(&done[*index]),
            Value::Prepared(id) => Operand::Column(&self.constants[id].column),
        }
    }

    fn symbol(&self, symbol: Symbol) -> Operand<'_> {
        match self.symbols.get(&symbol) {
            Some(column) => Operand::Column(column),
            None => Operand::Same(Rounded::exact(f64::NAN)),
        }
    }

    /// A prepared constant, computed as its expression stands.
    fn constant(&mut self, graph: &Graph, id: ExprId) -> &Constant {
        if !self.constants.contains_key(&id) {
            for part in graph.dependencies(&[id]) {
                if !self.constants.contains_key(&part) {
                    let constant = self.part(graph, part);
                    self.constants.insert(part, constant);
                }
            }
        }
        &self.constants[&id]
    }

    fn part(&self, graph: &Graph, id: ExprId) -> Constant {
        let of = |part: &ExprId| Operand::Column(&self.constants[part].column);
        let column: Column = match graph.node(id) {
            Node::Number(number) => vec![Rounded::number(number); self.count],
            Node::Pi => {
                let pi = Rounded {
                    value: std::f64::consts::PI,
                    error: std::f64::consts::PI,
                };
                vec![pi; self.count]
            }
            Node::Symbol(symbol) => {
                let symbol = self.symbol(*symbol);
                (0..self.count).map(|place| symbol.at(place)).collect()
            }
            Node::Sum { constant, terms } => self.sum(constant, terms),
            Node::Written(terms) => self.sum(&Rational::ZERO, terms),
            Node::Product(factors) => {
                let mut product = vec![Rounded::exact(1.0); self.count];
                for (base, exponent) in factors {
                    let base = of(base);
                    for (place, product) in product.iter_mut().enumerate() {
                        let base = base.at(place);
                        *product = match exponent.to_integer() {
                            Some(1) => product.product(base),
                            Some(-1) => product.quotient(base),
                            _ => product.product(base.power(exponent)),
                        };
                    }
                }
                product
            }
            Node::Call(function, arguments) => {
                let operands: Vec<Operand> = arguments.iter().map(of).collect();
                self.call(*function, &operands)
            }
        };
        let mut leaves_range: Vec<bool> = column.iter().map(|v| v.leaves_range()).collect();
        for child in graph.children(id) {
            mark(&mut leaves_range, &self.constants[&child].leaves_range);
        }
        Constant {
            column,
            leaves_range,
        }
    }

    fn sum(&self, start: &Rational, terms: &[(ExprId, Rational)]) -> Column {
        let mut sum = vec![Rounded::number(start); self.count];
        for (term, coefficient) in terms {
            let coefficient = Rounded::number(coefficient);
            let column = &self.constants[term].column;
            for (sum, term) in sum.iter_mut().zip(column) {
                *sum = sum.sum(term.product(coefficient), 1.0);
            }
        }
        sum
    }
}

fn mark(marks: &mut [bool], more: &[bool]) {
    for (mark, more) in marks.iter_mut().zip(more) {
        *mark |= more;
    }
}
