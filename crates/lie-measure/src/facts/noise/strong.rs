//! The order in the mean square: the distance from the path that fine steps make of the same noise.

use super::paths::{Increments, end};
use super::slope::{Level, slope};
use super::{FEWEST, Finding, Noise, judged};
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::methods::Rk4;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::state::State;

/// The paths of a batch.
const PATHS: usize = 12;
/// Levels, each with steps of half the size.
const LEVELS: u32 = 5;
/// Steps of the paths that count as exact over the smallest ones of a level.
const FINER: usize = 16;
/// An error of this part of the state is round-off.
const ROUND_OFF: f64 = 1e-11;

/// The number of steps of a level.
fn steps(level: u32) -> usize {
    FEWEST << level
}

/// The paths that count as exact: `rk4` with fine steps, which is no method of the algebra and converges to the equation of Stratonovich. Paths on
/// which it ends where nothing is a number are left out.
pub(super) fn exact<P: Poisson<f64>>(
    system: &P,
    noise: &Noise<P::State>,
) -> Vec<(Increments, P::State)> {
    let finest = FINER * steps(LEVELS - 1);
    let path = |path: usize| {
        let fine = Increments::draw(noise.places, noise.seed, path as u64, finest, noise.span);
        let end = end(
            system,
            &Rk4,
            noise.places,
            (&noise.start, noise.span),
            &fine,
        )?;
        Some((fine.in_steps(steps(LEVELS - 1)), end))
    };
    (0..noise.samples(PATHS)).filter_map(path).collect()
}

pub(super) fn finding<P: Lift<f64>>(
    system: &P,
    noise: &Noise<P::State>,
    method: &dyn AnyMethod<f64, P>,
) -> Finding {
    const FACT: &str = "strong order";
    let claim = method.claims().strong_order(noise.commuting);
    let paths = noise.samples(PATHS);
    let mut levels = Vec::new();
    for level in 0..LEVELS {
        let square = |number: usize| {
            let (path, exact) = noise.exact.get(number)?;
            let path = path.in_steps(steps(level));
            let start = (&noise.start, noise.span);
            let end = end(system, method, noise.places, start, &path)?;
            let values = |mu: &P::State| noise.places.values(mu.as_slice()).collect::<Vec<f64>>();
            let (end, exact) = (values(&end), values(exact));
            let pairs = end.iter().zip(&exact);
            Some(vec![pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>()])
        };
        let h = noise.span / steps(level) as f64;
        // large steps that fail say nothing of the order
        levels.extend(Level::of(h, paths, square));
    }
    let size = noise.places.size(noise.start.as_slice());
    let roots = |means: &[Vec<f64>]| means.iter().map(|mean| mean[0].sqrt()).collect::<Vec<_>>();
    let exact = |level: &Level| level.mean(0).sqrt() <= ROUND_OFF * size;
    if let (Some(claim), true) = (claim, !levels.is_empty() && levels.iter().all(exact)) {
        return Finding::at_least(FACT, true, f64::INFINITY, claim, claim)
            .note("exact to round-off".to_owned());
    }
    judged(FACT, claim, slope(&levels, &roots), (paths, "paths"))
}
