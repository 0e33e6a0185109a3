//! A scalar whose arithmetic is written down.

use super::record::with_record;
use crate::code::{Code, Instruction, Number, Register, Source};
use crate::engine::{Frame, Machine, Targets};
use lie_core::Elementary;
use lie_runtime::Scalar;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use std::sync::Arc;

/// A number of the record.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recorded(pub(super) Register);

impl Recorded {
    /// The number of a source.
    pub fn from_source(source: Source) -> Self {
        Self(with_record(|record| record.source(source)))
    }

    fn number(number: Number) -> Self {
        Self::from_source(Source::Number(number))
    }

    fn result(instruction: Instruction) -> Self {
        Self(with_record(|record| record.push(instruction)))
    }

    /// An answer that depends on the values.
    fn branch<T>(answer: T) -> T {
        with_record(|record| record.branched = true);
        answer
    }
}

/// Codes whose instructions are written down one by one.
pub(crate) struct Inlined(pub Arc<[Code]>);

impl Machine<Recorded> for Inlined {
    fn run(&self, code: usize, frame: &Frame<'_, Recorded>, mut targets: Targets<'_, Recorded>) {
        let code = &self.0[code];
        let mut registers = Vec::with_capacity(code.registers as usize);
        for source in &code.sources {
            registers.push(match source.place() {
                Some((slice, entry)) => frame.slices()[slice][entry],
                None => Recorded::from_source(*source),
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

/// Whether two numbers are equal depends on their values, unless both are written out.
impl PartialEq for Recorded {
    fn eq(&self, other: &Self) -> bool {
        match with_record(|record| [record.exact(self.0), record.exact(other.0)]) {
            [Some(one), Some(other)] => one == other,
            _ => Self::branch(self.0 == other.0),
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
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(fn $name(self) -> Self {
            Self::result(Instruction::Call(Elementary::$variant, self.0))
        })+
    };
}

impl Scalar for Recorded {
    type Lane = Self;
    type Mask = bool;
    /// In whichever lanes it will be run, a number is the same register.
    type Wide = Self;
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
    fn gather([first, ..]: [Self; 8]) -> Self {
        Self::branch(first)
    }
    fn scatter(wide: Self) -> [Self; 8] {
        Self::branch([wide; 8])
    }
    fn exchange<const D: usize>(wide: Self) -> Self {
        Self::result(Instruction::Exchange(D as u8, wide.0))
    }
    fn widen(self) -> Self {
        self
    }

    fn abs(self) -> Self {
        Self::result(Instruction::Abs(self.0))
    }
    fn sqrt(self) -> Self {
        Self::result(Instruction::Sqrt(self.0))
    }
    lie_core::elementary_functions!(functions);
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
    /// Taken to be finite; whoever runs the code refuses a step where the number is not.
    fn finite(self) -> bool {
        with_record(|record| record.asked.push(self.0));
        true
    }
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}
