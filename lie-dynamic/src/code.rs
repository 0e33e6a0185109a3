//! Programs of a plan as code over registers.

use lie_codegen::derive::{Argument, Quantity, Shape};
use lie_codegen::exact::Rational;
use lie_codegen::plan::{Code as Program, Constant, Function as Kernel};
use lie_codegen::schedule::{self, Operation, Value};
use lie_codegen::symbolic::{Function, Symbol};
use std::collections::HashMap;

/// The place of a number while code runs.
pub type Register = u32;

/// Where a register gets its number from before the first instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// An entry of a vector argument.
    Argument(u8, u32),
    /// A constant of the system.
    System(u32),
    /// A constant of the step size.
    OfStep(u32),
    /// A parameter.
    Parameter(u32),
    /// The step size.
    Step,
    /// The time.
    Time,
    /// A number.
    Number(Number),
}

/// An exact number as scalars know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// A number that f64 holds.
    Exact(f64),
    /// A quotient of integers that f64 holds.
    Ratio(f64, f64),
    /// A number and what is left of it.
    Parts(f64, f64),
}

/// What is done, with the registers of the operands; results go to the registers in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instruction {
    /// `a + b`
    Add(Register, Register),
    /// `a - b`
    Sub(Register, Register),
    /// `a * b`
    Mul(Register, Register),
    /// `a / b`
    Div(Register, Register),
    /// `-a`
    Neg(Register),
    /// The square root.
    Sqrt(Register),
    /// `a` to the power `b`.
    Power(Register, Register),
    /// An elementary function of one number.
    Call(Function, Register),
    /// The angle of the point (b, a).
    Atan2(Register, Register),
    /// `b` where `a` is negative, `c` elsewhere.
    Below(Register, Register, Register),
    /// All Stumpff functions below an index, each in a register of its own.
    Stumpff(u8, Register),
    /// The same of the functions `phi_k`.
    Phi(u8, Register),
}

impl Instruction {
    /// How many registers it writes.
    pub fn width(&self) -> u32 {
        match self {
            Self::Stumpff(count, _) | Self::Phi(count, _) => u32::from(*count),
            _ => 1,
        }
    }
}

/// A result: what is written, the entry and the register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Store {
    /// 0: the number or vector, 1: the matrix.
    pub target: u8,
    /// The entry; of a matrix row after row.
    pub entry: u32,
    /// The register.
    pub register: Register,
}

/// A program over registers: first those of the sources, then those of the results.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Code {
    /// What is loaded.
    pub sources: Vec<Source>,
    /// What is done.
    pub instructions: Vec<Instruction>,
    /// What is written.
    pub stores: Vec<Store>,
    /// The number of registers.
    pub registers: u32,
    /// Whether not every entry of a target is written, so that it is cleared first: of a vector and a matrix, with the number of
    /// their entries.
    pub clear: [Option<u32>; 2],
}

/// A number of the plan.
fn number(value: &Rational) -> Number {
    const EXACT: u64 = 1 << 53;
    let high = value.to_f64();
    if Rational::from_f64(high).as_ref() == Some(value) {
        return Number::Exact(high);
    }
    if let Some((n, d)) = value.to_words()
        && n.unsigned_abs() <= EXACT
        && d.unsigned_abs() <= EXACT
    {
        return Number::Ratio(n as f64, d as f64);
    }
    let low = Rational::from_f64(high).map_or(0.0, |high| (value - &high).to_f64());
    Number::Parts(high, low)
}

const PI: Number = Number::Parts(std::f64::consts::PI, 1.2246467991473532e-16);

/// What a program is lowered with.
struct Lowering<'a, P> {
    /// The source of a value that is not a temporary.
    source_of: &'a dyn Fn(&Value<P>) -> Source,
    code: Code,
    known: HashMap<String, Register>,
}

impl<P> Lowering<'_, P> {
    fn source(&mut self, source: Source) -> Register {
        let key = format!("{source:?}");
        if let Some(register) = self.known.get(&key) {
            return *register;
        }
        let register = self.code.sources.len() as Register;
        self.code.sources.push(source);
        self.known.insert(key, register);
        register
    }

    /// The register of a value that is not a temporary.
    fn leaf(&mut self, value: &Value<P>) -> Register {
        self.source((self.source_of)(value))
    }
}

