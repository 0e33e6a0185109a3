//! Ball arithmetic: numbers of many digits with rigorous bounds of their errors.
//!
//! A [`Ball`] is a set `{x : |x - mid| <= radius}`; every operation returns a ball that contains the result
//! for all members of its operands. What may be undefined for some member (the logarithm of a ball that
//! reaches zero, a step across a branch cut) is `None`: the ball is too wide to tell, or there is no value.
//! The operations are those that the compiler needs, over `num-bigint`, which it has anyway: `astro-float`
//! adds nineteen crates to a procedural macro and 19 s of processor time to its build.

mod elementary;
mod series;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::Rational;

/// Radii have at most so many bits.
const RADIUS_BITS: u64 = 32;
/// Larger exponents count as undefined.
const MAX_EXPONENT: i64 = 1 << 40;
/// Arguments of periodic functions and of exp have at most so many bits before the point.
const MAX_ARGUMENT: i64 = 24;

/// The precision of a computation, with the constants that it needs.
#[derive(Clone, Debug)]
pub struct Precision {
    bits: u64,
    pi: Ball,
    log_two: Ball,
}

/// All numbers within `radius 2^exponent` of `mid 2^exponent`.
#[derive(Clone, Debug)]
pub struct Ball {
    mid: BigInt,
    radius: BigInt,
    exponent: i64,
}

impl Precision {
    /// Results of about so many bits.
    pub fn new(bits: u64) -> Self {
        let (pi, log_two) = (Ball::integer(3), Ball::integer(1));
        let mut precision = Self { bits, pi, log_two };
        precision.pi = series::pi(&precision);
        precision.log_two = series::log_two(&precision);
        precision
    }

    /// Pi.
    pub fn pi(&self) -> Ball {
        self.pi.clone()
    }

    /// The ball of a rational number.
    pub fn rational(&self, value: &Rational) -> Ball {
        if let Some(integer) = value.to_integer() {
            return Ball::integer(integer).rounded(self);
        }
        let value = value.to_big();
        let (n, d) = (value.numer(), value.denom());
        let shift = (self.bits + d.bits()).saturating_sub(n.bits());
        let (mid, rest) = (n << shift).div_rem(d);
        Ball {
            mid,
            radius: BigInt::from(u8::from(!rest.is_zero())),
            exponent: -(shift as i64),
        }
        .rounded(self)
    }
}

impl Ball {
    /// An integer.
    pub fn integer(value: i64) -> Self {
        Self {
            mid: value.into(),
            radius: BigInt::zero(),
            exponent: 0,
        }
    }

    /// `numerator * 2^exponent`.
    pub fn dyadic(numerator: i64, exponent: i64) -> Self {
        Self {
            mid: numerator.into(),
            radius: BigInt::zero(),
            exponent,
        }
    }

    /// The sign of all members: -1, 0 or 1; `None` where they differ.
    pub fn sign(&self) -> Option<i32> {
        if self.mid.is_zero() && self.radius.is_zero() {
            return Some(0);
        }
        (self.mid.abs() > self.radius).then(|| if self.mid.is_negative() { -1 } else { 1 })
    }

    /// Whether it is zero and nothing else.
    pub fn is_zero(&self) -> bool {
        self.mid.is_zero() && self.radius.is_zero()
    }

    /// Whether no member is zero.
    pub fn excludes_zero(&self) -> bool {
        self.mid.abs() > self.radius
    }

    /// A bound `2^k` of the absolute values of all members.
    pub fn magnitude(&self) -> i64 {
        (self.mid.abs() + &self.radius).bits() as i64 + self.exponent
    }

    /// The middle in double precision.
    pub fn to_f64(&self) -> f64 {
        let value = if self.exponent >= 0 {
            Rational::from_big(&self.mid << self.exponent.min(1 << 14), BigInt::one())
        } else {
            Rational::from_big(
                self.mid.clone(),
                BigInt::one() << (-self.exponent).min(1 << 14),
            )
        };
        value.map_or(f64::NAN, |value| value.to_f64())
    }

    /// The same numbers, and perhaps some more, in as few bits as the precision asks for.
    fn rounded(mut self, precision: &Precision) -> Self {
        let long = self.mid.bits().saturating_sub(precision.bits);
        let wide = self.radius.bits().saturating_sub(RADIUS_BITS);
        let cut = long.max(wide);
        if cut > 0 {
            self.lose(cut);
        }
        self
    }

    /// Drops bits at the end; a floor is at most one off, and so is the radius.
    fn lose(&mut self, bits: u64) {
        let zeros = self.mid.trailing_zeros().unwrap_or(u64::MAX);
        let exact = zeros >= bits && self.radius.is_zero();
        self.mid >>= bits;
        if !exact {
            self.radius = (&self.radius >> bits) + 2;
        }
        self.exponent += bits as i64;
    }

    /// The ball, if it is of moderate size.
    pub fn bounded(self) -> Option<Self> {
        let top = self.magnitude();
        let all = (-MAX_EXPONENT..MAX_EXPONENT).contains(&self.exponent);
        (all && top < MAX_EXPONENT).then_some(self)
    }

    /// With this exponent.
    fn aligned(&self, exponent: i64) -> Self {
        let mut result = self.clone();
        let shift = self.exponent - exponent;
        if shift >= 0 {
            result.mid <<= shift;
            result.radius <<= shift;
            result.exponent = exponent;
        } else {
            result.lose(shift.unsigned_abs());
        }
        result
    }

