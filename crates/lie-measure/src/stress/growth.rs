//! How round-off grows: the exponent of the error of a claimed invariant in the number of steps.
//!
//! Rounding errors that are independent of each other make a random walk, N^(1/2) (Brouwer's law); a bias in them
//! grows like N. Several states are followed, the root of the mean square of their errors is taken at geometrically
//! spaced N, and a line is fitted to its logarithm by least squares. The standard error is that of the jackknife:
//! the fit is repeated without each state, since the points of one state are not independent of each other.
//!
//! The bias is the mean over the states of what the error is at the end, with its sign, per step. An exponent hides one that is
//! small beside the walk; the bias has a standard error of the walk over `sqrt(N)` and the root of the number of states.
//!
//! Reference: E. Hairer, R. I. McLachlan, A. Razakarivony, "Achieving Brouwer's law with implicit Runge–Kutta
//! methods", BIT Numerical Mathematics 48 (2008) 231–243,
//! [doi:10.1007/s10543-008-0170-3](https://doi.org/10.1007/s10543-008-0170-3).

use super::found;
use super::outcome::{bound, claimed, sizes, values};
use crate::random::Random;
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::Poisson;
use lie_runtime::scalar::Scalar;
use std::sync::atomic::{AtomicBool, Ordering};

/// States that are followed.
pub(super) const STATES: usize = 16;
/// How far they lie from the initial one, in parts of its largest coordinate.
const APART: f64 = 0.25;
/// Points of the fit, each at the square root of two times the steps of the one before.
const POINTS: usize = 14;
/// Steps between two looks at the wish to stop.
const CHUNK: u64 = 1 << 12;

/// The growth of the claimed invariant that moved most.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Growth {
    /// The invariant: 0 the energy, then the Casimirs.
    pub(super) invariant: usize,
    /// The exponent and its standard error.
    pub(super) exponent: (f64, f64),
    /// The mean of the error per step, and its standard error over the states.
    pub(super) bias: (f64, f64),
    /// The error at the end, relative to the size of the terms: root of the mean square, and the largest.
    pub(super) end: (f64, f64),
    /// The steps of the first and of the last point.
    pub(super) steps: (u64, u64),
    /// States that came to the end.
    pub(super) states: usize,
}

impl Growth {
    /// The same of a method, in words.
    pub(super) fn named<P: Poisson<f64>>(
        self,
        method: String,
        system: &P,
        step: f64,
    ) -> found::Growth {
        let casimir = self.invariant.checked_sub(1);
        let invariant = casimir.map_or("energy", |index| system.casimir_name(index));
        let (from, to) = self.steps;
        found::Growth {
            method,
            invariant: invariant.to_owned(),
            exponent: self.exponent.0,
            error: self.exponent.1,
            bias: self.bias.0,
            bias_error: self.bias.1,
            end: self.end.0,
            largest: self.end.1,
            from,
            to,
            states: self.states,
            step,
            ratio: self.end.1 / bound(to, false),
        }
    }
}

/// Numbers of steps from about N/90 to N, without repetitions.
fn points(steps: u64) -> Vec<u64> {
    let at = |k: usize| (steps as f64 * 2_f64.powf(-0.5 * k as f64)).round() as u64;
    let mut points: Vec<u64> = (0..POINTS).rev().map(at).filter(|&n| n > 0).collect();
    points.dedup();
    points
}

/// Follows the claimed invariants of a method; none where it claims nothing, where fewer than three states come to the
/// end, or where nothing moves.
pub(super) fn growth<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    step: f64,
    steps: u64,
    stop: &AtomicBool,
) -> Option<Growth> {
    let claims = claimed(system, &method.claims());
    let points = points(steps);
    if !claims.contains(&true) || points.len() < 4 {
        return None;
    }
    let mut random = Random::new(2018);
    // errors[state][invariant][point]
    let mut errors: Vec<Vec<Vec<f64>>> = Vec::new();
    for state in 0..STATES {
        let start = match state {
            0 => mu.clone(),
            _ => random.near_state(system, mu, APART),
        };
        errors.extend(follow(system, method, start, step, &points, stop));
    }
    let largest = |invariant: usize| mean_square(&errors, invariant, points.len() - 1);
    let invariant = (0..claims.len())
        .filter(|&invariant| claims[invariant])
        .max_by(|&a, &b| largest(a).total_cmp(&largest(b)))?;
    let last = |state: &Vec<Vec<f64>>| state[invariant][points.len() - 1];
    let ends: Vec<f64> = errors.iter().map(last).collect();
    Some(Growth {
        invariant,
        exponent: exponent(&errors, invariant, &points)?,
        bias: bias(&ends, *points.last()?),
        end: (
            largest(invariant).sqrt(),
            ends.iter().map(|end| end.abs()).fold(0.0, Scalar::max),
        ),
        steps: (points[0], *points.last()?),
        states: errors.len(),
    })
}

/// The relative error of each invariant at each point, with its sign; none if a step fails, or a number is not finite.
fn follow<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mut mu: P::State,
    step: f64,
    points: &[u64],
    stop: &AtomicBool,
) -> Option<Vec<Vec<f64>>> {
    let mut first = vec![0.0; system.casimir_count() + 1];
    values(system, &mu, &mut first);
    let mut sizes_seen = sizes(system, &mu);
    let mut now = first.clone();
    let mut errors = vec![Vec::with_capacity(points.len()); first.len()];
    let mut stepper = method.any_stepper(system, step, &NewtonOptions::default());
    let mut done = 0;
    for &point in points {
        while done < point {
            let chunk = CHUNK.min(point - done);
            stepper.advance(&mut mu, chunk).ok()?;
            done += chunk;
            if stop.load(Ordering::Relaxed) {
                return None;
            }
        }
        values(system, &mu, &mut now);
        let sizes = sizes(system, &mu);
        for (index, all) in errors.iter_mut().enumerate() {
            sizes_seen[index] = sizes_seen[index].max(sizes[index]);
            let error = (now[index] - first[index]) / sizes_seen[index];
            if !error.is_finite() {
                return None;
            }
            all.push(error);
        }
    }
    Some(errors)
}