/// The source of a constant.
fn source_of_constant(constant: Constant) -> Source {
    match constant {
        Constant::Pi => Source::Number(PI),
        Constant::Step => Source::Step,
        Constant::System(position) => Source::System(position as u32),
        Constant::OfStep(position) => Source::OfStep(position as u32),
    }
}

/// The source of a symbol among these arguments.
fn source_of_symbol(symbol: Symbol, arguments: &[Argument]) -> Source {
    match symbol {
        Symbol::Parameter(index) => Source::Parameter(index as u32),
        Symbol::Step => Source::Step,
        Symbol::Time => Source::Time,
        Symbol::Coordinate(_) | Symbol::Input(_) => {
            for (argument, known) in positions(arguments) {
                let mut symbols = known.symbols.iter();
                if let Some(entry) = symbols.position(|known| *known == symbol) {
                    return Source::Argument(argument, entry as u32);
                }
            }
            unreachable!("every symbol of a kernel is one of its arguments")
        }
    }
}

fn positions(arguments: &[Argument]) -> impl Iterator<Item = (u8, &Argument)> {
    (0..).zip(arguments)
}

/// The source of a value of a kernel.
fn source_of_value(value: &Value<Constant>, arguments: &[Argument]) -> Source {
    match value {
        Value::Symbol(symbol) => source_of_symbol(*symbol, arguments),
        Value::Number(value) => Source::Number(number(value)),
        Value::Prepared(constant) => source_of_constant(*constant),
        Value::Temporary(_) => unreachable!("temporaries are no leaves"),
    }
}

/// What the program for order k of a recurrence reads: the coefficients, the rests of sums, what was kept, k and 1/k are its
/// arguments.
fn source_of_quantity(value: &Value<Quantity<Constant>>) -> Source {
    match value {
        Value::Symbol(Symbol::Coordinate(index)) => Source::Argument(0, *index as u32),
        Value::Symbol(symbol) => source_of_symbol(*symbol, &[]),
        Value::Number(value) => Source::Number(number(value)),
        Value::Prepared(Quantity::Constant(constant)) => source_of_constant(*constant),
        Value::Prepared(Quantity::Rest(pair)) => Source::Argument(1, *pair as u32),
        Value::Prepared(Quantity::Kept(place)) => Source::Argument(2, *place as u32),
        Value::Prepared(Quantity::Order) => Source::Argument(3, 0),
        Value::Prepared(Quantity::InverseOrder) => Source::Argument(3, 1),
        Value::Temporary(_) => unreachable!("temporaries are no leaves"),
    }
}

/// What the program for order 0 of a recurrence reads: the state is its argument.
fn source_of_state(value: &Value<Constant>) -> Source {
    match value {
        Value::Symbol(Symbol::Coordinate(index)) => Source::Argument(0, *index as u32),
        other => source_of_value(other, &[]),
    }
}

