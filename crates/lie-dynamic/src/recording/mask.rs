//! Truth values of what is written down.

use super::record::with_record;
use super::recorded::Recorded;
use crate::code::Register;
use lie_runtime::Scalar;
use lie_runtime::scalar::Mask;
use std::ops::{BitAnd, BitOr, Not};

/// Truth values of the record: those that are known, or a number that is 1 where it is true and 0 elsewhere, with what it is where
/// values are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RecordedMask {
    Known(bool),
    Number(Register, bool),
}

impl RecordedMask {
    /// The same, known where the record is only for one answer.
    pub(super) fn settled(self) -> Self {
        match self {
            Self::Number(register, _) => {
                with_record(|record| record.answer(register)).map_or(self, Self::Known)
            }
            known => known,
        }
    }

    /// As a number.
    pub(super) fn number<const LANES: usize>(self) -> Recorded<LANES> {
        match self {
            Self::Known(true) => Scalar::one(),
            Self::Known(false) => Scalar::zero(),
            Self::Number(register, is) => Recorded {
                register,
                value: f64::from(u8::from(is)),
            },
        }
    }

    /// Asks whether it is true in every lane, or in any.
    fn ask(self, every: bool) -> bool {
        match self.settled() {
            Self::Known(is) => is,
            Self::Number(register, expected) => {
                with_record(|record| record.ask(register, expected, every));
                expected
            }
        }
    }
}

impl Mask for RecordedMask {
    fn splat(value: bool) -> Self {
        Self::Known(value)
    }
    fn from_bits(bits: u64) -> Self {
        Self::Known(bits & 1 == 1)
    }
    fn bits(self) -> u64 {
        match self.settled() {
            Self::Known(is) => u64::from(is) * u64::from(u8::MAX),
            Self::Number(_, is) => Recorded::<1>::branch(u64::from(is)),
        }
    }
    fn all(self) -> bool {
        self.ask(true)
    }
    fn any(self) -> bool {
        self.ask(false)
    }
    fn surely_all(self) -> bool {
        self.settled() == Self::Known(true)
    }
}

impl BitAnd for RecordedMask {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        match (self.settled(), other.settled()) {
            (Self::Known(true), mask) | (mask, Self::Known(true)) => mask,
            (Self::Known(false), _) | (_, Self::Known(false)) => Self::Known(false),
            (one, other) if one == other => one,
            (one, other) => (one.number::<1>() * other.number()).mask(),
        }
    }
}

impl BitOr for RecordedMask {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        match (self.settled(), other.settled()) {
            (Self::Known(false), mask) | (mask, Self::Known(false)) => mask,
            (Self::Known(true), _) | (_, Self::Known(true)) => Self::Known(true),
            (one, other) if one == other => one,
            (one, other) => {
                let (one, other) = (one.number::<1>(), other.number());
                (one + other - one * other).mask()
            }
        }
    }
}

impl Not for RecordedMask {
    type Output = Self;
    fn not(self) -> Self {
        match self.settled() {
            Self::Known(is) => Self::Known(!is),
            number => (Recorded::<1>::one() - number.number()).mask(),
        }
    }
}
