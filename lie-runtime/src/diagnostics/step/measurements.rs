//! What a step does: its order, its symmetry, what drifts, the defect of its Poisson map.

use super::Measured;
use crate::diagnostics::order::order_of_convergence;
use crate::diagnostics::reference::reference;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::state::{State, Unknown};

/// Steps over which energy and Casimirs are followed.
pub(super) const STEPS: u32 = 100;
/// How much smaller than the order claimed a slope may be, at least and as a part of it.
const SLACK: [f64; 2] = [0.3, 0.1];
/// An error below this at the longest step is at round-off before an order shows.
const NEGLIGIBLE: f64 = 1e-9;

/// The larger of two, or NaN where one is.
pub(super) fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

/// The largest difference of entries.
fn distance<V: State<f64>>(a: &V, b: &V) -> f64 {
    let pairs = a.as_slice().iter().zip(b.as_slice());
    pairs.fold(0.0, |largest, (a, b)| worse(largest, (a - b).abs()))
}

fn size<V: State<f64>>(mu: &V) -> f64 {
    mu.max_norm().max(f64::MIN_POSITIVE)
}

/// One step of the classical Runge–Kutta method.
pub(super) fn runge_kutta<P: Poisson<f64>>(system: &P, mu: &mut P::State, h: f64) {
    let start = mu.clone();
    let (mut point, mut slope) = (start.clone(), system.zero_state());
    for (next, weight) in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)] {
        system.vector_field(&point, &mut slope);
        mu.axpy(h * weight / 6.0, &slope);
        point.copy_from(&start);
        point.axpy(h * next, &slope);
    }
}

pub(super) fn order<P: Poisson<f64>, E>(
    system: &P,
    mu: &P::State,
    h: f64,
    claimed: u32,
    step: &mut impl FnMut(&mut P::State, f64) -> Result<(), E>,
) -> Result<Measured, E> {
    let span = 8.0 * h;
    let exact = reference(system, mu, span);
    let mut points = Vec::new();
    for halvings in 0..8 {
        let steps = 8_u32 << halvings;
        let mut end = mu.clone();
        for _ in 0..steps {
            step(&mut end, span / f64::from(steps))?;
        }
        let error = exact
            .as_ref()
            .map_or(f64::NAN, |exact| distance(&end, &exact.mu));
        points.push((span / f64::from(steps), error / size(mu)));
    }
    let floor = exact
        .map_or(0.0, |exact| exact.error / size(mu))
        .max(100.0 * f64::EPSILON);
    // few errors above round-off show no order where the step is short; those that are large and do not fall show that there is none
    let value = match order_of_convergence(&points, floor) {
        Some(order) => order.slope,
        None if points[0].1 < NEGLIGIBLE => f64::NAN,
        None => 0.0,
    };
    let order = f64::from(claimed);
    let bound = order - SLACK[0].max(SLACK[1] * order);
    Ok(Measured {
        fact: "order",
        claimed: true,
        value,
        bound,
        control: None,
    })
}

pub(super) fn symmetry<V: State<f64>, E>(
    mu: &V,
    h: f64,
    step: &mut impl FnMut(&mut V, f64) -> Result<(), E>,
) -> Result<f64, E> {
    let mut end = mu.clone();
    step(&mut end, h)?;
    step(&mut end, -h)?;
    Ok(distance(&end, mu) / size(mu))
}

/// The largest change of a function over the largest of its values and of the changes that a step makes in the state.
pub(super) fn drift<V: State<f64>, E>(
    mu: &V,
    h: f64,
    function: &impl Fn(&V) -> f64,
    step: &mut impl FnMut(&mut V, f64) -> Result<(), E>,
) -> Result<f64, E> {
    let first = function(mu);
    let mut state = mu.clone();
    let mut largest = 0.0;
    for _ in 0..STEPS {
        step(&mut state, h)?;
        largest = worse(largest, (function(&state) - first).abs());
    }
    let variation = variation(mu, function);
    Ok(largest / first.abs().max(variation).max(f64::MIN_POSITIVE))
}

/// By how much a function changes where one entry changes by the size of the state: the size of its terms.
fn variation<V: State<f64>>(mu: &V, function: &impl Fn(&V) -> f64) -> f64 {
    let part = 1e-3 * size(mu);
    let changes = (0..mu.as_slice().len()).map(|index| {
        let mut moved = mu.clone();
        moved.as_mut_slice()[index] += part;
        let above = function(&moved);
        moved.as_mut_slice()[index] -= 2.0 * part;
        ((above - function(&moved)) / 2e-3).abs()
    });
    changes
        .filter(|change| change.is_finite())
        .fold(0.0, f64::max)
}

pub(super) fn poisson<P: Poisson<f64>, E>(
    system: &P,
    mu: &P::State,
    h: f64,
    step: &mut impl FnMut(&mut P::State, f64) -> Result<(), E>,
) -> Result<f64, E> {
    let n = system.dimension();
    let part = f64::EPSILON.cbrt() * size(mu);
    let mut derivative = vec![vec![0.0; n]; n];
    for direction in 0..n {
        let mut ends = [mu.clone(), mu.clone()];
        for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
            end.as_mut_slice()[direction] += sign * part;
            step(end, h)?;
        }
        for (row, entries) in derivative.iter_mut().enumerate() {
            entries[direction] = (ends[0].entry(row) - ends[1].entry(row)) / (2.0 * part);
        }
    }
    let mut end = mu.clone();
    step(&mut end, h)?;
    let [before, after] = [mu, &end].map(|mu| {
        let mut matrix = system.zero_jacobian();
        system.poisson_matrix(mu, &mut matrix);
        matrix
    });
    let (mut defect, mut largest) = (0.0, f64::MIN_POSITIVE);
    for row in 0..n {
        for column in 0..n {
            let terms = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let moved: f64 = terms
                .map(|(i, j)| derivative[row][i] * before.get(i, j) * derivative[column][j])
                .sum();
            defect = worse(defect, (moved - after.get(row, column)).abs());
            largest = f64::max(largest, after.get(row, column).abs());
        }
    }
    Ok(defect / largest)
}