impl Code {
    /// The code of a program; its results are not stored yet.
    fn lowered<P: PartialEq>(
        program: &schedule::Program<P>,
        source_of: &dyn Fn(&Value<P>) -> Source,
    ) -> (Self, Vec<Register>) {
        let mut lowering = Lowering {
            source_of,
            code: Self::default(),
            known: HashMap::new(),
        };
        // all sources come first, so that results follow one another
        for value in program.values() {
            if !matches!(value, Value::Temporary(_)) {
                lowering.leaf(value);
            }
        }
        for operation in &program.operations {
            if let Operation::Power(_, exponent) = operation {
                lowering.source(Source::Number(number(exponent)));
            }
        }
        let families = families(program);
        let mut next = lowering.code.sources.len() as Register;
        let mut places: Vec<Register> = Vec::with_capacity(program.operations.len());
        let mut begun: HashMap<usize, Register> = HashMap::new();
        for operation in &program.operations {
            if let Some((family, count, k, argument)) = member(operation, &families) {
                let start = match begun.get(&family) {
                    Some(start) => *start,
                    None => {
                        let argument = match argument {
                            Value::Temporary(index) => places[*index],
                            other => lowering.leaf(other),
                        };
                        let instruction = match operation {
                            Operation::Call(Function::Stumpff(_), _) => {
                                Instruction::Stumpff(count, argument)
                            }
                            _ => Instruction::Phi(count, argument),
                        };
                        lowering.code.instructions.push(instruction);
                        let start = next;
                        next += u32::from(count);
                        begun.insert(family, start);
                        start
                    }
                };
                places.push(start + u32::from(k));
                continue;
            }
            let mut at = |value: &Value<P>| match value {
                Value::Temporary(index) => places[*index],
                other => lowering.leaf(other),
            };
            let instruction = match operation {
                Operation::Add(a, b) => Instruction::Add(at(a), at(b)),
                Operation::Sub(a, b) => Instruction::Sub(at(a), at(b)),
                Operation::Mul(a, b) => Instruction::Mul(at(a), at(b)),
                Operation::Div(a, b) => Instruction::Div(at(a), at(b)),
                Operation::Neg(a) => Instruction::Neg(at(a)),
                Operation::Sqrt(a) => Instruction::Sqrt(at(a)),
                Operation::Power(a, exponent) => {
                    let a = at(a);
                    Instruction::Power(a, lowering.source(Source::Number(number(exponent))))
                }
                Operation::Call(Function::Below, arguments) => {
                    Instruction::Below(at(&arguments[0]), at(&arguments[1]), at(&arguments[2]))
                }
                Operation::Call(Function::Atan2, arguments) => {
                    Instruction::Atan2(at(&arguments[0]), at(&arguments[1]))
                }
                Operation::Call(function, arguments) => {
                    Instruction::Call(*function, at(&arguments[0]))
                }
            };
            lowering.code.instructions.push(instruction);
            places.push(next);
            next += 1;
        }
        let outputs = program.outputs.iter().map(|value| match value {
            Value::Temporary(index) => places[*index],
            other => lowering.leaf(other),
        });
        let outputs: Vec<Register> = outputs.collect();
        lowering.code.registers = next;
        (lowering.code, outputs)
    }

    /// The code of a kernel; vectors have so many entries, matrices the square of it.
    pub fn of_kernel(kernel: &Kernel, size: usize) -> Self {
        let (mut code, outputs) = Self::lowered(&kernel.program, &|value| {
            source_of_value(value, &kernel.arguments)
        });
        let all = [size, size * size].map(|count| count as u32);
        let (vector, matrix): (Vec<u32>, Vec<u32>) = match &kernel.shape {
            Shape::Scalar => (vec![0], Vec::new()),
            Shape::Vector(entries) => (numbers(entries), Vec::new()),
            Shape::Matrix(places) => (Vec::new(), rows(places, size)),
            Shape::VectorAndMatrix(entries, places) => (numbers(entries), rows(places, size)),
        };
        code.clear = match &kernel.shape {
            Shape::Scalar => [None, None],
            Shape::Vector(_) => [partial(&vector, all[0]), None],
            Shape::Matrix(_) => [None, partial(&matrix, all[1])],
            Shape::VectorAndMatrix(..) => [partial(&vector, all[0]), partial(&matrix, all[1])],
        };
        let vector = vector.into_iter().map(|entry| (0, entry));
        let places = vector.chain(matrix.into_iter().map(|entry| (1, entry)));
        code.stores = places
            .zip(outputs)
            .map(|((target, entry), register)| Store {
                target,
                entry,
                register,
            })
            .collect();
        code
    }

    /// The code of a program without arguments whose results follow one another.
    pub fn of_program(program: &Program) -> Self {
        Self::in_order(program, &|value| source_of_value(value, &[]))
    }

    /// The code for order 0 of a recurrence, whose argument is the state.
    pub fn of_beginning(program: &Program) -> Self {
        Self::in_order(program, &source_of_state)
    }

    /// The code for order k of a recurrence, whose arguments are the coefficients, the rests of sums, what was kept, and k
    /// with 1/k.
    pub fn of_advance(program: &schedule::Program<Quantity<Constant>>) -> Self {
        Self::in_order(program, &source_of_quantity)
    }

