//! A solution of the declared equations, by their Taylor series in time.
//!
//! The coefficients follow from each other: `(k + 1) mu_(k+1)` is the coefficient of degree k of `f(mu(t))`, with the
//! gradient of H by jets over series and the brackets as they were declared.

use crate::functions::slope;
use crate::number::Number;
use crate::system::Declared;
use lie_core::Elementary;

/// Terms of a series.
const TERMS: usize = 16;
/// Steps, and operations on coefficients, that are worth it.
const STEPS: usize = 400;
const WORK: f64 = 4e8;

/// A power series in time, cut off.
#[derive(Clone, Debug)]
struct Series(Vec<f64>);

impl Series {
    fn new(of: impl Fn(usize) -> f64) -> Self {
        Self((0..TERMS).map(of).collect())
    }

    /// The series of a function g of this one whose derivative is `h(g) x'`: `k g_k = sum_j j x_j h_(k-j)`, where
    /// `partner` gives the coefficient of h of some degree from the coefficients of g below it.
    fn chain(&self, first: f64, mut partner: impl FnMut(&[f64]) -> Vec<f64>) -> Self {
        let mut made = vec![first];
        for k in 1..TERMS {
            let slope = partner(&made);
            let terms = (1..=k).map(|j| j as f64 * self.0[j] * slope[k - j]);
            made.push(terms.sum::<f64>() / k as f64);
        }
        Self(made)
    }

    /// Sine and cosine, or those of hyperbolic kind: `s' = c x'`, `c' = sign s x'`.
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
        (Self(s), Self(c))
    }

    /// The series of which the derivative by time is the product of x' and `slope`.
    fn integral(&self, first: f64, slope: &Self) -> Self {
        self.chain(first, |_| slope.0.clone())
    }
}

impl Number for Series {
    fn rounded(value: f64, _units: f64) -> Self {
        Self::new(|k| if k == 0 { value } else { 0.0 })
    }
    fn value(&self) -> f64 {
        self.0[0]
    }
    fn add(&self, other: &Self) -> Self {
        Self::new(|k| self.0[k] + other.0[k])
    }
    fn neg(&self) -> Self {
        Self::new(|k| -self.0[k])
    }
    fn mul(&self, other: &Self) -> Self {
        Self::new(|k| (0..=k).map(|j| self.0[j] * other.0[k - j]).sum())
    }
    fn div(&self, other: &Self) -> Self {
        let mut made: Vec<f64> = Vec::new();
        for k in 0..TERMS {
            let taken: f64 = (0..k).map(|j| made[j] * other.0[k - j]).sum();
            made.push((self.0[k] - taken) / other.0[0]);
        }
        Self(made)
    }
    fn call(&self, function: Elementary) -> Self {
        let x = self.0[0];
        let first = function.evaluate(x);
        match function {
            Elementary::Exp => self.chain(first, <[f64]>::to_vec),
            Elementary::Expm1 => self.chain(first, |made| {
                let mut power = made.to_vec();
                power[0] = x.exp();
                power
            }),
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
                let unknown = Self::rounded(f64::NAN, 0.0);
                self.integral(first, &slope(function, self, &unknown))
            }
        }
    }
    fn atan2(&self, other: &Self) -> Self {
        // (x y' - y x')/(x^2 + y^2), integrated
        let (y, x) = (self, other);
        let derivative = |s: &Self| {
            Self::new(|k| {
                if k + 1 < TERMS {
                    (k + 1) as f64 * s.0[k + 1]
                } else {
                    0.0
                }
            })
        };
        let rise = x.mul(&derivative(y)).sub(&y.mul(&derivative(x)));
        let slope = rise.div(&x.mul(x).add(&y.mul(y)));
        let first = y.0[0].atan2(x.0[0]);
        Self::new(|k| {
            if k == 0 {
                first
            } else {
                slope.0[k - 1] / k as f64
            }
        })
    }
    fn power(&self, exponent: f64) -> Self {
        let first = self.0[0].power(exponent);
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
        Self(made)
    }
}

/// The declared field over series.
fn field(declared: &Declared, mu: &[Series]) -> Vec<Series> {
    let gradient = declared.gradient(mu, |mu| declared.hamiltonian(mu, &[]));
    let rows = declared.poisson(mu);
    let row = |row: &Vec<Series>| Series::sum(row.iter().zip(&gradient).map(|(a, b)| a.mul(b)));
    let mut field: Vec<Series> = rows.iter().map(row).collect();
    let driven = declared.driven(mu, &[]).unwrap_or_default();
    for (slot, extra) in field.iter_mut().zip(&driven) {
        *slot = slot.add(extra);
    }
    field
}

/// The series of the solution from a state.
fn expand(declared: &Declared, start: &[f64]) -> Vec<Series> {
    let mut mu: Vec<Series> = start.iter().map(|&x| Series::rounded(x, 0.0)).collect();
    for k in 0..TERMS - 1 {
        let slope = field(declared, &mu);
        for (mu, slope) in mu.iter_mut().zip(&slope) {
            mu.0[k + 1] = slope.0[k] / (k + 1) as f64;
        }
    }
    mu
}

/// The state after a time, with the steps that it took; `None` where it is too much work, or no number.
pub(super) fn solution(declared: &Declared, start: &[f64], span: f64) -> Option<(Vec<f64>, usize)> {
    let n = start.len();
    let step_work = (TERMS * TERMS * TERMS * n * (declared.size() + n)) as f64;
    let mut state = start.to_vec();
    let mut done = 0.0;
    for step in 0..STEPS {
        if step as f64 * step_work > WORK {
            return None;
        }
        let series = expand(declared, &state);
        let size = state.iter().fold(0.0_f64, |m, x| f64::max(m, x.abs()));
        // the last two terms are to be round-off
        let radius = |k: usize| {
            let largest = series
                .iter()
                .fold(0.0_f64, |m, s| f64::max(m, s.0[k].abs()));
            (0.1 * f64::EPSILON * size / largest).powf(1.0 / k as f64)
        };
        let h = f64::min(radius(TERMS - 1), radius(TERMS - 2));
        let left = span.abs() - done;
        if h.is_nan() || h < 1e-9 * span.abs() {
            return None;
        }
        let taken = h.min(left);
        let time = taken.copysign(span);
        for (entry, series) in state.iter_mut().zip(&series) {
            let rest = series.0[1..]
                .iter()
                .rev()
                .fold(0.0, |sum, c| sum * time + c);
            *entry += rest * time;
        }
        if !state.iter().all(|x| x.is_finite()) {
            return None;
        }
        if taken == left {
            return Some((state, step + 1));
        }
        done += taken;
    }
    None
}
