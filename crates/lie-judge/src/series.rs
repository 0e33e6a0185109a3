//! Power series in time.

use std::rc::Rc;

use crate::functions::slope;
use crate::number::Number;
use crate::rounded::power;
use lie_core::Elementary;

/// Terms of a series.
pub const TERMS: usize = 16;

/// A power series in time, cut off.
#[derive(Clone, Debug)]
pub struct Series(Rc<[f64]>);

impl Series {
    /// The series with these coefficients.
    pub fn new(of: impl Fn(usize) -> f64) -> Self {
        Self((0..TERMS).map(of).collect())
    }

    /// A number that does not change.
    pub fn constant(value: f64) -> Self {
        Self::new(|k| if k == 0 { value } else { 0.0 })
    }

    /// What belongs to a power of the time.
    pub fn coefficient(&self, degree: usize) -> f64 {
        self.0[degree]
    }

    /// The derivative by the time, of which the last term is not known.
    fn derivative(&self) -> Self {
        let next = |k: usize| self.0.get(k + 1).map_or(0.0, |next| (k + 1) as f64 * next);
        Self::new(next)
    }

    /// The series with this derivative.
    fn integral(&self, first: f64) -> Self {
        let sum = |k: usize| match k {
            0 => first,
            _ => self.0[k - 1] / k as f64,
        };
        Self::new(sum)
    }

    /// Sine and cosine, or those of hyperbolic kind, or twice the exponential: `s' = c x'`, `c' = sign s x'`.
    fn pair(&self, sine: f64, cosine: f64, sign: f64) -> (Self, Self) {
        let (mut s, mut c) = (vec![sine], vec![cosine]);
        for k in 1..TERMS {
            let sum = |other: &[f64]| {
                let terms = (1..=k).map(|j| j as f64 * self.0[j] * other[k - j]);
                terms.sum::<f64>() / k as f64
            };
            let (next_s, next_c) = (sum(&c), sign * sum(&s));
            s.push(next_s);
            c.push(next_c);
        }
        (Self(s.into()), Self(c.into()))
    }
}

/// The operations of [`Number`].
impl Series {
    pub(super) fn add(&self, other: &Self) -> Self {
        Self::new(|k| self.0[k] + other.0[k])
    }
    pub(super) fn neg(&self) -> Self {
        Self::new(|k| -self.0[k])
    }
    pub(super) fn mul(&self, other: &Self) -> Self {
        Self::new(|k| (0..=k).map(|j| self.0[j] * other.0[k - j]).sum())
    }
    pub(super) fn div(&self, other: &Self) -> Self {
        let mut made: Vec<f64> = Vec::new();
        for k in 0..TERMS {
            let taken: f64 = (0..k).map(|j| made[j] * other.0[k - j]).sum();
            made.push((self.0[k] - taken) / other.0[0]);
        }
        Self(made.into())
    }
    pub(super) fn call(&self, function: Elementary) -> Self {
        let x = self.0[0];
        let first = function.evaluate(x);
        match function {
            Elementary::Exp => self.pair(first, first, 1.0).0,
            Elementary::Sin => self.pair(x.sin(), x.cos(), -1.0).0,
            Elementary::Cos => self.pair(x.sin(), x.cos(), -1.0).1,
            Elementary::Sinh => self.pair(x.sinh(), x.cosh(), 1.0).0,
            Elementary::Cosh => self.pair(x.sinh(), x.cosh(), 1.0).1,
            Elementary::Tan => {
                let (sine, cosine) = self.pair(x.sin(), x.cos(), -1.0);
                sine.div(&cosine)
            }
            Elementary::Tanh => {
                let (sine, cosine) = self.pair(x.sinh(), x.cosh(), 1.0);
                sine.div(&cosine)
            }
            Elementary::Cbrt if x < 0.0 => self.neg().power(1.0 / 3.0).neg(),
            Elementary::Cbrt => self.power(1.0 / 3.0),
            // the slope is one of the argument alone
            _ => {
                let unknown = Number::rounded(f64::NAN, 0.0);
                let slope = slope(function, &Number::Series(self.clone()), &unknown).series();
                slope.mul(&self.derivative()).integral(first)
            }
        }
    }
    pub(super) fn atan2(&self, other: &Self) -> Self {
        // (x y' - y x')/(x^2 + y^2), integrated
        let (y, x) = (self, other);
        let rise = x.mul(&y.derivative()).add(&y.mul(&x.derivative()).neg());
        let slope = rise.div(&x.mul(x).add(&y.mul(y)));
        slope.integral(y.0[0].atan2(x.0[0]))
    }
    pub(super) fn power(&self, exponent: f64) -> Self {
        let first = power(self.0[0], exponent);
        // x (x^p)' = p x^p x'
        let mut made = vec![first];
        for k in 1..TERMS {
            let terms = (1..=k).map(|j| {
                let weight = exponent * j as f64 - (k - j) as f64;
                weight * self.0[j] * made[k - j]
            });
            let sum: f64 = terms.sum();
            made.push(sum / (k as f64 * self.0[0]));
        }
        Self(made.into())
    }
}
