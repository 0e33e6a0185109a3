//! A scalar whose arithmetic is written down: what a step does becomes a code.

use crate::code::{Code, Instruction, Number, Register, Source, Store};
use crate::kernels::{Frame, Machine, Targets};
use lie_codegen::symbolic::Function;
use lie_runtime::Scalar;
use lie_runtime::scalar::Pack;
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use std::sync::Arc;

/// A step of more instructions is not one program: it takes long to compile, and calls cost little beside it.
const LONGEST: usize = 20_000;

/// What is written down. Numbers go by their order of coming into being.
#[derive(Default)]
struct Record {
    /// For each number its source, or none of a result.
    sources: Vec<Option<Source>>,
    known: HashMap<(u8, u64, u64), Register>,
    /// Each with the first number that it gives.
    instructions: Vec<(Instruction, Register)>,
    /// Numbers that were asked whether they are finite.
    asked: Vec<Register>,
    /// Whether something was asked that the values decide.
    branched: bool,
}

thread_local! {
    /// It belongs to the thread because arithmetic has no place for it.
    static RECORD: RefCell<Record> = RefCell::default();
}

fn with<T>(use_it: impl FnOnce(&mut Record) -> T) -> T {
    RECORD.with_borrow_mut(use_it)
}

impl Record {
    fn source(&mut self, source: Source) -> Register {
        let next = self.sources.len() as Register;
        *self.known.entry(key(source)).or_insert_with(|| {
            self.sources.push(Some(source));
            next
        })
    }

    /// The first number that the instruction gives.
    fn push(&mut self, instruction: Instruction) -> Register {
        let first = self.sources.len() as Register;
        if self.instructions.len() == LONGEST {
            self.branched = true;
            return 0;
        }
        self.instructions.push((instruction, first));
        let count = instruction.width() as usize;
        self.sources.extend(std::iter::repeat_n(None, count));
        first
    }

    /// The code that stores these numbers, without what they do not need.
    fn code(&self, stored: &[Register]) -> Code {
        let needed: Vec<Cell<bool>> = vec![Cell::new(false); self.sources.len()];
        let need = |number: Register| {
            needed[number as usize].set(true);
            number
        };
        stored.iter().for_each(|number| {
            need(*number);
        });
        let mut kept = Vec::new();
        for (instruction, first) in self.instructions.iter().rev() {
            let numbers = *first as usize..(first + instruction.width()) as usize;
            if needed[numbers].iter().any(Cell::get) {
                instruction.moved(&need);
                kept.push((instruction, *first));
            }
        }
        let mut places = vec![0; self.sources.len()];
        let mut sources = Vec::new();
        for (number, source) in self.sources.iter().enumerate() {
            if let (Some(source), true) = (source, needed[number].get()) {
                places[number] = sources.len() as Register;
                sources.push(*source);
            }
        }
        let mut next = sources.len() as Register;
        let mut instructions = Vec::with_capacity(kept.len());
        for (instruction, first) in kept.into_iter().rev() {
            instructions.push(instruction.moved(&|number| places[number as usize]));
            for part in 0..instruction.width() {
                places[(first + part) as usize] = next;
                next += 1;
            }
        }
        let stores = (0..).zip(stored).map(|(entry, number)| Store {
            target: 0,
            entry,
            register: places[*number as usize],
        });
        Code {
            sources,
            instructions,
            stores: stores.collect(),
            registers: next,
            clear: [None, None],
        }
    }
}

/// What tells sources apart; numbers by their bits, so that 0 and -0 are two.
fn key(source: Source) -> (u8, u64, u64) {
    match source {
        Source::Argument(argument, entry) => (0, argument.into(), entry.into()),
        Source::System(place) => (1, place.into(), 0),
        Source::OfStep(place) => (2, place.into(), 0),
        Source::Parameter(place) => (3, place.into(), 0),
        Source::Step => (4, 0, 0),
        Source::Time => (5, 0, 0),
        Source::Number(Number::Exact(value)) => (6, value.to_bits(), 0),
        Source::Number(Number::Ratio(a, b)) => (7, a.to_bits(), b.to_bits()),
        Source::Number(Number::Parts(high, low)) => (8, high.to_bits(), low.to_bits()),
    }
}

/// Writes down what is done in `run`, which gives the numbers to store and something else: the code that stores them, behind them
/// those of which it was asked whether they are finite. None where `run` gives none, or the values decide what is done.
pub(super) fn recorded<T>(run: impl FnOnce() -> Option<(Vec<Recorded>, T)>) -> Option<(Code, T)> {
    let before = RECORD.replace(Record::default());
    let given = run();
    let record = RECORD.replace(before);
    let (numbers, rest) = given?;
    if record.branched {
        return None;
    }
    let numbers = numbers.iter().map(|number| number.0);
    let stored: Vec<Register> = numbers.chain(record.asked.iter().copied()).collect();
    Some((record.code(&stored), rest))
}

