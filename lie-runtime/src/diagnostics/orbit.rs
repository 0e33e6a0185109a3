//! How far a state lies from the coadjoint orbit of another.

use super::basis::Basis;
use crate::matrix::SquareMatrix;
use crate::poisson::LiePoisson;
use crate::state::State;

const ITERATIONS: usize = 40;

/// The distance of `end` from the coadjoint orbit of `start`, along the part of the orbit near it.
///
/// ```math
/// \min_{g}\; \lvert \mathrm{Ad}^*_g \mu - \mu_1 \rvert_\infty
/// ```
///
/// by the Gauss–Newton iteration `nu <- exp(ad*_xi) nu` with xi a least-squares solution of
/// `Pi(nu) xi = mu1 - nu`, which starts at mu and stays on its orbit to round-off: whatever it comes to is
/// a bound from above. It looks neither at Casimirs, declared or not, nor at the factors of a method.
/// Zero to round-off on open orbits, whatever `end` is.
pub fn orbit_distance<P: LiePoisson<f64>>(system: &P, start: &P::State, end: &P::State) -> f64 {
    let mut point = start.clone();
    let mut best = distance(&point, end);
    let mut stalled = 0;
    let mut xi = system.zero_state();
    for _ in 0..ITERATIONS {
        if best == 0.0 || stalled == 3 {
            break;
        }
        let columns = poisson_columns(system, &point);
        let gap: Vec<f64> = pairs(end, &point).map(|(a, b)| a - b).collect();
        let solution = Basis::of_span(&columns).solve(&gap, P::DIM);
        xi.as_mut_slice().copy_from_slice(&solution);
        act_by_exp(system, &xi, &mut point);
        let next = distance(&point, end);
        // the last digits go up and down
        stalled = if next < 0.5 * best { 0 } else { stalled + 1 };
        if next.is_nan() {
            break;
        }
        best = best.min(next);
    }
    best
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
    let column = |j| (0..P::DIM).map(|i| matrix.get(i, j)).collect();
    (0..P::DIM).map(column).collect()
}

/// Replaces mu by `Ad*_(exp xi) mu = exp(ad*_xi) mu`: the Taylor series of a part of xi that is small,
/// applied as often as it takes.
pub fn act_by_exp<P: LiePoisson<f64>>(system: &P, xi: &P::State, mu: &mut P::State) {
    let mut matrix = system.zero_jacobian();
    system.ad_star_matrix(xi, &mut matrix);
    let row = |i| (0..P::DIM).map(|j| matrix.get(i, j).abs()).sum::<f64>();
    let size = (0..P::DIM).map(row).fold(0.0, f64::max);
    let times = (2.0 * size).ceil().clamp(1.0, 1e4);
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
