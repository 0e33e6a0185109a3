//! The numbers of an interpretation: values with a bound of their round-off, power series in time, and derivatives of those.

use std::rc::Rc;

use crate::functions::slope;
use crate::rounded::Rounded;
use crate::series::Series;
use lie_core::Elementary;
use lie_symbolic::exact::Rational;

/// What an expression is evaluated over.
///
/// Directions of derivatives are counted from 1, the last one is the outermost. What does not vary in the direction of another number
/// is constant there, and has no slope to compute with.
#[derive(Clone, Debug)]
pub enum Number {
    /// A value with a bound.
    Rounded(Rounded),
    /// A function of the time.
    Series(Series),
    /// A number with its derivative along a direction, `v + d e`, `e^2 = 0`; both may vary in the directions before it.
    Jet(usize, Rc<(Number, Number)>),
}

/// A number and its derivative along a direction, if it varies there.
type Parts<'a> = (&'a Number, Option<&'a Number>);

impl Number {
    /// A constant of double precision, known to so many units of round-off of itself.
    pub fn rounded(value: f64, units: f64) -> Self {
        Self::Rounded(Rounded::new(value, units))
    }

    /// A number that is known to one unit in its last place.
    pub fn input(value: f64) -> Self {
        Self::rounded(value, 1.0)
    }

    /// An integer.
    pub fn integer(value: i32) -> Self {
        Self::rounded(f64::from(value), 0.0)
    }

    /// An exact constant.
    pub fn constant(value: &Rational) -> Self {
        let exact = value.is_integer() && value.to_f64().abs() < 2_f64.powi(53);
        Self::rounded(value.to_f64(), if exact { 0.0 } else { 1.0 })
    }

    /// This number as the variable of a direction that is new to it.
    pub fn variable(&self, direction: usize) -> Self {
        Self::jet(direction, self.clone(), Some(Self::integer(1)))
    }

    /// A number with a derivative, where it has one.
    fn jet(direction: usize, at: Self, slope: Option<Self>) -> Self {
        match slope {
            Some(slope) => Self::Jet(direction, Rc::new((at, slope))),
            None => at,
        }
    }

    /// The outermost direction in which it varies, 0 for none.
    pub fn direction(&self) -> usize {
        match self {
            Self::Jet(direction, _) => *direction,
            _ => 0,
        }
    }

