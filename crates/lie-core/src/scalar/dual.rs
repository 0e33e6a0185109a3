//! Dual numbers: derivatives along one direction, exact to round-off.

use super::Scalar;
use crate::functions::{Curve, Elementary, Quadratic, Rules, Slope, Words};
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// `value + derivative * eps` with `eps^2 = 0`: carries the derivative of every computed number
/// along one direction.
///
/// Masks, comparisons and [`Scalar::select`] look at the value alone, so that a computation over
/// dual numbers takes the same branches; only norms ([`Scalar::magnitude`]) see the derivative. Where an iteration measures its error by such
/// a norm, choose derivatives of the size of the values.
///
/// ```
/// use lie_core::Dual;
/// let x = Dual::variable(2.0_f64);
/// assert_eq!((x * x * x).derivative, 12.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dual<S> {
    /// The number itself.
    pub value: S,
    /// Its derivative along the direction.
    pub derivative: S,
}

impl<S: Scalar> Dual<S> {
    /// A number and its derivative.
    #[inline]
    pub fn new(value: S, derivative: S) -> Self {
        Self { value, derivative }
    }

    /// A number that does not depend on the direction.
    #[inline]
    pub fn constant_of(value: S) -> Self {
        Self::new(value, S::zero())
    }

    /// The variable of differentiation: derivative 1.
    #[inline]
    pub fn variable(value: S) -> Self {
        Self::new(value, S::one())
    }

    /// A function's value and its slope, by the chain rule.
    #[inline]
    fn chain(self, value: S, slope: S) -> Self {
        Self::new(value, slope * self.derivative)
    }
}

impl<S: Scalar> Add for Dual<S> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.value + other.value, self.derivative + other.derivative)
    }
}

impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.value - other.value, self.derivative - other.derivative)
    }
}

impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.value * other.value,
            self.value * other.derivative + self.derivative * other.value,
        )
    }
}

impl<S: Scalar> Div for Dual<S> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self::new(
            value,
            (self.derivative - value * other.derivative) / other.value,
        )
    }
}

impl<S: Scalar> Neg for Dual<S> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.value, -self.derivative)
    }
}

