//! Means over coadjoint orbits that are spheres, ellipsoids or products of them.

use super::quadrature::{Functions, MOST_VALUES, Means, Sums, converged};
use crate::random::Random;
use lie_runtime::matrix::SquareMatrix;
use lie_runtime::poisson::Poisson;
use lie_runtime::state::State;
use std::f64::consts::{PI, TAU};

/// The most spheres of a product.
const MOST_SPHERES: usize = 2;

/// Nodes and weights of the quadrature of Gauss and Legendre on (-1, 1).
fn legendre(count: usize) -> Vec<(f64, f64)> {
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (count as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut before, mut value) = (1.0, x);
            for degree in 2..=count {
                let n = degree as f64;
                (before, value) = (
                    value,
                    ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n,
                );
            }
            slope = count as f64 * (x * value - before) / (x * x - 1.0);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

/// Nodes of the unit sphere: Gauss and Legendre along the axis, equal angles about it.
fn sphere(count: usize) -> Vec<([f64; 3], f64)> {
    let round = 2 * count;
    let circles = legendre(count).into_iter();
    let circle = |(z, weight): (f64, f64)| {
        let radius = (1.0 - z * z).sqrt();
        (0..round).map(move |k| {
            let (sine, cosine) = (TAU * (k as f64 + 0.5) / round as f64).sin_cos();
            ([radius * cosine, radius * sine, z], weight)
        })
    };
    circles.flat_map(circle).collect()
}

/// A map of the unit sphere to an orbit, by rows.
type Map = [[f64; 3]; 3];

/// The map of the unit sphere to the orbit of each part of three coordinates with the bracket `{mu_i, mu_j} = eps_ijk (B mu)_k` of a definite
/// matrix B, through a state: `mu = A n` with `A^T B A = r^2`, where the measure of Liouville is the uniform one. Why there are none otherwise.
fn maps<P: Poisson<f64>>(system: &P, own: usize, mu: &P::State) -> Result<Vec<Map>, String> {
    let other = || Err("the orbits are not spheres".to_owned());
    if !own.is_multiple_of(3) {
        return other();
    }
    if own > 3 * MOST_SPHERES {
        let spheres = own / 3;
        return Err(format!(
            "the orbit has {spheres} parts, and a quadrature of {MOST_SPHERES} is made"
        ));
    }
    let matrix_at = |mu: &P::State| {
        let mut matrix = system.zero_jacobian();
        system.poisson_matrix(mu, &mut matrix);
        matrix
    };
    let (zero, mut random) = (system.zero_state(), Random::new(7));
    let mut somewhere = zero.clone();
    let entries = somewhere.as_mut_slice()[..own].iter_mut();
    entries.for_each(|entry| *entry = random.unit());
    let together = matrix_at(&somewhere);
    let apart = |i: usize, j: usize| i / 3 == j / 3 || together.get(i, j) == 0.0;
    if !(0..own).all(|i| (0..own).all(|j| apart(i, j))) {
        return other();
    }
    let mut maps = Vec::new();
    for first in (0..own).step_by(3) {
        let mut b = [[0.0; 3]; 3];
        for column in 0..3 {
            let mut unit = zero.clone();
            unit.as_mut_slice()[first + column] = 1.0;
            let matrix = matrix_at(&unit);
            for (row, b) in b.iter_mut().enumerate() {
                let (i, j) = ((row + 1) % 3, (row + 2) % 3);
                b[column] = matrix.get(first + i, first + j);
            }
        }
        let at = &somewhere.as_slice()[first..first + 3];
        let is_linear = b.iter().enumerate().all(|(row, b)| {
            let (i, j) = ((row + 1) % 3, (row + 2) % 3);
            let found: f64 = b.iter().zip(at).map(|(b, x)| b * x).sum();
            let size: f64 = b.iter().map(|x| x.abs()).sum();
            (found - together.get(first + i, first + j)).abs() <= 1e-14 * size
        });
        let trace = b[0][0] + b[1][1] + b[2][2];
        let b = b.map(|row| row.map(|x| x * trace.signum()));
        let symmetric =
            (0..3).all(|i| (0..3).all(|j| (b[i][j] - b[j][i]).abs() <= 1e-14 * trace.abs()));
        let Some(inverse) = cholesky(&b)
            .filter(|_| is_linear && symmetric)
            .map(|l| inverse_transposed(&l))
        else {
            return other();
        };
        let x = &mu.as_slice()[first..first + 3];
        let square: f64 = (0..3)
            .map(|i| (0..3).map(|j| b[i][j] * x[i] * x[j]).sum::<f64>())
            .sum();
        let radius = square.sqrt();
        maps.push(inverse.map(|row| row.map(|entry| entry * radius)));
    }
    Ok(maps)
}

/// L with `L L^T = B`; none of a matrix that is not positive.
fn cholesky(b: &Map) -> Option<Map> {
    let mut l = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            let left = b[i][j] - sum;
            l[i][j] = match i == j {
                true if left <= 1e-14 * b[i][i].abs() => return None,
                true => left.sqrt(),
                false => left / l[j][j],
            };
        }
    }
    Some(l)
}

