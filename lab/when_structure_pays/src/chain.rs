//! The temperature of a chain of spins over a long run.
//!
//! Of a system on a shell of constant energy it is the mean of a function of the state (H. H. Rugh, "Dynamical approach to temperature",
//! Phys. Rev. Lett. 78 (1997) 772–774, doi:10.1103/PhysRevLett.78.772; for spins W. B. Nurdin and K.-D. Schotte, Phys. Rev. E 61 (2000)
//! 3579–3582, doi:10.1103/PhysRevE.61.3579):
//!
//! ```text
//! 1/T = < div(grad H / |grad H|^2) > = < lap H / G - (grad H . grad G) / G^2 >,    G = |grad H|^2
//! ```
//!
//! with gradient, divergence and Laplacian on the product of unit spheres. With h_i the sum of the neighbours of spin i, each
//! component times its exchange: grad_i H =
//! -(h_i - (s_i . h_i) s_i), lap H = 2 sum s_i . h_i, G = sum |h_i|^2 - (s_i . h_i)^2.

use crate::contest::{Entrant, Problem, Setting};
use crate::{table, top};
use lie_plot::chart::{Axis, Chart, Panel, Series, Stroke};
use lie_runtime::{Poisson, State};

type Vector = [f64; 3];

/// The exchange along the three axes.
const EXCHANGE: Vector = [1.0, 0.8, 0.6];

/// Blocks of a run, whose means tell how far a mean is from its limit.
const BLOCKS: usize = 100;

fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn neighbours(of: &[Vector]) -> Vec<Vector> {
    let at = |i: Option<usize>| i.and_then(|i| of.get(i)).copied().unwrap_or([0.0; 3]);
    let sum = |i: usize| {
        let (a, b) = (at(i.checked_sub(1)), at(Some(i + 1)));
        [0, 1, 2].map(|c| EXCHANGE[c] * (a[c] + b[c]))
    };
    (0..of.len()).map(sum).collect()
}

/// The function whose mean is 1/T, of the directions of the spins.
fn inverse_temperature(mu: &[f64]) -> f64 {
    let spins: Vec<Vector> = mu
        .chunks_exact(3)
        .map(|s| {
            let length = dot(&[s[0], s[1], s[2]], &[s[0], s[1], s[2]]).sqrt();
            [s[0] / length, s[1] / length, s[2] / length]
        })
        .collect();
    let fields = neighbours(&spins);
    let gradient: Vec<Vector> = spins
        .iter()
        .zip(&fields)
        .map(|(s, h)| {
            let along = dot(s, h);
            [0, 1, 2].map(|c| along * s[c] - h[c])
        })
        .collect();
    let moved = neighbours(&gradient);
    let (mut laplacian, mut square, mut slope) = (0.0, 0.0, 0.0);
    for (((s, h), v), dh) in spins.iter().zip(&fields).zip(&gradient).zip(&moved) {
        let along = dot(s, h);
        laplacian += 2.0 * along;
        square += dot(v, v);
        slope += 2.0 * (dot(h, dh) - along * (dot(v, h) + dot(s, dh)));
    }
    laplacian / square - slope / (square * square)
}

