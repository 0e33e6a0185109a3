//! A scalar whose arithmetic is written down.

use super::mask::RecordedMask;
use super::record::with_record;
use crate::code::{Code, Instruction, Number, Register, Source};
use crate::engine::{Frame, Machine, Targets};
use lie_core::Elementary;
use lie_runtime::Scalar;
use lie_runtime::scalar::{Counted, Mask};
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use std::sync::Arc;

/// A number of the record, in so many lanes as far as the numeric core asks, with the value that it has where one is followed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recorded<const LANES: usize = 1> {
    pub(super) register: Register,
    pub(super) value: f64,
}

impl<const LANES: usize> Recorded<LANES> {
    /// The number of a source.
    pub fn from_source(source: Source) -> Self {
        Self::of_value(source, f64::NAN)
    }

    /// The number of a source that has this value.
    pub fn of_value(source: Source, value: f64) -> Self {
        Self {
            register: with_record(|record| record.source(source)),
            value,
        }
    }

    /// A number that was written down before.
    pub(super) fn of_register(register: Register) -> Self {
        Self {
            register,
            value: f64::NAN,
        }
    }

    fn number(number: Number) -> Self {
        Self::of_value(Source::Number(number), number.value())
    }

    /// The only number that an instruction gives, of operands with these values.
    fn result(instruction: Instruction, values: [f64; 3]) -> Self {
        let [a, b, c] = values;
        // the operands by their places
        let of_places = instruction.with_operands([0, 1, 2]);
        let at = |place: Register| [a, b, c][place as usize];
        Self {
            register: with_record(|record| record.push(instruction)),
            value: of_places.single::<f64>(&at).unwrap_or(f64::NAN),
        }
    }

    /// An answer that depends on the values.
    pub(super) fn branch<T>(answer: T) -> T {
        with_record(|record| record.branched = true);
        answer
    }

    /// A number that is 1 where something holds and 0 elsewhere, as what holds.
    pub(super) fn mask(self) -> RecordedMask {
        RecordedMask::Number(self.register, self.value == 1.0)
    }
}

/// What tells a number that was reported from others that are none: its bits but for the lowest 32, which are its register.
const REPORTED: u64 = 0x7FF8_5EED << 32;

/// The register of a number that was reported.
pub(super) fn reported(value: f64) -> Option<Register> {
    let bits = value.to_bits();
    (bits & !u64::from(u32::MAX) == REPORTED).then_some(bits as Register)
}

/// Codes whose instructions are written down one by one.
pub(crate) struct Inlined(pub Arc<[Code]>);

impl<const LANES: usize> Machine<Recorded<LANES>> for Inlined {
    fn run(
        &self,
        code: usize,
        frame: &Frame<'_, Recorded<LANES>>,
        mut targets: Targets<'_, Recorded<LANES>>,
    ) {
        let code = &self.0[code];
        let mut registers: Vec<Recorded<LANES>> = Vec::with_capacity(code.registers as usize);
        for source in &code.sources {
            registers.push(match (source.place(), source) {
                (Some((slice, entry)), _) => frame.slices()[slice][entry],
                (None, Source::Number(number)) => Recorded::number(*number),
                (None, other) => Recorded::from_source(*other),
            });
        }
        let follows_values = with_record(|record| record.follows_values());
        for instruction in &code.instructions {
            if follows_values && instruction.is_family() {
                // which of the sums it is can be asked
                let all = instruction.family(&|register| registers[register as usize]);
                registers.extend(&all[..instruction.width() as usize]);
                continue;
            }
            let moved = instruction.moved(&|register| registers[register as usize].register);
            let first = with_record(|record| record.push(moved));
            let at = |register: Register| registers[register as usize].value;
            match instruction.single::<f64>(&at) {
                Some(value) => registers.push(Recorded {
                    register: first,
                    value,
                }),
                None => {
                    let values = instruction.family::<f64>(&at);
                    let parts = (first..first + moved.width()).zip(values);
                    registers.extend(parts.map(|(register, value)| Recorded { register, value }));
                }
            }
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
impl<const LANES: usize> PartialEq for Recorded<LANES> {
    fn eq(&self, other: &Self) -> bool {
        match with_record(|record| [record.exact(self.register), record.exact(other.register)]) {
            [Some(one), Some(other)] => one == other,
            _ => (self.less_equal(*other) & other.less_equal(*self)).all(),
        }
    }
}

impl<const LANES: usize> Default for Recorded<LANES> {
    fn default() -> Self {
        Self::zero()
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $assign:ident $assigned:ident;)+) => {$(
        impl<const LANES: usize> $trait for Recorded<LANES> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self::binary(Instruction::$trait, self, other)
            }
        }
        impl<const LANES: usize> $assign for Recorded<LANES> {
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

impl<const LANES: usize> Neg for Recorded<LANES> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(Instruction::Neg)
    }
}

impl<const LANES: usize> Recorded<LANES> {
    pub(super) fn unary(self, instruction: impl FnOnce(Register) -> Instruction) -> Self {
        let values = [self.value, f64::NAN, f64::NAN];
        Self::result(instruction(self.register), values)
    }

    pub(super) fn ternary(
        instruction: impl FnOnce(Register, Register, Register) -> Instruction,
        operands: [Self; 3],
    ) -> Self {
        let [a, b, c] = operands.map(|operand| operand.register);
        Self::result(instruction(a, b, c), operands.map(|operand| operand.value))
    }

    pub(super) fn binary(
        instruction: impl FnOnce(Register, Register) -> Instruction,
        one: Self,
        other: Self,
    ) -> Self {
        let values = [one.value, other.value, f64::NAN];
        Self::result(instruction(one.register, other.register), values)
    }
}

macro_rules! functions {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(fn $name(self) -> Self {
            self.unary(|a| Instruction::Call(Elementary::$variant, a))
        })+
    };
}

impl<const COUNT: usize> Scalar for Recorded<COUNT> {
    type Lane = f64;
    type Mask = RecordedMask;
    /// In whichever lanes it will be run, a number is the same register.
    type Wide = Self;
    const LANES: usize = COUNT;
    const LOOPS: bool = false;

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