/// `L^-T`: its rows are the columns of the inverse.
fn inverse_transposed(l: &Map) -> Map {
    std::array::from_fn(|column| {
        let mut solution = [0.0; 3];
        for i in column..3 {
            let sum: f64 = (column..i).map(|k| l[i][k] * solution[k]).sum();
            solution[i] = (f64::from(u8::from(i == column)) - sum) / l[i][i];
        }
        solution
    })
}

/// The means over the orbit of a state, where it is a sphere or a product of two.
pub(super) fn on_orbit<P: Poisson<f64>>(
    system: &P,
    own: usize,
    mu: &P::State,
    temperature: f64,
    functions: Functions<'_, P::State>,
) -> Result<Means, String> {
    let maps = maps(system, own, mu)?;
    converged(|count| {
        let nodes = sphere(count);
        let all = nodes.len().checked_pow(maps.len() as u32)?;
        if all > MOST_VALUES {
            return None;
        }
        let (mut sums, mut point) = (Sums::new(), mu.clone());
        for index in 0..all {
            let (mut rest, mut weight) = (index, 1.0);
            for (part, map) in maps.iter().enumerate() {
                let (n, own_weight) = &nodes[rest % nodes.len()];
                rest /= nodes.len();
                weight *= own_weight;
                for (row, entry) in map.iter().zip(&mut point.as_mut_slice()[3 * part..]) {
                    *entry = row.iter().zip(n).map(|(a, x)| a * x).sum();
                }
            }
            sums.add(&functions(&point), weight, temperature);
        }
        Some(sums.means())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_of_a_sphere_are_exact_for_polynomials() {
        let mean = |of: fn(&[f64; 3]) -> f64| {
            let nodes = sphere(6);
            let total: f64 = nodes.iter().map(|(_, weight)| weight).sum();
            nodes.iter().map(|(n, weight)| of(n) * weight).sum::<f64>() / total
        };
        for (found, exact) in [
            (mean(|n| n[2] * n[2]), 1.0 / 3.0),
            (mean(|n| n[0].powi(4)), 1.0 / 5.0),
            (
                mean(|n| n[0].powi(4) * n[1].powi(2) * n[2].powi(2)),
                1.0 / 315.0,
            ),
            (mean(|n| n[0] * n[1]), 0.0),
        ] {
            assert!((found - exact).abs() < 1e-14, "{found} {exact}");
        }
    }

    #[test]
    fn a_map_takes_the_sphere_to_the_orbit() {
        let b = [[2.0, 0.5, 0.1], [0.5, 1.0, -0.2], [0.1, -0.2, 3.0]];
        let map = inverse_transposed(&cholesky(&b).expect("it is positive"));
        for (n, _) in sphere(3) {
            let mu: Vec<f64> = map
                .iter()
                .map(|row| (0..3).map(|k| row[k] * n[k]).sum())
                .collect();
            let value: f64 = (0..3)
                .map(|i| (0..3).map(|j| b[i][j] * mu[i] * mu[j]).sum::<f64>())
                .sum();
            assert!((value - 1.0).abs() < 1e-14, "{value}");
        }
        assert!(cholesky(&[[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).is_none());
    }
}
