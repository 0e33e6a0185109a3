//! A reference solution by extrapolation, which shares nothing with the methods it is compared with.
//!
//! The modified midpoint rule of Gragg with 2, 4, 6, … substeps, extrapolated to substeps of length zero
//! in even powers (Bulirsch and Stoer), steps chosen by the difference of the last two columns. Increments
//! are extrapolated and summed with compensation, so that round-off stays near that of one step.
//!
//! Reference: E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd
//! edition, Springer 1993, section II.9,
//! [doi:10.1007/978-3-540-78862-1](https://doi.org/10.1007/978-3-540-78862-1).

use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::{State, Unknown};

const MAX_STEPS: u64 = 2_000_000;

/// A solution at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference<V> {
    /// The state.
    pub mu: V,
    /// The largest difference, over the components, from a second run with one column more and its own
    /// steps.
    pub error: f64,
    /// Evaluations of the vector field, of both runs.
    pub evaluations: u64,
}

/// The state at time t from `mu` at time 0 to nearly round-off, with an estimate of its error. None if a number
/// becomes infinite or the steps too many.
pub fn reference<P: Poisson<f64>>(
    system: &P,
    mu: &P::State,
    t: f64,
) -> Option<Reference<P::State>> {
    let (fine, first) = run(system, mu, t, 6, 1e-15)?;
    let (other, second) = run(system, mu, t, 7, 1e-15)?;
    let pairs = fine.as_slice().iter().zip(other.as_slice());
    let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, Scalar::max);
    Some(Reference {
        mu: fine,
        error,
        evaluations: first + second,
    })
}

fn run<P: Poisson<f64>>(
    system: &P,
    mu: &P::State,
    t: f64,
    columns: usize,
    tolerance: f64,
) -> Option<(P::State, u64)> {
    let mut state = mu.clone();
    let mut lost = vec![0.0; system.dimension()];
    let mut field = system.zero_state();
    system.vector_field(&state, &mut field);
    let speed = field.max_norm() / state.max_norm().max(f64::MIN_POSITIVE);
    let mut step = if speed > 0.0 {
        f64::min(0.5 / speed, t.abs())
    } else {
        t.abs()
    };
    let mut done = 0.0;
    let mut evaluations = 1;
    let order = (2 * columns - 1) as f64;
    for _ in 0..MAX_STEPS {
        let left = t.abs() - done;
        if left <= 0.0 {
            return Some((state, evaluations));
        }
        // two equal steps rather than a long and a tiny one
        let h = if step >= left {
            left
        } else {
            step.min(0.5 * left)
        };
        let (increment, error) =
            extrapolate(system, &state, h.copysign(t), columns, &mut evaluations);
        let scale = tolerance * state.max_norm().max(f64::MIN_POSITIVE);
        let ratio = error / scale;
        if ratio.is_nan() || (ratio > 1.0 && h > 1e-14 * t.abs()) {
            let factor = if ratio.is_nan() {
                0.1
            } else {
                0.9 * ratio.powf(-1.0 / order)
            };
            step = h * factor.clamp(0.1, 0.8);
            if step < 1e-14 * t.abs() {
                return None;
            }
            continue;
        }
        add(state.as_mut_slice(), &mut lost, &increment);
        done = if h == left { t.abs() } else { done + h };
        step = h * (0.9 * ratio.max(1e-30).powf(-1.0 / order)).clamp(0.3, 3.0);
    }
    None
}

/// Adds an increment; what rounding loses is kept for the next one.
fn add(state: &mut [f64], lost: &mut [f64], increment: &[f64]) {
    for ((entry, lost), change) in state.iter_mut().zip(lost).zip(increment) {
        let change = change - *lost;
        let sum = *entry + change;
        *lost = (sum - *entry) - change;
        *entry = sum;
    }
}

/// The extrapolated increment over one step, and the size of the last correction.
fn extrapolate<P: Poisson<f64>>(
    system: &P,
    start: &P::State,
    h: f64,
    columns: usize,
    evaluations: &mut u64,
) -> (Vec<f64>, f64) {
    let mut table: Vec<Vec<f64>> = Vec::new();
    let mut error = f64::NAN;
    for row in 0..columns {
        let substeps = 2 * (row + 1);
        let mut entry = gragg(system, start, h, substeps);
        *evaluations += substeps as u64 + 1;
        // Aitken–Neville in h^2; `table` keeps the row above
        let mut next = Vec::with_capacity(row + 1);
        for (column, above) in table.iter().enumerate() {
            let ratio = substeps as f64 / (2 * (row - column)) as f64;
            let factor = 1.0 / (ratio * ratio - 1.0);
            let better: Vec<f64> = entry
                .iter()
                .zip(above)
                .map(|(e, a)| e + (e - a) * factor)
                .collect();
            let change = entry.iter().zip(&better).map(|(a, b)| (a - b).abs());
            error = change.fold(0.0, Scalar::max);
            next.push(entry);
            entry = better;
        }
        next.push(entry);
        table = next;
    }
    (table.pop().unwrap_or_default(), error)
}

/// The increment of the modified midpoint rule, its end smoothed.
fn gragg<P: Poisson<f64>>(system: &P, start: &P::State, h: f64, substeps: usize) -> Vec<f64> {
    let small = h / substeps as f64;
    let mut field = system.zero_state();
    let mut before = vec![0.0; system.dimension()];
    let mut point = start.clone();
    system.vector_field(&point, &mut field);
    let mut now: Vec<f64> = field.as_slice().iter().map(|f| small * f).collect();
    for _ in 1..substeps {
        place(&mut point, start, &now);
        system.vector_field(&point, &mut field);
        for ((before, now), f) in before.iter_mut().zip(&mut now).zip(field.as_slice()) {
            let next = *before + 2.0 * small * f;
            *before = *now;
            *now = next;
        }
    }
    place(&mut point, start, &now);
    system.vector_field(&point, &mut field);
    let all = before.iter().zip(&now).zip(field.as_slice());
    all.map(|((before, now), f)| 0.5 * (before + now + small * f))
        .collect()
}

fn place<V: State<f64>>(point: &mut V, start: &V, increment: &[f64]) {
    let pairs = start.as_slice().iter().zip(increment);
    for (entry, (start, change)) in point.as_mut_slice().iter_mut().zip(pairs) {
        *entry = start + change;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_systems::Spring;

    #[test]
    fn the_exact_solution_of_a_spring() {
        let start = [0.3, -0.4].into();
        for t in [20.0_f64, -7.0] {
            let end = reference(&Spring, &start, t).expect("a solution");
            let exact = [
                0.3 * t.cos() - 0.4 * t.sin(),
                -0.4 * t.cos() - 0.3 * t.sin(),
            ];
            for (value, exact) in end.mu.as_slice().iter().zip(exact) {
                assert!((value - exact).abs() < 1e-14, "{value} {exact}");
            }
            assert!(end.error < 1e-14 && end.evaluations > 100);
        }
    }
}
