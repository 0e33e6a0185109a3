//! Truncated power series: Taylor coefficients of everything that is computed, by the plain rules.

use super::{Pack, Scalar};
use crate::functions::{Curve, Elementary, Numbers, Quadratic, Rules, Words};
use crate::recurrence::MOST_ORDERS;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// `sum_k terms_k t^k`, k below a length. What has one term is a constant; of anything else the terms from the length on
/// are not known, and all numbers of a computation that are not constants have the same length.
///
/// Masks and comparisons look at the constant term, so that a computation over series takes the branches of one over
/// numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truncated<S> {
    terms: [S; MOST_ORDERS + 1],
    length: usize,
}

impl<S: Scalar> Default for Truncated<S> {
    fn default() -> Self {
        Self::constant_of(S::zero())
    }
}

impl<S: Scalar> Truncated<S> {
    /// A constant.
    pub fn constant_of(value: S) -> Self {
        Self::from_fn(1, |_| value)
    }

    /// The series with these coefficients, at least one and at most [`MOST_ORDERS`] + 1.
    pub fn from_fn(length: usize, coefficient: impl Fn(usize) -> S) -> Self {
        let mut terms = [S::zero(); MOST_ORDERS + 1];
        for (k, term) in terms[..length].iter_mut().enumerate() {
            *term = coefficient(k);
        }
        Self { terms, length }
    }

    /// The coefficient of `t^k`, 0 beyond those that there are.
    pub fn coefficient(&self, k: usize) -> S {
        self.terms[k]
    }

    /// The series whose coefficients follow from those before them, from its constant term.
    fn recursive(length: usize, first: S, next: impl Fn(&[S], usize) -> S) -> Self {
        let mut series = Self::from_fn(length, |_| S::zero());
        series.terms[0] = first;
        for k in 1..length {
            series.terms[k] = next(&series.terms[..k], k);
        }
        series
    }

    /// `t d/dt`.
    fn slope(&self) -> Self {
        Self::from_fn(self.length, |k| S::from_f64(k as f64) * self.terms[k])
    }

    /// The series with a constant term whose `t d/dt` is given.
    fn integral(first: S, slope: &Self) -> Self {
        Self::from_fn(slope.length, |k| match k {
            0 => first,
            _ => slope.terms[k] / S::from_f64(k as f64),
        })
    }

    /// The series y with `x y' = c y x'` from its constant term: `y_k = sum_(0<j<=k) (c j - (k - j)) x_j y_(k-j) / (k x_0)`.
    fn power(&self, first: S, c: S) -> Self {
        let x = &self.terms;
        Self::recursive(self.length, first, |y, k| {
            let mut sum = S::zero();
            for j in 1..=k {
                let weight = c * S::from_f64(j as f64) - S::from_f64((k - j) as f64);
                sum += weight * x[j] * y[k - j];
            }
            sum / (S::from_f64(k as f64) * x[0])
        })
    }

    /// Two series y, z with `y' = a z x'` and `z' = b y x'`: sines and cosines.
    fn pair(&self, first: S, second: S, [a, b]: [f64; 2]) -> (Self, Self) {
        let slope = self.slope();
        let mut y = Self::from_fn(self.length, |_| first);
        let mut z = Self::from_fn(self.length, |_| second);
        for k in 1..self.length {
            let (mut of_y, mut of_z) = (S::zero(), S::zero());
            for j in 1..=k {
                of_y += slope.terms[j] * z.terms[k - j];
                of_z += slope.terms[j] * y.terms[k - j];
            }
            let k_inverse = S::ratio(1.0, k as f64);
            y.terms[k] = S::from_f64(a) * of_y * k_inverse;
            z.terms[k] = S::from_f64(b) * of_z * k_inverse;
        }
        (y, z)
    }
}