    /// The number and its derivative along a direction that is not before its own.
    fn parts(&self, direction: usize) -> Parts<'_> {
        match self {
            Self::Jet(own, parts) if *own == direction => (&parts.0, Some(&parts.1)),
            _ => (self, None),
        }
    }

    /// The number without its derivative along the outermost direction.
    pub fn at(&self, direction: usize) -> Self {
        self.parts(direction).0.clone()
    }

    /// The derivative along the outermost direction, which is unknown where the value is.
    pub fn slope(&self, direction: usize) -> Self {
        match self.parts(direction).1 {
            _ if self.value().is_nan() => Self::rounded(f64::NAN, 0.0),
            Some(slope) => slope.clone(),
            None => Self::integer(0),
        }
    }

    /// The value with its bound, without derivatives.
    pub fn known(&self) -> Rounded {
        match self {
            Self::Rounded(rounded) => *rounded,
            Self::Series(series) => Rounded::new(series.coefficient(0), 0.0),
            Self::Jet(_, parts) => parts.0.known(),
        }
    }

    /// The value alone.
    pub fn value(&self) -> f64 {
        self.known().value
    }

    /// The function of the time that it is without derivatives.
    pub fn series(&self) -> Series {
        match self {
            Self::Series(series) => series.clone(),
            _ => Series::constant(self.value()),
        }
    }

    /// An operation on two numbers: on values, on series, and the derivative of its result from numbers and their derivatives.
    fn binary(
        &self,
        other: &Self,
        values: fn(&Rounded, &Rounded) -> Rounded,
        series: fn(&Series, &Series) -> Series,
        of: fn(&Self, &Self) -> Self,
        slope: fn(&Self, Parts, Parts) -> Option<Self>,
    ) -> Self {
        let direction = self.direction().max(other.direction());
        match (self, other) {
            (Self::Rounded(a), Self::Rounded(b)) => Self::Rounded(values(a, b)),
            _ if direction == 0 => Self::Series(series(&self.series(), &other.series())),
            _ => {
                let (a, b) = (self.parts(direction), other.parts(direction));
                let at = of(a.0, b.0);
                let slope = slope(&at, a, b);
                Self::jet(direction, at, slope)
            }
        }
    }

    /// `a + b`
    pub fn add(&self, other: &Self) -> Self {
        let slope = |_: &Self, (_, da): Parts, (_, db): Parts| plus(da.cloned(), db.cloned());
        self.binary(other, Rounded::add, Series::add, Self::add, slope)
    }

    /// `a b`
    pub fn mul(&self, other: &Self) -> Self {
        let slope = |_: &Self, (a, da): Parts, (b, db): Parts| {
            plus(da.map(|da| da.mul(b)), db.map(|db| a.mul(db)))
        };
        self.binary(other, Rounded::mul, Series::mul, Self::mul, slope)
    }

    /// `a/b`
    pub fn div(&self, other: &Self) -> Self {
        let slope = |at: &Self, (_, da): Parts, (b, db): Parts| {
            let rise = plus(da.cloned(), db.map(|db| at.mul(db).neg()));
            rise.map(|rise| rise.div(b))
        };
        self.binary(other, Rounded::div, Series::div, Self::div, slope)
    }

    /// `atan2(a, b)`
    pub fn atan2(&self, other: &Self) -> Self {
        let slope = |_: &Self, (y, dy): Parts, (x, dx): Parts| {
            let rise = plus(dy.map(|dy| x.mul(dy)), dx.map(|dx| y.mul(dx).neg()));
            let square = x.mul(x).add(&y.mul(y));
            rise.map(|rise| rise.div(&square))
        };
        self.binary(other, Rounded::atan2, Series::atan2, Self::atan2, slope)
    }

    /// `-a`
    pub fn neg(&self) -> Self {
        match self {
            Self::Rounded(rounded) => Self::Rounded(rounded.neg()),
            Self::Series(series) => Self::Series(series.neg()),
            Self::Jet(direction, parts) => {
                Self::jet(*direction, parts.0.neg(), Some(parts.1.neg()))
            }
        }
    }

    /// `a - b`
    pub fn sub(&self, other: &Self) -> Self {
        self.add(&other.neg())
    }

    /// An elementary function of one argument.
    pub fn call(&self, function: Elementary) -> Self {
        match self {
            Self::Rounded(rounded) => Self::Rounded(rounded.call(function)),
            Self::Series(series) => Self::Series(series.call(function)),
            Self::Jet(direction, parts) => {
                let (x, dx) = &**parts;
                let y = x.call(function);
                let dy = slope(function, x, &y).mul(dx);
                Self::jet(*direction, y, Some(dy))
            }
        }
    }

    /// `a^p` for a constant p.
    pub fn power(&self, exponent: f64) -> Self {
        match self {
            Self::Rounded(rounded) => Self::Rounded(rounded.power(exponent)),
            Self::Series(series) => Self::Series(series.power(exponent)),
            Self::Jet(direction, parts) => {
                let (x, dx) = &**parts;
                let slope = x.power(exponent - 1.0);
                let slope = slope.mul(&Self::rounded(exponent, 0.0));
                Self::jet(*direction, x.power(exponent), Some(slope.mul(dx)))
            }
        }
    }

    /// The sum over an iterator.
    pub fn sum(terms: impl IntoIterator<Item = Self>) -> Self {
        let terms = terms.into_iter();
        terms.fold(Self::integer(0), |sum, term| sum.add(&term))
    }
}

/// A sum of two derivatives, either of which may be absent.
fn plus(a: Option<Number>, b: Option<Number>) -> Option<Number> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.add(&b)),
        (a, b) => a.or(b),
    }
}
