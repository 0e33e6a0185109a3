//! Numbers modulo a prime: a quick look at exact values.
//!
//! A rational function that does not vanish modulo the prime does not vanish over the rationals. The
//! converse is not a proof; what vanishes here is looked at again.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::ToPrimitive;

use super::Rational;

/// The Mersenne prime 2^61 - 1.
const PRIME: u64 = (1 << 61) - 1;

/// A number modulo 2^61 - 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Residue(u64);

impl Residue {
    /// Zero.
    pub const ZERO: Self = Self(0);
    /// One.
    pub const ONE: Self = Self(1);

    /// A residue from any bits.
    pub fn from_bits(bits: u64) -> Self {
        Self(bits % PRIME)
    }

    /// The residue of a rational number; `None` where the prime divides its denominator.
    pub fn from_rational(value: &Rational) -> Option<Self> {
        let (numerator, denominator) = match value.to_words() {
            Some((n, d)) => (Self::from_word(n), Self::from_word(d)),
            None => {
                let big = value.to_big();
                (
                    Self::from_integer(big.numer()),
                    Self::from_integer(big.denom()),
                )
            }
        };
        match denominator {
            Self::ONE => Some(numerator),
            _ => Some(numerator.times(denominator.inverse()?)),
        }
    }

    fn from_word(word: i64) -> Self {
        let size = Self::from_bits(word.unsigned_abs());
        if word < 0 {
            Self::ZERO.minus(size)
        } else {
            size
        }
    }

    /// The residue of an integer.
    pub fn from_integer(value: &BigInt) -> Self {
        let rest = value.mod_floor(&BigInt::from(PRIME));
        Self(rest.to_u64().unwrap_or(0))
    }

    /// Whether it is zero.
    pub fn is_zero(self) -> bool {
        self.0 == 0
    }

    /// The sum.
    pub fn plus(self, other: Self) -> Self {
        Self::reduced(self.0 + other.0)
    }

    /// The difference.
    pub fn minus(self, other: Self) -> Self {
        Self::reduced(self.0 + (PRIME - other.0))
    }

    /// The product.
    pub fn times(self, other: Self) -> Self {
        let product = u128::from(self.0) * u128::from(other.0);
        // 2^61 = 1: the upper bits count as lower ones.
        Self::reduced((product as u64 & PRIME) + (product >> 61) as u64)
    }

    /// The residue of a number below 2 (2^61 - 1) + 1.
    fn reduced(sum: u64) -> Self {
        Self(if sum >= PRIME { sum - PRIME } else { sum })
    }

    /// The inverse; `None` of zero.
    pub fn inverse(self) -> Option<Self> {
        (!self.is_zero()).then(|| self.raised(PRIME - 2))
    }

    /// The power; `None` for a negative power of zero.
    pub fn power(self, exponent: i64) -> Option<Self> {
        let base = if exponent < 0 { self.inverse()? } else { self };
        Some(base.raised(exponent.unsigned_abs()))
    }

    fn raised(self, mut exponent: u64) -> Self {
        let (mut result, mut square) = (Self::ONE, self);
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = result.times(square);
            }
            square = square.times(square);
            exponent >>= 1;
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_laws_of_a_field_hold() {
        let third = Residue::from_rational(&Rational::new(-1, 3).unwrap()).unwrap();
        assert_eq!(third.times(Residue(3)).plus(Residue::ONE), Residue::ZERO);
        let a = Residue::from_bits(0x9e37_79b9_7f4a_7c15);
        assert_eq!(a.times(a.inverse().unwrap()), Residue::ONE);
        assert_eq!(
            a.power(-5).unwrap().times(a.power(5).unwrap()),
            Residue::ONE
        );
        assert_eq!(a.minus(a), Residue::ZERO);
        assert_eq!(Residue::ZERO.power(-1), None);
        assert_eq!(Residue::ZERO.power(0), Some(Residue::ONE));
        // 2^61 = 1 modulo 2^61 - 1, as a word and as a long number
        let power = |e| Rational::from(2).pow(e).unwrap();
        assert_eq!(Residue::from_rational(&power(61)), Some(Residue::ONE));
        assert_eq!(Residue::from_rational(&power(610)), Some(Residue::ONE));
        assert_eq!(
            Residue::from_rational(&Rational::from(i64::MIN)),
            Some(Residue::ZERO.minus(Residue(4)))
        );
        let pole = Rational::new(1, PRIME as i64).unwrap();
        assert_eq!(Residue::from_rational(&pole), None);
    }
}
