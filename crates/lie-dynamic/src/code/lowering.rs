//! From a program to the registers and instructions of its code.

use super::{Code, Instruction, Number, Register, Source};
use lie_codegen::derive::{Argument, Quantity};
use lie_codegen::plan::Constant;
use lie_symbolic::exact::Rational;
use lie_symbolic::schedule::{self, Operation, Value};
use lie_symbolic::symbolic::{Function, Symbol};
use std::collections::HashMap;

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
pub(super) fn source_of_value(value: &Value<Constant>, arguments: &[Argument]) -> Source {
    match value {
        Value::Symbol(symbol) => source_of_symbol(*symbol, arguments),
        Value::Number(value) => Source::Number(number(value)),
        Value::Prepared(constant) => source_of_constant(*constant),
        Value::Temporary(_) => unreachable!("temporaries are no leaves"),
    }
}

/// What the program for order k of a recurrence reads: the coefficients, the rests of sums, what was kept, k and 1/k are its
/// arguments.
pub(super) fn source_of_quantity(value: &Value<Quantity<Constant>>) -> Source {
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
pub(super) fn source_of_state(value: &Value<Constant>) -> Source {
    match value {
        Value::Symbol(Symbol::Coordinate(index)) => Source::Argument(0, *index as u32),
        other => source_of_value(other, &[]),
    }
}

impl Code {
    /// The code of a program; its results are not stored yet.
    pub(super) fn lowered<P: PartialEq>(
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
                Operation::Call(Function::Elementary(function), arguments) => {
                    Instruction::Call(*function, at(&arguments[0]))
                }
                Operation::Call(Function::Stumpff(_) | Function::Phi(_), _) => {
                    unreachable!("members of a family")
                }
                Operation::Call(Function::Own(own), _) => {
                    unreachable!("{own:?} has no code at run time")
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
