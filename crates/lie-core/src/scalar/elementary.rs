//! The elementary functions as programs: straight lines of arithmetic, over one number, lanes or instructions alike.
//!
//! Each is the same sequence of operations whatever it is made over, so that lanes and machine code have the bits of one number. What few
//! arguments ask for (results that are subnormal or overflow, angles beyond 400,000, what is not a number) is left to `libm`,
//! by [`Primitive::rare`].
//!
//! - Sine and cosine: reduction by multiples of pi/2 in three parts (W. J. Cody and W. Waite, *Software Manual for the Elementary
//!   Functions*, 1980), whose rest is a sum of two numbers, then the polynomials of S. Moshier and Sun as in fdlibm's `k_sin.c` and
//!   `k_cos.c`. Up to pi/4 they are those of `libm` bit for bit.
//! - The exponential: a power of two times a minimax polynomial of degree 12, whose leading sum keeps its rounding error.
//! - The logarithm: that of fdlibm's `e_log.c`, bit for bit.
//! - The tangent up to pi/4: the quotient of S. Moshier's Cephes library (`tan.c`), with an error below 1.4 units in the last place; up to
//!   1/16 a polynomial, without a division.
//!
//! Where all angles are small, one number and lanes of printed code leave out what would change nothing.

pub(super) mod one;
pub(super) mod small;

use super::{Primitive, Scalar};
use crate::functions::Elementary;

/// Angles up to this are small: the double below pi/4.
const SMALL: f64 = core::f64::consts::FRAC_PI_4;
/// The tangent of an angle up to this is a polynomial.
const VERY_SMALL: f64 = 1.0 / 16.0;
/// The sine of an angle below this is the angle.
const TINY: f64 = 1.0 / 134_217_728.0;
/// Angles up to this have fewer than 2^18 quarters of a turn.
const LARGE: f64 = 4e5;
/// A number whose last bit counts ones: the sum with another one is rounded to an integer, which stands in its last bits.
const INTEGERS: f64 = 6_755_399_441_055_744.0;

/// The lanes in which an angle is small.
#[inline(always)]
pub(super) fn is_small<S: Scalar>(x: S) -> S::Mask {
    x.abs().less_equal(S::from_f64(SMALL))
}

/// Coefficients, highest first.
#[inline(always)]
fn polynomial<P: Primitive, const N: usize>(x: P, coefficients: [f64; N]) -> P {
    let mut value = P::number(coefficients[0]);
    for &coefficient in &coefficients[1..] {
        value = value * x + P::number(coefficient);
    }
    value
}

/// What the sine adds to an angle up to pi/4 and a little beyond, whose square is z.
#[inline(always)]
fn sine_rest<P: Primitive>(x: P, z: P) -> P {
    let low = polynomial(
        z,
        [
            2.755_731_370_707_006_8e-6,
            -1.984_126_982_985_795e-4,
            8.333_333_333_322_49e-3,
        ],
    );
    let high = polynomial(z, [1.589_690_995_211_55e-10, -2.505_076_025_340_686_3e-8]);
    let r = low + z * (z * z) * high;
    z * x * (P::number(-0.166_666_666_666_666_32) + z * r)
}

/// `1 - z/2`, what its rounding left, and what the cosine of an angle whose square is z adds to these.
#[inline(always)]
fn cosine_parts<P: Primitive>(z: P) -> [P; 3] {
    let w = z * z;
    let low = polynomial(
        z,
        [
            2.480_158_728_947_673e-5,
            -1.388_888_888_887_411e-3,
            0.041_666_666_666_666_6,
        ],
    );
    let high = polynomial(
        z,
        [
            -1.135_964_755_778_819_5e-11,
            2.087_572_321_298_175e-9,
            -2.755_731_435_139_066_3e-7,
        ],
    );
    let r = z * low + w * w * high;
    let half = P::number(0.5) * z;
    let one = P::number(1.0);
    let rest = one - half;
    [rest, (one - rest) - half, z * r]
}

