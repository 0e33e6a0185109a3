//! The coadjoint orbit with a trajectory on it as lines in space, which a page turns.

use lie_dynamic::Dynamic;
use lie_poisson::plot::contours::contours;
use lie_poisson::plot::surface::Point;
use serde_json::{Value, json};

use crate::command::run::picture::{casimir, energy};

/// Points of the trajectory at most.
const MOST: usize = 4000;
/// Values of each coordinate that have lines on a surface without level curves.
const NET: usize = 7;

/// The lines of a scene: of each the coordinates of its points, then the normals of the surface there. None where there is no
/// surface.
pub fn scene(system: &Dynamic<f64>, axes: &[String], states: &[Point]) -> Option<Value> {
    let first = states.first()?;
    let bounds = |of: fn(f64, f64) -> f64| {
        states
            .iter()
            .fold(*first, |all, point| [0, 1, 2].map(|i| of(all[i], point[i])))
    };
    let (low, high) = (bounds(f64::min), bounds(f64::max));
    let casimir = |point: &Point| casimir(system, point);
    let energy = |point: &Point| energy(system, point);
    let found = contours(&casimir, Some(&energy), first, (low, high))?;
    let (low, high) = found.surface.bounds()?;
    let size = (0..3)
        .map(|i| (high[i] - low[i]).powi(2))
        .sum::<f64>()
        .sqrt();
    let line = |points: &[Point]| -> Vec<f64> {
        let normals = points.iter().map(|point| {
            let normal = casimir(point).1;
            let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
            normal.map(|x| x / length.max(f64::MIN_POSITIVE))
        });
        let normals: Vec<Point> = normals.collect();
        points
            .iter()
            .chain(&normals)
            .flatten()
            .map(|x| short(*x))
            .collect()
    };
    let every = states.len().div_ceil(MOST);
    let curve: Vec<Point> = states.iter().copied().step_by(every).collect();
    let middle = [0, 1, 2].map(|i| short(0.5 * (low[i] + high[i])));
    let mut behind = found.surface.border();
    if found.constant {
        // so that the surface is seen
        behind.extend(found.surface.net(NET));
    }
    let levels = found.levels.iter().chain(&behind);
    let levels: Vec<Vec<f64>> = levels.map(|level| line(level)).collect();
    Some(json!({
        "axes": axes,
        "middle": middle,
        "size": short(size),
        "closed": found.closed,
        "constant": found.constant,
        "levels": levels,
        "curves": [line(&curve)],
    }))
}

/// Five digits, which a picture does not need more of.
fn short(x: f64) -> f64 {
    format!("{x:.4e}").parse().unwrap_or(x)
}