/// The mean square over the states of the error of an invariant at a point.
fn mean_square(errors: &[Vec<Vec<f64>>], invariant: usize, point: usize) -> f64 {
    let sum: f64 = errors.iter().map(|e| e[invariant][point].powi(2)).sum();
    sum / errors.len() as f64
}

/// The mean of the errors per step, and its standard error.
fn bias(ends: &[f64], steps: u64) -> (f64, f64) {
    let (count, steps) = (ends.len() as f64, steps as f64);
    let mean = ends.iter().sum::<f64>() / count;
    let square: f64 = ends.iter().map(|end| (end - mean).powi(2)).sum();
    (
        mean / steps,
        (square / (count * (count - 1.0))).sqrt() / steps,
    )
}

/// The exponent with its standard error.
fn exponent(errors: &[Vec<Vec<f64>>], invariant: usize, points: &[u64]) -> Option<(f64, f64)> {
    if errors.len() < 3 {
        return None;
    }
    let slope = |left_out: Option<usize>| {
        let logarithms = points.iter().enumerate().filter_map(|(point, &steps)| {
            let kept = errors.iter().enumerate();
            let kept = kept.filter(|(state, _)| Some(*state) != left_out);
            let (count, sum) = kept.fold((0.0, 0.0), |(count, sum), (_, error)| {
                (count + 1.0, sum + error[invariant][point].powi(2))
            });
            (sum > 0.0).then(|| ((steps as f64).ln(), 0.5 * (sum / count).ln()))
        });
        least_squares(&logarithms.collect::<Vec<_>>())
    };
    let whole = slope(None)?;
    let parts: Vec<f64> = (0..errors.len())
        .filter_map(|state| slope(Some(state)))
        .collect();
    let count = parts.len() as f64;
    let mean = parts.iter().sum::<f64>() / count;
    let square: f64 = parts.iter().map(|part| (part - mean).powi(2)).sum();
    Some((whole, ((count - 1.0) / count * square).sqrt()))
}

/// The slope of the line through points; none through fewer than four.
fn least_squares(points: &[(f64, f64)]) -> Option<f64> {
    if points.len() < 4 {
        return None;
    }
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (mut above, mut below) = (0.0, 0.0);
    for point in points {
        above += (point.0 - x) * (point.1 - y);
        below += (point.0 - x).powi(2);
    }
    Some(above / below)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The exponent and the bias of one invariant over 2^16 steps, from increments of each step.
    fn fitted(increment: impl Fn(&mut Random) -> f64) -> [(f64, f64); 2] {
        let points = points(1 << 16);
        let errors: Vec<Vec<Vec<f64>>> = (0..STATES as u64)
            .map(|seed| {
                let mut random = Random::new(seed + 1);
                let (mut sum, mut done, mut all) = (0.0_f64, 0, Vec::new());
                for &point in &points {
                    while done < point {
                        sum += increment(&mut random);
                        done += 1;
                    }
                    all.push(sum);
                }
                vec![all]
            })
            .collect();
        let ends: Vec<f64> = errors.iter().map(|e| e[0][points.len() - 1]).collect();
        let exponent = exponent(&errors, 0, &points).expect("a fit");
        [exponent, bias(&ends, 1 << 16)]
    }

    #[test]
    fn walks_and_biases_have_their_exponents() {
        let [(walk, error), (mean, deviation)] = fitted(|random| random.unit());
        assert!(
            (walk - 0.5).abs() < 3.0 * error && error < 0.15,
            "{walk} ± {error}"
        );
        // uniform in -1..1: its deviation over the root of all draws
        let draws = (65536.0 * STATES as f64).sqrt();
        assert!(
            mean.abs() < 3.0 * deviation && (deviation * draws * 3_f64.sqrt() - 1.0).abs() < 0.5,
            "{mean} ± {deviation}"
        );
        let [(exponent, error), (mean, deviation)] = fitted(|_| 1e-16);
        assert!(
            (exponent - 1.0).abs() < 1e-3 && error < 1e-3,
            "{exponent} ± {error}"
        );
        assert!(
            (mean - 1e-16).abs() < 1e-24 && deviation < 1e-24,
            "{mean} ± {deviation}"
        );
        // a bias that an exponent does not tell from the walk is many of its own errors
        let [(both, error), (mean, deviation)] = fitted(|random| random.unit() + 0.005);
        assert!(both < 0.85 && error < 0.15, "{both} ± {error}");
        assert!(
            mean > 5.0 * deviation && (mean - 0.005).abs() < 3.0 * deviation,
            "{mean} ± {deviation}"
        );
        // a larger one shows in both
        let [(larger, _), _] = fitted(|random| random.unit() + 0.05);
        assert!(larger > walk + 0.15 && larger < 1.1, "{larger}");
    }

    #[test]
    fn points_are_geometric_and_need_steps() {
        let points = points(1_000_000);
        assert_eq!((points.len(), points[13]), (POINTS, 1_000_000));
        assert_eq!(points[11], 500_000);
        assert_eq!(super::points(1), [1]);
        assert_eq!(
            least_squares(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0), (3.0, 7.0)]),
            Some(2.0)
        );
        assert_eq!(least_squares(&[(0.0, 1.0), (1.0, 3.0)]), None);
    }
}