    /// `-self`
    pub fn neg(&self) -> Self {
        Self {
            mid: -&self.mid,
            ..self.clone()
        }
    }

    /// `self + other`
    pub fn add(&self, other: &Self, precision: &Precision) -> Self {
        if self.mid.is_zero() && self.radius.is_zero() {
            return other.clone();
        }
        if other.mid.is_zero() && other.radius.is_zero() {
            return self.clone();
        }
        // bits far below the sum are not worth keeping
        let top = self.magnitude().max(other.magnitude());
        let least = top - 2 * precision.bits as i64;
        let exponent = self.exponent.min(other.exponent).max(least);
        let (a, b) = (self.aligned(exponent), other.aligned(exponent));
        Self {
            mid: a.mid + b.mid,
            radius: a.radius + b.radius,
            exponent,
        }
        .rounded(precision)
    }

    /// `self - other`
    pub fn sub(&self, other: &Self, precision: &Precision) -> Self {
        self.add(&other.neg(), precision)
    }

    /// `self * other`
    pub fn mul(&self, other: &Self, precision: &Precision) -> Self {
        let radius = self.mid.abs() * &other.radius
            + other.mid.abs() * &self.radius
            + &self.radius * &other.radius;
        Self {
            mid: &self.mid * &other.mid,
            radius,
            exponent: self.exponent + other.exponent,
        }
        .rounded(precision)
    }

    /// `self * 2^power`
    fn shifted(&self, power: i64) -> Self {
        Self {
            exponent: self.exponent + power,
            ..self.clone()
        }
    }

    /// `1 / self`
    pub fn recip(&self, precision: &Precision) -> Option<Self> {
        let size = self.mid.abs();
        if size <= self.radius {
            return None;
        }
        // 1/(m + d) - 1/m = -d/(m (m + d))
        let shift = size.bits() + precision.bits;
        let one = BigInt::one() << shift;
        let error = (&one * &self.radius) / (&size * (&size - &self.radius));
        Self {
            mid: &one / &self.mid,
            radius: error + 2,
            exponent: -(shift as i64) - self.exponent,
        }
        .rounded(precision)
        .bounded()
    }

    /// `self / other`
    pub fn div(&self, other: &Self, precision: &Precision) -> Option<Self> {
        Some(self.mul(&other.recip(precision)?, precision))
    }

    /// `self^exponent` for an integer.
    pub fn powi(&self, exponent: i64, precision: &Precision) -> Option<Self> {
        let (mut result, mut left) = (Self::integer(1), exponent.unsigned_abs());
        let mut square = self.clone();
        while left > 0 {
            if left & 1 == 1 {
                result = result.mul(&square, precision).bounded()?;
            }
            left >>= 1;
            if left > 0 {
                square = square.mul(&square, precision).bounded()?;
            }
        }
        if exponent < 0 {
            result.recip(precision)
        } else {
            Some(result)
        }
    }

    /// The square root; all members must be positive, or all zero.
    pub fn sqrt(&self, precision: &Precision) -> Option<Self> {
        match self.sign()? {
            0 => return Some(self.clone()),
            1 => {}
            _ => return None,
        }
        // sqrt(m + d) - sqrt(m) is at most d/sqrt(m - d)
        let mut shift = (2 * precision.bits).saturating_sub(self.mid.bits()) as i64;
        shift += (self.exponent - shift) & 1;
        let wide = self.aligned(self.exponent - shift);
        let low = (&wide.mid - &wide.radius).sqrt().max(BigInt::one());
        Some(
            Self {
                mid: wide.mid.sqrt(),
                radius: wide.radius / low + 2,
                exponent: wide.exponent / 2,
            }
            .rounded(precision),
        )
    }

    /// `self^exponent`; all members must be positive, or all zero and the exponent positive.
    pub fn power(&self, exponent: &Rational, precision: &Precision) -> Option<Self> {
        if let Some(integer) = exponent.to_integer() {
            return self.powi(integer, precision);
        }
        if self.sign()? == 0 {
            return (!exponent.is_negative()).then(|| self.clone());
        }
        if let Some((n, 2)) = exponent.to_words() {
            return self.sqrt(precision)?.powi(n, precision);
        }
        let logarithm = self.log(precision)?;
        logarithm
            .mul(&precision.rational(exponent), precision)
            .exp(precision)
    }

    /// The nearest integer to the middle, where it is small.
    fn nearest(&self) -> Option<i64> {
        if self.magnitude() < 0 {
            return Some(0);
        }
        let exponent = self.exponent.min(-1);
        let doubled: BigInt = self.aligned(exponent).mid >> (-1 - exponent);
        let halves: BigInt = (doubled + 1) >> 1;
        halves.to_i64()
    }

    /// Widens by `2^power`, which may be far below the last bit.
    fn widened(self, power: i64, precision: &Precision) -> Self {
        let least = self.magnitude() - 2 * precision.bits as i64;
        let mut wide = self.aligned(self.exponent.min(power.max(least)));
        wide.radius += BigInt::one() << (power - wide.exponent).max(0);
        wide.rounded(precision)
    }
}

#[cfg(test)]
mod tests;
