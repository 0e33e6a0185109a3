//! Programs of a plan as code over registers.

mod expansion;
mod halves;
mod lowering;

use lie_codegen::derive::{Quantity, Shape};
use lie_codegen::plan::{Code as Program, Constant, Function as Kernel};
use lie_core::Elementary;
use lie_symbolic::schedule::{self, Value};
use lowering::{source_of_quantity, source_of_state, source_of_value};

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

/// What is done with the bits of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bitwise {
    /// The bits that both have.
    And,
    /// The bits that one of them has.
    Or,
    /// The bits in which they differ.
    Xor,
    /// The sum of both words, modulo 2^64.
    Plus,
}

impl Bitwise {
    /// It is done with these words.
    pub const fn of(self, a: u64, b: u64) -> u64 {
        match self {
            Self::And => a & b,
            Self::Or => a | b,
            Self::Xor => a ^ b,
            Self::Plus => a.wrapping_add(b),
        }
    }
}

/// What is done, with the registers of the operands; results go to the registers in order.
///
/// What is said of bits is said of those of double precision: the instructions from `Blend` on are what [`Code::expanded`] writes
/// elementary functions out in, for one number and for lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
    /// The number without its sign.
    Abs(Register),
    /// Over eight lanes: in place i the number in place i xor the first of these, which is 1, 2, 4 or 6.
    Exchange(u8, Register),
    /// `a` to the power `b`.
    Power(Register, Register),
    /// An elementary function of one number.
    Call(Elementary, Register),
    /// The angle of the point (b, a).
    Atan2(Register, Register),
    /// `b` where `a` is negative, `c` elsewhere.
    Below(Register, Register, Register),
    /// 1 where `a < b`, 0 elsewhere.
    Less(Register, Register),
    /// 1 where `a <= b`, 0 elsewhere.
    LessEqual(Register, Register),
    /// The larger of two, the first where they are equal; no number where one is none.
    Larger(Register, Register),
    /// All Stumpff functions below an index, each in a register of its own.
    Stumpff(u8, Register),
    /// The same of the functions `phi_k`.
    Phi(u8, Register),
    /// The same as `Below`, without a jump.
    Blend(Register, Register, Register),
    /// The bits of both.
    Bits(Bitwise, Register, Register),
    /// The bits so many places to the left, or to the right where that is negative; zeros come in.
    Shift(i8, Register),
    /// `c` where `b` is 0 or above, the function of `a` elsewhere, which seldom is.
    Rare(Elementary, Register, Register, Register),
}

impl Instruction {
    /// Whether it gives all functions of a family below an index.
    pub(crate) fn is_family(&self) -> bool {
        matches!(self, Self::Stumpff(..) | Self::Phi(..))
    }

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

impl Code {
    /// The code of a kernel; vectors have so many entries, matrices the square of it.
    pub fn from_kernel(kernel: &Kernel, size: usize) -> Self {
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
    pub fn from_program(program: &Program) -> Self {
        Self::in_order(program, &|value| source_of_value(value, &[]))
    }

    /// The code for order 0 of a recurrence, whose argument is the state.
    pub fn from_beginning(program: &Program) -> Self {
        Self::in_order(program, &source_of_state)
    }

    /// The code for order k of a recurrence, whose arguments are the coefficients, the rests of sums, what was kept, and k
    /// with 1/k.
    pub fn from_advance(program: &schedule::Program<Quantity<Constant>>) -> Self {
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
    /// The same with these operands, in their order.
    pub(crate) fn with_operands(self, operands: [Register; 3]) -> Self {
        let next = std::cell::Cell::new(0);
        self.moved(&|_| {
            let place = next.get();
            next.set(place + 1);
            operands[place]
        })
    }

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
            Self::Abs(a) => Self::Abs(to(a)),
            Self::Exchange(distance, a) => Self::Exchange(distance, to(a)),
            Self::Call(function, a) => Self::Call(function, to(a)),
            Self::Below(a, b, c) => Self::Below(to(a), to(b), to(c)),
            Self::Less(a, b) => Self::Less(to(a), to(b)),
            Self::LessEqual(a, b) => Self::LessEqual(to(a), to(b)),
            Self::Larger(a, b) => Self::Larger(to(a), to(b)),
            Self::Stumpff(count, a) => Self::Stumpff(count, to(a)),
            Self::Phi(count, a) => Self::Phi(count, to(a)),
            Self::Blend(a, b, c) => Self::Blend(to(a), to(b), to(c)),
            Self::Bits(what, a, b) => Self::Bits(what, to(a), to(b)),
            Self::Shift(places, a) => Self::Shift(places, to(a)),
            Self::Rare(function, a, b, c) => Self::Rare(function, to(a), to(b), to(c)),
        }
    }

    /// The word with its bits moved so many places.
    pub const fn shifted(word: u64, places: i8) -> u64 {
        if places < 0 {
            word >> places.unsigned_abs()
        } else {
            word << places
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