/// A number of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Recorded(Register);

impl Recorded {
    /// The number of a source.
    pub fn of(source: Source) -> Self {
        Self(with(|record| record.source(source)))
    }

    fn number(number: Number) -> Self {
        Self::of(Source::Number(number))
    }

    fn result(instruction: Instruction) -> Self {
        Self(with(|record| record.push(instruction)))
    }

    fn call(self, function: Function) -> Self {
        Self::result(Instruction::Call(function, self.0))
    }

    /// An answer that depends on the values.
    fn branch<T>(answer: T) -> T {
        with(|record| record.branched = true);
        answer
    }
}

/// Codes whose instructions are written down one by one.
pub(super) struct Inlined(pub Arc<[Code]>);

impl Machine<Recorded> for Inlined {
    fn run(&self, code: usize, frame: &Frame<'_, Recorded>, mut targets: Targets<'_, Recorded>) {
        let code = &self.0[code];
        let mut registers = Vec::with_capacity(code.registers as usize);
        for source in &code.sources {
            registers.push(match source.place() {
                Some((slice, entry)) => frame.slices()[slice][entry],
                None => Recorded::of(*source),
            });
        }
        for instruction in &code.instructions {
            let moved = instruction.moved(&|register| registers[register as usize].0);
            let Recorded(first) = Recorded::result(moved);
            registers.extend((0..moved.width()).map(|part| Recorded(first + part)));
        }
        for (target, clear) in targets.iter_mut().zip(code.clear) {
            if let Some(count) = clear {
                target[..count as usize].fill(Recorded::zero());
            }
        }
        for store in &code.stores {
            targets[usize::from(store.target)][store.entry as usize] =
                registers[store.register as usize];
        }
    }
}

impl Default for Recorded {
    fn default() -> Self {
        Self::zero()
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $assign:ident $assigned:ident;)+) => {$(
        impl $trait for Recorded {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self::result(Instruction::$trait(self.0, other.0))
            }
        }
        impl $assign for Recorded {
            fn $assigned(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )+};
}
operators! {
    Add add AddAssign add_assign;
    Sub sub SubAssign sub_assign;
    Mul mul MulAssign mul_assign;
    Div div DivAssign div_assign;
}

impl Neg for Recorded {
    type Output = Self;
    fn neg(self) -> Self {
        Self::result(Instruction::Neg(self.0))
    }
}

macro_rules! functions {
    ($($name:ident $function:ident,)+) => {$(
        fn $name(self) -> Self {
            self.call(Function::$function)
        }
    )+};
}

impl Scalar for Recorded {
    type Lane = Self;
    type Mask = bool;
    type Wide = Pack<Self>;
    const LANES: usize = 1;

    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    fn one() -> Self {
        Self::from_f64(1.0)
    }
    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::number(Number::Ratio(numerator, denominator))
    }
    fn constant(high: f64, low: f64) -> Self {
        Self::number(Number::Parts(high, low))
    }
    fn from_f64(value: f64) -> Self {
        Self::number(Number::Exact(value))
    }
    fn epsilon() -> Self {
        Self::from_f64(f64::EPSILON)
    }

    fn splat(lane: Self) -> Self {
        lane
    }
    fn lane(self, _index: usize) -> Self {
        self
    }
    fn with_lane(self, _index: usize, lane: Self) -> Self {
        lane
    }
    fn to_f64(self) -> f64 {
        Self::branch(f64::NAN)
    }
    fn gather(numbers: [Self; 8]) -> Self::Wide {
        Pack(numbers)
    }
    fn scatter(wide: Self::Wide) -> [Self; 8] {
        wide.0
    }

    fn abs(self) -> Self {
        Self::branch(self)
    }
    fn sqrt(self) -> Self {
        Self::result(Instruction::Sqrt(self.0))
    }
    functions! {
        exp Exp, log Log, sin Sin, cos Cos, tan Tan, asin Asin, acos Acos, atan Atan, sinh Sinh, cosh Cosh, tanh Tanh,
        cbrt Cbrt, log1p Log1p, expm1 Expm1, asinh Asinh, acosh Acosh, atanh Atanh,
    }
    fn atan2(self, x: Self) -> Self {
        Self::result(Instruction::Atan2(self.0, x.0))
    }
    fn powf(self, exponent: Self) -> Self {
        Self::result(Instruction::Power(self.0, exponent.0))
    }

    fn max(self, _other: Self) -> Self {
        Self::branch(self)
    }
    fn less(self, _other: Self) -> bool {
        Self::branch(false)
    }
    fn less_equal(self, _other: Self) -> bool {
        Self::branch(false)
    }
    /// It is: a step that meets another number is refused, by whoever runs the code.
    fn finite(self) -> bool {
        with(|record| record.asked.push(self.0));
        true
    }
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}