/// The sine of an angle in radians.
#[inline]
pub fn sin<P: Primitive>(x: P) -> P {
    sin_cos(x).0
}

/// The cosine of an angle in radians.
#[inline]
pub fn cos<P: Primitive>(x: P) -> P {
    sin_cos(x).1
}

/// Sine and cosine of an angle in radians.
#[inline(always)]
pub fn sin_cos<P: Primitive>(x: P) -> (P, P) {
    let size = x.size();
    let test = P::number(LARGE) - size;
    let reduced = Reduced::new(size);
    let (sine, cosine) = (reduced.sine(), reduced.cosine());
    let is_odd = reduced.turns.left(63).or(P::number(1.0));
    let value = P::blend(is_odd, cosine, sine).xor(reduced.sign_of_sine(x));
    let other = P::blend(is_odd, sine, cosine).xor(reduced.sign_of_cosine());
    (
        P::rare(Elementary::Sin, x, test, value),
        P::rare(Elementary::Cos, x, test, other),
    )
}

/// An angle up to 400,000 less quarters of a turn.
#[derive(Clone, Copy)]
struct Reduced<P> {
    /// The number of quarters, in the last bits: bit 0 exchanges sine and cosine, bit 1 has the sign.
    turns: P,
    /// What is left, from -pi/4 to pi/4 and a little beyond, is a sum.
    angle: P,
    rest: P,
}

impl<P: Primitive> Reduced<P> {
    #[inline(always)]
    fn new(size: P) -> Self {
        let turns = size * P::number(core::f64::consts::FRAC_2_PI) + P::number(INTEGERS);
        let n = turns - P::number(INTEGERS);
        // pi/2 in three parts; those of 35 bits have exact products with n, and the first difference is exact
        let first = size - n * P::number(1.570_796_326_792_333_3);
        let second = n * P::number(2.563_344_151_583_955_8e-12);
        let difference = first - second;
        let left = (first - difference) - second;
        let third = n * P::number(1.056_299_906_698_742_8e-23) - left;
        let angle = difference - third;
        Self {
            turns,
            angle,
            rest: (difference - angle) - third,
        }
    }

    #[inline(always)]
    fn sine(self) -> P {
        let z = self.angle * self.angle;
        let half = P::number(0.5) * z;
        self.angle + (sine_rest(self.angle, z) + (self.rest - half * self.rest))
    }

    #[inline(always)]
    fn cosine(self) -> P {
        let [one, left, r] = cosine_parts(self.angle * self.angle);
        one + (left + (r - self.angle * self.rest))
    }

    #[inline(always)]
    fn sign_of_sine(self, x: P) -> P {
        self.turns.left(62).xor(x).sign()
    }

    #[inline(always)]
    fn sign_of_cosine(self) -> P {
        self.turns.left(62).xor(self.turns.left(63)).sign()
    }
}

/// The exponential.
#[inline]
pub fn exp<P: Primitive>(x: P) -> P {
    const BIAS: f64 = 1023.0;
    // powers of two beyond are subnormal or overflow
    let test = P::number(708.0) - x.size();
    let power = x * P::number(core::f64::consts::LOG2_E) + P::number(INTEGERS + BIAS);
    let n = power - P::number(INTEGERS + BIAS);
    // log(2) in two parts; the products with the first and the difference are exact
    let high = x - n * P::number(6.931_471_803_691_238e-1);
    let low = n * P::number(1.908_214_929_270_587_7e-10);
    let r = high - low;
    let z = r * r;
    // the polynomial of degree 10 for (exp(r) - 1 - r)/r^2 in which r^2 times the error is least, 2^-64
    let even = polynomial(
        z,
        [
            2.092_694_137_009_959e-9,
            2.755_723_336_414_553_7e-7,
            2.480_158_737_374_138e-5,
            1.388_888_888_885_843_4e-3,
            4.166_666_666_666_673e-2,
            0.5,
        ],
    );
    let odd = polynomial(
        z,
        [
            2.511_228_839_746_035_6e-8,
            2.755_723_409_939_445_3e-6,
            1.984_126_989_719_445_3e-4,
            8.333_333_333_316_685e-3,
            1.666_666_666_666_668_5e-1,
        ],
    );
    let square = z * (even + r * odd);
    let one = P::number(1.0);
    let sum = one + high;
    let left = (one - sum) + high;
    let value = sum + (left + (square - low));
    P::rare(Elementary::Exp, x, test, value * power.left(52))
}