/// `sum_(1 <= j <= k) u_j v_(k-j)`, as far as u and v go.
fn sum<S: Scalar>(u: &[S], v: &[S], k: usize) -> S {
    let mut sum = S::zero();
    for (j, &factor) in u.iter().enumerate().take(k + 1).skip(1) {
        if let Some(&other) = v.get(k - j) {
            sum += factor * other;
        }
    }
    sum
}

/// The series of a function of a series, from its constant term.
struct Composed<S> {
    x: Truncated<S>,
    first: S,
}

impl<S: Scalar> Composed<S> {
    /// Sine and cosine.
    fn pair(&self, curve: Curve) -> (Truncated<S>, Truncated<S>) {
        let at_zero = |function: Elementary| function.apply(self.x.terms[0]);
        let sign = match curve {
            Curve::Circle => -1.0,
            Curve::Hyperbola => 1.0,
        };
        let (sine, cosine) = (at_zero(curve.sine()), at_zero(curve.cosine()));
        self.x.pair(sine, cosine, [1.0, sign])
    }

    /// The series of a function that differs from this one by a constant.
    fn shifted(&self, series: &Truncated<S>) -> Truncated<S> {
        Truncated::from_fn(self.x.length, |k| match k {
            0 => self.first,
            _ => series.terms[k],
        })
    }
}

impl<S: Scalar> Rules for Composed<S> {
    type Words = Numbers<Truncated<S>>;
    type Answer = Truncated<S>;

    fn integral(
        self,
        slope: impl FnOnce(&mut Self::Words, &Truncated<S>) -> Truncated<S>,
    ) -> Truncated<S> {
        let y = slope(&mut Numbers::default(), &self.x);
        let x = self.x.slope();
        let (x, y) = (&x.terms[..x.length], &y.terms[..y.length]);
        Truncated::from_fn(self.x.length, |k| match k {
            0 => self.first,
            _ => sum(x, y, k) / S::from_f64(k as f64),
        })
    }
    fn exponential(self) -> Truncated<S> {
        let slope = self.x.slope();
        let slope = &slope.terms[..self.x.length];
        Truncated::recursive(self.x.length, self.first, |y, k| {
            sum(slope, y, k) / S::from_f64(k as f64)
        })
    }
    fn sine(self, curve: Curve) -> Truncated<S> {
        self.pair(curve).0
    }
    fn cosine(self, curve: Curve) -> Truncated<S> {
        self.pair(curve).1
    }
    fn tangent(self, curve: Curve) -> Truncated<S> {
        let (sine, cosine) = self.pair(curve);
        self.shifted(&(sine / cosine))
    }
    fn cube_root(self) -> Truncated<S> {
        self.x.power(self.first, S::ratio(1.0, 3.0))
    }
    fn inverse(self, w: Quadratic) -> Truncated<S> {
        let w = Numbers::default().quadratic(w, &self.x);
        Truncated::integral(self.first, &(self.x.slope() / w))
    }
    fn inverse_root(self, sign: i32, w: Quadratic) -> Truncated<S> {
        let w = match w {
            Quadratic::OneMinusSquare => Truncated::one() - self.x * self.x,
            other => Numbers::default().quadratic(other, &self.x),
        };
        let slope = self.x.slope() / w.sqrt();
        Truncated::integral(self.first, &if sign < 0 { -slope } else { slope })
    }
}

macro_rules! functions {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal {
        rule: $rule:ident $form:tt, $($facts:tt)*
    })+) => {
        $(fn $name(self) -> Self {
            Composed { x: self, first: self.terms[0].$name() }.$rule $form
        })+
    };
}

impl<S: Scalar> Add for Truncated<S> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let length = self.length.max(other.length);
        Self::from_fn(length, |k| self.terms[k] + other.terms[k])
    }
}

impl<S: Scalar> Sub for Truncated<S> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let length = self.length.max(other.length);
        Self::from_fn(length, |k| self.terms[k] - other.terms[k])
    }
}

