//! A solution of the declared equations, by their Taylor series in time.
//!
//! The coefficients follow from each other: `(k + 1) mu_(k+1)` is the coefficient of degree k of `f(mu(t))`, with the
//! gradient of H by jets over series and the brackets as they were declared.

use crate::derivatives::gradient;
use crate::linear::{add_to, times};
use crate::number::Number;
use crate::series::{Series, TERMS};
use crate::system::Declared;

/// Steps, and operations on coefficients, that are worth it.
const STEPS: usize = 400;
const WORK: f64 = 4e8;

/// The declared field over series.
fn field(declared: &Declared, mu: &[Number]) -> Vec<Number> {
    let slopes = gradient(mu, |mu| declared.hamiltonian(mu, &[]));
    let mut field = times(&declared.poisson(mu), &slopes);
    let driven = declared.driven(mu, &[]).unwrap_or_default();
    add_to(&mut field, &driven);
    field
}

/// The coefficients of the solution from a state, degree by degree for each coordinate.
fn expand(declared: &Declared, start: &[f64]) -> Vec<Vec<f64>> {
    let mut mu: Vec<Vec<f64>> = start.iter().map(|&x| vec![x]).collect();
    for k in 1..TERMS {
        let series = |known: &Vec<f64>| Series::new(|k| known.get(k).copied().unwrap_or(0.0));
        let state: Vec<Number> = mu.iter().map(|mu| Number::Series(series(mu))).collect();
        for (mu, slope) in mu.iter_mut().zip(field(declared, &state)) {
            mu.push(slope.series().coefficient(k - 1) / k as f64);
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
            let largest = series.iter().fold(0.0_f64, |m, s| f64::max(m, s[k].abs()));
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
            let rest = series[1..].iter().rev().fold(0.0, |sum, c| sum * time + c);
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
