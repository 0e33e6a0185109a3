//! The numbers in which one formula is evaluated: to find, to follow in the complex plane, to prove.

use lie_symbolic::exact::{Ball, Precision, Rational};
use lie_symbolic::symbolic::{Function, chosen};
use num_complex::Complex64 as c64;

/// A kind of numbers. What has no value, or none that is certain, is `None`.
pub trait Arithmetic {
    /// A number.
    type Number: Clone;
    /// A rational number.
    fn rational(&self, value: &Rational) -> Self::Number;
    /// The constant pi.
    fn pi(&self) -> Option<Self::Number>;
    /// A sum.
    fn add(&self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// A difference.
    fn sub(&self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// A product.
    fn mul(&self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// A quotient.
    fn div(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number>;
    /// A power.
    fn power(&self, base: &Self::Number, exponent: &Rational) -> Option<Self::Number>;
    /// A function of its arguments.
    fn call(&self, function: Function, arguments: &[Self::Number]) -> Option<Self::Number>;
}

/// Numbers whose signs are certain where they are given: what a proof needs.
pub trait Signed: Arithmetic {
    /// The sign: -1, 0 or 1; `None` where it is open.
    fn sign(&self, value: &Self::Number) -> Option<i32>;
    /// About how large it is.
    fn size(&self, value: &Self::Number) -> f64;
}

/// Double precision.
#[derive(Clone, Copy, Debug)]
pub struct Floats;

impl Arithmetic for Floats {
    type Number = f64;

    fn rational(&self, value: &Rational) -> f64 {
        value.to_f64()
    }

    fn pi(&self) -> Option<f64> {
        Some(std::f64::consts::PI)
    }

    fn add(&self, a: &f64, b: &f64) -> f64 {
        a + b
    }

    fn sub(&self, a: &f64, b: &f64) -> f64 {
        a - b
    }

    fn mul(&self, a: &f64, b: &f64) -> f64 {
        a * b
    }

    fn div(&self, a: &f64, b: &f64) -> Option<f64> {
        Some(a / b)
    }

    fn power(&self, base: &f64, exponent: &Rational) -> Option<f64> {
        Some(match exponent.to_words() {
            Some((n, 1)) if n.unsigned_abs() < 64 => base.powi(n as i32),
            Some((1, 2)) => base.sqrt(),
            _ => base.powf(exponent.to_f64()),
        })
    }

    fn call(&self, function: Function, arguments: &[f64]) -> Option<f64> {
        match function {
            Function::Own(_) => None,
            _ => Some(function.evaluate(arguments)),
        }
    }
}

/// Complex numbers in double precision, for polynomials and rational functions.
#[derive(Clone, Copy, Debug)]
pub struct Complexes;

impl Arithmetic for Complexes {
    type Number = c64;

    fn rational(&self, value: &Rational) -> c64 {
        c64::new(value.to_f64(), 0.0)
    }

    fn pi(&self) -> Option<c64> {
        Some(c64::new(std::f64::consts::PI, 0.0))
    }

    fn add(&self, a: &c64, b: &c64) -> c64 {
        a + b
    }

    fn sub(&self, a: &c64, b: &c64) -> c64 {
        a - b
    }

    fn mul(&self, a: &c64, b: &c64) -> c64 {
        a * b
    }

    fn div(&self, a: &c64, b: &c64) -> Option<c64> {
        Some(a / b)
    }

    fn power(&self, base: &c64, exponent: &Rational) -> Option<c64> {
        if base.im == 0.0 && !exponent.is_integer() {
            return Some(c64::new(base.re.powf(exponent.to_f64()), 0.0));
        }
        Some(base.powi(i32::try_from(exponent.to_integer()?).ok()?))
    }

    fn call(&self, function: Function, arguments: &[c64]) -> Option<c64> {
        // constants alone: a polynomial has no other functions
        let real = arguments.iter().all(|argument| argument.im == 0.0);
        let parts: Vec<f64> = arguments.iter().map(|argument| argument.re).collect();
        let value = Floats.call(function, &parts).filter(|_| real)?;
        Some(c64::new(value, 0.0))
    }
}

/// Rational numbers, exact.
#[derive(Clone, Copy, Debug)]
pub struct Rationals;

/// Longer numbers are not computed with.
const MOST_BITS: u64 = 1 << 14;

impl Arithmetic for Rationals {
    type Number = Rational;

    fn rational(&self, value: &Rational) -> Rational {
        value.clone()
    }

    fn pi(&self) -> Option<Rational> {
        None
    }

    fn add(&self, a: &Rational, b: &Rational) -> Rational {
        a + b
    }

    fn sub(&self, a: &Rational, b: &Rational) -> Rational {
        a - b
    }

    fn mul(&self, a: &Rational, b: &Rational) -> Rational {
        a * b
    }

    fn div(&self, a: &Rational, b: &Rational) -> Option<Rational> {
        Some(a * &b.recip()?)
    }

    fn power(&self, base: &Rational, exponent: &Rational) -> Option<Rational> {
        if let Some((n, 2)) = exponent.to_words() {
            return base.square_root()?.pow(i32::try_from(n).ok()?);
        }
        let exponent = i32::try_from(exponent.to_integer()?).ok()?;
        let long = base.bits().saturating_mul(exponent.unsigned_abs().into());
        (long < MOST_BITS).then(|| base.pow(exponent))?
    }

    fn call(&self, function: Function, arguments: &[Rational]) -> Option<Rational> {
        match function {
            Function::Below => arguments.get(chosen(arguments[0].is_negative())).cloned(),
            _ => None,
        }
    }
}

impl Signed for Rationals {
    fn sign(&self, value: &Rational) -> Option<i32> {
        Some(match (value.is_zero(), value.is_negative()) {
            (true, _) => 0,
            (_, true) => -1,
            _ => 1,
        })
    }

    fn size(&self, value: &Rational) -> f64 {
        value.to_f64().abs()
    }
}

/// Balls: many digits with rigorous bounds.
#[derive(Clone, Debug)]
pub struct Balls(pub Precision);

impl Balls {
    /// All numbers within `2^exponent` of zero.
    pub fn around_zero(&self, exponent: i64) -> Ball {
        // a third is rounded; less itself it is 0 with twice that error
        let third = self
            .0
            .rational(&Rational::new(1, 3).unwrap_or(Rational::ONE));
        let zero = third.sub(&third, &self.0);
        // `magnitude` is a power of two above the radius, which is one itself
        let shift = exponent - (zero.magnitude() - 1);
        zero.mul(&Ball::dyadic(1, shift), &self.0)
    }
}

impl Arithmetic for Balls {
    type Number = Ball;

    fn rational(&self, value: &Rational) -> Ball {
        self.0.rational(value)
    }

    fn pi(&self) -> Option<Ball> {
        Some(self.0.pi())
    }

    fn add(&self, a: &Ball, b: &Ball) -> Ball {
        a.add(b, &self.0)
    }

    fn sub(&self, a: &Ball, b: &Ball) -> Ball {
        a.sub(b, &self.0)
    }

    fn mul(&self, a: &Ball, b: &Ball) -> Ball {
        a.mul(b, &self.0)
    }

    fn div(&self, a: &Ball, b: &Ball) -> Option<Ball> {
        a.div(b, &self.0)
    }

    fn power(&self, base: &Ball, exponent: &Rational) -> Option<Ball> {
        base.power(exponent, &self.0)
    }

    fn call(&self, function: Function, arguments: &[Ball]) -> Option<Ball> {
        match function {
            Function::Elementary(function) => arguments[0].function(function, &self.0),
            Function::Atan2 => arguments[0].atan2(&arguments[1], &self.0),
            Function::Below => {
                let negative = arguments[0].sign()? < 0;
                arguments.get(chosen(negative)).cloned()
            }
            Function::Stumpff(_) | Function::Phi(_) | Function::Own(_) => None,
        }
    }
}

impl Signed for Balls {
    fn sign(&self, value: &Ball) -> Option<i32> {
        value.sign()
    }

    fn size(&self, value: &Ball) -> f64 {
        value.to_f64().abs()
    }
}

/// Degrees of polynomials, from above: a sum has the larger one, a product their sum.
#[derive(Clone, Copy, Debug)]
pub struct Degrees;

impl Arithmetic for Degrees {
    type Number = u32;

    fn rational(&self, _: &Rational) -> u32 {
        0
    }

    fn pi(&self) -> Option<u32> {
        Some(0)
    }

    fn add(&self, a: &u32, b: &u32) -> u32 {
        *a.max(b)
    }

    fn sub(&self, a: &u32, b: &u32) -> u32 {
        *a.max(b)
    }

    fn mul(&self, a: &u32, b: &u32) -> u32 {
        a.saturating_add(*b)
    }

    fn div(&self, a: &u32, b: &u32) -> Option<u32> {
        (*b == 0).then_some(*a)
    }

    fn power(&self, base: &u32, exponent: &Rational) -> Option<u32> {
        match exponent.to_integer() {
            _ if *base == 0 => Some(0),
            Some(power) => base.checked_mul(u32::try_from(power).ok()?),
            None => None,
        }
    }

    fn call(&self, _: Function, arguments: &[u32]) -> Option<u32> {
        arguments.iter().all(|degree| *degree == 0).then_some(0)
    }
}
