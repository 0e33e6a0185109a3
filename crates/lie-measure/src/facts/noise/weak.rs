//! The order of means: by how much the mean of functions of the state changes when steps are halved.

use super::paths::{Increments, end};
use super::slope::{BATCHES, Level, slope};
use super::{FEWEST, FEWEST_SAMPLES, Finding, Noise, judged};
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::state::State;

/// The samples of a batch of a level: means over a path, the one of opposite sign, and both with steps that change places.
const SAMPLES: usize = 25;
/// The paths of a sample.
const PATHS: usize = 4;
/// Levels, each with steps of half the size.
const LEVELS: u32 = 4;
/// The most coordinates of which products are looked at.
const PRODUCTS: usize = 4;
/// Samples of levels have paths of their own, behind those in the mean square.
const FIRST: u64 = 1 << 20;

/// Functions of the state: its coordinates, their squares, of few ones their products, and the energy, each about 1 in size.
fn functions<P: Poisson<f64>>(system: &P, noise: &Noise<P::State>, mu: &P::State) -> Vec<f64> {
    let size = |mu: &P::State| noise.places.size(mu.as_slice());
    let scale = size(&noise.start).recip();
    let values = noise.places.values(mu.as_slice());
    let x: Vec<f64> = values.map(|x| x * scale).collect();
    let mut values = x.clone();
    for (i, first) in x.iter().enumerate() {
        let last = if x.len() <= PRODUCTS { x.len() } else { i + 1 };
        values.extend(x[i..last].iter().map(|second| first * second));
    }
    let mut gradient = system.zero_state();
    system.gradient(&noise.start, &mut gradient);
    let slope = size(&gradient) * size(&noise.start);
    if slope > 0.0 {
        values.push(system.energy(mu) / slope);
    }
    values
}

pub(super) fn finding<P: Lift<f64>>(
    system: &P,
    noise: &Noise<P::State>,
    method: &dyn AnyMethod<f64, P>,
    paths: Option<usize>,
) -> Finding {
    let of_batch = |paths: usize| BATCHES * paths.div_ceil(PATHS * BATCHES).max(FEWEST_SAMPLES);
    let samples = paths.map_or_else(|| noise.samples(SAMPLES), of_batch);
    let samples = samples.min(FIRST as usize / BATCHES * BATCHES);
    let mut levels = Vec::new();
    for level in 0..LEVELS {
        let steps = FEWEST << level;
        let h = noise.span / steps as f64;
        let change = |sample: usize| {
            let number = FIRST * (u64::from(level) + 1) + sample as u64;
            let fine = Increments::draw(noise.places, noise.seed, number, 2 * steps, noise.span);
            let turned = fine.in_turned_pairs();
            let mut sum = Vec::new();
            let paths = [&fine, &turned].map(|path| [path.clone(), path.negated()]);
            for path in paths.as_flattened() {
                let start = (&noise.start, noise.span);
                let along = |path: &Increments| {
                    let end = end(system, method, noise.places, start, path)?;
                    Some(functions(system, noise, &end))
                };
                let (coarse, fine) = (along(&path.in_steps(steps))?, along(path)?);
                sum.resize(coarse.len(), 0.0);
                let changes = coarse.iter().zip(&fine);
                for (sum, (coarse, fine)) in sum.iter_mut().zip(changes) {
                    *sum += (coarse - fine) / PATHS as f64;
                }
            }
            Some(sum)
        };
        levels.extend(Level::of(h, samples, change));
    }
    judged(
        "weak order",
        method.claims().weak_order(),
        slope(&levels, &along_their_sum),
        (samples, "samples of four paths"),
    )
}

/// The components of the changes along their sum over all levels: where h is small all point the same way.
fn along_their_sum(means: &[Vec<f64>]) -> Vec<f64> {
    let quantities = means.first().map_or(0, Vec::len);
    let sum: Vec<f64> = (0..quantities)
        .map(|k| means.iter().map(|mean| mean[k]).sum())
        .collect();
    let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
    let along = |mean: &Vec<f64>| mean.iter().zip(&sum).map(|(x, y)| x * y).sum::<f64>() / length;
    means.iter().map(along).collect()
}
