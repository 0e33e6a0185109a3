//! The elementary functions of balls.

use super::{Ball, MAX_ARGUMENT, Precision, series};
use crate::exact::Rational;
use lie_core::Elementary;
use num_traits::Zero;

/// Halvings of the argument before the series of exp.
const EXP_HALVINGS: i64 = 8;
/// Halvings of the angle before the series of atan.
const ATAN_HALVINGS: u32 = 3;

macro_rules! functions {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        impl Ball {
            /// An elementary function, by the method of its name.
            pub fn function(&self, function: Elementary, precision: &Precision) -> Option<Self> {
                match function {
                    $(Elementary::$variant => self.$name(precision),)+
                }
            }
        }
    };
}
lie_core::elementary_functions!(functions);

impl Ball {
    /// Whether it is the number zero.
    pub(super) fn is_exact_zero(&self) -> bool {
        self.mid.is_zero() && self.radius.is_zero()
    }

    /// The argument of a function that needs one of moderate size.
    fn moderate(&self) -> Option<&Self> {
        let narrow = self.radius.bits() as i64 + self.exponent <= 0;
        (self.magnitude() <= MAX_ARGUMENT && narrow).then_some(self)
    }

    /// The exponential.
    pub fn exp(&self, precision: &Precision) -> Option<Self> {
        let x = self.moderate()?;
        let n = x.div(&precision.log_two, precision)?.nearest()?;
        let shift = precision.log_two.mul(&Ball::integer(n), precision);
        let rest = x.sub(&shift, precision).shifted(-EXP_HALVINGS);
        let odd = series::factorial(&rest, 1, 1, precision)?;
        let even = series::factorial(&rest, 0, 1, precision)?;
        let mut value = odd.add(&even, precision);
        for _ in 0..EXP_HALVINGS {
            value = value.mul(&value, precision);
        }
        Some(value.shifted(n))
    }

    /// The natural logarithm; all members must be positive.
    pub fn log(&self, precision: &Precision) -> Option<Self> {
        if self.sign()? <= 0 {
            return None;
        }
        // x = y 2^n with y in [3/4, 3/2), log y = 2 artanh((y - 1)/(y + 1))
        let mut n = self.mid.bits() as i64 + self.exponent;
        let mut y = self.shifted(-n);
        let below = y.sub(&Ball::dyadic(3, -2), precision);
        if below.sign() == Some(-1) {
            n -= 1;
            y = y.shifted(1);
        }
        let one = Ball::integer(1);
        let ratio = y
            .sub(&one, precision)
            .div(&y.add(&one, precision), precision)?;
        if ratio.magnitude() > -1 {
            return None;
        }
        let value = series::odd_powers(&ratio, 1, precision)?.shifted(1);
        let shift = precision.log_two.mul(&Ball::integer(n), precision);
        Some(value.add(&shift, precision))
    }

    /// Sine and cosine.
    pub fn sin_cos(&self, precision: &Precision) -> Option<(Self, Self)> {
        let x = self.moderate()?;
        let quarter = precision.pi.shifted(-1);
        let n = x.div(&quarter, precision)?.nearest()?;
        let rest = x.sub(&quarter.mul(&Ball::integer(n), precision), precision);
        if rest.magnitude() > 1 {
            return None;
        }
        let sine = series::factorial(&rest, 1, -1, precision)?;
        let cosine = series::factorial(&rest, 0, -1, precision)?;
        Some(match n.rem_euclid(4) {
            0 => (sine, cosine),
            1 => (cosine, sine.neg()),
            2 => (sine.neg(), cosine.neg()),
            _ => (cosine.neg(), sine),
        })
    }

    /// Sine.
    pub fn sin(&self, precision: &Precision) -> Option<Self> {
        Some(self.sin_cos(precision)?.0)
    }

    /// Cosine.
    pub fn cos(&self, precision: &Precision) -> Option<Self> {
        Some(self.sin_cos(precision)?.1)
    }

    /// The tangent.
    pub fn tan(&self, precision: &Precision) -> Option<Self> {
        let (sine, cosine) = self.sin_cos(precision)?;
        sine.div(&cosine, precision)
    }

    /// The inverse tangent.
    pub fn atan(&self, precision: &Precision) -> Option<Self> {
        let one = Ball::integer(1);
        // atan x = sign(x) pi/2 - atan(1/x)
        if self.magnitude() > 1 {
            let sign = i64::from(self.sign()?);
            let inverse = self.recip(precision)?.atan(precision)?;
            let quarter = precision
                .pi
                .shifted(-1)
                .mul(&Ball::integer(sign), precision);
            return Some(quarter.sub(&inverse, precision));
        }
        let mut x = self.clone();
        for _ in 0..ATAN_HALVINGS {
            let root = one.add(&x.mul(&x, precision), precision).sqrt(precision)?;
            x = x.div(&one.add(&root, precision), precision)?;
        }
        let value = series::odd_powers(&x, -1, precision)?;
        Some(value.shifted(i64::from(ATAN_HALVINGS)))
    }

