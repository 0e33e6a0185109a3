//! The coadjoint orbit with a trajectory on it as lines in space, which a page turns.

use lie_dynamic::Dynamic;
use lie_plot::contours::contours;
use lie_plot::surface::Point;
use serde_json::{Value, json};

use crate::command::run::picture::{casimir, energy};

/// Points of a trajectory that are kept at most, of which at least half are drawn.
const MOST: usize = 8000;
/// Values of each coordinate that have lines on a surface without level curves.
const NET: usize = 7;

/// A trajectory, thinned out as it comes: of any length it takes little memory.
#[derive(Default)]
pub struct Curve {
    points: Vec<Point>,
    /// Every so-manyth point is kept, from the first one on.
    every: usize,
    seen: usize,
    bounds: Option<(Point, Point)>,
}

impl Curve {
    /// Takes the next point.
    pub fn push(&mut self, point: Point) {
        let (low, high) = self.bounds.unwrap_or((point, point));
        let of = |all: Point, of: fn(f64, f64) -> f64| [0, 1, 2].map(|i| of(all[i], point[i]));
        self.bounds = Some((of(low, f64::min), of(high, f64::max)));
        self.every = self.every.max(1);
        if self.seen.is_multiple_of(self.every) {
            self.points.push(point);
        }
        self.seen += 1;
        if self.points.len() == MOST {
            let mut place = 0;
            self.points.retain(|_| {
                place += 1;
                place % 2 == 1
            });
            self.every *= 2;
        }
    }
}

/// The lines of a scene: of each the coordinates of its points, then the normals of the surface there. None where there is no
/// surface.
pub fn scene(system: &Dynamic<f64>, axes: &[String], curve: &Curve) -> Option<Value> {
    let first = curve.points.first()?;
    let (low, high) = curve.bounds?;
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
        "curves": [line(&curve.points)],
    }))
}

/// Five digits, which a picture does not need more of.
fn short(x: f64) -> f64 {
    format!("{x:.4e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_trajectories_keep_their_shape_in_little_memory() {
        let mut curve = Curve::default();
        let count = 100_000;
        for k in 0..count {
            curve.push([f64::from(k), f64::from(-k), 1.0]);
        }
        let end = f64::from(count - 1);
        assert_eq!(curve.bounds, Some(([0.0, -end, 1.0], [end, 0.0, 1.0])));
        let steps: Vec<f64> = curve
            .points
            .windows(2)
            .map(|two| two[1][0] - two[0][0])
            .collect();
        assert!((MOST / 2..MOST).contains(&curve.points.len()));
        assert!(steps.iter().all(|step| *step == 16.0), "{}", steps[0]);
    }
}