    /// The code of a program whose results follow one another.
    fn in_order<P: PartialEq>(
        program: &schedule::Program<P>,
        source_of: &dyn Fn(&Value<P>) -> Source,
    ) -> Self {
        let (mut code, outputs) = Self::lowered(program, source_of);
        let outputs = (0..).zip(outputs);
        code.stores = outputs
            .map(|(entry, register)| Store {
                target: 0,
                entry,
                register,
            })
            .collect();
        code
    }

    /// Adds a source. Registers of sources come first: the new one moves all that hold results.
    pub(crate) fn add_source(&mut self, source: Source) -> Register {
        let new = self.sources.len() as Register;
        self.sources.push(source);
        let moved = |register: Register| register + Register::from(register >= new);
        self.instructions = self.instructions.iter().map(|i| i.moved(&moved)).collect();
        for store in &mut self.stores {
            store.register = moved(store.register);
        }
        self.registers += 1;
        new
    }

    /// The same, writing zeros to these entries of the matrix too.
    #[must_use]
    pub fn with_zeros(mut self, places: &[(usize, usize)], size: usize) -> Self {
        if places.is_empty() {
            return self;
        }
        let zero = self.add_source(Source::Number(Number::Exact(0.0)));
        let entries = rows(places, size).into_iter();
        self.stores.extend(entries.map(|entry| Store {
            target: 1,
            entry,
            register: zero,
        }));
        self
    }
}

impl Instruction {
    /// The same with its operands in other registers.
    pub(crate) fn moved(self, to: &dyn Fn(Register) -> Register) -> Self {
        match self {
            Self::Add(a, b) => Self::Add(to(a), to(b)),
            Self::Sub(a, b) => Self::Sub(to(a), to(b)),
            Self::Mul(a, b) => Self::Mul(to(a), to(b)),
            Self::Div(a, b) => Self::Div(to(a), to(b)),
            Self::Power(a, b) => Self::Power(to(a), to(b)),
            Self::Atan2(a, b) => Self::Atan2(to(a), to(b)),
            Self::Neg(a) => Self::Neg(to(a)),
            Self::Sqrt(a) => Self::Sqrt(to(a)),
            Self::Call(function, a) => Self::Call(function, to(a)),
            Self::Below(a, b, c) => Self::Below(to(a), to(b), to(c)),
            Self::Stumpff(count, a) => Self::Stumpff(count, to(a)),
            Self::Phi(count, a) => Self::Phi(count, to(a)),
        }
    }
}

fn numbers(entries: &[usize]) -> Vec<u32> {
    entries.iter().map(|entry| *entry as u32).collect()
}

fn rows(places: &[(usize, usize)], size: usize) -> Vec<u32> {
    let places = places.iter();
    places
        .map(|(row, column)| (row * size + column) as u32)
        .collect()
}

fn partial(written: &[u32], all: u32) -> Option<u32> {
    ((written.len() as u32) < all).then_some(all)
}

/// The functions of closed forms with one argument, and one more than the largest index among them.
type Families<'a, P> = Vec<(bool, &'a Value<P>, u8)>;

fn of_closed_form<P>(operation: &Operation<P>) -> Option<(bool, u8, &Value<P>)> {
    match operation {
        Operation::Call(Function::Stumpff(k), arguments) => Some((true, *k, &arguments[0])),
        Operation::Call(Function::Phi(k), arguments) => Some((false, *k, &arguments[0])),
        _ => None,
    }
}

fn families<P: PartialEq>(program: &schedule::Program<P>) -> Families<'_, P> {
    let mut families: Families<'_, P> = Vec::new();
    for (stumpff, k, argument) in program.operations.iter().filter_map(of_closed_form) {
        let mut known = families.iter_mut();
        match known.find(|family| (family.0, family.1) == (stumpff, argument)) {
            Some(family) => family.2 = family.2.max(k + 1),
            None => families.push((stumpff, argument, k + 1)),
        }
    }
    families
}

/// The position of the family of an operation, the size of the family, the index in it, the argument.
fn member<'a, P: PartialEq>(
    operation: &'a Operation<P>,
    families: &Families<'_, P>,
) -> Option<(usize, u8, u8, &'a Value<P>)> {
    let (stumpff, k, argument) = of_closed_form(operation)?;
    let mut known = families.iter();
    let position = known.position(|family| (family.0, family.1) == (stumpff, argument))?;
    Some((position, families[position].2, k, argument))
}