    fn splat(lane: f64) -> Self {
        Self::from_f64(lane)
    }
    fn lane(self, _index: usize) -> f64 {
        Self::branch(self.value)
    }
    fn with_lane(self, _index: usize, _lane: f64) -> Self {
        Self::branch(self)
    }
    fn to_f64(self) -> f64 {
        let exact = with_record(|record| record.exact(self.register));
        exact.unwrap_or_else(|| Self::branch(self.value))
    }
    /// Something to be told apart, which whoever runs the code replaces by the number that it has there.
    fn reported(self) -> f64 {
        with_record(|record| record.branched |= !record.follows_values());
        f64::from_bits(REPORTED | u64::from(self.register))
    }
    fn counted(self, all: u32, what: Counted) -> u32 {
        let missing = Self::from_f64(f64::from(all)) - self;
        with_record(|record| record.missing[what as usize].push(missing.register));
        all
    }
    fn larger(one: f64, other: f64) -> f64 {
        let number = |value: f64| match reported(value) {
            Some(register) => Self {
                register,
                value: f64::NAN,
            },
            None => Self::from_f64(value),
        };
        match (reported(one), reported(other)) {
            (None, None) => Scalar::max(one, other),
            _ => number(one).max(number(other)).reported(),
        }
    }
    fn gather([first, ..]: [Self; 8]) -> Self {
        Self::branch(first)
    }
    fn scatter(wide: Self) -> [Self; 8] {
        Self::branch([wide; 8])
    }
    fn exchange<const D: usize>(wide: Self) -> Self {
        wide.unary(|a| Instruction::Exchange(D as u8, a))
    }
    fn widen(self) -> Self {
        self
    }

    fn abs(self) -> Self {
        self.unary(Instruction::Abs)
    }
    fn sqrt(self) -> Self {
        self.unary(Instruction::Sqrt)
    }
    lie_core::elementary_functions!(functions);
    fn atan2(self, x: Self) -> Self {
        Self::binary(Instruction::Atan2, self, x)
    }
    fn powf(self, exponent: Self) -> Self {
        Self::binary(Instruction::Power, self, exponent)
    }

    fn max(self, other: Self) -> Self {
        Self::binary(Instruction::Larger, self, other)
    }
    fn less(self, other: Self) -> RecordedMask {
        Self::binary(Instruction::Less, self, other).mask()
    }
    fn less_equal(self, other: Self) -> RecordedMask {
        Self::binary(Instruction::LessEqual, self, other).mask()
    }
    /// Where values are not followed, taken to be finite; whoever runs the code refuses a step where the number is not.
    fn finite(self) -> RecordedMask {
        if with_record(|record| record.follows_values()) {
            return self.abs().less_equal(Self::from_f64(f64::MAX));
        }
        with_record(|record| record.asked.push(self.register));
        RecordedMask::Known(true)
    }
    fn select(mask: RecordedMask, yes: Self, no: Self) -> Self {
        match mask.settled() {
            RecordedMask::Known(true) => yes,
            RecordedMask::Known(false) => no,
            number => {
                let below = -number.number::<COUNT>();
                Self::ternary(Instruction::Blend, [below, yes, no])
            }
        }
    }
}