    /// The inverse sine; all members must be within (-1, 1).
    pub fn asin(&self, precision: &Precision) -> Option<Self> {
        let one = Ball::integer(1);
        if self.radius.is_zero() {
            let ends = [(1, one.clone()), (-1, one.neg())];
            for (sign, end) in ends {
                if self.sub(&end, precision).is_exact_zero() {
                    let quarter = precision.pi.shifted(-1);
                    return Some(quarter.mul(&Ball::integer(sign), precision));
                }
            }
        }
        // (1 - x)(1 + x) keeps its digits near the ends
        let (below, above) = (one.sub(self, precision), one.add(self, precision));
        let root = below.mul(&above, precision).sqrt(precision)?;
        self.div(&root, precision)?.atan(precision)
    }

    /// The inverse cosine, as the inverse sine.
    pub fn acos(&self, precision: &Precision) -> Option<Self> {
        Some(
            precision
                .pi
                .shifted(-1)
                .sub(&self.asin(precision)?, precision),
        )
    }

    /// The angle of the point (x, y); it must not be near the negative axis or the origin.
    pub fn atan2(&self, x: &Self, precision: &Precision) -> Option<Self> {
        if x.sign() == Some(1) {
            return self.div(x, precision)?.atan(precision);
        }
        if self.is_exact_zero() && x.sign() == Some(-1) {
            return Some(precision.pi());
        }
        let sign = self.sign().filter(|sign| *sign != 0)?;
        let quarter = precision
            .pi
            .shifted(-1)
            .mul(&Ball::integer(sign.into()), precision);
        let rest = x.div(self, precision)?.atan(precision)?;
        Some(quarter.sub(&rest, precision))
    }

    /// The cube root; of members of both signs there is none.
    pub fn cbrt(&self, precision: &Precision) -> Option<Self> {
        let third = Rational::new(1, 3)?;
        match self.sign()? {
            0 => Some(self.clone()),
            1 => self.power(&third, precision),
            _ => Some(self.neg().power(&third, precision)?.neg()),
        }
    }

    /// `log(1 + x)`; all members must be above -1.
    pub fn log1p(&self, precision: &Precision) -> Option<Self> {
        // 2 artanh(x/(2 + x)) keeps the digits of a small x
        let ratio = self.div(&self.add(&Ball::integer(2), precision), precision);
        match ratio.filter(|ratio| ratio.magnitude() <= -1) {
            Some(ratio) => Some(series::odd_powers(&ratio, 1, precision)?.shifted(1)),
            None => self.add(&Ball::integer(1), precision).log(precision),
        }
    }

    /// `exp(x) - 1 = 2 sinh(x/2) exp(x/2)`
    pub fn expm1(&self, precision: &Precision) -> Option<Self> {
        let half = self.shifted(-1);
        let (sine, _) = half.sinh_cosh(precision)?;
        Some(sine.mul(&half.exp(precision)?, precision).shifted(1))
    }

    /// The inverse hyperbolic sine, for x that are not negative `log1p(x + x^2/(1 + sqrt(1 + x^2)))`.
    pub fn asinh(&self, precision: &Precision) -> Option<Self> {
        if self.sign() == Some(-1) {
            return Some(self.neg().asinh(precision)?.neg());
        }
        let one = Ball::integer(1);
        let square = self.mul(self, precision);
        let root = one.add(&square, precision).sqrt(precision)?;
        let rest = square.div(&one.add(&root, precision), precision)?;
        self.add(&rest, precision).log1p(precision)
    }

    /// The inverse hyperbolic cosine, `log1p(y + sqrt(y (y + 2)))` of `y = x - 1`; no member may be below 1.
    pub fn acosh(&self, precision: &Precision) -> Option<Self> {
        let y = self.sub(&Ball::integer(1), precision);
        let square = y.mul(&y.add(&Ball::integer(2), precision), precision);
        let root = (y.sign()? >= 0).then(|| square.sqrt(precision))??;
        y.add(&root, precision).log1p(precision)
    }

    /// The inverse hyperbolic tangent; all members must be within (-1, 1).
    pub fn atanh(&self, precision: &Precision) -> Option<Self> {
        if self.magnitude() <= -1 {
            return series::odd_powers(self, 1, precision);
        }
        let one = Ball::integer(1);
        let below = one.sub(self, precision);
        if below.sign()? <= 0 {
            return None;
        }
        let ratio = one.add(self, precision).div(&below, precision)?;
        Some(ratio.log(precision)?.shifted(-1))
    }

    /// Hyperbolic sine and cosine.
    pub fn sinh_cosh(&self, precision: &Precision) -> Option<(Self, Self)> {
        // e^x - e^-x would lose the digits of a small x
        if self.magnitude() <= 0 {
            let odd = series::factorial(self, 1, 1, precision)?;
            return Some((odd, series::factorial(self, 0, 1, precision)?));
        }
        let power = self.exp(precision)?;
        let inverse = power.recip(precision)?;
        let (difference, sum) = (
            power.sub(&inverse, precision),
            power.add(&inverse, precision),
        );
        Some((difference.shifted(-1), sum.shifted(-1)))
    }

    /// Hyperbolic sine.
    pub fn sinh(&self, precision: &Precision) -> Option<Self> {
        Some(self.sinh_cosh(precision)?.0)
    }

    /// Hyperbolic cosine.
    pub fn cosh(&self, precision: &Precision) -> Option<Self> {
        Some(self.sinh_cosh(precision)?.1)
    }

    /// The hyperbolic tangent.
    pub fn tanh(&self, precision: &Precision) -> Option<Self> {
        let (sine, cosine) = self.sinh_cosh(precision)?;
        sine.div(&cosine, precision)
    }
}