macro_rules! assign {
    ($($trait:ident $assign:ident $method:ident),*) => {$(
        impl<S: Scalar> $trait for Dual<S> {
            #[inline]
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}
assign!(AddAssign add_assign add, SubAssign sub_assign sub, MulAssign mul_assign mul, DivAssign div_assign div);

/// Values with slopes by the rules of the functions.
macro_rules! functions {
    ($name:ident sine(Curve::Circle)) => {
        fn $name(self) -> Self {
            let (sine, cosine) = self.value.sin_cos();
            self.chain(sine, cosine)
        }
    };
    ($name:ident cosine(Curve::Circle)) => {
        fn $name(self) -> Self {
            let (sine, cosine) = self.value.sin_cos();
            self.chain(cosine, -sine)
        }
    };
    ($name:ident $rule:ident $form:tt) => {
        fn $name(self) -> Self {
            let (x, y) = (self.value, self.value.$name());
            self.chain(y, Slope { x, y }.$rule $form)
        }
    };
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal {
        rule: $rule:ident $form:tt, $($facts:tt)*
    })+) => {
        $(functions!($name $rule $form);)+
    };
}

impl<S: Scalar> Scalar for Dual<S> {
    type Lane = Dual<S::Lane>;
    type Mask = S::Mask;
    type Wide = Dual<S::Wide>;
    const LANES: usize = S::LANES;
    const DERIVATIVES: u32 = S::DERIVATIVES + 1;
    const LOOPS: bool = S::LOOPS;

    fn zero() -> Self {
        Self::constant_of(S::zero())
    }
    fn one() -> Self {
        Self::constant_of(S::one())
    }
    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::constant_of(S::ratio(numerator, denominator))
    }
    fn constant(high: f64, low: f64) -> Self {
        Self::constant_of(S::constant(high, low))
    }
    fn from_f64(value: f64) -> Self {
        Self::constant_of(S::from_f64(value))
    }
    fn epsilon() -> Self {
        Self::constant_of(S::epsilon())
    }
    fn splat(lane: Self::Lane) -> Self {
        Self::new(S::splat(lane.value), S::splat(lane.derivative))
    }
    fn lane(self, index: usize) -> Self::Lane {
        Dual::new(self.value.lane(index), self.derivative.lane(index))
    }
    fn with_lane(self, index: usize, lane: Self::Lane) -> Self {
        Self::new(
            self.value.with_lane(index, lane.value),
            self.derivative.with_lane(index, lane.derivative),
        )
    }
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }
    fn gather(numbers: [Self; 8]) -> Self::Wide {
        Dual::new(
            S::gather(numbers.map(|x| x.value)),
            S::gather(numbers.map(|x| x.derivative)),
        )
    }
    fn exchange<const D: usize>(wide: Self::Wide) -> Self::Wide {
        Dual::new(
            S::exchange::<D>(wide.value),
            S::exchange::<D>(wide.derivative),
        )
    }
    fn scatter(wide: Self::Wide) -> [Self; 8] {
        let (values, derivatives) = (S::scatter(wide.value), S::scatter(wide.derivative));
        core::array::from_fn(|k| Self::new(values[k], derivatives[k]))
    }
    fn abs(self) -> Self {
        Self::select(self.value.less(S::zero()), -self, self)
    }
    fn magnitude(self) -> Self {
        Self::constant_of(self.value.magnitude().max(self.derivative.magnitude()))
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, S::one() / (root + root))
    }
    crate::elementary_functions!(functions);
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        Self::new(
            self.value.atan2(x.value),
            (x.value * self.derivative - self.value * x.derivative) / square,
        )
    }
    fn powf(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        let base = exponent.value * self.value.powf(exponent.value - S::one()) * self.derivative;
        // log of a negative base is not a number: only a varying exponent may see it
        let size = exponent.derivative.abs();
        let varying = self.value.log() * value * exponent.derivative;
        let varying = S::select(size.less_equal(S::zero()), S::zero(), varying);
        Self::new(value, base + varying)
    }
    fn max(self, other: Self) -> Self {
        let first = other.value.less_equal(self.value) | !self.value.less_equal(self.value);
        Self::select(first, self, other)
    }
    fn less(self, other: Self) -> S::Mask {
        self.value.less(other.value)
    }
    fn less_equal(self, other: Self) -> S::Mask {
        self.value.less_equal(other.value)
    }
    fn finite(self) -> S::Mask {
        self.value.finite() & self.derivative.finite()
    }
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        Self::new(
            S::select(mask, yes.value, no.value),
            S::select(mask, yes.derivative, no.derivative),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::Domain;

    type Function<'a> = Box<dyn Fn(Dual<f64>) -> Dual<f64> + 'a>;

    /// Every function against a central difference, whose error is about 1e-10.
    #[test]
    fn slopes_agree_with_differences() {
        let others: [fn(Dual<f64>) -> Dual<f64>; 8] = [
            Scalar::abs,
            Scalar::sqrt,
            |x| (-x).cbrt(),
            |x| x.atan2(Dual::one() + x * x),
            |x| x.powf(Dual::from_f64(2.5)),
            |x| x.powf(x),
            |x| Dual::one() / (x * x - x),
            |x| (-x).max(x * x * x),
        ];
        let elementary = Elementary::ALL.iter().map(|function| {
            let shift = f64::from(u8::from(function.domain() == Domain::FromOne));
            move |x: Dual<f64>| function.apply(x + Dual::from_f64(shift))
        });
        let others = others.iter().map(|function| Box::new(function) as Function);
        let functions = elementary.map(|function| Box::new(function) as Function);
        for (index, function) in functions.chain(others).enumerate() {
            for x in [0.3, 0.7] {
                let h = 1e-5;
                let value = |x: f64| function(Dual::constant_of(x)).value;
                let difference = (value(x + h) - value(x - h)) / (2.0 * h);
                let slope = function(Dual::variable(x)).derivative;
                assert!(
                    (slope - difference).abs() < 1e-8 * (1.0 + slope.abs()),
                    "function {index} at {x}: {slope} against {difference}"
                );
            }
        }
        assert_eq!(Dual::variable(-2.0_f64).abs().derivative, -1.0);
        assert_eq!(
            Dual::variable(-2.0_f64)
                .powf(Dual::from_f64(3.0))
                .derivative,
            12.0
        );
    }

    #[test]
    fn magnitude_sees_the_derivative() {
        assert_eq!(Dual::new(1.0_f64, -3.0).magnitude().value, 3.0);
        assert_eq!(Dual::new(1.0_f64, -3.0).abs().value, 1.0);
        assert!(!Dual::new(1.0_f64, f64::NAN).finite());
    }
}