/// Numbers of (0, 1).
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Spins of a canonical ensemble with the same exchange along all axes: the angles between neighbours are independent there.
pub fn sample(temperature: f64, count: usize, seed: u64) -> Vec<f64> {
    let mut random = random(seed);
    let beta = 1.0 / temperature;
    let mut spin: Vector = [0.0, 0.0, 1.0];
    let mut mu = Vec::new();
    for _ in 0..count {
        // the cosine has the density exp(beta z)
        let u = random();
        let z = ((-2.0 * beta).exp() + u * (1.0 - (-2.0 * beta).exp())).ln() / beta + 1.0;
        let angle = 2.0 * std::f64::consts::PI * random();
        let r = (1.0 - z * z).max(0.0).sqrt();
        // a frame with the last spin as its third axis
        let other = if spin[0].abs() < 0.9 {
            [1.0, 0.0, 0.0]
        } else {
            [0.0, 1.0, 0.0]
        };
        let a = unit(cross(&spin, &other));
        let b = cross(&spin, &a);
        spin = unit([0, 1, 2].map(|c| z * spin[c] + r * (angle.cos() * a[c] + angle.sin() * b[c])));
        mu.extend(spin);
    }
    mu
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(v: Vector) -> Vector {
    let length = dot(&v, &v).sqrt();
    v.map(|x| x / length)
}

/// What is seen of a run: block by block the mean of 1/T and the largest drifts.
struct Seen {
    inverse: Vec<f64>,
    energy: f64,
    lengths: f64,
}

fn look<P: Poisson<f64>>(
    problem: &Problem<P>,
    entrant: &Entrant<P>,
    setting: Setting,
    until: f64,
) -> Result<Seen, String> {
    let system = &problem.system;
    let mut mu = problem.start.clone();
    let start = system.energy(&mu);
    let mut seen = Seen {
        inverse: Vec::new(),
        energy: 0.0,
        lengths: 0.0,
    };
    let (mut sum, mut count) = (0.0, 0);
    (entrant.run)(problem, setting, until, &mut |time, state| {
        mu.as_mut_slice().copy_from_slice(state);
        sum += inverse_temperature(state);
        count += 1;
        let energy = system.energy(&mu);
        seen.energy = seen.energy.max(((energy - start) / start).abs());
        for spin in state.chunks_exact(3) {
            seen.lengths = seen
                .lengths
                .max((dot(&[spin[0], spin[1], spin[2]], &[spin[0], spin[1], spin[2]]) - 1.0).abs());
        }
        if time >= until * (seen.inverse.len() + 1) as f64 / BLOCKS as f64 * (1.0 - 1e-12) {
            seen.inverse.push(sum / f64::from(count));
            (sum, count) = (0.0, 0);
        }
    })?;
    Ok(seen)
}

/// T of some blocks, and its standard error.
fn temperature(blocks: &[f64]) -> (f64, f64) {
    let count = blocks.len() as f64;
    let mean = blocks.iter().sum::<f64>() / count;
    let variance = blocks.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (1.0 / mean, (variance / count).sqrt() / (mean * mean))
}

/// The cells of a run behind those of its method, and its curve.
fn shown(
    seen: &Seen,
    until: f64,
    name: &str,
    control: bool,
    colour: usize,
) -> (Vec<String>, Series) {
    let tenth = seen.inverse.len() / 10;
    let last = seen.inverse.len() - tenth;
    let mut cells = [seen.energy, seen.lengths]
        .map(|x| format!("{x:.1e}"))
        .to_vec();
    for part in [&seen.inverse[..tenth], &seen.inverse[last..]] {
        let (mean, error) = temperature(part);
        cells.push(format!("{mean:.4} ± {error:.4}"));
    }
    let points = seen.inverse.chunks(5).enumerate().map(|(k, blocks)| {
        let time = until * (k as f64 + 0.5) * 5.0 / seen.inverse.len() as f64;
        (time, blocks.len() as f64 / blocks.iter().sum::<f64>())
    });
    let mut series = Series::line(name, colour, points.collect());
    if control {
        series.stroke = Stroke::Dashed;
    }
    (cells, series)
}

/// The table and the picture, at costs.
pub fn report<P: Poisson<f64>>(
    problem: &Problem<P>,
    entrants: &[Entrant<P>],
    until: f64,
    costs: &[f64],
) -> (String, String) {
    let head = [
        "method",
        "at",
        "µs",
        "energy",
        "lengths",
        "T, first tenth",
        "T, last tenth",
    ];
    let mut text = String::new();
    let mut panels = Vec::new();
    for &most in costs {
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let mut series = Vec::new();
        for (colour, entrant) in entrants.iter().enumerate() {
            let Some((setting, cost)) = top::dearest(problem, entrant, most) else {
                continue;
            };
            let name = &entrant.name;
            eprintln!("{name} at {:.2} µs", cost * 1e6);
            let setting_text = setting.text(problem.delta);
            let mut row = vec![name.clone(), setting_text, format!("{:.2}", cost * 1e6)];
            match look(problem, entrant, setting, until) {
                Err(why) => row.push(why),
                Ok(seen) => {
                    let (cells, curve) = shown(&seen, until, name, entrant.control, colour);
                    row.extend(cells);
                    series.push(curve);
                }
            }
            rows.push(row);
        }
        let cost = format!("at most {} µs", table::rounded(most * 1e6));
        text.push_str(&format!("{cost} of the processor for a unit of time:\n\n"));
        text.push_str(&table::text(&rows));
        text.push('\n');
        panels.push(Panel {
            title: format!("{cost} for a unit of time"),
            x: Axis::linear("time"),
            y: Axis::linear("temperature"),
            series,
        });
    }
    let chart = Chart {
        title: "Temperature of a chain of eight spins".to_owned(),
        subtitle: format!(
            "Mean over twentieths of runs to t = {until}; dashed: methods without structure"
        ),
        panels,
        across: 2,
    };
    (text, chart.to_svg())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The energy in heights and angles of the spins.
    fn energy_of(at: &[(f64, f64)]) -> f64 {
        let spin = |&(z, angle): &(f64, f64)| {
            let r = (1.0 - z * z).sqrt();
            [r * angle.cos(), r * angle.sin(), z]
        };
        let spins: Vec<Vector> = at.iter().map(spin).collect();
        let bond = |pair: &[Vector]| -> f64 {
            (0..3).map(|c| EXCHANGE[c] * pair[0][c] * pair[1][c]).sum()
        };
        -spins.windows(2).map(bond).sum::<f64>()
    }

    /// The divergence by differences, in coordinates of the spheres (height and angle, whose area is constant).
    #[test]
    fn the_formula_is_the_divergence() {
        let mu = sample(0.7, 4, 3);
        let coordinates: Vec<(f64, f64)> = mu
            .chunks_exact(3)
            .map(|s| (s[2], s[1].atan2(s[0])))
            .collect();
        let shifted = |at: &[(f64, f64)], k: usize, by: f64| {
            let mut at = at.to_vec();
            match k % 2 {
                0 => at[k / 2].0 += by,
                _ => at[k / 2].1 += by,
            }
            at
        };
        let eps = 1e-4;
        // the metric is diagonal: 1/(1-z^2) and 1-z^2
        let field = |at: &[(f64, f64)]| -> Vec<f64> {
            let slopes: Vec<f64> = (0..8)
                .map(|k| {
                    (energy_of(&shifted(at, k, eps)) - energy_of(&shifted(at, k, -eps)))
                        / (2.0 * eps)
                })
                .collect();
            let raised: Vec<f64> = slopes
                .iter()
                .enumerate()
                .map(|(k, slope)| {
                    let rest = 1.0 - at[k / 2].0.powi(2);
                    if k % 2 == 0 {
                        slope * rest
                    } else {
                        slope / rest
                    }
                })
                .collect();
            let square: f64 = slopes.iter().zip(&raised).map(|(a, b)| a * b).sum();
            raised.iter().map(|x| x / square).collect()
        };
        let divergence: f64 = (0..8)
            .map(|k| {
                (field(&shifted(&coordinates, k, eps))[k]
                    - field(&shifted(&coordinates, k, -eps))[k])
                    / (2.0 * eps)
            })
            .sum();
        let found = inverse_temperature(&mu);
        assert!(
            (found - divergence).abs() < 1e-5 * found.abs(),
            "{found} {divergence}"
        );
    }

    /// The mean over a canonical ensemble is 1/T too: the integral of a divergence vanishes. By Metropolis' method.
    #[test]
    fn the_mean_of_a_canonical_ensemble() {
        const BETA: f64 = 1.5;
        let mut spins = sample(1.0 / BETA, 8, 5);
        let energy = |mu: &[f64]| -> f64 {
            let bonds = mu.chunks_exact(3).zip(mu[3..].chunks_exact(3));
            -bonds
                .map(|(a, b)| (0..3).map(|c| EXCHANGE[c] * a[c] * b[c]).sum::<f64>())
                .sum::<f64>()
        };
        let mut now = energy(&spins);
        let (mut sum, mut count) = (0.0, 0);
        let mut chance = random(11);
        let moves = sample(1e6, 400_000, 7);
        for (k, spin) in moves.chunks_exact(3).enumerate() {
            let mut other = spins.clone();
            other[3 * (k % 8)..3 * (k % 8) + 3].copy_from_slice(spin);
            let then = energy(&other);
            if chance() < (BETA * (now - then)).exp() {
                (spins, now) = (other, then);
            }
            if k > 1000 {
                sum += inverse_temperature(&spins);
                count += 1;
            }
        }
        let mean = sum / f64::from(count);
        assert!((mean / BETA - 1.0).abs() < 0.03, "{mean}");
    }
}
