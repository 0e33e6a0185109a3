//! Elementary functions that are programs, written down as codes.

use super::Recorded;
use super::record::written;
use crate::code::{Bitwise, Code, Instruction, Number, Source};
use lie_core::Elementary;
use lie_core::scalar::Primitive;

/// The code of a function of its only argument; none of those that are no programs.
pub(crate) fn program(function: Elementary) -> Option<Code> {
    let argument = || Recorded::from_source(Source::Argument(0, 0));
    let (result, written) = written(|| function.program(argument()))?;
    let [_, code] = written.codes(&[result], &[]);
    Some(code)
}

macro_rules! of_bits {
    ($($name:ident $what:ident;)+) => {
        $(fn $name(self, other: Self) -> Self {
            Self::binary(|a, b| Instruction::Bits(Bitwise::$what, a, b), self, other)
        })+
    };
}

impl Primitive for Recorded {
    fn number(value: f64) -> Self {
        Self::from_source(Source::Number(Number::Exact(value)))
    }
    fn from_word(word: u64) -> Self {
        Primitive::number(f64::from_bits(word))
    }
    of_bits! {
        and And;
        or Or;
        xor Xor;
        plus Plus;
    }
    fn left(self, places: u8) -> Self {
        self.unary(|a| Instruction::Shift(places as i8, a))
    }
    fn right(self, places: u8) -> Self {
        self.unary(|a| Instruction::Shift(-(places as i8), a))
    }
    fn blend(test: Self, then: Self, otherwise: Self) -> Self {
        Self::ternary(Instruction::Blend, [test, then, otherwise])
    }
    fn rare(function: Elementary, x: Self, test: Self, usual: Self) -> Self {
        Self::ternary(
            |x, test, usual| Instruction::Rare(function, x, test, usual),
            [x, test, usual],
        )
    }
}
