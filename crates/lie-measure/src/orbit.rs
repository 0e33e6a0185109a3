//! How far a state lies from the coadjoint orbit of another.

use crate::basis::{Basis, norm};
use crate::random::Random;
use lie_runtime::matrix::SquareMatrix;
use lie_runtime::poisson::LiePoisson;
use lie_runtime::scalar::Scalar;
use lie_runtime::state::State;

/// Steps of a descent; one that needs as many is near no point.
const ITERATIONS: usize = 300;
/// Halvings of one step of a descent.
const HALVINGS: usize = 40;
/// Descents from other points of the orbit, where the first one ends away from the state.
const RESTARTS: u64 = 4;
/// A relative distance at which a descent has come to the state.
const REACHED: f64 = 1e-9;

/// The distance of `end` from the coadjoint orbit of `start`: the orbit of the connected group.
///
/// ```math
/// \min_{g}\; \lvert \mathrm{Ad}^*_g \mu - \mu_1 \rvert_\infty
/// ```
///
/// by the damped Gauss–Newton iteration `nu <- exp(ad*_(s xi)) nu` with xi a least-squares solution of
/// `Pi(nu) xi = mu1 - nu`, and s in (0, 1] so small that `|s ad*_xi|` is at most 1 and the Euclidean distance
/// shrinks. It starts at mu and moves along the coadjoint action alone, so that it never leaves the connected
/// orbit, whatever `end` is: what it comes to is a bound from above, to round-off. Where it ends away from
/// `end` it starts again from other points of the orbit, since a distance can have minima of its own. It looks
/// neither at Casimirs, declared or not, nor at the factors of a method. Not a number where `end` is none.
pub fn orbit_distance<P: LiePoisson<f64>>(system: &P, start: &P::State, end: &P::State) -> f64 {
    let scale = distance(&system.zero_state(), end).max(distance(&system.zero_state(), start));
    if !scale.is_finite() {
        return f64::NAN;
    }
    let mut best = descend(system, start.clone(), end);
    for seed in 0..RESTARTS {
        if best <= REACHED * scale {
            break;
        }
        let mut random = Random::new(seed);
        let mut xi = system.zero_state();
        for entry in xi.as_mut_slice() {
            *entry = random.unit();
        }
        let size = action(system, &xi);
        if size > 0.0 {
            xi.as_mut_slice()
                .iter_mut()
                .for_each(|entry| *entry /= size);
        }
        let mut point = start.clone();
        act_by_exp(system, &xi, &mut point);
        best = best.min(descend(system, point, end));
    }
    best
}

/// The least distance that a descent from a point comes to.
fn descend<P: LiePoisson<f64>>(system: &P, mut point: P::State, end: &P::State) -> f64 {
    let mut xi = system.zero_state();
    let mut trial = point.clone();
    let mut stalled = 0;
    let mut best = distance(&point, end);
    for _ in 0..ITERATIONS {
        if best == 0.0 || stalled == 3 {
            break;
        }
        let gap: Vec<f64> = pairs(end, &point).map(|(a, b)| a - b).collect();
        let before = norm(&gap);
        let solution =
            Basis::from_span(&poisson_columns(system, &point)).solve(&gap, system.dimension());
        xi.as_mut_slice().copy_from_slice(&solution);
        let factor = 1.0 / action(system, &xi).max(1.0);
        xi.as_mut_slice()
            .iter_mut()
            .for_each(|entry| *entry *= factor);
        let mut after = f64::INFINITY;
        for _ in 0..HALVINGS {
            trial.copy_from(&point);
            act_by_exp(system, &xi, &mut trial);
            let gap: Vec<f64> = pairs(end, &trial).map(|(a, b)| a - b).collect();
            after = norm(&gap);
            if after < before {
                break;
            }
            xi.as_mut_slice().iter_mut().for_each(|entry| *entry *= 0.5);
        }
        if after >= before || after.is_nan() {
            break;
        }
        point.copy_from(&trial);
        best = best.min(distance(&point, end));
        // a minimum away from the state, or the last digits, which go up and down
        stalled = if after < (1.0 - 1e-4) * before {
            0
        } else {
            stalled + 1
        };
    }
    best
}

/// The largest absolute sum of a row of the matrix of `ad*_xi`.
fn action<P: LiePoisson<f64>>(system: &P, xi: &P::State) -> f64 {
    let mut matrix = system.zero_jacobian();
    system.ad_star_matrix(xi, &mut matrix);
    let row = |i| {
        (0..system.dimension())
            .map(|j| matrix.get(i, j).abs())
            .sum::<f64>()
    };
    (0..system.dimension()).map(row).fold(0.0, Scalar::max)
}

fn pairs<'a, V: State<f64>>(a: &'a V, b: &'a V) -> impl Iterator<Item = (f64, f64)> + 'a {
    let pairs = a.as_slice().iter().zip(b.as_slice());
    pairs.map(|(&a, &b)| (a, b))
}

fn distance<V: State<f64>>(a: &V, b: &V) -> f64 {
    pairs(a, b).fold(0.0, |largest, (a, b)| {
        if (a - b).is_nan() {
            f64::NAN
        } else {
            f64::max(largest, (a - b).abs())
        }
    })
}

fn poisson_columns<P: LiePoisson<f64>>(system: &P, mu: &P::State) -> Vec<Vec<f64>> {
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut matrix);
    let column = |j| (0..system.dimension()).map(|i| matrix.get(i, j)).collect();
    (0..system.dimension()).map(column).collect()
}

/// The most parts that an element is divided into.
const MAX_PARTS: f64 = 1e6;

/// Replaces mu by `Ad*_(exp xi) mu = exp(ad*_xi) mu`: the Taylor series of a part of xi that is small,
/// applied as often as it takes. Not a number where that is over a million times.
pub fn act_by_exp<P: LiePoisson<f64>>(system: &P, xi: &P::State, mu: &mut P::State) {
    let times = (2.0 * action(system, xi)).ceil().max(1.0);
    if times.is_nan() || times > MAX_PARTS {
        return mu.fill(f64::NAN);
    }
    let mut term = system.zero_state();
    let mut next = system.zero_state();
    for _ in 0..times as usize {
        term.copy_from(mu);
        for k in 1..=20 {
            system.ad_star(xi, &term, &mut next);
            let factor = 1.0 / (times * f64::from(k));
            term.fill(0.0);
            term.axpy(factor, &next);
            mu.axpy(1.0, &term);
        }
    }
}