impl<S: Scalar> Mul for Truncated<S> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (u, v) = (&self.terms[..self.length], &other.terms[..other.length]);
        Self::from_fn(self.length.max(other.length), |k| {
            let first = v.get(k).map_or(S::zero(), |&v| u[0] * v);
            first + sum(u, v, k)
        })
    }
}

impl<S: Scalar> Div for Truncated<S> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl)]
    /// `q_0 = u_0/v_0`, `q_k = (u_k - sum_(0<j<=k) v_j q_(k-j))/v_0`
    fn div(self, other: Self) -> Self {
        let length = self.length.max(other.length);
        let v = &other.terms[..other.length];
        Self::recursive(length, self.terms[0] / v[0], |q, k| {
            (self.terms[k] - sum(v, q, k)) / v[0]
        })
    }
}

impl<S: Scalar> Neg for Truncated<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::from_fn(self.length, |k| -self.terms[k])
    }
}

macro_rules! assign {
    ($($trait:ident $assign:ident $method:ident),*) => {$(
        impl<S: Scalar> $trait for Truncated<S> {
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}
assign!(AddAssign add_assign add, SubAssign sub_assign sub, MulAssign mul_assign mul, DivAssign div_assign div);

impl<S: Scalar> Scalar for Truncated<S> {
    type Lane = Truncated<S::Lane>;
    type Mask = S::Mask;
    type Wide = Pack<Self>;
    const LANES: usize = S::LANES;
    const DERIVATIVES: u32 = S::DERIVATIVES;
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
        Self::from_fn(lane.length, |k| S::splat(lane.terms[k]))
    }
    fn lane(self, index: usize) -> Self::Lane {
        Truncated::from_fn(self.length, |k| self.terms[k].lane(index))
    }
    fn with_lane(self, index: usize, lane: Self::Lane) -> Self {
        let length = self.length.max(lane.length);
        Self::from_fn(length, |k| self.terms[k].with_lane(index, lane.terms[k]))
    }
    fn to_f64(self) -> f64 {
        self.terms[0].to_f64()
    }
    fn gather(numbers: [Self; 8]) -> Pack<Self> {
        Pack(numbers)
    }
    fn scatter(wide: Pack<Self>) -> [Self; 8] {
        wide.0
    }
    fn abs(self) -> Self {
        Self::select(self.terms[0].less(S::zero()), -self, self)
    }
    /// `y^2 = x`: `y_k = (x_k - sum_(0<j<k) y_j y_(k-j))/(2 y_0)`
    fn sqrt(self) -> Self {
        let root = self.terms[0].sqrt();
        Self::recursive(self.length, root, |y, k| {
            (self.terms[k] - sum(y, y, k)) / (root + root)
        })
    }
    crate::elementary_functions!(functions);
    fn atan2(self, x: Self) -> Self {
        let slope = (x * self.slope() - self * x.slope()) / (x * x + self * self);
        Self::integral(self.terms[0].atan2(x.terms[0]), &slope)
    }
    /// A constant power; `exp(c log x)` of one that varies.
    fn powf(self, exponent: Self) -> Self {
        if exponent.length > 1 {
            return (exponent * self.log()).exp();
        }
        let c = exponent.terms[0];
        self.power(self.terms[0].powf(c), c)
    }
    fn max(self, other: Self) -> Self {
        let (one, two) = (self.terms[0], other.terms[0]);
        let first = two.less_equal(one) | !one.less_equal(one);
        Self::select(first, self, other)
    }
    fn less(self, other: Self) -> S::Mask {
        self.terms[0].less(other.terms[0])
    }
    fn less_equal(self, other: Self) -> S::Mask {
        self.terms[0].less_equal(other.terms[0])
    }
    fn finite(self) -> S::Mask {
        self.terms[..self.length]
            .iter()
            .fold(self.terms[0].finite(), |all, term| all & term.finite())
    }
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        let length = yes.length.max(no.length);
        Self::from_fn(length, |k| S::select(mask, yes.terms[k], no.terms[k]))
    }
}