/// The natural logarithm.
#[inline]
pub fn log<P: Primitive>(x: P) -> P {
    // the high word of sqrt(1/2)
    const ROOT: u64 = 0x3fe6_a09e << 32;
    const ONE: u64 = 0x3ff0_0000 << 32;
    const MANTISSA: u64 = (1 << 52) - 1;
    const TWO_TO_52: f64 = 4_503_599_627_370_496.0;
    // not below the least normal number, and finite
    let test = (x - P::number(f64::MIN_POSITIVE)) * (P::number(f64::MAX) - x);
    // x = 2^k (1 + f) with sqrt(1/2) < 1 + f < sqrt(2)
    let moved = x.plus(P::from_word(ONE - ROOT));
    let exponent = moved.right(52).or(P::number(TWO_TO_52));
    let k = exponent - P::number(TWO_TO_52 + 1023.0);
    let mantissa = moved.and(P::from_word(MANTISSA));
    let f = mantissa.plus(P::from_word(ROOT)) - P::number(1.0);
    let half_square = P::number(0.5) * f * f;
    let s = f / (P::number(2.0) + f);
    let z = s * s;
    let w = z * z;
    let even = polynomial(
        w,
        [
            1.531_383_769_920_937_3e-1,
            2.222_219_843_214_978_4e-1,
            3.999_999_999_940_942e-1,
        ],
    );
    let odd = polynomial(
        w,
        [
            1.479_819_860_511_658_6e-1,
            1.818_357_216_161_805e-1,
            2.857_142_874_366_239e-1,
            6.666_666_666_666_735e-1,
        ],
    );
    let r = z * odd + w * even;
    let value = s * (half_square + r) + k * P::number(1.908_214_929_270_587_7e-10) - half_square
        + f
        + k * P::number(6.931_471_803_691_238e-1);
    P::rare(Elementary::Log, x, test, value)
}

/// The tangent of an angle in radians.
#[inline]
pub fn tan<P: Primitive>(x: P) -> P {
    let size = x.size();
    let beyond = P::number(VERY_SMALL) - size;
    let value = P::blend(beyond, tan_quotient(x), tan_polynomial(x));
    P::rare(Elementary::Tan, x, P::number(SMALL) - size, value)
}

/// The lanes in which the tangent is a polynomial.
#[inline(always)]
fn is_very_small<S: Scalar>(x: S) -> S::Mask {
    x.abs().less_equal(S::from_f64(VERY_SMALL))
}

/// The minimax polynomial of that degree for `|x| <= 1/16`, with a relative error of 2^-55.
#[inline(always)]
fn tan_polynomial<P: Primitive>(x: P) -> P {
    let z = x * x;
    let slope = polynomial(
        z,
        [
            0.021_954_092_633_481_01,
            0.053_967_976_048_537_35,
            0.133_333_333_692_985_45,
            0.333_333_333_333_188_7,
        ],
    );
    x + x * (z * slope)
}

#[inline(always)]
fn tan_quotient<P: Primitive>(x: P) -> P {
    let z = x * x;
    let numerator = polynomial(
        z,
        [
            -1.309_369_391_813_837_9e4,
            1.153_516_648_385_874_2e6,
            -1.795_652_519_764_848_8e7,
        ],
    );
    let denominator = polynomial(
        z,
        [
            1.0,
            1.368_129_634_706_929_5e4,
            -1.320_892_344_402_109_7e6,
            2.500_838_018_233_579e7,
            -5.386_957_559_294_546_5e7,
        ],
    );
    x + x * (z * numerator / denominator)
}

#[cfg(test)]
mod tests;
